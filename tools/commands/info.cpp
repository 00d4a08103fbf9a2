#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "codec/decode/decoder.h"
#include "dam/model/model.h"
#include "dam/script/script.h"
#include "fap/rate_text.h"
#include "tools/commands/common.h"
#include "tools/inspect/stream.h"
#include "tools/media/container.h"

namespace animeme::tools {

namespace {

using inspect::Json;

struct Options {
  std::string input;
  bool json = false;
  bool planes = false;
};

// What describe() found. In text form planes are a table, so the stream is kept for it.
struct Description {
  Json json;
  std::optional<fba::DecodedStream> stream;
};

Result<Json> describe_coded(const Options& options, std::span<const std::uint8_t> bytes,
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

Result<Json> describe_media(const Options& options, std::span<const std::uint8_t> bytes,
                            Description& out) {
  const bool playlist = is_playlist(bytes);
  Result<media::ContainerInfo> info = playlist ? media::probe(options.input) : media::probe(bytes);
  if (!info) return info.error();
  Json tracks = Json::array();
  for (const media::TrackInfo& track : info->tracks) tracks.push_back(describe_track(track));
  Json json = {{"kind", "media"},           {"format", info->format}, {"bytes", info->bytes},
               {"seconds", info->duration}, {"tracks", tracks},       {"warnings", info->warnings}};
  if (info->first(media::TrackKind::face) == nullptr) return json;
  Result<media::Container> container =
      playlist ? media::read_container(options.input) : media::read_container(bytes);
  if (!container) return container.error();
  Result<Json> stream = describe_coded(options, fba::join_access_units(container->face), out);
  if (!stream) return stream.error();
  json["face"] = *stream;
  return json;
}

Result<Json> describe_model(std::span<const std::uint8_t> bytes) {
  Result<dam::Model> model = dam::read_model(bytes);
  if (!model) return model.error();
  Json phones = Json::array();
  const auto* animemes = std::get_if<dam::AnimemeParameters>(&model->parameters);
  std::size_t modes = 0;
  for (std::size_t i = 0; i < model->phones.size(); ++i) {
    const dam::PhoneModel& phone = model->phones[i];
    Json json = {{"phone", phone.label}, {"examples", phone.examples}};
    if (animemes != nullptr) {
      json["modes"] = animemes->phones[i].modes.size();
      modes += animemes->phones[i].modes.size();
    }
    phones.push_back(std::move(json));
  }
  Json controls = Json::array();
  for (const dam::Control& control : model->controls) controls.push_back(control.name);
  Json json = {{"kind", "model"},
               {"method", dam::method_name(model->method)},
               {"bytes", bytes.size()},
               {"rate", fap::format_rate(model->rate)}};
  if (animemes != nullptr) {
    json["order"] = animemes->order;
    json["modes"] = modes;
  }
  json.update({{"phones", phones},
               {"controls", controls},
               {"attribution", model->attribution},
               {"provenance", model->provenance}});
  return json;
}

Result<Json> describe_script(std::span<const std::uint8_t> bytes) {
  Result<dam::Script> script =
      dam::read_script({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  if (!script) return script.error();
  return Json{
      {"kind", "script"}, {"phones", script->phones.size()}, {"seconds", script->duration()}};
}

Result<Json> describe_text(const Options& options, std::vector<std::uint8_t> bytes) {
  Result<MotionInput> motion = parse_motion(std::move(bytes), options.input);
  if (!motion) return motion.error();
  const bool bap = motion->kind == FileKind::bap_text;
  Json json = {{"kind", bap ? "bap" : "fap"}};
  json.update(bap ? inspect::describe_body(motion->body) : inspect::describe_clip(motion->face));
  return json;
}

Result<Description> describe(const Options& options) {
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
      json = describe_model(*bytes);
      break;
    case FileKind::script:
      json = describe_script(*bytes);
      break;
    default:
      json = describe_text(options, std::move(*bytes));
  }
  if (!json) return json.error();
  out.json.update(*json);
  return out;
}

std::string text_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_number_float()) return value.dump();
  char text[40];
  std::snprintf(text, sizeof text, "%.3f", value.get<double>());
  return text;
}

// The tree as indented "name: value" lines; lists of objects as one line each.
void print(const Json& json, int indent) {
  for (const auto& [key, value] : json.items()) {
    const std::string pad(std::size_t(indent), ' ');
    if (value.is_object()) {
      std::printf("%s%s:\n", pad.c_str(), key.c_str());
      print(value, indent + 2);
    } else if (value.is_array() && !value.empty() && value.front().is_object()) {
      std::printf("%s%s:\n", pad.c_str(), key.c_str());
      for (const Json& item : value) {
        std::string line;
        for (const auto& [name, field] : item.items()) {
          line += (line.empty() ? "" : "  ") + name + " " + text_of(field);
        }
        std::printf("%s  %s\n", pad.c_str(), line.c_str());
      }
    } else if (value.is_array()) {
      std::string line;
      for (const Json& item : value) line += (line.empty() ? "" : ", ") + text_of(item);
      if (!line.empty()) std::printf("%s%s: %s\n", pad.c_str(), key.c_str(), line.c_str());
    } else if (const std::string text = text_of(value); !text.empty()) {
      std::printf("%s%s: %s\n", pad.c_str(), key.c_str(), text.c_str());
    }
  }
}

Result<int> run(const Options& options) {
  Result<Description> found = describe(options);
  if (!found) return found.error().in_file(options.input);
  if (options.json) {
    std::printf("%s\n", found->json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    return kOk;
  }
  print(found->json, 0);
  if (found->stream) std::fputs(inspect::planes_text(*found->stream).c_str(), stdout);
  return kOk;
}

Action add(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("file", options->input,
                 "FAP or BAP text, FBA stream, container, sound, model or phoneme script")
      ->required();
  app.add_flag("--json", options->json, "Machine-readable result");
  app.add_flag(
      "--planes", options->planes,
      "One line a plane: bit position, size, headers, masks, ranges (all of them with --json)");
  return [options] { return run(*options); };
}

}  // namespace

const Command kInfo{"info", "What a file holds",
                    "  animeme info talk.mp4\n"
                    "  animeme info talk.fba --planes --json",
                    add};

}  // namespace animeme::tools
