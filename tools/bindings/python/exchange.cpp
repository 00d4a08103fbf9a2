// Faces out of files of all kinds, and into them.
#include "tools/formats/exchange/motion.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "codec/decode/access_unit.h"
#include "codec/decode/fill.h"
#include "dam/signal/fap_signal.h"
#include "fap/text.h"
#include "tools/bindings/python/python_internal.h"
#include "tools/formats/exchange/arkit.h"
#include "tools/formats/exchange/curves.h"
#include "tools/formats/exchange/visemes.h"
#include "tools/formats/files/files.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/mux.h"

namespace animeme::python {

namespace {

constexpr media::ReadOptions kRepair{.repair = true};

Result<exchange::Motion> motion_of(Result<media::Container> container) {
  if (!container) return container.error();
  auto motion = exchange::decode_motion(fba::join_access_units(container->face));
  if (motion) {
    auto& warnings = motion->warnings;
    warnings.insert(warnings.begin(), container->warnings.begin(), container->warnings.end());
    for (const fba::Damage& one : container->damage) {
      warnings.push_back("damaged " + one.describe());
    }
  }
  return motion;
}

// A container is opened by its path and read as it is needed; all others are read whole.
Result<exchange::Motion> read_file(const std::string& path) {
  std::vector<std::uint8_t> first(4096);
  std::ifstream in(path, std::ios::binary);
  in.read(reinterpret_cast<char*>(first.data()), std::streamsize(first.size()));
  first.resize(std::size_t(in.gcount()));
  if (!first.empty() && exchange::kind_of(first) == exchange::FileKind::media) {
    return motion_of(media::read_container(path, kRepair));
  }
  auto bytes = tools::read_file(path);
  if (!bytes) return bytes.error();
  return exchange::read_motion(std::move(*bytes));
}

Result<exchange::Motion> read_bytes(std::span<const std::uint8_t> bytes) {
  if (exchange::kind_of(bytes) == exchange::FileKind::media) {
    return motion_of(media::read_container(bytes, kRepair));
  }
  return exchange::read_motion({bytes.begin(), bytes.end()});
}

Clip face_of(Result<exchange::Motion> read, const std::string& path) {
  if (!read) raise(std::move(read).error().in_file(path));
  for (const std::string& text : read->warnings) warn(path.empty() ? text : path + ": " + text);
  if (read->face.frames.empty()) {
    raise(make_error(Code::not_found, "there is no face in it").in_file(path));
  }
  std::vector<fap::GroupRules> rules;
  const fba::FaceSettings none;
  for (const fba::Plane& plane : read->decoded.planes) {
    if (!fba::has_face(plane.object_mask)) continue;
    rules.push_back(fba::group_rules(plane.face_settings ? *plane.face_settings : none));
  }
  if (read->face.name.empty()) read->face.name = std::filesystem::path(path).stem().string();
  return clip_of(read->face, std::move(rules));
}

Clip load(const py::object& file) {
  const std::string path = path_of(file);
  return face_of(unlocked([&] { return read_file(path); }), path);
}

Clip read(const py::object& data) {
  if (py::isinstance<py::str>(data)) {
    const auto text = data.cast<std::string>();
    return face_of(unlocked([&] { return exchange::read_motion({text.begin(), text.end()}); }), {});
  }
  const Bytes bytes(data.cast<py::buffer>());
  return face_of(unlocked([&] { return read_bytes(bytes.span()); }), {});
}

// ".livelink.csv" of "talk.livelink.csv", ".csv" of "talk.csv".
std::string ending_of(const std::string& path) {
  const std::string last = tools::extension_of(path);
  const std::string inner = tools::extension_of(std::filesystem::path(path).stem().string());
  for (const char* known : {".livelink", ".visemes", ".rhubarb", ".talkinghead"}) {
    if (inner == known) return inner + last;
  }
  return last;
}

fap::FillOptions shown_options(bool keep_high_level) {
  fap::FillOptions options;
  options.interpolate = options.complete = true;
  options.keep_high_level = keep_high_level;
  options.expand = !keep_high_level;
  return options;
}

Result<std::string> visemes_text(const fap::Sequence& clip, const std::string& ending) {
  const auto filled = fap::fill(clip, shown_options(true));
  if (!filled) return filled.error();
  const auto track = exchange::track_of_face(*filled);
  if (ending == ".visemes.json") return exchange::write_visemes_json(track);
  if (ending == ".visemes.csv") return exchange::write_visemes_csv(track);
  if (ending == ".talkinghead.json") return exchange::write_talking_head(track, {});
  if (ending == ".xml") return exchange::write_rhubarb_xml(track);
  if (ending == ".dat") return exchange::write_rhubarb_dat(track);
  return ending == ".tsv" ? exchange::write_rhubarb_tsv(track)
                          : exchange::write_rhubarb_json(track);
}

// The text of a file; nothing: it is no text.
std::optional<Result<std::string>> text_of(const fap::Sequence& clip, const std::string& ending) {
  if (ending == ".fap") return fap::write_text(clip);
  if (ending == ".csv") {
    const auto signal = dam::to_signal(clip);
    if (!signal) return signal.error();
    return exchange::write_curves(*signal);
  }
  if (ending == ".livelink.csv" || ending == ".json") {
    const auto filled = fap::fill(clip, shown_options(false));
    if (!filled) return filled.error();
    const auto curves = exchange::fit_arkit(*filled);
    return ending == ".json" ? exchange::write_arkit_json(curves)
                             : exchange::write_live_link(curves);
  }
  for (const char* known : {".visemes.json", ".visemes.csv", ".rhubarb.json", ".talkinghead.json",
                            ".tsv", ".xml", ".dat"}) {
    if (ending == known) return visemes_text(clip, ending);
  }
  return std::nullopt;
}

Result<void> write_media(const std::vector<std::uint8_t>& stream, const std::string& path,
                         const Beside& beside, WarningLog& heard) {
  const auto units = fba::split_access_units(stream);
  if (!units) return units.error();
  media::MuxInput input{.face = &*units, .audio = beside.sound};
  if (!beside.sound_file.empty()) input.audio_file = &beside.sound_file;
  if (!beside.texts.empty() && media::takes_text(path)) input.texts = &beside.texts;
  media::MuxOptions options;
  options.audio.codec = media::usual_codec(path);
  options.warnings = &heard.sentences;
  const auto written = media::write_container(path, input, options);
  if (!written) return written.error().in_file(path);
  return {};
}

}  // namespace

fap::Sequence shown(const Clip& clip, bool keep_high_level) {
  const fap::Sequence sequence = sequence_of(clip);
  return value_of(
      unlocked([&] { return fap::fill(sequence, clip.rules, shown_options(keep_high_level)); }));
}

void save(const fap::Sequence& clip, const std::string& path, const Coding& coding,
          const Beside& beside) {
  const std::string ending = ending_of(path);
  if (auto text = unlocked([&] { return text_of(clip, ending); })) {
    const std::string written = value_of(std::move(*text));
    return value_of(unlocked([&] { return tools::write_file(path, written); }));
  }
  Coding settings = coding;
  // As the program does: players begin anywhere in a container.
  if (ending != ".fba" && !settings.intra_seconds) settings.intra_seconds = 5;
  const std::vector<std::uint8_t> stream = coded(clip, settings, py::none());
  if (ending == ".fba") {
    return value_of(unlocked([&] { return tools::write_file(path, stream); }));
  }
  WarningLog heard;
  auto written = unlocked([&] { return write_media(stream, path, beside, heard); });
  heard.tell(beside.sound_file);
  value_of(std::move(written));
}

void bind_exchange(py::module_& module) {
  module.def("load", &load, py::arg("path"),
             R"(Reads a face from a file of any supported format, detected by content.

FBA streams, FAP text, containers (.mp4 .mkv .ts ...), curves of FAPs, ARKit's shapes (Live Link
Face), landmarks of trackers (OpenFace, MediaPipe, dlib).

path: str or os.PathLike.

Anomalies give an InputWarning. Raises Error with position.file and line or bit. Releases the
GIL.)");
  module.def(
      "read", &read, py::arg("data"),
      R"(The same as load() from memory: bytes or any object with a buffer, or text as str.)");
}

}  // namespace animeme::python
