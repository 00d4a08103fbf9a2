#include "tools/app/commands/edit_frames.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "codec/decode/fill.h"
#include "fap/receiver.h"

namespace animeme::tools {
namespace {

fap::FillOptions filling_of(const EditSource& source) {
  fap::FillOptions options;
  options.keep_high_level = true;
  if (!source.coded()) options.mirror = options.lips = false;  // a text leaves them undefined
  return options;
}

// What is coded in a source, in its order.
class CodedFaces {
 public:
  explicit CodedFaces(const EditSource& source) : source_(source) {
    if (source.stream) planes_.emplace(source.stream->file);
    if (source.text) text_.emplace(source.text->reader());
  }

  // The next frame with its rules, good until the next call; null: there is none.
  Result<const fap::Frame*> next(fap::GroupRules& rules) {
    if (text_) return text_->next();
    for (;;) {
      const Result<const fba::Plane*> plane = next_plane();
      if (!plane) return plane.error();
      if (*plane == nullptr) break;
      if (!fba::has_face((*plane)->object_mask)) continue;
      const fba::FaceSettings none;
      rules = fba::group_rules((*plane)->face_settings ? *(*plane)->face_settings : none);
      return &(*plane)->face;
    }
    const std::vector<fap::Frame>& frames = source_.motion.face.frames;
    if (source_.coded() || next_ >= frames.size()) return nullptr;
    return &frames[next_++];
  }

 private:
  Result<const fba::Plane*> next_plane() {
    if (planes_) return planes_->next();
    const std::vector<fba::Plane>& planes = source_.motion.decoded.planes;
    if (!source_.coded() || next_ >= planes.size()) return nullptr;
    return &planes[next_++];
  }

  const EditSource& source_;
  std::optional<PlaneReader> planes_;
  std::optional<fap::TextReader> text_;
  std::size_t next_ = 0;
};

class CodedBodies {
 public:
  explicit CodedBodies(const EditSource& source) : source_(source) {
    if (source.stream) planes_.emplace(source.stream->file);
  }

  Result<const fba::BodyFrame*> next() {
    while (planes_) {
      const Result<const fba::Plane*> plane = planes_->next();
      if (!plane) return plane.error();
      if (*plane == nullptr) return nullptr;
      if ((*plane)->body) return &*(*plane)->body;
    }
    const std::vector<fba::BodyFrame>& frames = source_.motion.body.frames;
    return next_ < frames.size() ? &frames[next_++] : nullptr;
  }

 private:
  const EditSource& source_;
  std::optional<PlaneReader> planes_;
  std::size_t next_ = 0;
};

Result<void> read_faces(const EditSource& source, EditExtent& extent) {
  CodedFaces faces(source);
  fap::Receiver receiver(filling_of(source));
  fap::GroupRules rules{};
  std::int64_t count = 0;
  for (;;) {
    const auto frame = faces.next(rules);
    if (!frame) return frame.error();
    if (*frame == nullptr) break;
    const std::int64_t number = (*frame)->number;
    if (number <= extent.last_face) {
      return make_error(Code::invalid_argument, "the frame numbers have to ascend from 0, but " +
                                                    std::to_string(number) + " follows " +
                                                    std::to_string(extent.last_face));
    }
    extent.last_face = number;
    ++count;
    receiver.receive(**frame, rules);
  }
  if (extent.last_face + 1 - count > fap::kMostMissing) {
    return make_error(Code::out_of_range,
                      "the clip runs to frame " + std::to_string(extent.last_face) +
                          " but has only " + std::to_string(count) + "; at most " +
                          std::to_string(fap::kMostMissing) +
                          " frames that are missing are filled in: correct the frame numbers");
  }
  extent.face = receiver.mask();
  return {};
}

Result<void> read_bodies(const EditSource& source, EditExtent& extent) {
  CodedBodies bodies(source);
  for (;;) {
    const auto body = bodies.next();
    if (!body) return body.error();
    if (*body == nullptr) return {};
    if (extent.first_body < 0) extent.first_body = (*body)->number;
    extent.body |= (*body)->mask;
  }
}

}  // namespace

Result<EditExtent> extent_of(const EditSource& source) {
  EditExtent extent;
  if (auto done = read_faces(source, extent); !done) return done.error().in_file(source.path);
  if (auto done = read_bodies(source, extent); !done) return done.error().in_file(source.path);
  return extent;
}

struct FaceFrames::Impl {
  Impl(const EditCut& its, const EditExtent& known)
      : cut(its), extent(known), coded(*its.source), receiver(filling_of(*its.source)) {}

  // Goes on to the frame `wanted`; at the end the last one is held.
  Result<void> advance(std::int64_t wanted) {
    while (number < wanted && !over) {
      if (pending == nullptr) {
        const auto next = coded.next(rules);
        if (!next) return next.error();
        pending = *next;
        over = pending == nullptr;
        if (over) break;
      }
      ++number;
      if (pending->number <= number) {
        shown = &receiver.receive(*pending, rules);
        pending = nullptr;
      } else {
        shown = &receiver.hold();
      }
    }
    return {};
  }

  // At the rate of the source.
  Result<const fap::Frame*> next_shown() {
    if (at == cut.end - cut.first) return nullptr;
    const auto done = advance(std::max<std::int64_t>(cut.first + at - cut.source->lead, 0));
    if (!done) return done.error().in_file(cut.source->path);
    if (shown == nullptr) {
      return make_error(Code::io, "the file has changed while it was read")
          .in_file(cut.source->path);
    }
    out = fap::with_mask(*shown, extent.face);
    out.number = at++;
    return &out;
  }

