#include "tools/formats/exchange/face_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "fap/tables.h"
#include "tools/formats/exchange/detail/json_landmarks.h"

namespace animeme::exchange {

namespace {

using Json = nlohmann::json;

constexpr const char* kFormat = "animeme-face";
constexpr std::pair<const char*, double fap::Fapu::*> kUnits[] = {{"IRISD", &fap::Fapu::irisd},
                                                                  {"ES", &fap::Fapu::es},
                                                                  {"ENS", &fap::Fapu::ens},
                                                                  {"MNS", &fap::Fapu::mns},
                                                                  {"MW", &fap::Fapu::mw}};

Result<fap::Fapu> read_units(const Json& json) {
  fap::Fapu fapu;
  for (const auto& [name, member] : kUnits) {
    const auto found = json.is_object() ? json.find(name) : json.end();
    if (!json.is_object() || found == json.end()) {
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
  if (json.value("version", 0) != 1) {
    return make_error(Code::unsupported, "a face file of another version; 1 is known");
  }
  fap::RestingFace face;
  const auto depth = json.find("depth");
  if (depth != json.end() && !depth->is_boolean()) {
    return make_error(Code::syntax, "depth is true or false");
  }
  face.depth = depth != json.end() && depth->get<bool>();
  const auto fapu = read_units(json.contains("fapu") ? json["fapu"] : Json());
  if (!fapu) return fapu.error();
  face.fapu = *fapu;
  const auto points = json.find("points");
  if (points == json.end() || !points->is_object() || points->empty()) {
    return make_error(Code::not_found, "the face file has no points");
  }
  for (const auto& [id, value] : points->items()) {
    const auto place = numbers<3>(value);
    if (!is_id(id) || !place) {
      return make_error(Code::invalid_argument,
                        "the point '" + id + "' is no feature point with three numbers");
    }
    face.points[id] = *place;
  }
  if (const auto turn = numbers<3>(json.value("turn", Json()))) {
    face.turn = {(*turn)[0], (*turn)[1], (*turn)[2]};
  }
  if (const Json gaze = json.value("gaze", Json()); gaze.is_array() && gaze.size() == 2) {
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
    const auto found = json["neutral_px"].find(std::to_string(source.landmark));
    if (found == json["neutral_px"].end()) continue;
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
  const auto points = json.find("neutral_px");
  return json.contains("fapu_px") && points != json.end() && points->is_object();
}

}  // namespace

bool is_face_file(std::string_view text) {
  if (!is_json(text)) return false;
  const Json json = Json::parse(text, nullptr, false);
  return json.is_object() && (json.value("format", Json()) == kFormat || is_pixels(json));
}

Result<fap::RestingFace> read_face_file(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object()) {
    return make_error(Code::syntax,
                      "this is no face file; import --save-face writes one, of any recording");
  }
  if (is_pixels(json)) return read_pixels(json);
  if (json.value("format", Json()) != kFormat) {
    return make_error(Code::unsupported,
                      "this JSON is no face file; import --save-face writes one, of any recording");
  }
  if (json.contains("version") && !json["version"].is_number_integer()) {
    return make_error(Code::syntax, "the version of a face file is a number");
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
