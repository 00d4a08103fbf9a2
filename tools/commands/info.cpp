#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "codec/decoder.h"
#include "dam/model.h"
#include "dam/script.h"
#include "fap/rate_text.h"
#include "fap/tables.h"
#include "tools/commands/common.h"
#include "tools/media/container.h"

namespace animeme::tools {

namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::string input;
  bool json = false;
  bool planes = false;
};

std::string mask_text(const fap::Mask& mask) {
  // Runs of numbers: "3-13, 51-60".
  std::string text;
  for (std::size_t fap = 1; fap <= fap::kFapCount; ++fap) {
    if (!mask[fap]) continue;
    std::size_t last = fap;
    while (last < fap::kFapCount && mask[last + 1]) ++last;
    if (!text.empty()) text += ", ";
    text += std::to_string(fap);
    if (last > fap) text += "-" + std::to_string(last);
    fap = last;
  }
  return text.empty() ? "none" : text;
}

Json describe_clip(const fap::Sequence& clip) {
  fap::Mask used;
  for (const fap::Frame& frame : clip.frames) used |= frame.mask;
  Json faps = Json::array();
  for (int number = fap::kFirstLowLevel; number <= fap::kFapCount; ++number) {
    if (!used[std::size_t(number)]) continue;
    std::int32_t low = 0;
    std::int32_t high = 0;
    bool first = true;
    for (const fap::Frame& frame : clip.frames) {
      if (!frame.mask[std::size_t(number)]) continue;
      const std::int32_t value = frame.value[std::size_t(number)];
      low = first ? value : std::min(low, value);
      high = first ? value : std::max(high, value);
      first = false;
    }
    faps.push_back(
        {{"fap", number}, {"name", fap::info(number).name}, {"min", low}, {"max", high}});
  }
  return {{"frames", clip.frames.size()},
          {"rate", fap::format_rate(clip.rate)},
          {"seconds", clip.duration()},
          {"coded_faps", mask_text(used)},
          {"faps", faps}};
}

Json describe_plane(const fba::Plane& plane) {
  Json json = {{"number", plane.number},
               {"seconds", plane.seconds},
               {"type", plane.intra ? "I" : "P"},
               {"bit", plane.bit_begin},
               {"bits", plane.bit_end - plane.bit_begin},
               {"start_code", plane.start_code},
               {"face", fba::has_face(plane.object_mask)},
               {"body", fba::has_body(plane.object_mask)}};
  if (plane.temporal.skip) json["skip"] = *plane.temporal.skip;
  if (plane.intra && plane.face_settings) {
    const fba::FaceSettings& face = *plane.face_settings;
    json["fap_quant"] = face.fap_quant;
    Json types = Json::array();
    for (const fba::MaskType type : face.mask_type) types.push_back(int(type));
    json["mask_types"] = types;
    json["faps"] = mask_text(face.mask);
    constexpr const char* kNames[4] = {"i_max", "i_min", "p_max", "p_min"};
    for (std::size_t kind = 0; kind < 4; ++kind) {
      if (!face.send_range[kind]) continue;
      Json ranges = Json::array();
      for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
        if (face.mask[fap]) ranges.push_back(face.range[kind][fap] * 60);
      }
      json[kNames[kind]] = ranges;
    }
  }
  return json;
}

