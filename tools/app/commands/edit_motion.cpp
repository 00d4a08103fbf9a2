#include "tools/app/commands/edit_motion.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <utility>

#include "fap/edit.h"
#include "fap/resample.h"

namespace animeme::tools {
namespace {

constexpr std::int64_t kFramesAtOnce = 2048;

// Faster by a factor, to a thousandth.
fap::Rate times(fap::Rate rate, double factor) {
  std::uint64_t num = rate.num * std::uint64_t(std::lround(1000 * factor));
  std::uint64_t den = rate.den * std::uint64_t(1000);
  for (; num > UINT32_MAX || den > UINT32_MAX; num /= 2, den /= 2) {
  }
  return fap::make_rate(std::uint32_t(num), std::uint32_t(den));
}

// A cut as it is joined to others. The time of one without a face, or without a body, passes in the
// other parts, too: there these rest.
struct JoinedPiece {
  EditCut cut;
  const EditExtent* extent = nullptr;
  fap::Rate played;         // rate at which its frames are shown
  std::int64_t faces = 0;   // frames of it in the face, at the rate of all
  std::int64_t bodies = 0;  // likewise in the body
};

struct JoinedCuts {
  fap::Rate rate;
  std::vector<JoinedPiece> pieces;
  double cross_fade = 0;
  std::int64_t hold = 0;
  fap::Mask mask;  // of the face
  std::bitset<fba::kBapCount + 1> body_mask;
  std::int64_t faces = 0;  // with those for which the first one is held
  std::int64_t bodies = 0;
};

// The faces of all pieces, one behind the other, without changes.
class JoinedFaces {
 public:
  explicit JoinedFaces(const JoinedCuts& cuts) : cuts_(cuts) {}

  // Not to be called more often than there are frames.
  Result<fap::Frame> next() {
    if (given_ > 0 && held_ < cuts_.hold) {
      ++held_;
      return first_;
    }
    for (;;) {
      if (!begun_) {
        if (auto done = begin(); !done) return done.error();
      }
      const auto frame = faded_.empty() ? next_of_piece() : next_faded();
      if (!frame) return frame.error();
      if (!*frame) {
        ++piece_;
        begun_ = false;
        continue;
      }
      last_ = **frame;
      last_.mask = cuts_.mask;
      if (given_++ == 0) first_ = last_;
      return last_;
    }
  }

 private:
  using MaybeFrame = std::optional<fap::Frame>;

  Result<MaybeFrame> next_of_piece() {
    if (!reader_) return rest_-- > 0 ? MaybeFrame(fap::Frame()) : MaybeFrame();
    const auto frame = reader_->next();
    if (!frame) return frame.error();
    return *frame == nullptr ? MaybeFrame() : MaybeFrame(**frame);
  }

  Result<MaybeFrame> next_faded() {
    MaybeFrame frame = faded_.front();
    faded_.pop_front();
    return frame;
  }

  // A piece; where it is cross-faded, its first frames are made at once.
  Result<void> begin() {
    if (piece_ >= cuts_.pieces.size()) return make_error(Code::io, "the input has become shorter");
    begun_ = true;
    const JoinedPiece& piece = cuts_.pieces[piece_];
    reader_.reset();
    rest_ = piece.faces;
    if (piece.extent->has_face()) {
      reader_.emplace(piece.cut, *piece.extent, piece.played, cuts_.rate);
    }
    if (given_ == 0 || !(cuts_.cross_fade > 0)) return {};
    const double blend = cuts_.cross_fade * cuts_.rate.frames_per_second();
    fap::Sequence next{cuts_.rate, {}, {}}, joint{cuts_.rate, {last_}, {}};
    while (double(next.frames.size()) < blend) {
      const auto frame = next_of_piece();
      if (!frame) return frame.error();
      if (!*frame) break;
      next.frames.push_back(**frame);
    }
    fap::append(joint, next, cuts_.cross_fade);
    faded_.assign(joint.frames.begin() + 1, joint.frames.end());
    return {};
  }

