#include "tools/speech/text/ssml_values.h"

#include <algorithm>
#include <cmath>

namespace animeme::text {
namespace {

constexpr double kLongestPause = 10;  // seconds

struct Word {
  std::string_view name;
  double value;
};

std::optional<double> named(std::string_view name, std::initializer_list<Word> words) {
  for (const Word& word : words) {
    if (word.name == name) return word.value;
  }
  return std::nullopt;
}

// A number with what follows it: "+6dB" is 6 and "dB".
std::optional<double> number_of(std::string_view text, std::string_view& unit) {
  std::size_t i = !text.empty() && (text[0] == '+' || text[0] == '-') ? 1 : 0;
  const std::size_t first = i;
  double value = 0, place = 0;
  for (; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '.' && place == 0) {
      place = 1;
    } else if (c >= '0' && c <= '9') {
      value = value * 10 + (c - '0');
      place *= 10;
    } else {
      break;
    }
    if (i > first + 12) return std::nullopt;
  }
  if (i == first) return std::nullopt;
  unit = text.substr(i);
  if (place > 1) value /= place;
  return text[0] == '-' ? -value : value;
}

bool has_sign(std::string_view text) { return !text.empty() && (text[0] == '+' || text[0] == '-'); }

std::optional<int> within(std::optional<double> percent, int least, int most) {
  if (!percent || !std::isfinite(*percent)) return std::nullopt;
  return int(std::lround(std::clamp(*percent, double(least), double(most))));
}

// "150%" and "+50%" of what is around.
std::optional<double> percent_of(std::string_view value, double around) {
  std::string_view unit;
  const auto number = number_of(value, unit);
  if (!number || unit != "%") return std::nullopt;
  return has_sign(value) ? around * (1 + *number / 100) : around * *number / 100;
}

}  // namespace

std::optional<double> seconds_of(std::string_view time) {
  std::string_view unit;
  const auto number = number_of(time, unit);
  if (!number || *number < 0 || (unit != "s" && unit != "ms")) return std::nullopt;
  return std::min(unit == "s" ? *number : *number / 1000, kLongestPause);
}

std::optional<double> break_strength(std::string_view strength) {
  return named(strength, {{"none", 0},
                          {"x-weak", 0.1},
                          {"weak", 0.2},
                          {"medium", 0.4},
                          {"strong", 0.8},
                          {"x-strong", 1.2}});
}

std::optional<int> rate_of(std::string_view value, int around) {
  auto percent = named(value, {{"x-slow", 50},
                               {"slow", 75},
                               {"medium", 100},
                               {"default", 100},
                               {"fast", 135},
                               {"x-fast", 180}});
  if (!percent) percent = percent_of(value, around);
  std::string_view unit;
  const auto factor = percent ? std::nullopt : number_of(value, unit);
  if (factor && unit.empty() && !has_sign(value)) percent = around * *factor;
  return within(percent, 20, 400);
}

std::optional<int> pitch_of(std::string_view value, int around) {
  auto percent = named(value, {{"x-low", 60},
                               {"low", 80},
                               {"medium", 100},
                               {"default", 100},
                               {"high", 125},
                               {"x-high", 160}});
  if (!percent) percent = percent_of(value, around);
  std::string_view unit;
  const auto number = percent ? std::nullopt : number_of(value, unit);
  if (number && unit == "st") percent = around * std::exp2(*number / 12);
  // Voices of espeak-ng speak at about 100 Hz.
  if (number && unit == "Hz") percent = has_sign(value) ? around + *number : *number;
  return within(percent, 20, 300);
}

std::optional<int> volume_of(std::string_view value, int around) {
  auto percent = named(value, {{"silent", 0},
                               {"x-soft", 40},
                               {"soft", 65},
                               {"medium", 100},
                               {"default", 100},
                               {"loud", 140},
                               {"x-loud", 180}});
  if (!percent) percent = percent_of(value, around);
  std::string_view unit;
  const auto number = percent ? std::nullopt : number_of(value, unit);
  if (number && unit == "dB") percent = around * std::pow(10, *number / 20);
  if (number && unit.empty()) percent = has_sign(value) ? around + *number : *number;
  return within(percent, 0, 200);
}

bool emphasise(std::string_view level, Manner& manner) {
  struct Level {
    std::string_view name;
    int rate, pitch, volume;
  };
  constexpr Level kLevels[] = {{"strong", 85, 115, 140},
                               {"moderate", 92, 108, 120},
                               {"", 92, 108, 120},
                               {"none", 100, 100, 100},
                               {"reduced", 108, 95, 75}};
  for (const Level& row : kLevels) {
    if (row.name != level) continue;
    manner.rate = std::clamp(manner.rate * row.rate / 100, 20, 400);
    manner.pitch = std::clamp(manner.pitch * row.pitch / 100, 20, 300);
    manner.volume = std::clamp(manner.volume * row.volume / 100, 0, 200);
    return true;
  }
  return false;
}

std::optional<SayAs> say_as_of(std::string_view interpret_as) {
  struct Row {
    std::string_view name;
    SayAs how;
  };
  // Time, currency and measure are read by what they look like.
  constexpr Row kRows[] = {{"characters", SayAs::characters},
                           {"character", SayAs::characters},
                           {"spell-out", SayAs::characters},
                           {"verbatim", SayAs::characters},
                           {"letters", SayAs::characters},
                           {"digits", SayAs::digits},
                           {"telephone", SayAs::telephone},
                           {"ordinal", SayAs::ordinal},
                           {"date", SayAs::date},
                           {"cardinal", SayAs::words},
                           {"number", SayAs::words},
                           {"time", SayAs::words},
                           {"currency", SayAs::words},
                           {"unit", SayAs::words},
                           {"measure", SayAs::words},
                           {"fraction", SayAs::words},
                           {"address", SayAs::words},
                           {"name", SayAs::words},
                           {"net", SayAs::words}};
  for (const Row& row : kRows) {
    if (row.name == interpret_as) return row.how;
  }
  return std::nullopt;
}

}  // namespace animeme::text
