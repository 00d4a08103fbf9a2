#include "dam/script/script_text_internal.h"

#include <algorithm>

namespace animeme::dam {
namespace {

constexpr char32_t kReplacement = 0xFFFD;

// Windows-1252 where it differs from Latin-1; 0: no character.
constexpr char16_t kWindows[32] = {0x20AC, 0,      0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021,
                                   0x02C6, 0x2030, 0x0160, 0x2039, 0x0152, 0,      0x017D, 0,
                                   0,      0x2018, 0x2019, 0x201C, 0x201D, 0x2022, 0x2013, 0x2014,
                                   0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0,      0x017E, 0x0178};

bool is_surrogate(char32_t code) { return code >= 0xD800 && code <= 0xDFFF; }

std::string from_utf16(std::string_view bytes, bool big_endian) {
  const auto unit = [&](std::size_t at) {
    const auto first = char32_t(static_cast<unsigned char>(bytes[at]));
    const auto second = char32_t(static_cast<unsigned char>(bytes[at + 1]));
    return big_endian ? (first << 8 | second) : (second << 8 | first);
  };
  std::string out;
  out.reserve(bytes.size());
  for (std::size_t at = 0; at + 1 < bytes.size(); at += 2) {
    char32_t code = unit(at);
    if (is_surrogate(code)) {
      const char32_t low = at + 3 < bytes.size() ? unit(at + 2) : 0;
      const bool pair = code < 0xDC00 && low >= 0xDC00 && low <= 0xDFFF;
      code = pair ? 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00) : kReplacement;
      if (pair) at += 2;
    }
    append_utf8(out, code);
  }
  return out;
}

// What a byte in the middle of UTF-8 was meant to be. Texts that were put together from several
// files have letters and quotation marks of Windows-1252; all others are remains of characters that
// were cut (C2, C3 and E2 begin the usual ones) or damage.
char32_t meaning_of_odd(char c) {
  const auto byte = static_cast<unsigned char>(c);
  const bool quotes = byte >= 0x91 && byte <= 0x97;
  const bool letter = byte >= 0xC0 && byte < 0xFE && byte != 0xC2 && byte != 0xC3 && byte != 0xE2;
  return quotes || letter ? from_windows(c) : kReplacement;
}

// The characters of a text in UTF-8, and how many of them are more than a byte long.
std::string read_utf8(std::string_view bytes, OddBytes& odd, std::size_t& long_characters) {
  std::string out;
  out.reserve(bytes.size());
  std::int64_t line = 1;
  while (!bytes.empty()) {
    const std::string_view before = bytes;
    const char32_t code = take_code_point(bytes);
    const std::size_t taken = before.size() - bytes.size();
    if (code == kReplacement && !before.starts_with("\xEF\xBF\xBD")) {
      for (const char c : before.substr(0, taken)) append_utf8(out, meaning_of_odd(c));
      odd.count += taken;
      if (odd.line == 0) odd.line = line;
      continue;
    }
    line += code == U'\n' ? 1 : 0;
    long_characters += taken > 1 ? 1 : 0;
    out.append(before.substr(0, taken));
  }
  return out;
}

}  // namespace

void append_utf8(std::string& out, char32_t code) {
  const auto put = [&](char32_t byte) { out += static_cast<char>(byte); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xC0 | code >> 6);
    put(0x80 | (code & 0x3F));
  } else if (code < 0x10000) {
    put(0xE0 | code >> 12);
    put(0x80 | (code >> 6 & 0x3F));
    put(0x80 | (code & 0x3F));
  } else {
    put(0xF0 | code >> 18);
    put(0x80 | (code >> 12 & 0x3F));
    put(0x80 | (code >> 6 & 0x3F));
    put(0x80 | (code & 0x3F));
  }
}

char32_t take_code_point(std::string_view& text) {
  const auto byte = [&](std::size_t i) { return char32_t(static_cast<unsigned char>(text[i])); };
  const char32_t first = byte(0);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xC2 ? 0
                             : first < 0xE0 ? 2
                             : first < 0xF0 ? 3
                             : first < 0xF5 ? 4
                                            : 0;
  if (length == 0 || length > text.size()) {
    text.remove_prefix(1);
    return kReplacement;
  }
  char32_t code = length == 1 ? first : first & (0x7Fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) {
      text.remove_prefix(1);
      return kReplacement;
    }
    code = code << 6 | (byte(i) & 0x3F);
  }
  constexpr char32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  text.remove_prefix(length);
  return code < kLeast[length] || code > 0x10FFFF || is_surrogate(code) ? kReplacement : code;
}

char32_t from_windows(char c) {
  const auto byte = static_cast<unsigned char>(c);
  if (byte < 0x80 || byte >= 0xA0) return byte;
  return kWindows[byte - 0x80] == 0 ? kReplacement : char32_t(kWindows[byte - 0x80]);
}

std::string OddBytes::describe() const {
  return (count == 1 ? "1 byte is" : std::to_string(count) + " bytes are") +
         std::string(" not UTF-8; read as Windows-1252 where that gives a letter, else as U+FFFD");
}

std::string to_utf8(std::string_view bytes, OddBytes* odd) {
  if (bytes.starts_with("\xFF\xFE")) return from_utf16(bytes.substr(2), false);
  if (bytes.starts_with("\xFE\xFF")) return from_utf16(bytes.substr(2), true);
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  // In a few bytes a zero is a fault.
  const auto big_endian = fap::detail::unmarked_utf16(bytes);
  if (big_endian && bytes.size() >= 8) return from_utf16(bytes, *big_endian);
  OddBytes found;
  std::size_t long_characters = 0;
  std::string out = read_utf8(bytes, found, long_characters);
  if (found.count == 0 || long_characters > 0) {
    if (odd != nullptr) *odd = found;
    return out;
  }
  out.clear();
  for (const char c : bytes) append_utf8(out, from_windows(c));
  return out;
}

bool LineReader::next(Line& line) {
  if (rest_.empty()) return false;
  const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
  line = {rest_.substr(0, end), ++number_};
  rest_.remove_prefix(end);
  if (rest_.starts_with("\r\n")) {
    rest_.remove_prefix(2);
  } else if (!rest_.empty()) {
    rest_.remove_prefix(1);
  }
  return true;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replace});
    }
  }
  return row.back();
}

}  // namespace animeme::dam
