#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>

#include "codec/decode/decoder.h"
#include "tools/commands/common.h"
#include "tools/inspect/file_internal.h"
#include "tools/inspect/stream_internal.h"
#include "tools/json.h"
#include "tools/media/container.h"

namespace animeme::tools {

namespace {

struct InfoOptions {
  std::string input;
  bool json = false;
  bool planes = false;
};

// What describe() found. In text form planes are a table, so the stream is kept for it.
struct Description {
  Json json;
  std::optional<fba::DecodedStream> stream;
};

Result<Json> describe_coded(const InfoOptions& options, std::span<const std::uint8_t> bytes,
                            Description& out) {
  Result<fba::DecodedStream> decoded = fba::decode(bytes);
  if (!decoded) return decoded.error();
  Json json = inspect::describe_stream(*decoded, bytes.size());
  if (options.planes && options.json) json["plane_list"] = inspect::describe_planes(*decoded);
  if (options.planes) out.stream = std::move(*decoded);
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
  if (track.kind == media::TrackKind::face) {
    json["timescale"] = track.timescale;
    json["profile"] = track.visual_profile;
  }
  return json;
}

Result<Json> describe_media(const InfoOptions& options, std::span<const std::uint8_t> bytes,
                            Description& out) {
  const bool playlist = is_playlist(bytes);
  Result<media::ContainerInfo> info = playlist ? media::probe(options.input) : media::probe(bytes);
  if (!info) return info.error();
  Json json = {{"kind", "media"},
               {"format", info->format},
               {"bytes", info->bytes},
               {"seconds", info->duration},
               {"tracks", json_list(info->tracks, describe_track)},
               {"warnings", info->warnings}};
  if (info->first(media::TrackKind::face) == nullptr) return json;
  Result<media::Container> container =
      playlist ? media::read_container(options.input) : media::read_container(bytes);
  if (!container) return container.error();
  Result<Json> stream = describe_coded(options, fba::join_access_units(container->face), out);
  if (!stream) return stream.error();
  json["face"] = *stream;
  return json;
}

Result<Json> describe_text(const InfoOptions& options, std::vector<std::uint8_t> bytes) {
  Result<MotionInput> motion = parse_motion(std::move(bytes), options.input);
  if (!motion) return motion.error();
  const bool bap = motion->kind == FileKind::bap_text;
  Json json = {{"kind", bap ? "bap" : "fap"}};
  json.update(bap ? inspect::describe_body(motion->body) : inspect::describe_clip(motion->face));
  return json;
}

Result<Description> describe(const InfoOptions& options) {
  Result<std::vector<std::uint8_t>> bytes = read_file(options.input);
  if (!bytes) return bytes.error();
  if (bytes->empty()) return make_error(Code::truncated, "the file is empty");
  Description out;
  Result<Json> json = Json();
  switch (kind_of(*bytes)) {
    case FileKind::fba_stream:
      out.json = {{"kind", "fba"}};
      json = describe_coded(options, *bytes, out);
      break;
    case FileKind::media:
      json = describe_media(options, *bytes, out);
      break;
    case FileKind::model:
      json = inspect::describe_model(*bytes);
      break;
    case FileKind::script:
      json = inspect::describe_script(*bytes);
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
    std::printf("%s\n", found->json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    return kOk;
  }
  std::string text = inspect::tree_text(found->json);
  if (found->stream) text += inspect::planes_text(*found->stream);
  std::fputs(text.c_str(), stdout);
  return kOk;
}

void add_options(CLI::App& app, InfoOptions& options) {
  app.add_option("file", options.input,
                 "FAP or BAP text, FBA stream, container, sound, model or phoneme script")
      ->required();
  app.add_flag("--json", options.json, "Machine-readable result");
  app.add_flag(
      "--planes", options.planes,
      "One line a plane: bit position, size, headers, masks, ranges (all of them with --json)");
}

}  // namespace

const Command kInfo{"info", "What a file holds",
                    "  animeme info talk.mp4\n"
                    "  animeme info talk.fba --planes --json",
                    set_up<InfoOptions>};

}  // namespace animeme::tools
