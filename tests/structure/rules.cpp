#include "tests/structure/rules.h"

#include <cctype>

namespace animeme::test {
namespace {

bool starts_with(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

bool is_header(std::string_view path) { return path.ends_with(".h") || path.ends_with(".hpp"); }

// Not installed for others (only .h files are), so it may show what it is made of.
bool is_internal(std::string_view path) {
  return path.ends_with("_internal.h") || path.ends_with(".hpp") || contains(path, "/detail/") ||
         contains(path, "/kinds/") || contains(path, "/maths/");
}

// Part of the manual that Doxygen makes.
bool is_public(std::string_view path) {
  return path.ends_with(".h") && !is_internal(path) && !starts_with(path, "tests/");
}

// <vector>, but neither <zlib.h> nor <Eigen/Dense>.
bool is_standard(const Include& include) {
  return !include.quoted && include.name.find_first_of("./") == std::string::npos;
}

bool is_ffmpeg(std::string_view name) {
  return starts_with(name, "libav") || starts_with(name, "libsw") || starts_with(name, "libpost");
}

bool is_voice(std::string_view name) {
  return starts_with(name, "espeak") || starts_with(name, "speak_lib") ||
         starts_with(name, "pocketsphinx") || starts_with(name, "sphinxbase");
}

bool is_web(std::string_view name) { return starts_with(name, "libwebsockets"); }

bool is_libxml(std::string_view name) { return starts_with(name, "libxml/"); }

bool is_eigen(std::string_view name) {
  return starts_with(name, "Eigen/") || starts_with(name, "unsupported/Eigen/");
}

bool in_any(std::string_view path, std::initializer_list<std::string_view> folders) {
  for (const std::string_view folder : folders) {
    if (starts_with(path, folder)) return true;
  }
  return false;
}

// Libraries that have one home each, whoever asks.
std::string library_rule(std::string_view path, const Include& include) {
  if (is_ffmpeg(include.name) && !in_any(path, {"tools/media/", "tests/media/"})) {
    return "FFmpeg belongs to tools/media";
  }
  if (is_voice(include.name) && !in_any(path, {"tools/voice/", "tests/voice/"})) {
    return "espeak and pocketsphinx belong to tools/voice";
  }
  if (is_web(include.name) && !in_any(path, {"tools/web/detail/"})) {
    return "libwebsockets belongs to tools/web/detail";
  }
  if (is_libxml(include.name)) {
    if (!in_any(path, {"fap/xml/"})) return "libxml2 belongs to fap/xml";
    if (is_header(path)) return "libxml2 must not show in a header";
  }
  if (is_eigen(include.name)) {
    if (!in_any(path, {"dam/", "tests/dam/", "tests/bench/"})) return "Eigen belongs to dam";
    if (starts_with(path, "dam/") && is_header(path) && !is_internal(path)) {
      return "Eigen must not show in a header that is installed";
    }
  }
  return {};
}

std::string library_folder_rule(std::string_view path, const Include& include) {
  if (starts_with(path, "fap/")) {
    const bool heads = in_any(path, {"fap/head/", "fap/xml/"});
    if (!heads && starts_with(include.name, "fap/head/")) {
      return "fap does not know its heads";
    }
    if (!starts_with(path, "fap/xml/") && starts_with(include.name, "fap/xml/")) {
      return "fap does not know its files in XML";
    }
    if (is_standard(include) || (include.quoted && starts_with(include.name, "fap/"))) return {};
    if (is_libxml(include.name)) return {};  // library_rule() knows where
    return "fap includes only fap and the C++ library";
  }
  if (starts_with(path, "codec/")) {
    const bool own = include.quoted && in_any(include.name, {"fap/", "codec/"});
    if (own || is_standard(include)) return {};
    return "codec includes only fap, codec and the C++ library";
  }
  if (starts_with(path, "dam/")) {
    const bool own = include.quoted && in_any(include.name, {"fap/", "dam/"});
    if (own || is_standard(include) || is_eigen(include.name)) return {};
    return "dam includes only fap, dam, Eigen and the C++ library";
  }
  if (starts_with(path, "conformance/")) {
    const bool other = include.quoted && in_any(include.name, {"dam/", "tools/", "tests/"});
    return other ? "conformance includes only fap and codec of our own" : "";
  }
  if (starts_with(path, "tools/") && include.quoted && starts_with(include.name, "tests/")) {
    return "tools do not include tests";
  }
  return {};
}

std::string at(std::string_view path, int line, std::string_view sentence) {
  return std::string(path) + ":" + std::to_string(line) + ": " + std::string(sentence);
}

template <class Visit>
void for_each_line(std::string_view text, Visit visit) {
  int number = 1;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    visit(number++, text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

// `part` in `line` and not in the middle of a longer word.
bool names(std::string_view line, std::string_view part) {
  for (std::size_t i = line.find(part); i != std::string_view::npos; i = line.find(part, i + 1)) {
    const char before = i == 0 ? ' ' : line[i - 1];
    if (!std::isalnum(static_cast<unsigned char>(before)) && before != '_') return true;
  }
  return false;
}

}  // namespace

std::vector<Include> includes_of(std::string_view text) {
  std::vector<Include> result;
  for_each_line(text, [&](int number, std::string_view line) {
    std::size_t i = line.find_first_not_of(" \t");
    if (i == std::string_view::npos || line[i] != '#') return;
    i = line.find_first_not_of(" \t", i + 1);
    if (i == std::string_view::npos || !starts_with(line.substr(i), "include")) return;
    const std::size_t open = line.find_first_of("<\"", i);
    if (open == std::string_view::npos) return;
    const bool quoted = line[open] == '"';
    const std::size_t close = line.find(quoted ? '"' : '>', open + 1);
    if (close == std::string_view::npos) return;
    result.push_back({number, quoted, std::string(line.substr(open + 1, close - open - 1))});
  });
  return result;
}

std::vector<std::string> include_violations(std::string_view path, std::string_view text) {
  std::vector<std::string> result;
  for (const Include& include : includes_of(text)) {
    for (const std::string& rule :
         {library_rule(path, include), library_folder_rule(path, include)}) {
      if (!rule.empty()) result.push_back(at(path, include.line, rule + ": " + include.name));
    }
  }
  return result;
}

std::vector<std::string> header_violations(std::string_view path, std::string_view text) {
  std::vector<std::string> result;
  if (!is_header(path)) return result;
  if (is_public(path)) {
    if (!starts_with(text, "/// @file\n/// ")) {
      result.push_back(at(path, 1, "a public header starts with /// @file and what it is for"));
    }
  } else if (!starts_with(text, "//") && !starts_with(text, "/*")) {
    result.push_back(at(path, 1, "a header starts with a comment that says what it is for"));
  }
  if (!contains(text, "\n#pragma once\n")) {
    result.push_back(at(path, 1, "a header has #pragma once"));
  }
  return result;
}

std::vector<std::string> path_violations(std::string_view path, std::string_view text) {
  std::vector<std::string> result;
  // The one place that knows where reference data may lie, and the names as written here.
  if (path == "tests/support/shared.h" || starts_with(path, "tests/structure/")) return result;
  for_each_line(text, [&](int number, std::string_view line) {
    for (const std::string_view part : {"/work/", "../shared"}) {
      if (names(line, part)) {
        result.push_back(at(path, number, "this path exists on one machine only: ") +
                         std::string(part));
      }
    }
  });
  return result;
}

}  // namespace animeme::test
