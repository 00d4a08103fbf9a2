#include "codec/encode/long_clip.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "codec/decode/decoder.h"
#include "codec/encode/clip_internal.h"
#include "codec/encode/splice.h"
#include "codec/syntax/settings_internal.h"

namespace animeme::fba {

namespace {

// Frames of a face, a body or both.
struct Window {
  fap::Sequence face;
  std::vector<BodyFrame> body;
  std::size_t planes = 0;
  std::int64_t last = 0;  // number of the last plane

  void add(const fap::Frame* face_frame, const BodyFrame* body_frame) {
    if (face_frame != nullptr) face.frames.push_back(*face_frame);
    if (body_frame != nullptr) body.push_back(*body_frame);
    last = face_frame != nullptr ? face_frame->number : body_frame->number;
    ++planes;
  }
  // Keeps the memory.
  void clear() {
    face.frames.clear();
    body.clear();
    planes = 0;
  }
};

// What occurs in a clip as a whole, and the clip itself as long as it is no longer than a window.
struct Extent {
  fap::Mask face;
  std::bitset<kBapCount + 1> body;
  bool has_face = false;
  bool has_body = false;
  std::size_t planes = 0;
  Window whole;
};

std::size_t window_planes(const Extent& extent, std::size_t window) {
  return std::max<std::size_t>(1, extent.has_body ? window / 4 : window);
}

Result<Extent> look_at(const ClipSource& source, const EncodeOptions& options, std::size_t window) {
  Extent extent;
  extent.whole.face.rate = source.rate;
  auto done = source.each([&](const fap::Frame* face, const BodyFrame* body) -> Result<void> {
    if (face != nullptr) extent.face |= face->mask;
    if (body != nullptr) extent.body |= body->mask;
    extent.has_face = extent.has_face || face != nullptr;
    extent.has_body = extent.has_body || body != nullptr;
    ++extent.planes;
    if (options.kept_ranges || extent.planes <= window_planes(extent, window)) {
      extent.whole.add(face, body);
    } else {
      extent.whole = {};
    }
    return {};
  });
  if (!done) return done.error();
  return extent;
}

void add_report(const EncodeReport& more, EncodeReport& sum) {
  const auto add_error = [](double& rms, double& values, double more_rms, double more_values) {
    const double squares = rms * rms * values + more_rms * more_rms * more_values;
    values += more_values;
    rms = values > 0 ? std::sqrt(squares / values) : 0;
  };
  const bool first = sum.planes == 0;
  add_error(sum.rms, sum.values, more.rms, more.values);
  add_error(sum.rms_other, sum.values_other, more.rms_other, more.values_other);
  sum.fap_quant = std::max(sum.fap_quant, more.fap_quant);
  sum.bap_quant = std::max(sum.bap_quant, more.bap_quant);
  sum.coded = std::max(sum.coded, more.coded);
  sum.mirrored = std::max(sum.mirrored, more.mirrored);
  sum.left_out = first ? more.left_out : std::min(sum.left_out, more.left_out);
  sum.stilled = first ? more.stilled : std::min(sum.stilled, more.stilled);
  sum.planes += more.planes;
  sum.intra_planes += more.intra_planes;
  sum.skipped += more.skipped;
  sum.limited += more.limited;
  sum.retries += more.retries;
  sum.hazards += more.hazards;
}

class LongEncoder {
 public:
  LongEncoder(const ClipSource& source, const Extent& extent, const EncodeOptions& options,
              const TakeBytes& take, std::size_t window)
      : source_(source), extent_(extent), options_(options), take_(take), splicer_(options.stream) {
    window_.face.rate = source.rate;
    most_ = window_planes(extent, window);
    const std::int64_t period = internal::period_frames(options.intra_seconds, source.rate);
    if (period > 0 && std::size_t(period) <= most_) most_ -= most_ % std::size_t(period);
    options_.progress = [this](double share) { tell(share); };
  }

