#include <algorithm>
#include <cmath>
#include <string>

#include "codec/encode/clip_internal.h"
#include "codec/syntax/settings_internal.h"
#include "codec/syntax/state_internal.h"

namespace animeme::fba::internal {

namespace {

template <class Frames>
Result<void> check_numbers(const Frames& frames) {
  for (std::size_t i = 1; i < frames.size(); ++i) {
    if (frames[i].number <= frames[i - 1].number) {
      return make_error(Code::invalid_argument, "frame numbers must ascend, but " +
                                                    std::to_string(frames[i].number) + " follows " +
                                                    std::to_string(frames[i - 1].number));
    }
  }
  return {};
}

// Numbers of the planes: those of either list.
std::vector<std::int64_t> merge_numbers(const fap::Sequence& face,
                                        std::span<const BodyFrame> body) {
  std::vector<std::int64_t> numbers;
  numbers.reserve(face.frames.size() + body.size());
  for (const fap::Frame& frame : face.frames) numbers.push_back(frame.number);
  for (const BodyFrame& frame : body) numbers.push_back(frame.number);
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

Result<void> check_high_levels(const fap::Sequence& face) {
  for (const fap::Frame& frame : face.frames) {
    if (auto ok = check_high_level(frame); !ok) {
      return make_error(ok.error().code,
                        "frame " + std::to_string(frame.number) + ": " + ok.error().message);
    }
  }
  return {};
}

Result<void> check_gaps(const std::vector<std::int64_t>& numbers) {
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    if (auto ok = check_step(numbers[i - 1], numbers[i]); !ok) return ok;
  }
  return {};
}

// The row of one parameter: the values of the frames that have it, held in between.
template <class Frames>
void fill_row(const Frames& frames, std::size_t index, const std::vector<std::int64_t>& numbers,
              std::vector<std::int32_t>& row) {
  row.resize(numbers.size());
  std::int32_t held = 0;
  std::size_t next = 0;
  for (std::size_t plane = 0; plane < numbers.size(); ++plane) {
    if (next < frames.size() && frames[next].number == numbers[plane]) {
      if (frames[next].mask[index]) held = frames[next].value[index];
      ++next;
    }
    row[plane] = held;
  }
}

template <class Frames>
auto used_mask(const Frames& frames) {
  auto mask = decltype(frames[0].mask){};
  for (const auto& frame : frames) mask |= frame.mask;
  return mask;
}

void gather_high_level(const fap::Sequence& face, ClipData& clip) {
  const fap::Mask used = used_mask(face.frames);
  clip.has_viseme = used[1];
  clip.has_expression = used[2];
  if (!used[1] && !used[2]) return;
  clip.viseme.resize(clip.planes());
  clip.expression.resize(clip.planes());
  fap::Viseme viseme;
  fap::Expression expression;
  std::size_t next = 0;
  for (std::size_t plane = 0; plane < clip.planes(); ++plane) {
    // What a frame defines or initialises is no state: it happens once.
    viseme.def = expression.def = expression.init_face = false;
    if (next < face.frames.size() && face.frames[next].number == clip.number[plane]) {
      if (face.frames[next].mask[1]) viseme = face.frames[next].viseme;
      if (face.frames[next].mask[2]) expression = face.frames[next].expression;
      ++next;
    }
    clip.viseme[plane] = viseme;
    clip.expression[plane] = expression;
  }
}

void gather_face(const fap::Sequence& face, bool all_faps, ClipData& clip) {
  const fap::Mask used = used_mask(face.frames);
  std::array<std::ptrdiff_t, fap::kFapCount + 1> index_of;
  index_of.fill(-1);
  for (int number = fap::kFirstLowLevel; number <= fap::kFapCount; ++number) {
    const bool given = used[std::size_t(number)];
    if (!given && !all_faps) continue;
    const fap::FapInfo& info = fap::info(number);
    Channel channel;
    channel.given = given;
    channel.number = number;
    channel.step = info.quant_step;
    channel.distance = info.unit != fap::Unit::angle;
    channel.unit = channel.distance ? 1 : channel.step * 0.5;
    if (info.mirror != 0 && info.mirror < number) {
      channel.left = index_of[std::size_t(info.mirror)];
    }
    fill_row(face.frames, std::size_t(number), clip.number, channel.value);
    if (given) index_of[std::size_t(number)] = std::ptrdiff_t(clip.channels.size());
    clip.channels.push_back(std::move(channel));
  }
}

void gather_body(std::span<const BodyFrame> body, ClipData& clip) {
  const auto used = used_mask(body);
  for (std::size_t slot = 0; slot < kBapOrder.size(); ++slot) {
    const std::size_t number = kBapOrder[slot];
    if (!used[number]) continue;
    Channel channel;
    channel.body = true;
    channel.distance = false;
    channel.number = int(number);
    channel.step = kBapSteps[slot];
    channel.unit = channel.step * 0.5;
    fill_row(body, number, clip.number, channel.value);
    clip.channels.push_back(std::move(channel));
  }
}

// FAP 1 and 2, a body or a face that rest throughout say nothing: decoders begin there. One of face
// and body stays.
void leave_out_rest(ClipData& clip) {
  const auto moves = [&](bool body) {
    return std::any_of(clip.channels.begin(), clip.channels.end(), [&](const Channel& channel) {
      return channel.body == body && !is_zero(channel.value);
    });
  };
  clip.has_viseme &= std::any_of(clip.viseme.begin(), clip.viseme.end(), [](const auto& viseme) {
    return viseme.select1 != 0 || viseme.select2 != 0 || viseme.def;
  });
  clip.has_expression &= std::any_of(
      clip.expression.begin(), clip.expression.end(), [](const fap::Expression& expression) {
        return (expression.select1 != 0 && expression.intensity1 != 0) ||
               (expression.select2 != 0 && expression.intensity2 != 0) || expression.def ||
               expression.init_face;
      });
  if (clip.has_face && !moves(true)) clip.has_body = false;
  if (clip.has_body && !clip.has_viseme && !clip.has_expression && !moves(false)) {
    clip.has_face = false;
  }
  std::erase_if(clip.channels, [&](const Channel& channel) {
    return !(channel.body ? clip.has_body : clip.has_face);
  });
}

}  // namespace

std::int64_t period_frames(double intra_seconds, fap::Rate rate) {
  if (intra_seconds <= 0) return 0;
  constexpr double kForever = 1e9;
  return std::max<std::int64_t>(
      1, std::llround(std::min(intra_seconds * rate.frames_per_second(), kForever)));
}

void add_periods(std::span<const std::int64_t> number, std::size_t first, std::size_t end,
                 std::int64_t frames, std::vector<std::size_t>& begins) {
  begins.push_back(first);
  if (frames <= 0) return;
  for (std::size_t plane = first + 1; plane < end; ++plane) {
    if (number[plane] - number[first] < frames) continue;
    begins.push_back(plane);
    first = plane;
  }
}

// A plane says how many frames are skipped behind it. Numbers may be any, so differences are taken
// without a sign.
Result<void> check_step(std::int64_t number, std::int64_t next) {
  if (std::uint64_t(next) - std::uint64_t(number) <= kMaxSkip + 1) return {};
  return make_error(Code::invalid_argument,
                    "frame " + std::to_string(next) + " follows frame " + std::to_string(number) +
                        ": more than a million frames in a row cannot be skipped; put frames "
                        "in between");
}

Result<ClipData> gather(const fap::Sequence& face, std::span<const BodyFrame> body,
                        bool leave_out) {
  if (face.frames.empty() && body.empty()) {
    return make_error(Code::invalid_argument, "the clip has no frames");
  }
  if (auto ok = check_numbers(face.frames); !ok) return ok.error();
  if (auto ok = check_numbers(body); !ok) return ok.error();
  if (auto ok = check_high_levels(face); !ok) return ok.error();
  const std::optional<CodedRate> rate = code_rate(face.rate);
  if (!rate) {
    return make_error(Code::unsupported,
                      "a rate of " + std::to_string(face.rate.num) + "/" +
                          std::to_string(face.rate.den) +
                          " frames per second cannot be coded; use k/16 frames per second up to "
                          "255 15/16, or those times 1000/1001");
  }
  ClipData clip;
  clip.rate = *rate;
  clip.has_face = !face.frames.empty();
  clip.has_body = !body.empty();
  clip.number = merge_numbers(face, body);
  if (auto ok = check_gaps(clip.number); !ok) return ok.error();
  gather_high_level(face, clip);
  gather_face(face, leave_out && clip.has_face, clip);
  gather_body(body, clip);
  if (leave_out) leave_out_rest(clip);
  return clip;
}

void quantise_row(std::span<const std::int32_t> value, std::int32_t step,
                  std::vector<std::int32_t>& levels) {
  levels.resize(value.size());
  std::int64_t rec = 0;
  std::int64_t level = 0;
  for (std::size_t plane = 0; plane < value.size(); ++plane) {
    const std::int64_t change = quantise(value[plane] - rec, step);
    level += change;
    rec += change * step;
    levels[plane] = std::int32_t(level);
  }
}

}  // namespace animeme::fba::internal
