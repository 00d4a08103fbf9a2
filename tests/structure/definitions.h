// What C++ files define for the whole program. A name that two files define differently makes a
// program whose behaviour nobody knows, and neither compiler nor linker says so.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace animeme::test {

/// Types, functions and inline variables of namespaces that other files can see: with namespaces
/// and the types of parameters, "animeme::fap::info(int)". What is in unnamed namespaces or static
/// belongs to its file and is left out, and so are members: they are as unique as their class.
/// An entry "?" says that the file could not be understood to its end.
std::vector<std::string> definitions_in(std::string_view text);

/// Names that two files of one program define: "name: path, path". `files` are paths and texts.
/// Tests are programs of their own, a folder each (in fuzz and bench a file each); headers and
/// tests/support may be part of any. A file "x_absent.cpp" or "x_late.cpp" is compiled in place of
/// others and left out.
std::vector<std::string> double_definitions(
    const std::vector<std::pair<std::string, std::string>>& files);

}  // namespace animeme::test
