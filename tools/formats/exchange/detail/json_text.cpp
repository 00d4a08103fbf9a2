#include "tools/formats/exchange/detail/json_text.h"

#include <cstdio>

#include "tools/formats/common/json.h"

namespace animeme::exchange {

std::string decimals(double value, int digits) {
  char text[400];  // the longest number has 309 digits before the point
  std::snprintf(text, sizeof text, "%.*f", digits, value == 0 ? 0.0 : value);
  return text;
}

std::string json_text(std::string_view text) { return tools::Json(text).dump(); }

std::string track_head(std::string_view format, const fap::Rate& rate, std::string_view audio) {
  char fps[40];
  std::snprintf(fps, sizeof fps, "%.12g", rate.frames_per_second());
  return "{\"format\": " + json_text(format) + ", \"version\": 1, \"fps\": " + fps +
         ", \"rate\": [" + std::to_string(rate.num) + ", " + std::to_string(rate.den) +
         "],\n \"audio\": " + (audio.empty() ? "null" : json_text(audio)) + ",\n \"names\": ";
}

}  // namespace animeme::exchange