  EditCut cut;
  const EditExtent& extent;
  CodedFaces coded;
  fap::Receiver receiver;
  fap::GroupRules rules{};
  const fap::Frame* pending = nullptr;  // coded, not shown yet
  const fap::Frame* shown = nullptr;    // of the receiver
  std::int64_t number = -1;             // of `shown`
  bool over = false;                    // nothing more is coded
  std::int64_t at = 0;                  // frames given
  fap::Frame out;
  std::optional<fap::Resampler> resampler;
  std::deque<fap::Frame> ready;  // resampled
  bool finished = false;
};

FaceFrames::FaceFrames(const EditCut& cut, const EditExtent& extent, fap::Rate played,
                       fap::Rate rate)
    : impl_(std::make_unique<Impl>(cut, extent)) {
  if (played != rate) impl_->resampler.emplace(played, rate);
}
FaceFrames::FaceFrames(FaceFrames&&) noexcept = default;
FaceFrames::~FaceFrames() = default;

Result<const fap::Frame*> FaceFrames::next() {
  Impl& self = *impl_;
  if (!self.resampler) return self.next_shown();
  const auto emit = [&self](const fap::Frame& frame) { self.ready.push_back(frame); };
  while (self.ready.empty()) {
    if (self.finished) return nullptr;
    const auto frame = self.next_shown();
    if (!frame) return frame;
    self.finished = *frame == nullptr;
    if (self.finished) {
      self.resampler->finish(emit);
    } else {
      self.resampler->push(**frame, emit);
    }
  }
  self.out = self.ready.front();
  self.ready.pop_front();
  return &self.out;
}

std::int64_t FaceFrames::count(const EditCut& cut, fap::Rate played, fap::Rate rate) {
  const std::int64_t frames = cut.end - cut.first;
  return played == rate ? frames : fap::Resampler(played, rate).frames(frames);
}

struct BodyFrames::Impl {
  Impl(const EditCut& its, const EditExtent& known) : cut(its), extent(known), coded(*its.source) {
    held.mask = known.body;
  }

  // At the rate of the source, and behind its end the last one.
  Result<void> next_shown() {
    before = held;
    if (at == cut.end - cut.first) return {};
    const std::int64_t wanted =
        std::max<std::int64_t>(cut.first + at - cut.source->lead, extent.first_body);
    for (;;) {
      if (pending == nullptr && !over) {
        const auto next = coded.next();
        if (!next) return next.error().in_file(cut.source->path);
        pending = *next;
        over = pending == nullptr;
      }
      if (over || pending->number > wanted) break;
      for (std::size_t bap = 1; bap < held.value.size(); ++bap) {
        if (pending->mask[bap]) held.value[bap] = pending->value[bap];
      }
      pending = nullptr;
    }
    if (at++ == 0) before = held;
    return {};
  }

  EditCut cut;
  const EditExtent& extent;
  CodedBodies coded;
  const fba::BodyFrame* pending = nullptr;  // coded, not shown yet
  bool over = false;                        // nothing more is coded
  fba::BodyFrame before,
      held;                 // the frames `at` - 2 and `at` - 1; behind the end both are the last
  std::int64_t at = 0;      // frames that `held` has gone on
  double step = 1;          // frames in, per frame out
  std::int64_t frames = 0;  // to give
  std::int64_t given = 0;
  fba::BodyFrame out;
};

BodyFrames::BodyFrames(const EditCut& cut, const EditExtent& extent, fap::Rate played,
                       fap::Rate rate)
    : impl_(std::make_unique<Impl>(cut, extent)) {
  if (played != rate) impl_->step = played.frames_per_second() / rate.frames_per_second();
  impl_->frames = count(cut, played, rate);
}
BodyFrames::BodyFrames(BodyFrames&&) noexcept = default;
BodyFrames::~BodyFrames() = default;

Result<const fba::BodyFrame*> BodyFrames::next() {
  Impl& self = *impl_;
  if (self.given == self.frames) return nullptr;
  const std::int64_t last = self.cut.end - self.cut.first - 1;
  const double at = std::min(double(self.given) * self.step, double(last));
  const auto index = std::int64_t(at);
  const double share = at - std::floor(at);
  // Frames `index` and, where something lies between, the one behind it.
  while (self.at < std::min(index + 2, last + 1)) {
    if (auto done = self.next_shown(); !done) return done.error();
  }
  const fba::BodyFrame& a = self.at == index + 2 ? self.before : self.held;
  self.out = a;
  for (std::size_t bap = 1; share > 0 && bap < a.value.size(); ++bap) {
    self.out.value[bap] =
        std::int32_t(std::llround(a.value[bap] * (1 - share) + self.held.value[bap] * share));
  }
  self.out.number = self.given++;
  return &self.out;
}

std::int64_t BodyFrames::count(const EditCut& cut, fap::Rate played, fap::Rate rate) {
  const std::int64_t frames = cut.end - cut.first;
  if (played == rate) return frames;
  const double step = played.frames_per_second() / rate.frames_per_second();
  return std::max<std::int64_t>(1, std::llround(double(frames) / step));
}

}  // namespace animeme::tools
