/// @file
/// JSON as the commands write it: members stay in the order in which they were added.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace animeme::tools {

/// Ordered: a script sees members as they were added.
using Json = nlohmann::ordered_json;

/// What `entry`, a function or a member, gives for each of a list.
template <class List, class Entry>
Json json_list(const List& list, Entry entry) {
  Json json = Json::array();
  for (const auto& one : list) json.push_back(std::invoke(entry, one));
  return json;
}

/// As it is printed: two blanks a level. Bytes that are no UTF-8, as names of files may have,
/// become U+FFFD.
inline std::string pretty(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace animeme::tools
