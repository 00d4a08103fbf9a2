#include <cstdio>
#include <optional>

#include "codec/decode/access_unit.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/fap_file.h"
#include "tools/app/commands/plane_file.h"
#include "tools/formats/common/json.h"
#include "tools/formats/inspect/file_internal.h"
#include "tools/formats/inspect/stream_internal.h"
#include "tools/formats/media/container.h"
#include "tools/formats/scripts/script_text.h"

namespace animeme::tools {

namespace {

struct InfoOptions {
  std::string input;
  bool json = false;
  bool planes = false;
};

// What describe() found. In text form planes are a table, for which the stream is read again.
struct Description {
  Json json;
  std::optional<PlaneFile> stream;
};

Result<Json> describe_coded(const InfoOptions& options, PlaneFile file, Description& out) {
  PlaneReader reader(file);
  inspect::StreamExtent extent;
  Json list = Json::array();
  for (;;) {
    const Result<const fba::Plane*> plane = reader.next();
    const bool ends = plane && *plane == nullptr;
    if (!plane || (ends && !reader.warnings().empty())) {
      auto repaired = file.repaired(options.input);
      if (repaired) return describe_coded(options, std::move(*repaired), out);
    }
    if (!plane) return plane.error();
    if (ends) break;
    extent.add(**plane);
    if (options.planes && options.json) list.push_back(inspect::describe_plane(**plane));
  }
  Json json = inspect::describe_stream(extent, reader.info(), reader.warnings(), reader.bytes());
  if (options.planes && options.json) json["plane_list"] = std::move(list);
  if (options.planes) out.stream = std::move(file);
  return json;
}

Json describe_track(const media::TrackInfo& track) {
  Json json = {{"kind", media::name_of(track.kind)},
               {"codec", track.codec},
               {"tag", track.tag},
               {"start", track.start},
               {"seconds", track.duration},
               {"samples", track.samples}};
  if (track.kind == media::TrackKind::audio) {
    json["sample_rate"] = track.sample_rate;
    json["channels"] = track.channels;
  }
  if (track.kind == media::TrackKind::video) {
    json["width"] = track.width;
    json["height"] = track.height;
  }
  if (track.kind == media::TrackKind::text) {
    json["name"] = track.name;
    json["language"] = track.language;
  }
  if (track.kind == media::TrackKind::face) {
    json["timescale"] = track.timescale;
    json["profile"] = track.visual_profile;
  }
  const media::TrackLabels& labels = track.labels;
  if (!labels.empty()) {
    const std::string language = labels.language.empty() ? labels.code : labels.language;
    if (track.kind != media::TrackKind::text && !language.empty()) json["language"] = language;
    if (!labels.language.empty()) json["language_tag"] = labels.language;
    if (!labels.speaker.empty()) json["speaker"] = labels.speaker;
    json["default"] = track.is_default;
  }
  return json;
}

Result<Json> describe_media(const InfoOptions& options, std::span<const std::uint8_t> bytes,
                            Description& out) {
  Result<media::ContainerInfo> info =
      is_on_disk(options.input) ? media::probe(options.input) : media::probe(bytes);
  if (!info) return info.error();
  Json json = {{"kind", "media"},
               {"format", info->format},
               {"bytes", info->bytes},
               {"seconds", info->duration},
               {"tracks", json_list(info->tracks, describe_track)},
               {"warnings", info->warnings}};
  if (info->first(media::TrackKind::face) == nullptr) return json;
  Result<media::Container> container = open_container(bytes, options.input);
  if (!container) return container.error();
  Result<Json> stream =
      describe_coded(options, PlaneFile(fba::join_access_units(container->face)), out);
  if (!stream) return stream.error();
  json["face"] = *stream;
  return json;
}

Result<Json> describe_script_file(std::span<const std::uint8_t> bytes) {
  const auto timings =
      scripts::read_labels({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  if (!timings) return timings.error();
  return inspect::describe_script(*timings);
}

Result<Json> describe_text(const InfoOptions& options, std::vector<std::uint8_t> bytes) {
  Result<MotionInput> motion = parse_motion(std::move(bytes), options.input);
  if (!motion) return motion.error();
  const bool bap = motion->kind == FileKind::bap_text;
  Json json = {{"kind", bap ? "bap" : "fap"}};
  json.update(bap ? inspect::describe_body(motion->body) : inspect::describe_clip(motion->face));
  return json;
}

Result<Json> describe_fap_file(const InfoOptions& options) {
  const Result<FapFile> file = FapFile::open(options.input);
  if (!file) return file.error();
  inspect::Extent<fap::Frame> extent;
  auto done = file->for_each([&extent](const fap::Frame& frame) {
    extent.add(frame);
    return Result<void>();
  });
  if (!done) return done.error();
  Json json = {{"kind", "fap"}};
  json.update(inspect::describe_clip(extent, file->survey().rate));
  return json;
}

Result<Description> describe(const InfoOptions& options) {
  Description out;
  Result<Json> json = Json();
  const Json of_stream = {{"kind", "fba"}};
  if (PlaneFile::can_read(options.input)) {
    out.json = of_stream;
    json = describe_coded(options, PlaneFile(options.input), out);
    if (!json) return json.error();
    out.json.update(*json);
    return out;
  }
  if (FapFile::can_read(options.input)) {
    json = describe_fap_file(options);
    if (!json) return json.error();
    out.json.update(*json);
    return out;
  }
  Result<std::vector<std::uint8_t>> bytes = read_input(options.input);
  if (!bytes) return bytes.error();
  if (bytes->empty()) return make_error(Code::truncated, "the file is empty");
  switch (kind_of(*bytes)) {
    case FileKind::fba_stream:
      out.json = of_stream;
      json = describe_coded(options, PlaneFile(std::move(*bytes)), out);
      break;
    case FileKind::media:
      json = describe_media(options, *bytes, out);
      break;
    case FileKind::model:
      json = inspect::describe_model(*bytes);
      break;
    case FileKind::script:
      json = describe_script_file(*bytes);
      break;
    default:
      json = describe_text(options, std::move(*bytes));
  }
  if (!json) return json.error();
  out.json.update(*json);
  return out;
}

Result<int> run(const InfoOptions& options) {
  Result<Description> found = describe(options);
  if (!found) return found.error().in_file(options.input);
  if (options.json) {
    std::printf("%s\n", pretty(found->json).c_str());
    return kOk;
  }
  std::fputs(inspect::tree_text(found->json).c_str(), stdout);
  if (!found->stream) return kOk;
  std::fputs(inspect::planes_heading().c_str(), stdout);
  auto printed = found->stream->for_each([](const fba::Plane& plane) {
    std::fputs(inspect::plane_text(plane).c_str(), stdout);
    return Result<void>();
  });
  if (!printed) return printed.error().in_file(options.input);
  return kOk;
}

void add_options(OptionTable& cli, InfoOptions& options) {
  cli.add("file", options.input,
          "FAP or BAP text, FBA stream, container, sound, model or phoneme script")
      ->required();
  cli.add("--json", options.json, "Print a machine-readable result");
  cli.add("--planes", options.planes,
          "Print a line per plane: bit position, size, headers, masks, ranges (all of them "
          "with --json)");
}

}  // namespace

const Command kInfo{"info", "Print what a file contains",
                    "  animeme info talk.mp4\n"
                    "  animeme info talk.fba --planes --json",
                    set_up<InfoOptions>};

}  // namespace animeme::tools
