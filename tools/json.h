/// @file
/// JSON as the commands write it: members stay in the order in which they were added.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>

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

}  // namespace animeme::tools