  const JoinedCuts& cuts_;
  std::size_t piece_ = 0;
  bool begun_ = false;
  std::optional<FaceFrames> reader_;  // of the piece; none: it has no face
  std::int64_t rest_ = 0;             // frames of such a one to come
  std::deque<fap::Frame> faded_;
  std::int64_t given_ = 0, held_ = 0;
  fap::Frame first_, last_;
};

class JoinedBodies {
 public:
  explicit JoinedBodies(const JoinedCuts& cuts) : cuts_(cuts) {}

  // Not to be called more often than there are frames.
  Result<fba::BodyFrame> next() {
    if (given_ > 0 && held_ < cuts_.hold) {
      ++held_;
      return first_;
    }
    fba::BodyFrame frame;
    for (;; ++piece_, here_ = 0) {
      if (piece_ >= cuts_.pieces.size()) {
        return make_error(Code::io, "the input has become shorter");
      }
      const JoinedPiece& piece = cuts_.pieces[piece_];
      if (here_ == piece.bodies) continue;
      if (!piece.extent->has_body()) break;
      if (here_ == 0) reader_.emplace(piece.cut, *piece.extent, piece.played, cuts_.rate);
      const auto body = reader_->next();
      if (!body) return body.error();
      if (*body != nullptr) frame = **body;
      break;
    }
    ++here_;
    frame.mask = cuts_.body_mask;
    if (given_++ == 0) first_ = frame;
    return frame;
  }

 private:
  const JoinedCuts& cuts_;
  std::size_t piece_ = 0;
  std::int64_t here_ = 0;  // frames of the piece so far
  std::optional<BodyFrames> reader_;
  std::int64_t given_ = 0, held_ = 0;
  fba::BodyFrame first_;
};

// A file of which something is taken, at its own speed.
struct Taken {
  EditTake take;
  std::unique_ptr<EditSource> source;
  EditExtent extent;

  EditCut cut() const { return {source.get(), 0, source->frames}; }
};

fap::Mask mirrored(const fap::Mask& mask) {
  fap::Sequence one;
  one.frames.emplace_back().mask = mask;
  fap::mirror(one);
  return one.frames.front().mask;
}

Result<JoinedCuts> join(const std::vector<EditCut>& cuts, fap::Rate rate,
                        const EditChanges& changes,
                        std::map<const EditSource*, EditExtent>& extents) {
  JoinedCuts joined{rate, {}, changes.cross_fade, changes.hold, {}, {}, 0, 0};
  bool face = false, body = false;
  for (const EditCut& cut : cuts) {
    const auto [place, is_new] = extents.try_emplace(cut.source);
    if (is_new) {
      auto extent = extent_of(*cut.source);
      if (!extent) return extent.error();
      place->second = *extent;
    }
    JoinedPiece piece{cut, &place->second, cut.source->rate, 0, 0};
    if (changes.speed != 1) piece.played = times(piece.played, changes.speed);
    if (piece.played != rate) {
      const auto sensible = fap::check_resampling(piece.played, rate, cut.end - cut.first);
      if (!sensible) return sensible.error().in_file(cut.source->path);
    }
    if (piece.extent->has_face()) piece.faces = FaceFrames::count(cut, piece.played, rate);
    if (piece.extent->has_body()) piece.bodies = BodyFrames::count(cut, piece.played, rate);
    face = face || piece.faces > 0;
    body = body || piece.bodies > 0;
    joined.mask |= piece.extent->face;
    joined.body_mask |= piece.extent->body;
    joined.pieces.push_back(piece);
  }
  for (JoinedPiece& piece : joined.pieces) {
    const std::int64_t frames = std::max(piece.faces, piece.bodies);
    if (face && piece.faces == 0) piece.faces = frames;
    if (body && piece.bodies == 0) piece.bodies = frames;
    joined.faces += piece.faces;
    joined.bodies += piece.bodies;
  }
  if (joined.faces > 0) joined.faces += changes.hold;
  if (joined.bodies > 0) joined.bodies += changes.hold;
  return joined;
}

}  // namespace

struct EditedMotion::Impl {
  JoinedCuts cuts;
  EditChanges changes;
  std::string name;
  std::vector<Taken> taken;
  std::map<const EditSource*, EditExtent> extents;  // of the sources of cuts
  std::int64_t faces = 0, bodies = 0;
  fap::Mask mask;  // of the face in the end

