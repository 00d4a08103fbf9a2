#include "tools/commands/arkit_export.h"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace animeme::tools {

namespace {

std::string fixed_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6f", value == 0 ? 0.0 : value);  // no "-0"
  return text;
}

std::string timecode(std::size_t frame, const fap::Rate& rate) {
  // As cameras count: 29.97 frames a second are numbered like 30, without dropping any.
  const auto per_second = std::int64_t(std::ceil(rate.frames_per_second() - 1e-9));
  const auto number = std::int64_t(frame);
  const std::int64_t seconds = number / per_second;
  char text[64];
  std::snprintf(text, sizeof text, "%02d:%02d:%02d:%02d.000", int(seconds / 3600 % 100),
                int(seconds / 60 % 60), int(seconds % 60), int(number % per_second));
  return text;
}

std::string capital(std::string_view name) {
  std::string out(name);
  out[0] = char(out[0] - 'a' + 'A');
  return out;
}

}  // namespace

std::string live_link_csv(const ArkitCurves& curves) {
  std::string text = "Timecode,BlendShapeCount";
  for (const std::string_view name : fap::kArkitNames) text += "," + capital(name);
  text += "\n";
  for (std::size_t i = 0; i < curves.frames.size(); ++i) {
    text += timecode(i, curves.rate) + "," + std::to_string(fap::kArkitChannelCount);
    for (const double value : curves.frames[i]) text += "," + fixed_text(value);
    text += "\n";
  }
  return text;
}

std::string arkit_json(const ArkitCurves& curves, std::string_view audio) {
  const nlohmann::json name = audio.empty() ? nlohmann::json() : nlohmann::json(audio);
  const nlohmann::json names(fap::kArkitNames);
  char fps[40];
  std::snprintf(fps, sizeof fps, "%.12g", curves.rate.frames_per_second());
  std::string text = "{\"format\": \"animeme-arkit\", \"version\": 1, \"fps\": ";
  text += fps;
  text += ", \"rate\": [" + std::to_string(curves.rate.num) + ", " +
          std::to_string(curves.rate.den) +
          "],\n \"audio\": " + name.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) +
          ",\n \"names\": " + names.dump() + ",\n \"frames\": [";
  for (std::size_t i = 0; i < curves.frames.size(); ++i) {
    text += i == 0 ? "\n  [" : ",\n  [";
    for (std::size_t c = 0; c < curves.frames[i].size(); ++c) {
      text += (c == 0 ? "" : ", ") + fixed_text(curves.frames[i][c]);
    }
    text += "]";
  }
  return text + "\n]}\n";
}

}  // namespace animeme::tools
