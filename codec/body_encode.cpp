#include "codec/body_encode.h"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <type_traits>

#include "codec/quantise_internal.h"

namespace animeme::fba {

namespace {

constexpr int kMaxRange = 31;  // the 5-bit number: 31 * 60 = 1860 levels at quantiser 1

// One family of parameters, face or body: what its planner has to know.
struct FaceFamily {
  using Settings = FaceSettings;
  using Frame = fap::Frame;
  static constexpr const char* kName = "FAP";
  static constexpr std::size_t kFirst = fap::kFirstLowLevel;
  static int scale(int quant) { return fap_scale(quant); }
  static int step(std::size_t number) { return fap::info(int(number)).quant_step; }
  static void set_quant(Settings& settings, int quant) { settings.fap_quant = quant; }
  static void hold(const Frame& given, Frame& held) {
    if (given.mask[1]) held.viseme = given.viseme;
    if (given.mask[2]) held.expression = given.expression;
  }
  template <class Visit>
  static void for_each_group(Visit visit) {
    for (std::size_t group = 0; group < fap::kGroupCount; ++group) {
      std::vector<std::size_t> members;
      for (int i = 0; i < fap::kGroups[group].size; ++i) {
        members.push_back(std::size_t(fap::kGroups[group].first + i));
      }
      visit(group, members);
    }
  }
};

struct BodyFamily {
  using Settings = BodySettings;
  using Frame = BodyFrame;
  static constexpr const char* kName = "BAP";
  static constexpr std::size_t kFirst = 1;
  static int scale(int quant) { return bap_scale(quant); }
  static int step(std::size_t number) {
    const auto slot = std::find(kBapOrder.begin(), kBapOrder.end(), number);
    return kBapSteps[std::size_t(slot - kBapOrder.begin())];
  }
  static void set_quant(Settings& settings, int quant) { settings.bap_quant = quant; }
  static void hold(const Frame&, Frame&) {}
  template <class Visit>
  static void for_each_group(Visit visit) {
    std::size_t slot = 0;
    for (std::size_t group = 0; group < kBodyGroupCount; ++group) {
      std::vector<std::size_t> members(
          kBapOrder.begin() + std::ptrdiff_t(slot),
          kBapOrder.begin() + std::ptrdiff_t(slot) + kBodyGroupSizes[group]);
      slot += members.size();
      visit(group, members);
    }
  }
};

// A frame for each number, with everything that occurs in the clip present.
template <class Family>
std::vector<typename Family::Frame> complete(const std::vector<typename Family::Frame>& frames,
                                             const std::vector<std::int64_t>& numbers) {
  typename Family::Frame held;
  for (const auto& frame : frames) held.mask |= frame.mask;
  std::vector<typename Family::Frame> out;
  auto next = frames.begin();
  for (const std::int64_t number : numbers) {
    if (next != frames.end() && next->number == number) {
      Family::hold(*next, held);
      for (std::size_t i = Family::kFirst; i < held.value.size(); ++i) {
        if (next->mask[i]) held.value[i] = next->value[i];
      }
      ++next;
    }
    held.number = number;
    out.push_back(held);
  }
  return out;
}

// Follows the frames of a run and widens its ranges to what they need.
template <class Family>
class RunPlanner {
 public:
  using Settings = typename Family::Settings;
  using Frame = typename Family::Frame;

  RunPlanner(const decltype(Settings().mask)& used, int quant) : scale_(Family::scale(quant)) {
    Family::set_quant(fresh_, quant);
    fresh_.mask = used;
    fresh_.send_range = {true, true, true, true};
    Family::for_each_group([&](std::size_t group, const std::vector<std::size_t>& members) {
      const auto coded = std::count_if(members.begin(), members.end(),
                                       [&](std::size_t number) { return used[number]; });
      fresh_.mask_type[group] = coded == 0                             ? MaskType::none
                                : std::size_t(coded) == members.size() ? MaskType::all
                                                                       : MaskType::hold;
    });
    for (std::size_t number = Family::kFirst; number < used.size(); ++number) {
      if (used[number]) coded_.push_back({number, quant == 0 ? 1 : Family::step(number) * scale_});
    }
  }

  // An intra plane.
  Result<void> begin(const Frame& frame) {
    settings_ = fresh_;
    for (Coded& one : coded_) {
      const std::int64_t value = frame.value[one.number];
      const std::int64_t level = internal::quantise(value, one.step);
      if (range_number(level) > kMaxRange) {
        return make_error(Code::out_of_range,
                          std::string(Family::kName) + " " + std::to_string(one.number) + " = " +
                              std::to_string(value) + " in frame " + std::to_string(frame.number) +
                              " cannot be coded: the limit is +-" +
                              std::to_string(kMaxRange * 60 / scale_ * one.step) +
                              "; use a larger quantiser");
      }
      widen(level >= 0 ? kIntraMax : kIntraMin, one.number, level);
      one.rec = level * one.step;
    }
    return {};
  }
  // True if the frame can be a predictive plane.
  bool fits(const Frame& frame) const {
    return std::all_of(coded_.begin(), coded_.end(), [&](const Coded& one) {
      return range_number(difference(one, frame)) <= kMaxRange;
    });
  }
  void follow(const Frame& frame) {
    for (Coded& one : coded_) {
      const std::int64_t level = difference(one, frame);
      widen(level >= 0 ? kPredictiveMax : kPredictiveMin, one.number, level);
      one.rec += level * one.step;
    }
  }
  const Settings& settings() const { return settings_; }