  Result<void> open_takes();
  std::int64_t reach() const;

  class Faces;
  class Bodies;
};

Result<void> EditedMotion::Impl::open_takes() {
  for (const EditTake& take : changes.takes) {
    auto source = open_edit_source(take.path);
    if (!source) return source.error();
    Taken one{take, std::make_unique<EditSource>(std::move(*source)), {}};
    auto extent = extent_of(*one.source);
    if (!extent) return extent.error();
    one.extent = *extent;
    const auto sensible = fap::check_resampling(one.source->rate, cuts.rate, one.source->frames);
    if (!sensible) return sensible.error().in_file(take.path);
    const bool body = take.what == EditTake::What::body;
    if (body ? !one.extent.has_body() : !one.extent.has_face()) {
      return make_error(Code::not_found, body ? "there is no body here" : "there is no face here")
          .in_file(take.path);
    }
    if (body) {
      bodies = std::max(faces, bodies);
    } else {
      faces = faces > 0 ? faces : bodies;
      mask |= one.extent.face & take.faps;
    }
    taken.push_back(std::move(one));
  }
  return {};
}

// Frames before and behind one that have a part in it.
std::int64_t EditedMotion::Impl::reach() const {
  double reach = 0;
  for (const EditAmount& amount : changes.smooth) {
    reach += fap::smooth_reach(cuts.rate, amount.value);
  }
  return std::int64_t(std::min(reach, double(faces)));
}

// The changed face, some frames at a time: what needs neighbours has those around them.
class EditedMotion::Impl::Faces {
 public:
  explicit Faces(const Impl& all)
      : all_(all), joined_(all.cuts), reach_(all.reach()), most_(std::max(kFramesAtOnce, reach_)) {
    for (const Taken& one : all.taken) {
      if (one.take.what == EditTake::What::body) continue;
      taken_.push_back({&one, FaceFrames(one.cut(), one.extent, one.source->rate, all.cuts.rate),
                        FaceFrames::count(one.cut(), one.source->rate, all.cuts.rate)});
    }
  }

  // The next frame, good until the next call.
  Result<const fap::Frame*> next() {
    if (at_ == ready_.frames.size()) {
      if (auto done = make(); !done) return done.error();
    }
    return &ready_.frames[at_++];
  }

 private:
  struct TakenFace {
    const Taken* one;
    FaceFrames frames;
    std::int64_t count;
  };

  // What each frame has by itself.
  Result<void> read_more(std::int64_t end) {
    const std::int64_t first = first_ + std::int64_t(read_.size());
    fap::Sequence piece{all_.cuts.rate, {}, {}};
    for (std::int64_t i = first; i < end; ++i) {
      if (all_.cuts.faces == 0) {  // all of it is taken from elsewhere
        piece.frames.emplace_back();
        continue;
      }
      const auto frame = joined_.next();
      if (!frame) return frame.error();
      piece.frames.push_back(*frame);
    }
    if (all_.changes.mirror) fap::mirror(piece);
    for (TakenFace& other : taken_) {
      fap::Sequence from{all_.cuts.rate, {}, {}};
      while (from.frames.size() < piece.frames.size()) {
        const auto frame = other.frames.next();
        if (!frame) return frame.error();
        if (*frame == nullptr) break;
        from.frames.push_back(**frame);
      }
      fap::replace(piece, from, other.one->take.faps, all_.cuts.cross_fade, {first, all_.faces},
                   other.count);
    }
    for (const EditAmount& amount : all_.changes.scale) {
      fap::scale(piece, amount.faps, amount.value);
    }
    for (fap::Frame& frame : piece.frames) {
      frame.mask = all_.mask;
      read_.push_back(frame);
    }
    return {};
  }

