// Looking things up in JSON that may be anything. Nothing here throws.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/formats/common/json.h"

namespace animeme::gltf {

using tools::Json;

/// The member of an object; null if there is none.
inline const Json& member(const Json& object, const char* key) { return object[key]; }

/// A member of a member.
template <class... Keys>
const Json& member(const Json& object, const char* key, Keys... keys) {
  return member(member(object, key), keys...);
}

/// The entries of a member that is an array; else none.
inline std::span<const Json> list(const Json& object, const char* key) {
  const Json& found = member(object, key);
  return {found.begin(), found.end()};
}

/// A whole number from 0 on.
inline std::optional<std::size_t> whole(const Json& value) {
  if (value.is_number_unsigned()) return value.get<std::uint64_t>();
  // Some programs write 3.0.
  if (!value.is_number_float()) return std::nullopt;
  const double number = value.get<double>();
  if (!(number >= 0 && number < 4e15) || number != std::floor(number)) return std::nullopt;
  return std::size_t(number);
}

inline std::size_t whole_or(const Json& value, std::size_t otherwise) {
  return whole(value).value_or(otherwise);
}

/// A finite number.
inline double number_or(const Json& value, double otherwise) {
  if (!value.is_number()) return otherwise;
  const double number = value.get<double>();
  return std::isfinite(number) ? number : otherwise;
}

inline std::string text_or(const Json& value, const std::string& otherwise = {}) {
  return value.is_string() ? value.get<std::string>() : otherwise;
}

inline bool is_true(const Json& value) { return value.is_boolean() && value.get<bool>(); }

/// `count` finite numbers; nothing if the array has another length or something else in it.
inline std::optional<std::vector<double>> numbers(const Json& value, std::size_t count) {
  if (!value.is_array() || value.size() != count) return std::nullopt;
  std::vector<double> out;
  for (const Json& entry : value) {
    if (!entry.is_number() || !std::isfinite(entry.get<double>())) return std::nullopt;
    out.push_back(entry.get<double>());
  }
  return out;
}

/// Members in the order of their names: the same value is the same text.
inline std::string sorted_text(Json value) {
  value.sort();
  return value.dump();
}

}  // namespace animeme::gltf
