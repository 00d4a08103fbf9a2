#include "tools/formats/exchange/face_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "fap/tables.h"
#include "tools/formats/common/json.h"
#include "tools/formats/exchange/detail/json_landmarks.h"

namespace animeme::exchange {

namespace {

using tools::Json;

constexpr const char* kFormat = "animeme-face";
constexpr std::pair<const char*, double fap::Fapu::*> kUnits[] = {{"IRISD", &fap::Fapu::irisd},
                                                                  {"ES", &fap::Fapu::es},
                                                                  {"ENS", &fap::Fapu::ens},
                                                                  {"MNS", &fap::Fapu::mns},
                                                                  {"MW", &fap::Fapu::mw}};

Result<fap::Fapu> read_units(const Json& json) {
  fap::Fapu fapu;
  for (const auto& [name, member] : kUnits) {
    const Json* found = json.find(name);
    if (found == nullptr) {
      return make_error(Code::not_found, std::string("the unit ") + name + " is missing");
    }
    if (!found->is_number()) {
      return make_error(Code::syntax, std::string("the unit ") + name + " is no number");
    }
    fapu.*member = found->get<double>();
    if (!(fapu.*member > 0) || !std::isfinite(fapu.*member)) {
      return make_error(Code::invalid_argument,
                        std::string("the unit ") + name + " is not positive");
    }
  }
  return fapu;
}

template <std::size_t N>
std::optional<std::array<double, N>> numbers(const Json& json) {
  if (!json.is_array() || json.size() != N) return std::nullopt;
  std::array<double, N> out{};
  for (std::size_t i = 0; i < N; ++i) {
    if (!json[i].is_number()) return std::nullopt;
    out[i] = json[i].get<double>();
    if (!std::isfinite(out[i])) return std::nullopt;
  }
  return out;
}

bool is_id(const std::string& id) {
  return id == fap::kNasion ||
         std::any_of(fap::kFeaturePoints.begin(), fap::kFeaturePoints.end(),
                     [&](const fap::FeaturePointInfo& point) { return point.id == id; });
}

Result<fap::RestingFace> read_ours(const Json& json) {
  const Json* version = json.find("version");
  if (version == nullptr || version->get<int>() != 1) {
    return make_error(Code::unsupported,
                      "unsupported version of a face file; version 1 is supported");
  }
  fap::RestingFace face;
  const Json* depth = json.find("depth");
  if (depth != nullptr && !depth->is_boolean()) {
    return make_error(Code::syntax, "depth must be true or false");
  }
  face.depth = depth != nullptr && depth->get<bool>();
  const auto fapu = read_units(json["fapu"]);
  if (!fapu) return fapu.error();
  face.fapu = *fapu;
  const Json& points = json["points"];
  if (!points.is_object() || points.empty()) {
    return make_error(Code::not_found, "the face file has no points");
  }
  for (const auto& [id, value] : points.items()) {
    const auto place = numbers<3>(value);
    if (!is_id(id) || !place) {
      return make_error(Code::invalid_argument,
                        "the point '" + id + "' is not a feature point with three numbers");
    }
    face.points[id] = *place;
  }
  if (const auto turn = numbers<3>(json["turn"])) {
    face.turn = {(*turn)[0], (*turn)[1], (*turn)[2]};
  }
  if (const Json& gaze = json["gaze"]; gaze.is_array() && gaze.size() == 2) {
    for (std::size_t eye = 0; eye < 2; ++eye) {
      if (const auto at = numbers<2>(gaze[eye])) face.gaze[eye] = fap::EyeTurn{(*at)[0], (*at)[1]};
    }
  }
  return face;
}

// Pixels of MediaPipe's points by number: y goes down, z away from the camera.
Result<fap::RestingFace> read_pixels(const Json& json) {
  fap::RestingFace face;
  const auto fapu = read_units(json["fapu_px"]);
  if (!fapu) return fapu.error();
  face.fapu = *fapu;
  face.depth = true;
  for (const fap::LandmarkSource& source : fap::landmark_sources(fap::LandmarkLayout::mediapipe)) {
    const Json* found = json["neutral_px"].find(std::to_string(source.landmark));
    if (found == nullptr) continue;
    const auto place = numbers<3>(*found);
    if (!place) {
      return make_error(Code::invalid_argument,
                        "the point " + std::to_string(source.landmark) + " has no three numbers");
    }
    face.points[std::string(source.point)] = {(*place)[0], -(*place)[1], -(*place)[2]};
  }
  if (face.points.empty()) return make_error(Code::not_found, "the face file has no points");
  return face;
}

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value == 0 ? 0.0 : value);
  return text;
}

bool is_pixels(const Json& json) {
  return json.contains("fapu_px") && json["neutral_px"].is_object();
}

}  // namespace

bool is_face_file(std::string_view text) {
  if (!is_json(text)) return false;
  const Result<Json> json = Json::parse(text);
  return json && ((*json)["format"] == kFormat || is_pixels(*json));
}

Result<fap::RestingFace> read_face_file(std::string_view text) {
  const Result<Json> read = Json::parse(text, {.sorted = true});
  if (!read || !read->is_object()) {
    return make_error(Code::syntax,
                      "this is not a face file; import --save-face makes one from any recording");
  }
  const Json& json = *read;
  if (is_pixels(json)) return read_pixels(json);
  if (json["format"] != kFormat) {
    return make_error(
        Code::unsupported,
        "this JSON is not a face file; import --save-face makes one from any recording");
  }
  if (json.contains("version") && !json["version"].is_number_integer()) {
    return make_error(Code::syntax, "the version of a face file must be a number");
  }
  return read_ours(json);
}

std::string write_face_file(const fap::RestingFace& face) {
  std::string text = std::string("{\"format\": \"") + kFormat +
                     "\", \"version\": 1, \"depth\": " + (face.depth ? "true" : "false") +
                     ",\n \"fapu\": {";
  const char* separator = "";
  for (const auto& [name, member] : kUnits) {
    text += separator + ("\"" + std::string(name) + "\": ") + number(face.fapu.*member);
    separator = ", ";
  }
  text += "},\n \"points\": {";
  separator = "";
  for (const auto& [id, place] : face.points) {
    text += std::string(separator) + "\n  \"" + id + "\": [" + number(place[0]) + ", " +
            number(place[1]) + ", " + number(place[2]) + "]";
    separator = ",";
  }
  text += "},\n \"turn\": [" + number(face.turn.pitch) + ", " + number(face.turn.yaw) + ", " +
          number(face.turn.roll) + "],\n \"gaze\": [";
  for (std::size_t eye = 0; eye < 2; ++eye) {
    const auto& gaze = face.gaze[eye];
    text += eye == 0 ? "" : ", ";
    text += gaze ? "[" + number(gaze->yaw) + ", " + number(gaze->pitch) + "]" : "null";
  }
  return text + "]}\n";
}

}  // namespace animeme::exchange