Result<Json> describe_stream(std::span<const std::uint8_t> stream, bool planes) {
  Result<fba::DecodedStream> decoded = fba::decode(stream);
  if (!decoded) return decoded.error();
  std::size_t intra = 0;
  std::int64_t bits = 0;
  std::size_t bodies = 0;
  for (const fba::Plane& plane : decoded->planes) {
    intra += plane.intra ? 1 : 0;
    bits += plane.bit_end - plane.bit_begin;
    bodies += plane.body ? 1 : 0;
  }
  const fba::Plane& last = decoded->planes.back();
  const double seconds = decoded->rate.seconds(double(last.number + 1));
  Json json = {{"planes", decoded->planes.size()},
               {"intra_planes", intra},
               {"body_planes", bodies},
               {"bytes", stream.size()},
               {"seconds", seconds},
               {"kbit_per_s", double(bits) * 1e-3 / seconds},
               {"clip", describe_clip(fba::face_sequence(*decoded))},
               {"warnings", decoded->warnings}};
  if (decoded->planes.front().face_settings) {
    json["fap_quant"] = decoded->planes.front().face_settings->fap_quant;
  }
  if (planes) {
    Json list = Json::array();
    for (const fba::Plane& plane : decoded->planes) list.push_back(describe_plane(plane));
    json["plane_list"] = list;
  }
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

Result<Json> describe_media(const Options& options, std::span<const std::uint8_t> bytes) {
  Result<media::ContainerInfo> info = media::probe(bytes);
  if (!info) return info.error();
  Json tracks = Json::array();
  for (const media::TrackInfo& track : info->tracks) tracks.push_back(describe_track(track));
  Json json = {{"kind", "media"},           {"format", info->format}, {"bytes", bytes.size()},
               {"seconds", info->duration}, {"tracks", tracks},       {"warnings", info->warnings}};
  if (info->first(media::TrackKind::face) == nullptr) return json;
  Result<media::Container> container = media::read_container(bytes);
  if (!container) return container.error();
  Result<Json> stream = describe_stream(fba::join_access_units(container->face), options.planes);
  if (!stream) return stream.error();
  json["face"] = *stream;
  return json;
}

Result<Json> describe_model(std::span<const std::uint8_t> bytes) {
  Result<dam::Model> model = dam::read_model(bytes);
  if (!model) return model.error();
  Json phones = Json::array();
  std::size_t modes = 0;
  for (const dam::PhoneModel& phone : model->phones) {
    modes += phone.modes.size();
    phones.push_back(
        {{"phone", phone.label}, {"examples", phone.examples}, {"modes", phone.modes.size()}});
  }
  Json controls = Json::array();
  for (const dam::Control& control : model->controls) controls.push_back(control.name);
  return Json{{"kind", "model"},
              {"method", dam::method_name(model->method)},
              {"bytes", bytes.size()},
              {"rate", fap::format_rate(model->rate)},
              {"order", model->order},
              {"modes", modes},
              {"phones", phones},
              {"controls", controls},
              {"attribution", model->attribution},
              {"provenance", model->provenance}};
}

Result<Json> describe(const Options& options) {
  Result<std::vector<std::uint8_t>> bytes = read_file(options.input);
  if (!bytes) return bytes.error();
  if (bytes->empty()) return make_error(Code::truncated, "the file is empty");
  const FileKind kind = kind_of(*bytes);
  switch (kind) {
    case FileKind::fba_stream: {
      Result<Json> json = describe_stream(*bytes, options.planes);
      if (!json) return json.error();
      Json out = {{"kind", "fba"}};
      out.update(*json);
      return out;
    }
    case FileKind::media:
      return describe_media(options, *bytes);
    case FileKind::model:
      return describe_model(*bytes);
    case FileKind::script: {
      Result<dam::Script> script =
          dam::read_script({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
      if (!script) return script.error();
      return Json{
          {"kind", "script"}, {"phones", script->phones.size()}, {"seconds", script->duration()}};
    }
    default: {
      Result<FaceInput> face = parse_face(std::move(*bytes), options.input);
      if (!face) return face.error();
      Json out = {{"kind", "fap"}};
      out.update(describe_clip(face->clip));
      return out;
    }
  }
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
  Result<Json> json = describe(options);
  if (!json) return json.error().in_file(options.input);
  if (options.json) {
    std::printf("%s\n", json->dump(2, ' ', false, Json::error_handler_t::replace).c_str());
  } else {
    print(*json, 0);
  }
  return kOk;
}

Action add(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("file", options->input,
                 "FAP text, FBA stream, container, sound, model or phoneme script")
      ->required();
  app.add_flag("--json", options->json, "Machine-readable result");
  app.add_flag("--planes", options->planes,
               "One line a plane: bit position, size, masks, ranges (levels at fap_quant 1)");
  return [options] { return run(*options); };
}

}  // namespace

const Command kInfo{"info", "What a file holds",
                    "  animeme info talk.mp4\n"
                    "  animeme info talk.fba --planes --json",
                    add};

}  // namespace animeme::tools
