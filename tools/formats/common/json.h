/// @file
/// JSON for output, with members in the order of insertion.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace animeme::tools {

/// A JSON value that keeps the order of members.
using Json = nlohmann::ordered_json;

/// An array with the result of `entry`, a function or a member, for each element of a list.
template <class List, class Entry>
Json json_list(const List& list, Entry entry) {
  Json json = Json::array();
  for (const auto& one : list) json.push_back(std::invoke(entry, one));
  return json;
}

/// Formats JSON with an indentation of two. Invalid UTF-8, which file names may contain, becomes
/// U+FFFD.
inline std::string pretty(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace animeme::tools