  Result<EncodeReport> encode() {
    auto read = source_.each(
        [this](const fap::Frame* face, const BodyFrame* body) { return add(face, body); });
    if (!read) return read.error();
    if (auto done = finish_window(0); !done) return done.error();
    if (auto done = take_(splicer_.finish()); !done) return done.error();
    if (splicer_.report().changed > 0) {
      return make_error(Code::internal, "the windows of the clip do not join to what was coded");
    }
    return report_;
  }

 private:
  Result<void> add(const fap::Frame* face, const BodyFrame* body) {
    const std::int64_t number = face != nullptr ? face->number : body->number;
    if (window_.planes == most_) {
      if (auto legal = internal::check_step(window_.last, number); !legal) return legal;
      if (auto done = finish_window(number - window_.last - 1); !done) return done;
      window_.clear();
    }
    hold(face, body);
    if (window_.planes == 0) {
      // What was held before is part of the window.
      const fap::Frame* all_face = extent_.has_face ? &face_ : nullptr;
      const BodyFrame* all_body = extent_.has_body ? &body_ : nullptr;
      face_.number = body_.number = number;
      window_.add(all_face, all_body);
    } else {
      window_.add(face, body);
    }
    return {};
  }

  // The state of a receiver, with everything that occurs in the clip.
  void hold(const fap::Frame* face, const BodyFrame* body) {
    face_.viseme.def = face_.expression.def = face_.expression.init_face = false;
    face_.mask = extent_.face;
    body_.mask = extent_.body;
    if (face != nullptr) {
      for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
        if (face->mask[fap]) face_.value[fap] = face->value[fap];
      }
      if (face->mask[1]) face_.viseme = face->viseme;
      if (face->mask[2]) face_.expression = face->expression;
    }
    if (body != nullptr) {
      for (std::size_t bap = 1; bap <= std::size_t(kBapCount); ++bap) {
        if (body->mask[bap]) body_.value[bap] = body->value[bap];
      }
    }
  }

  // Codes the window, which is followed by `gap` frames that are skipped.
  Result<void> finish_window(std::int64_t gap) {
    EncodeReport report;
    const auto stream = fba::encode(window_.face, options_, window_.body, &report);
    if (!stream) return stream.error();
    splicer_.begin_source();
    Decoder decoder;
    decoder.push(*stream);
    decoder.finish();
    for (std::size_t plane = 0; plane < report.planes;) {
      const Result<Event> event = decoder.next();
      if (!event) return event.error();
      if (event->kind != Event::Kind::plane) continue;
      const bool last = ++plane == report.planes;
      auto copied =
          last ? splicer_.copy(event->plane, std::uint32_t(gap)) : splicer_.copy(event->plane);
      if (!copied) return copied;
    }
    done_ += window_.planes;
    add_report(report, report_);
    return take_(splicer_.take());
  }

  void tell(double share) const {
    if (!progress_) return;
    progress_((double(done_) + share * double(window_.planes)) / double(extent_.planes));
  }

  const ClipSource& source_;
  const Extent& extent_;
  EncodeOptions options_;  // of each window
  const TakeBytes& take_;
  std::function<void(double)> progress_ = options_.progress;
  Splicer splicer_;
  Window window_;
  std::size_t most_ = 0;  // planes of a window
  fap::Frame face_;       // held
  BodyFrame body_;
  std::size_t done_ = 0;  // planes of the windows before
  EncodeReport report_;
};

}  // namespace

Result<EncodeReport> encode_long(const ClipSource& source, const EncodeOptions& options,
                                 const TakeBytes& take, std::size_t window) {
  const Result<Extent> extent = look_at(source, options, window);
  if (!extent) return extent.error();
  if (extent->planes != extent->whole.planes) {
    return LongEncoder(source, *extent, options, take, window).encode();
  }
  EncodeReport report;
  const auto stream = encode(extent->whole.face, options, extent->whole.body, &report);
  if (!stream) return stream.error();
  if (auto done = take(*stream); !done) return done.error();
  return report;
}

}  // namespace animeme::fba
