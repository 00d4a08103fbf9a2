#include "tests/structure/rules.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <set>

#include "tests/structure/modules.h"
#include "tests/structure/tree.h"

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

// Calls visit with each of the words of a text, until it returns true; if it did.
template <class Visit>
bool any_word(std::string_view text, Visit visit) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    if (end > 0 && visit(text.substr(0, end))) return true;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return false;
}

// `pattern` is a name, or "x/*".
bool fits(std::string_view name, std::string_view pattern) {
  return pattern.ends_with("/*") ? starts_with(name, pattern.substr(0, pattern.size() - 1))
                                 : name == pattern;
}

const Module* module_of(std::string_view path) {
  std::string_view folder = path.substr(0, std::min(path.rfind('/'), path.size()));
  if (folder.ends_with("/detail")) folder.remove_suffix(7);
  for (const Module& module : kModules) {
    if (any_word(module.folders,
                 [&](std::string_view f) { return fits(folder, f) || path == f; })) {
      return &module;
    }
  }
  return nullptr;
}

bool reaches(const Module& module, const Module& below) {
  if (&module == &below) return true;
  return any_word(module.depends_on, [&](std::string_view pattern) {
    return std::any_of(std::begin(kModules), std::end(kModules), [&](const Module& next) {
      return any_word(next.folders, [&](std::string_view f) { return fits(f, pattern); }) &&
             reaches(next, below);
    });
  });
}

bool is_installed(std::string_view path) {
  const Module* module = module_of(path);
  return is_header(path) && !is_internal(path) && module != nullptr && module->installed;
}

std::string own_rule(std::string_view path, std::string_view header) {
  const Module* module = module_of(path);
  if (module == nullptr) return "this folder has no row in tests/structure/modules.h";
  if (module_of(header) == nullptr)
    return "no module has this header; paths start at the top folder";
  if (!may_include(path, header)) return "the module does not depend on that of";
  if (is_installed(path) && is_internal(header)) return "an installed header shows an internal one";
  return {};
}

std::string library_rule(std::string_view path, std::string_view header) {
  if (header.find_first_of("./") == std::string::npos) return {};  // <vector>
  for (const Library& library : kLibraries) {
    if (!library.headers.empty() &&
        !any_word(library.headers, [&](std::string_view h) { return starts_with(header, h); })) {
      continue;
    }
    const std::string name(library.name);
    if (!any_word(library.allowed_in, [&](std::string_view home) {
          return path == home || fits(path, std::string(home) + "/*");
        })) {
      return name + " belongs to " + std::string(library.allowed_in);
    }
    if (is_header(path) && library.sources_only) return name + " must not show in a header";
    if (is_installed(path)) return name + " must not show in a header that is installed";
    return {};
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

bool may_include(std::string_view path, std::string_view header) {
  const Module *module = module_of(path), *other = module_of(header);
  return module != nullptr && other != nullptr && reaches(*module, *other);
}

std::vector<std::string> include_violations(std::string_view path, std::string_view text) {
  std::vector<std::string> result;
  for (const Include& include : includes_of(text)) {
    const std::string rule =
        include.quoted ? own_rule(path, include.name) : library_rule(path, include.name);
    if (!rule.empty()) result.push_back(at(path, include.line, rule + ": " + include.name));
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

std::vector<std::string> page_violations(std::string_view path, std::string_view text) {
  constexpr int kPage = 60;
  if (!path.ends_with("README.md")) return {};
  int prose = 0;
  bool code = false;
  for_each_line(text, [&](int, std::string_view line) {
    const bool fence = starts_with(line, "```");
    if (fence) code = !code;
    prose += !fence && !code && !line.empty() && line[0] != '|' && !starts_with(line, "    ");
  });
  if (prose <= kPage) return {};
  return {at(path, prose, "a README is a page; move what is longer to a page of its own")};
}

std::vector<std::string> folder_violations(const std::vector<std::string>& paths) {
  std::vector<std::string> result;
  std::set<std::string> seen;
  for (const std::string& path : paths) {
    const bool script = path.ends_with(".js") || path.ends_with(".mjs");
    if ((!is_code(path) && !script) || starts_with(path, "tests/data/")) continue;
    const std::string folder = path.substr(0, path.rfind('/'));
    if (!seen.insert(folder).second) continue;
    if (!script && module_of(path) == nullptr) {
      result.push_back(folder + ": has no row in tests/structure/modules.h");
    }
    if (contains(folder, "/detail/")) continue;  // detail/README.md covers what is inside
    if (std::find(paths.begin(), paths.end(), folder + "/README.md") == paths.end()) {
      result.push_back(folder + ": has no README.md");
    }
  }
  return result;
}

}  // namespace animeme::test