  Result<void> make() {
    const std::int64_t begin = made_, end = std::min(made_ + most_, all_.faces);
    const std::int64_t from = std::max<std::int64_t>(begin - reach_, 0);
    const std::int64_t to = std::min(end + reach_, all_.faces);
    while (first_ + std::int64_t(read_.size()) < to) {
      const std::int64_t have = first_ + std::int64_t(read_.size());
      if (auto done = read_more(std::min(have + kFramesAtOnce, to)); !done) return done;
    }
    for (; first_ < from; ++first_) read_.pop_front();
    ready_ = {all_.cuts.rate, {read_.begin(), read_.end()}, {}};
    for (const EditAmount& amount : all_.changes.smooth) {
      fap::smooth(ready_, amount.faps, amount.value);
    }
    ready_.frames.resize(std::size_t(end - from));
    ready_.frames.erase(ready_.frames.begin(), ready_.frames.begin() + (begin - from));
    fap::fade(ready_, all_.changes.fade_in, all_.changes.fade_out, {begin, all_.faces});
    for (fap::Frame& frame : ready_.frames) frame.number = made_++;
    at_ = 0;
    return {};
  }

  const Impl& all_;
  JoinedFaces joined_;
  std::vector<TakenFace> taken_;
  const std::int64_t reach_, most_;
  std::deque<fap::Frame> read_;  // from frame first_ on
  std::int64_t first_ = 0;
  fap::Sequence ready_;
  std::size_t at_ = 0;     // in ready_
  std::int64_t made_ = 0;  // frames that were in it so far
};

class EditedMotion::Impl::Bodies {
 public:
  explicit Bodies(const Impl& all) : joined_(all.cuts) {
    for (const Taken& one : all.taken) {
      if (one.take.what != EditTake::What::body) continue;
      taken_.emplace(one.cut(), one.extent, one.source->rate, all.cuts.rate);
    }
  }

  // The next frame, good until the next call. A body that is taken is held at its end.
  Result<const fba::BodyFrame*> next() {
    if (taken_) {
      const auto body = taken_->next();
      if (!body) return body;
      if (*body != nullptr) body_ = **body;
    } else {
      auto body = joined_.next();
      if (!body) return body.error();
      body_ = *body;
    }
    body_.number = number_++;
    return &body_;
  }

 private:
  JoinedBodies joined_;
  std::optional<BodyFrames> taken_;
  fba::BodyFrame body_;
  std::int64_t number_ = 0;
};

EditedMotion::EditedMotion(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
EditedMotion::EditedMotion(EditedMotion&&) noexcept = default;
EditedMotion& EditedMotion::operator=(EditedMotion&&) noexcept = default;
EditedMotion::~EditedMotion() = default;

Result<EditedMotion> EditedMotion::open(std::vector<EditCut> cuts, fap::Rate rate,
                                        EditChanges changes) {
  auto impl = std::make_unique<Impl>();
  impl->name = cuts.front().source->motion.face.name;
  auto joined = join(cuts, rate, changes, impl->extents);
  if (!joined) return joined.error();
  impl->cuts = std::move(*joined);
  impl->changes = std::move(changes);
  impl->faces = impl->cuts.faces;
  impl->bodies = impl->cuts.bodies;
  impl->mask = impl->changes.mirror ? mirrored(impl->cuts.mask) : impl->cuts.mask;
  if (auto done = impl->open_takes(); !done) return done.error();
  return EditedMotion(std::move(impl));
}

fap::Rate EditedMotion::rate() const { return impl_->cuts.rate; }
const std::string& EditedMotion::name() const { return impl_->name; }
std::int64_t EditedMotion::faces() const { return impl_->faces; }
std::int64_t EditedMotion::bodies() const { return impl_->bodies; }

Result<void> EditedMotion::each(const fba::TakeInstant& take) const {
  Impl::Faces faces(*impl_);
  Impl::Bodies bodies(*impl_);
  for (std::int64_t i = 0; i < std::max(impl_->faces, impl_->bodies); ++i) {
    Result<const fap::Frame*> face = nullptr;
    Result<const fba::BodyFrame*> body = nullptr;
    if (i < impl_->faces) face = faces.next();
    if (!face) return face.error();
    if (i < impl_->bodies) body = bodies.next();
    if (!body) return body.error();
    if (auto done = take(*face, *body); !done) return done;
  }
  return {};
}

}  // namespace animeme::tools
