// encode(): the decisions for a whole clip, made in two passes.
#include <algorithm>
#include <cstdlib>
#include <string>

#include "codec/encoder.h"
#include "codec/quantise_internal.h"

namespace animeme::fba {

namespace {

constexpr int kMaxRange = 31;  // the 5-bit number: 31 * 60 = 1860 levels at fap_quant 1

// The clip with every FAP that occurs at all present in every frame.
std::vector<fap::Frame> complete(const fap::Sequence& clip, fap::Mask& used) {
  for (const fap::Frame& frame : clip.frames) used |= frame.mask;
  std::vector<fap::Frame> frames;
  frames.reserve(clip.frames.size());
  fap::Frame last;
  for (const fap::Frame& frame : clip.frames) {
    last.number = frame.number;
    last.mask = used;
    if (frame.mask[1]) last.viseme = frame.viseme;
    if (frame.mask[2]) last.expression = frame.expression;
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (frame.mask[fap]) last.value[fap] = frame.value[fap];
    }
    frames.push_back(last);
  }
  return frames;
}

Result<void> check(const fap::Sequence& clip, const EncodeOptions& options) {
  if (clip.frames.empty()) return make_error(Code::invalid_argument, "the clip has no frames");
  if (options.fap_quant < 0 || options.fap_quant > 31) {
    return make_error(Code::invalid_argument, "fap_quant must be 0..31");
  }
  if (options.intra_period < 0) {
    return make_error(Code::invalid_argument, "the intra period must not be negative");
  }
  for (std::size_t i = 1; i < clip.frames.size(); ++i) {
    if (clip.frames[i].number <= clip.frames[i - 1].number) {
      return make_error(Code::invalid_argument,
                        "frame numbers must ascend, but " + std::to_string(clip.frames[i].number) +
                            " follows " + std::to_string(clip.frames[i - 1].number));
    }
  }
  return {};
}

// Smallest m with m*60/scale >= level; more than kMaxRange if there is none.
int range_number(std::int64_t level, int scale) {
  return int(std::min<std::int64_t>((level * scale + 59) / 60, kMaxRange + 1));
}

// One run from an intra plane to the next, with its ranges.
struct Run {
  std::size_t first = 0;
  std::size_t count = 0;
  FaceSettings settings;
};

class Planner {
 public:
  Planner(const std::vector<fap::Frame>& frames, const fap::Mask& used,
          const EncodeOptions& options)
      : frames_(frames), used_(used), options_(options), scale_(fap_scale(options.fap_quant)) {}

  // Splits the clip into runs: at the intra period, and where a difference is too large.
  Result<std::vector<Run>> plan() {
    std::vector<Run> runs;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const bool due = runs.empty() || (options_.intra_period > 0 &&
                                        runs.back().count >= std::size_t(options_.intra_period));
      if (due || !extend(runs.back(), frames_[i])) {
        Result<Run> run = begin(i);
        if (!run) return run.error();
        runs.push_back(std::move(*run));
      }
      ++runs.back().count;
    }
    return runs;
  }

 private:
  Result<Run> begin(std::size_t index) {
    Run run;
    run.first = index;
    FaceSettings& settings = run.settings;
    settings.fap_quant = options_.fap_quant;
    settings.mask = used_;
    settings.send_range = {true, true, true, true};
    for (std::size_t group = 0; group < fap::kGroupCount; ++group) {
      const fap::GroupInfo& info = fap::kGroups[group];
      int coded = 0;
      for (int i = 0; i < info.size; ++i) coded += used_[std::size_t(info.first + i)] ? 1 : 0;
      settings.mask_type[group] = coded == 0           ? MaskType::none
                                  : coded == info.size ? MaskType::all
                                                       : MaskType::hold;
    }
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      const std::size_t n = std::size_t(fap);
      if (!used_[n]) continue;
      const std::int64_t level = internal::quantise(frames_[index].value[n], step(fap));
      const int m = range_number(std::abs(level), scale_);
      if (m > kMaxRange) {
        return make_error(
            Code::out_of_range,
            "FAP " + std::to_string(fap) + " (" + std::string(fap::info(fap).name) +
                ") = " + std::to_string(frames_[index].value[n]) + " in frame " +
                std::to_string(frames_[index].number) + " cannot be coded: the limit is +-" +
                std::to_string(1860 / scale_ * step(fap)) +
                (options_.fap_quant == 0 ? " without quantisation; use --quant 1" : ""));
      }
      settings.range[level >= 0 ? kIntraMax : kIntraMin][n] = std::uint8_t(m);
      rec_[n] = level * step(fap);
    }
    return run;
  }

  // Takes a predictive plane into the run; false if a difference does not fit any range.
  bool extend(Run& run, const fap::Frame& frame) {
    std::array<std::int64_t, fap::kFapCount + 1> level{};
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      const std::size_t n = std::size_t(fap);
      if (!used_[n]) continue;
      level[n] = internal::quantise(frame.value[n] - rec_[n], step(fap));
      if (range_number(std::abs(level[n]), scale_) > kMaxRange) return false;
    }
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      const std::size_t n = std::size_t(fap);
      if (!used_[n]) continue;
      std::uint8_t& range = run.settings.range[level[n] >= 0 ? kPredictiveMax : kPredictiveMin][n];
      const int m = range_number(std::abs(level[n]), scale_);
      range = std::max(range, std::uint8_t(m));
      rec_[n] += level[n] * step(fap);
    }
    return true;
  }

  std::int64_t step(int fap) const {
    return options_.fap_quant == 0 ? 1 : std::int64_t(fap::info(fap).quant_step) * scale_;
  }

  const std::vector<fap::Frame>& frames_;
  const fap::Mask& used_;
  const EncodeOptions& options_;
  const int scale_;
  std::array<std::int64_t, fap::kFapCount + 1> rec_{};
};

}  // namespace

Result<std::vector<std::uint8_t>> encode(const fap::Sequence& clip, const EncodeOptions& options) {
  if (auto ok = check(clip, options); !ok) return ok.error();
  const std::optional<CodedRate> rate = code_rate(clip.rate);
  if (!rate) {
    return make_error(Code::unsupported,
                      "a rate of " + std::to_string(clip.rate.num) + "/" +
                          std::to_string(clip.rate.den) +
                          " frames per second cannot be coded; use k/16 frames per second up to "
                          "255 15/16, or those times 1000/1001");
  }
  fap::Mask used;
  const std::vector<fap::Frame> frames = complete(clip, used);
  Result<std::vector<Run>> runs = Planner(frames, used, options).plan();
  if (!runs) return runs.error();

  Encoder encoder(options.stream);
  for (const Run& run : *runs) {
    for (std::size_t i = run.first; i < run.first + run.count; ++i) {
      PlaneInput plane;
      plane.intra = i == run.first;
      plane.face = &frames[i];
      if (plane.intra) {
        plane.face_settings = &run.settings;
        plane.temporal.rate = rate;
      }
      if (i + 1 < frames.size() && frames[i + 1].number != frames[i].number + 1) {
        plane.temporal.skip = std::uint32_t(frames[i + 1].number - frames[i].number - 1);
      }
      if (auto ok = encoder.write(plane); !ok) {
        Error error = ok.error();
        error.message = "frame " + std::to_string(frames[i].number) + ": " + error.message;
        return error;
      }
    }
  }
  return encoder.finish();
}

}  // namespace animeme::fba
