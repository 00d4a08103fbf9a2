#include "tools/app/commands/clip_file.h"

#include <utility>
#include <vector>

#include "fap/rate_text.h"
#include "tools/app/commands/common.h"

namespace animeme::tools {

Result<ClipFile> ClipFile::open(const std::string& input, const std::string& bap, ClipRates rates) {
  ClipFile clip;
  if (!input.empty()) {
    if (auto ok = clip.open_face(input, !bap.empty()); !ok) return ok.error();
  }
  if (!bap.empty()) {
    Result<MotionInput> other = read_motion(bap, FrameNumbers::keep);
    if (!other) return other.error();
    if (other->body.frames.empty()) {
      return make_error(Code::not_found,
                        "there is no body here: --bap needs BAP text (version 3.1 or 3.2), or a "
                        "stream with a body")
          .in_file(bap);
    }
    clip.body_ = std::move(other->body);
  }
  const bool has_face = clip.text_ ? clip.text_->survey().frames > 0
                                   : clip.stream_.has_value() || !clip.face_.frames.empty();
  const fap::Rate face = clip.text_ ? clip.text_->survey().rate : clip.face_.rate;
  clip.rate_ = has_face ? face : clip.body_.rate;
  const bool both = has_face && !clip.body_.frames.empty();
  if (both && rates == ClipRates::equal && clip.body_.rate != face) {
    return make_error(Code::invalid_argument, "the body has " + fap::format_rate(clip.body_.rate) +
                                                  " frames per second and the face " +
                                                  fap::format_rate(face) + ": convert one of them")
        .in_file(bap.empty() ? input : bap);
  }
  return clip;
}

Result<void> ClipFile::open_face(const std::string& input, bool has_other_body) {
  if (FapFile::can_read(input)) {
    Result<FapFile> text = FapFile::open(input, FrameNumbers::keep);
    if (!text) return text.error();
    text_ = std::move(*text);
    return {};
  }
  if (open_stream(input, has_other_body)) return {};
  Result<MotionInput> motion = read_motion(input, FrameNumbers::keep);
  if (!motion) return motion.error();
  if (motion->kind == FileKind::bap_text) {
    return make_error(Code::not_found, "this is BAP text without a face: give it after --bap")
        .in_file(input);
  }
  if (motion->body.frames.empty() && !has_other_body) {
    if (auto ok = require_face(*motion, input); !ok) return ok;
  }
  face_ = std::move(motion->face);
  body_ = std::move(motion->body);
  return {};
}

// False: it is no such stream, or has to be read as a whole since something is wrong with it.
bool ClipFile::open_stream(const std::string& input, bool has_other_body) {
  if (!PlaneFile::can_read(input)) return false;
  PlaneFile file(input);
  bool faces = false, bodies = false, begun = false;
  std::vector<std::string> warnings;
  const auto read = file.for_each(
      [&](const fba::Plane& plane) {
        if (!begun) face_.rate = plane.rate;
        begun = true;
        faces = faces || fba::has_face(plane.object_mask);
        bodies = bodies || plane.body != nullptr;
        return Result<void>();
      },
      &warnings);
  if (!read || !warnings.empty() || !faces) return false;
  bodies_of_stream_ = bodies && !has_other_body;
  stream_ = std::move(file);
  return true;
}

fba::ClipSource ClipFile::source() const {
  return {rate_, [this](const fba::TakeInstant& take) { return each(take); }};
}

Result<void> ClipFile::each(const fba::TakeInstant& take) const {
  first_ = 0;
  last_ = -1;
  return each_instant([&](const fap::Frame* face, const fba::BodyFrame* body) {
    const std::int64_t number = face != nullptr ? face->number : body->number;
    if (last_ < first_) first_ = number;
    last_ = number;
    return take(face, body);
  });
}

Result<void> ClipFile::each_instant(const fba::TakeInstant& take) const {
  // Bodies in memory stand between the faces.
  auto body = body_.frames.begin();
  const auto bodies_before = [&](std::int64_t number) {
    for (; body != body_.frames.end() && body->number < number; ++body) {
      if (auto done = take(nullptr, &*body); !done) return done;
    }
    return Result<void>();
  };
  const auto with_body = [&](const fap::Frame& face) {
    if (auto done = bodies_before(face.number); !done) return done;
    const bool both = body != body_.frames.end() && body->number == face.number;
    return take(&face, both ? &*body++ : nullptr);
  };
  if (text_) {
    if (auto done = text_->for_each(with_body); !done) return done;
  } else if (stream_) {
    auto done = stream_->for_each([&](const fba::Plane& plane) {
      const fap::Frame* face = fba::has_face(plane.object_mask) ? &plane.face : nullptr;
      if (!bodies_of_stream_) return face != nullptr ? with_body(*face) : Result<void>();
      if (face == nullptr && !plane.body) return Result<void>();
      return take(face, plane.body.get());
    });
    if (!done) return done;
  } else {
    for (const fap::Frame& face : face_.frames) {
      if (auto done = with_body(face); !done) return done;
    }
  }
  for (; body != body_.frames.end(); ++body) {
    if (auto done = take(nullptr, &*body); !done) return done;
  }
  return {};
}

}  // namespace animeme::tools
