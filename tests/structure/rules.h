// The rules of the source tree that a program can check: who may include whom, what every header
// has, which paths no file may name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace animeme::test {

/// The header named in an include line: `fap/text.h` of `#include "fap/text.h"`.
struct Include {
  int line = 0;
  bool quoted = false;
  std::string name;
};

std::vector<Include> includes_of(std::string_view text);

/// True if a file of one folder may include one of another, by modules.h. Paths of files of the
/// tree.
bool may_include(std::string_view path, std::string_view header);

/// What breaks the rules in a file. `path` is relative to the root of the tree, with '/'. Each
/// entry is "path:line: sentence".
std::vector<std::string> include_violations(std::string_view path, std::string_view text);
std::vector<std::string> header_violations(std::string_view path, std::string_view text);
std::vector<std::string> path_violations(std::string_view path, std::string_view text);

/// A README of more than a page: 60 lines, where empty lines, tables and code do not count.
std::vector<std::string> page_violations(std::string_view path, std::string_view text);

/// Folders of sources that have no README.md or, for C++, no row in modules.h. `paths`: all files.
std::vector<std::string> folder_violations(const std::vector<std::string>& paths);

}  // namespace animeme::test