 private:
  struct Coded {
    std::size_t number;
    std::int64_t step;
    std::int64_t rec = 0;
  };

  static std::int64_t difference(const Coded& one, const Frame& frame) {
    return internal::quantise(frame.value[one.number] - one.rec, one.step);
  }
  // Smallest m with m * 60 / scale >= level.
  std::int64_t range_number(std::int64_t level) const {
    return (std::abs(level) * scale_ + 59) / 60;
  }
  void widen(RangeKind kind, std::size_t number, std::int64_t level) {
    std::uint8_t& range = settings_.range[kind][number];
    range = std::max(range, std::uint8_t(range_number(level)));
  }

  int scale_;
  Settings fresh_;
  Settings settings_;
  std::vector<Coded> coded_;
};

// From an intra plane to the next.
struct Run {
  std::size_t first = 0;
  FaceSettings face;
  BodySettings body;
};

template <class Frame>
bool ascends(const std::vector<Frame>& frames) {
  return std::adjacent_find(frames.begin(), frames.end(), [](const Frame& a, const Frame& b) {
           return a.number >= b.number;
         }) == frames.end();
}

Result<void> check(const fap::Sequence& face, const BodySequence& body,
                   const EncodeOptions& options) {
  const auto invalid = [](const char* text) { return make_error(Code::invalid_argument, text); };
  if (body.frames.empty()) return invalid("the body has no frames");
  if (!face.frames.empty() && face.rate != body.rate) {
    return invalid("face and body have different frame rates, a stream has one");
  }
  if (options.fap_quant < 0 || options.fap_quant > 31) return invalid("fap_quant must be 0..31");
  if (options.intra_period < 0) return invalid("the intra period must not be negative");
  if (!ascends(face.frames) || !ascends(body.frames)) return invalid("frame numbers must ascend");
  return {};
}

class Clip {
 public:
  Clip(const fap::Sequence& face, const BodySequence& body, const EncodeOptions& options)
      : options_(options),
        object_mask_(face.frames.empty() ? ObjectMask::body : ObjectMask::face_and_body) {
    for (const auto& frame : face.frames) numbers_.push_back(frame.number);
    for (const auto& frame : body.frames) numbers_.push_back(frame.number);
    std::sort(numbers_.begin(), numbers_.end());
    numbers_.erase(std::unique(numbers_.begin(), numbers_.end()), numbers_.end());
    face_ = complete<FaceFamily>(face.frames, numbers_);
    body_ = complete<BodyFamily>(body.frames, numbers_);
  }

  Result<void> plan() {
    RunPlanner<FaceFamily> face(face_.front().mask, options_.fap_quant);
    RunPlanner<BodyFamily> body(body_.front().mask, options_.fap_quant);
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      const bool due = options_.intra_period > 0 && !runs_.empty() &&
                       i - runs_.back().first >= std::size_t(options_.intra_period);
      if (runs_.empty() || due || !face.fits(face_[i]) || !body.fits(body_[i])) {
        runs_.push_back({i, {}, {}});
        if (auto ok = face.begin(face_[i]); !ok) return ok;
        if (auto ok = body.begin(body_[i]); !ok) return ok;
      } else {
        face.follow(face_[i]);
        body.follow(body_[i]);
      }
      runs_.back().face = face.settings();
      runs_.back().body = body.settings();
    }
    return {};
  }

  Result<std::vector<std::uint8_t>> write(const CodedRate& rate) const {
    Encoder encoder(options_.stream);
    auto run = runs_.begin();
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      if (run + 1 != runs_.end() && (run + 1)->first == i) ++run;
      PlaneInput plane;
      plane.intra = run->first == i;
      plane.object_mask = object_mask_;
      plane.face = &face_[i];
      plane.body = &body_[i];
      if (plane.intra) {
        plane.face_settings = &run->face;
        plane.body_settings = &run->body;
        plane.temporal.rate = rate;
      }
      if (i + 1 < numbers_.size() && numbers_[i + 1] != numbers_[i] + 1) {
        const std::int64_t skip = numbers_[i + 1] - numbers_[i] - 1;
        plane.temporal.skip = std::uint32_t(std::min<std::int64_t>(skip, UINT32_MAX));
      }
      if (auto ok = encoder.write(plane); !ok) {
        Error error = ok.error();
        error.message = "frame " + std::to_string(numbers_[i]) + ": " + error.message;
        return error;
      }
    }
    return encoder.finish();
  }

 private:
  const EncodeOptions& options_;
  ObjectMask object_mask_;
  std::vector<std::int64_t> numbers_;
  std::vector<fap::Frame> face_;
  std::vector<BodyFrame> body_;
  std::vector<Run> runs_;
};

}  // namespace

Result<std::vector<std::uint8_t>> encode_with_body(const fap::Sequence& face,
                                                   const BodySequence& body,
                                                   const EncodeOptions& options) {
  if (auto ok = check(face, body, options); !ok) return ok.error();
  const std::optional<CodedRate> rate = code_rate(body.rate);
  if (!rate) {
    return make_error(Code::unsupported,
                      "a rate of " + std::to_string(body.rate.num) + "/" +
                          std::to_string(body.rate.den) +
                          " frames per second cannot be coded; use k/16 frames per second up to "
                          "255 15/16, or those times 1000/1001");
  }
  Clip clip(face, body, options);
  if (auto ok = clip.plan(); !ok) return ok.error();
  return clip.write(*rate);
}

}  // namespace animeme::fba
