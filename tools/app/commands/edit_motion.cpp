#include "tools/app/commands/edit_motion.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "fap/edit.h"
#include "fap/resample.h"

namespace animeme::tools {
namespace {

// Faster by a factor, to a thousandth.
fap::Rate times(fap::Rate rate, double factor) {
  std::uint64_t num = rate.num * std::uint64_t(std::lround(1000 * factor));
  std::uint64_t den = rate.den * std::uint64_t(1000);
  for (; num > UINT32_MAX || den > UINT32_MAX; num /= 2, den /= 2) {
  }
  return fap::make_rate(std::uint32_t(num), std::uint32_t(den));
}

// At another rate, linearly, for the same time.
std::vector<fba::BodyFrame> resampled(const std::vector<fba::BodyFrame>& body, fap::Rate from,
                                      fap::Rate to) {
  if (body.empty() || from == to) return body;
  const double step = from.frames_per_second() / to.frames_per_second();
  const auto count = std::max<std::int64_t>(1, std::llround(double(body.size()) / step));
  std::vector<fba::BodyFrame> frames(std::size_t(count), body.front());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double at = std::min(double(i) * step, double(body.size() - 1));
    const fba::BodyFrame& a = body[std::size_t(at)];
    const fba::BodyFrame& b = body[std::min(std::size_t(at) + 1, body.size() - 1)];
    const double share = at - std::floor(at);
    for (std::size_t bap = 1; bap < a.value.size(); ++bap) {
      frames[i].value[bap] =
          std::int32_t(std::llround(a.value[bap] * (1 - share) + b.value[bap] * share));
    }
    frames[i].number = std::int64_t(i);
  }
  return frames;
}

struct Parts {
  fap::Sequence face;
  std::vector<fba::BodyFrame> body;
};

Parts parts_of(const EditCut& cut, const fap::Sequence& complete, fap::Rate rate, double speed) {
  Parts parts;
  parts.face = face_frames(cut, complete);
  parts.body = body_frames(cut);
  const fap::Rate played = speed == 1 ? cut.source->rate : times(cut.source->rate, speed);
  parts.face.rate = played;
  if (played != rate && !parts.face.frames.empty()) parts.face = fap::resample(parts.face, rate);
  parts.face.rate = rate;
  parts.body = resampled(parts.body, played, rate);
  return parts;
}

void append_body(std::vector<fba::BodyFrame>& body, std::vector<fba::BodyFrame> next) {
  if (next.empty()) return;
  if (!body.empty()) {
    const auto mask = body.front().mask | next.front().mask;
    for (auto* frames : {&body, &next}) {
      for (fba::BodyFrame& frame : *frames) frame.mask = mask;
    }
  }
  body.insert(body.end(), next.begin(), next.end());
}

// The time of a part without a face, or without a body, passes in the other parts, too.
void keep_length(Parts& parts, const Parts& all, std::size_t frames) {
  const auto has = [](const auto& list) { return !list.empty(); };
  if (parts.face.frames.empty() && has(all.face.frames)) {
    parts.face.frames.assign(frames, fap::Frame());
  }
  if (parts.body.empty() && has(all.body)) parts.body.assign(frames, fba::BodyFrame());
}

Result<void> take(EditedMotion& motion, const EditTake& take, double cross_fade) {
  const auto source = read_edit_source(take.path);
  if (!source) return source.error();
  const fap::Rate rate = motion.face.frames.empty() ? motion.body.rate : motion.face.rate;
  const auto complete = complete_face(*source);
  if (!complete) return complete.error();
  Parts parts = parts_of({&*source, 0, source->frames}, *complete, rate, 1);
  if (take.what == EditTake::What::body) {
    const std::size_t frames = std::max(motion.face.frames.size(), motion.body.frames.size());
    if (parts.body.empty()) {
      return make_error(Code::not_found, "there is no body here").in_file(take.path);
    }
    parts.body.resize(frames, parts.body.back());
    motion.body.frames = std::move(parts.body);
    return {};
  }
  if (parts.face.frames.empty()) {
    return make_error(Code::not_found, "there is no face here").in_file(take.path);
  }
  if (motion.face.frames.empty()) motion.face.frames.resize(motion.body.frames.size());
  fap::replace(motion.face, parts.face, take.faps, cross_fade);
  return {};
}

}  // namespace

Result<EditedMotion> change_motion(const std::vector<EditCut>& cuts, fap::Rate rate,
                                   const EditChanges& changes) {
  std::vector<Parts> pieces;
  Parts all;
  const EditSource* source = nullptr;  // of `complete`
  Result<fap::Sequence> complete = fap::Sequence();
  for (const EditCut& cut : cuts) {
    if (cut.source != source) complete = complete_face(*cut.source);
    if (!complete) return complete.error();
    source = cut.source;
    pieces.push_back(parts_of(cut, *complete, rate, changes.speed));
    if (!pieces.back().face.frames.empty()) all.face.frames.resize(1);
    if (!pieces.back().body.empty()) all.body.resize(1);
  }
  EditedMotion motion;
  motion.face.rate = motion.body.rate = rate;
  motion.face.name = cuts.front().source->motion.face.name;
  motion.body.name = motion.face.name;
  for (Parts& parts : pieces) {
    keep_length(parts, all, std::max(parts.face.frames.size(), parts.body.size()));
    fap::append(motion.face, parts.face, changes.cross_fade);
    append_body(motion.body.frames, std::move(parts.body));
  }
  const auto hold = [&](auto& frames) {
    if (!frames.empty()) frames.insert(frames.begin(), std::size_t(changes.hold), frames.front());
  };
  hold(motion.face.frames);
  hold(motion.body.frames);
  if (changes.mirror) fap::mirror(motion.face);
  for (const EditTake& part : changes.takes) {
    if (auto ok = take(motion, part, changes.cross_fade); !ok) return ok.error();
  }
  for (const EditAmount& amount : changes.scale) fap::scale(motion.face, amount.faps, amount.value);
  for (const EditAmount& amount : changes.smooth) {
    fap::smooth(motion.face, amount.faps, amount.value);
  }
  fap::fade(motion.face, changes.fade_in, changes.fade_out);
  const auto number = [](auto& frames) {
    for (std::size_t i = 0; i < frames.size(); ++i) frames[i].number = std::int64_t(i);
  };
  number(motion.face.frames);
  number(motion.body.frames);
  return motion;
}

}  // namespace animeme::tools
