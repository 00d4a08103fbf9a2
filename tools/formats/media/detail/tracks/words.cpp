#include "tools/formats/media/detail/tracks/words_internal.h"

#include <algorithm>
#include <charconv>

namespace animeme::media {

std::optional<std::vector<std::uint8_t>> from_hex(std::string_view text) {
  if (text.size() % 2 != 0) return std::nullopt;
  std::vector<std::uint8_t> out;
  for (std::size_t i = 0; i < text.size(); i += 2) {
    const char* const end = text.data() + i + 2;
    std::uint8_t& byte = out.emplace_back();
    if (std::from_chars(end - 2, end, byte, 16).ptr != end) return std::nullopt;
  }
  return out;
}

std::string_view trim(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

std::string_view take_until(std::string_view& text, char mark) {
  const std::size_t end = std::min(text.find(mark), text.size());
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return trim(part);
}

std::optional<std::uint32_t> to_number(std::string_view text, std::uint32_t highest) {
  std::uint32_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || at != end || value > highest) return std::nullopt;
  return value;
}

Parameters read_parameters(std::string_view text) {
  Parameters out;
  while (!text.empty()) {
    std::string_view value = take_until(text, ';');
    const std::string key = lower_case(take_until(value, '='));
    if (!key.empty()) out.try_emplace(key, trim(value));
  }
  return out;
}

std::optional<std::uint32_t> number_of(const Parameters& parameters, std::string_view key,
                                       std::uint32_t highest) {
  const auto found = parameters.find(key);
  if (found == parameters.end()) return std::nullopt;
  return to_number(found->second, highest);
}

}  // namespace animeme::media
