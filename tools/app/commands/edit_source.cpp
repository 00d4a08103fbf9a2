#include "tools/app/commands/edit_source.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "codec/decode/access_unit.h"
#include "codec/decode/fill.h"
#include "tools/formats/files/output_file.h"
#include "tools/formats/media/container.h"
#include "tools/formats/programs/scratch_folder.h"

namespace animeme::tools {
namespace {

// Rounding of times must not add a frame.
constexpr double kNearly = 1e-4;

std::int64_t frames_of_motion(const exchange::Motion& motion) {
  if (!motion.decoded.planes.empty()) {
    const fba::Plane& last = motion.decoded.planes.back();
    return last.number + 1 + std::int64_t(last.temporal.skip.value_or(0));
  }
  std::int64_t frames = 0;
  if (!motion.face.frames.empty()) frames = motion.face.frames.back().number + 1;
  if (!motion.body.frames.empty()) {
    frames = std::max(frames, motion.body.frames.back().number + 1);
  }
  return frames;
}

// Seconds of the sound of a container; nullopt: it has none.
Result<std::optional<double>> sound_seconds(const std::string& path) {
  const auto info = media::probe(path);
  if (!info) return info.error().in_file(path);
  const media::TrackInfo* track = info->first(media::TrackKind::audio);
  if (track == nullptr) return std::optional<double>();
  return std::optional(track->duration > 0 ? track->duration : info->duration);
}

// Sound and words of a container whose first plane is shown at `start`, seconds.
Result<void> add_container(EditSource& source, double start) {
  const std::string& path = source.path;
  const double rate = source.rate.frames_per_second();
  source.lead = std::max<std::int64_t>(0, std::int64_t(std::ceil(start * rate - kNearly)));
  source.origin = start - double(source.lead) / rate;
  source.frames += source.lead;
  const auto seconds = sound_seconds(path);
  if (!seconds) return seconds.error();
  if (*seconds) {
    source.sound = true;
    const double end = std::ceil((**seconds - source.origin) * rate - kNearly);
    source.frames = std::max(source.frames, std::int64_t(end));
  }
  source.texts = speech::carried_tracks(path, terminal_log());
  return {};
}

// The face of a container as a raw stream in a file, and when it begins; nullopt: it is damaged, or
// not a file.
Result<std::optional<double>> take_out(const std::string& path, EditStream& stream) {
  auto folder = ScratchFolder::make();
  if (!folder) return folder.error();
  stream.folder = std::move(*folder);
  const std::string raw = stream.folder->file("face.fba");
  OutputFile file(raw);
  const auto summary = media::stream_face(
      path, [&](const fba::AccessUnit& unit, std::span<const std::uint8_t>) -> Result<void> {
        return file.write(unit.bytes);
      });
  if (!summary || !*summary) return std::optional<double>();
  if (auto done = file.write(fba::end_code()); !done) return done.error();
  if (auto done = file.publish(); !done) return done.error();
  stream.file = PlaneFile(raw);
  return std::optional(double((*summary)->start) / (*summary)->timescale);
}

// What is known of an intact stream without its planes in memory. False: it is not one.
bool survey(EditSource& source, EditStream& stream) {
  std::vector<std::string> warnings;
  bool any = false;
  const auto note = [&](const fba::Plane& plane) -> Result<void> {
    if (!any) source.rate = plane.rate;
    any = true;
    stream.one_rate = stream.one_rate && plane.rate == source.rate;
    stream.start_codes = stream.start_codes && plane.start_code;
    if (plane.intra) stream.intra.push_back(plane.number);
    source.frames = plane.number + 1 + std::int64_t(plane.temporal.skip.value_or(0));
    return {};
  };
  return stream.file.for_each(note, &warnings) && any && warnings.empty();
}

// nullopt: its motion has to be in memory.
Result<std::optional<EditSource>> open_stream(const std::string& path) {
  EditSource source;
  source.path = path;
  auto stream = std::make_shared<EditStream>();
  std::optional<double> start;
  if (PlaneFile::can_read(path)) {
    stream->file = PlaneFile(path);
  } else {
    if (!is_on_disk(path)) return std::optional<EditSource>();
    const auto head = read_input(path);
    if (!head || kind_of(*head) != FileKind::media) return std::optional<EditSource>();
    auto begin = take_out(path, *stream);
    if (!begin) return begin.error();
    if (!*begin) return std::optional<EditSource>();
    start = *begin;
  }
  if (!survey(source, *stream)) return std::optional<EditSource>();
  source.stream = std::move(stream);
  if (start) {
    if (auto ok = add_container(source, *start); !ok) return ok.error();
  }
  return std::optional(std::move(source));
}

}  // namespace

Result<EditSource> read_edit_source(const std::string& path) {
  auto motion = read_motion(path);
  if (!motion) return motion.error();
  EditSource source;
  source.path = path;
  source.motion = std::move(*motion);
  const bool face = !source.motion.face.frames.empty();
  source.rate = face ? source.motion.face.rate : source.motion.body.rate;
  source.frames = frames_of_motion(source.motion);
  if (source.frames == 0) {
    return make_error(Code::not_found, "there is neither a face nor a body").in_file(path);
  }
  if (source.motion.kind != FileKind::media) return source;
  if (auto ok = add_container(source, source.motion.start); !ok) return ok.error();
  return source;
}

Result<EditSource> open_edit_source(const std::string& path) {
  auto source = open_stream(path);
  if (!source) return source.error();
  return *source ? Result<EditSource>(std::move(**source)) : read_edit_source(path);
}

Result<void> load_motion(EditSource& source) {
  if (source.stream == nullptr) return {};
  auto motion = read_motion(source.path);
  if (!motion) return motion.error();
  source.motion = std::move(*motion);
  source.stream.reset();
  return {};
}

Result<fap::Sequence> complete_face(const EditSource& source) {
  const fap::Sequence& face = source.motion.face;
  if (face.frames.empty()) return fap::Sequence{source.rate, {}, face.name};
  fap::FillOptions options;
  options.keep_high_level = true;
  if (!source.coded()) options.mirror = options.lips = false;  // a text leaves them undefined
  auto complete =
      source.coded() ? fba::fill(source.motion.decoded, options) : fap::fill(face, options);
  if (!complete) return complete.error().in_file(source.path);
  complete->rate = source.rate;
  complete->name = face.name;
  return complete;
}

fap::Sequence face_frames(const EditCut& cut, const fap::Sequence& complete) {
  fap::Sequence clip{complete.rate, {}, complete.name};
  if (complete.frames.empty()) return clip;
  const auto last = std::int64_t(complete.frames.size()) - 1;
  clip.frames.reserve(std::size_t(cut.end - cut.first));
  for (std::int64_t frame = cut.first; frame < cut.end; ++frame) {
    const auto at = std::clamp<std::int64_t>(frame - cut.source->lead, 0, last);
    clip.frames.push_back(complete.frames[std::size_t(at)]);
    clip.frames.back().number = frame - cut.first;
  }
  return clip;
}

std::vector<fba::BodyFrame> body_frames(const EditCut& cut) {
  const EditSource& source = *cut.source;
  const std::vector<fba::BodyFrame>& frames = source.motion.body.frames;
  std::vector<fba::BodyFrame> body;
  if (frames.empty()) return body;
  fba::BodyFrame held;
  for (const fba::BodyFrame& frame : frames) held.mask |= frame.mask;  // one mask for all
  std::size_t next = 0;
  for (std::int64_t frame = std::min<std::int64_t>(cut.first, source.lead); frame < cut.end;
       ++frame) {
    const std::int64_t at = std::max<std::int64_t>(frame - source.lead, frames.front().number);
    for (; next < frames.size() && frames[next].number <= at; ++next) {
      for (std::size_t bap = 1; bap < held.value.size(); ++bap) {
        if (frames[next].mask[bap]) held.value[bap] = frames[next].value[bap];
      }
    }
    held.number = frame - cut.first;
    if (frame >= cut.first) body.push_back(held);
  }
  return body;
}

}  // namespace animeme::tools
