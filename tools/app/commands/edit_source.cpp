#include "tools/app/commands/edit_source.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "codec/decode/access_unit.h"
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
  source.motion.kind = start ? FileKind::media : FileKind::fba_stream;
  source.motion.face.name = std::filesystem::path(path).stem().string();
  source.motion.body.name = source.motion.face.name;
  if (start) {
    if (auto ok = add_container(source, *start); !ok) return ok.error();
  }
  return std::optional(std::move(source));
}

Error without_motion(const std::string& path) {
  return make_error(Code::not_found, "there is neither a face nor a body").in_file(path);
}

Result<EditSource> open_text(const std::string& path) {
  auto text = FapFile::open(path);
  if (!text) return text.error();
  EditSource source;
  source.path = path;
  source.motion.kind = FileKind::fap_text;
  source.motion.face.name = text->survey().name;
  source.rate = text->survey().rate;
  source.frames = text->survey().last + 1;
  if (source.frames == 0) return without_motion(path);
  source.text = std::move(*text);
  return source;
}

Result<EditSource> read_source(const std::string& path) {
  auto motion = read_motion(path);
  if (!motion) return motion.error();
  EditSource source;
  source.path = path;
  source.motion = std::move(*motion);
  const bool face = !source.motion.face.frames.empty();
  source.rate = face ? source.motion.face.rate : source.motion.body.rate;
  source.frames = frames_of_motion(source.motion);
  if (source.frames == 0) return without_motion(path);
  if (source.motion.kind != FileKind::media) return source;
  if (auto ok = add_container(source, source.motion.start); !ok) return ok.error();
  return source;
}

}  // namespace

Result<EditSource> open_edit_source(const std::string& path) {
  if (FapFile::can_read(path)) return open_text(path);
  auto source = open_stream(path);
  if (!source) return source.error();
  return *source ? Result<EditSource>(std::move(**source)) : read_source(path);
}

}  // namespace animeme::tools
