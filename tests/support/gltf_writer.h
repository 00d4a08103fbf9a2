// A writer of glTF files for tests: what it writes is stated number by number.
#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <vector>

namespace animeme::test {

class GltfWriter {
 public:
  nlohmann::json root = {{"asset", {{"version", "2.0"}}}};
  std::vector<std::uint8_t> binary;

  /// Appends an entry to a list of the root and gives its number.
  int add(const char* list, nlohmann::json entry) {
    root[list].push_back(std::move(entry));
    return int(root[list].size()) - 1;
  }

  int view(const void* data, std::size_t size) {
    while (binary.size() % 4 != 0) binary.push_back(0);
    const int number = add("bufferViews", {{"buffer", 0}, {"byteOffset", binary.size()}});
    root["bufferViews"].back()["byteLength"] = size;
    const auto* first = static_cast<const std::uint8_t*>(data);
    binary.insert(binary.end(), first, first + size);
    return number;
  }
  template <class T>
  int view(const std::vector<T>& values) {
    return view(values.data(), values.size() * sizeof(T));
  }

  /// An accessor of all values; `type` is "SCALAR", "VEC2" ...
  template <class T>
  int accessor(const std::vector<T>& values, const char* type, bool normalised = false) {
    nlohmann::json entry = {{"bufferView", view(values)},
                            {"componentType", component<T>()},
                            {"count", values.size() / width(type)},
                            {"type", type}};
    if (normalised) entry["normalized"] = true;
    return add("accessors", std::move(entry));
  }

  /// An accessor that is 0 but at `where`.
  template <class I, class T>
  int sparse(std::size_t count, const std::vector<I>& where, const std::vector<T>& values,
             const char* type) {
    const int indices = view(where), data = view(values);
    return add("accessors",
               {{"componentType", component<T>()},
                {"count", count},
                {"type", type},
                {"sparse",
                 {{"count", where.size()},
                  {"indices", {{"bufferView", indices}, {"componentType", component<I>()}}},
                  {"values", {{"bufferView", data}}}}}});
  }

  std::vector<std::uint8_t> glb() const {
    nlohmann::json all = root;
    std::vector<std::uint8_t> data = binary;
    while (data.size() % 4 != 0) data.push_back(0);
    if (!data.empty()) all["buffers"] = {{{"byteLength", data.size()}}};
    std::string text = all.dump();
    while (text.size() % 4 != 0) text += ' ';
    std::vector<std::uint8_t> file;
    const auto put = [&](std::uint32_t word) {
      for (int i = 0; i < 4; ++i) file.push_back(std::uint8_t(word >> (8 * i)));
    };
    put(0x46546C67);
    put(2);
    put(std::uint32_t(12 + 8 + text.size() + (data.empty() ? 0 : 8 + data.size())));
    put(std::uint32_t(text.size()));
    put(0x4E4F534A);
    file.insert(file.end(), text.begin(), text.end());
    if (data.empty()) return file;
    put(std::uint32_t(data.size()));
    put(0x004E4942);
    file.insert(file.end(), data.begin(), data.end());
    return file;
  }

  /// The text of a .gltf whose buffer has this URI.
  std::string gltf(const std::string& uri) const {
    nlohmann::json all = root;
    all["buffers"] = {{{"byteLength", binary.size()}, {"uri", uri}}};
    return all.dump();
  }

  static std::string data_uri(const std::vector<std::uint8_t>& bytes,
                              const std::string& type = "application/octet-stream") {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text = "data:" + type + ";base64,";
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
      std::uint32_t word = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        word = word << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
      }
      for (std::size_t k = 0; k < 4; ++k) {
        text += i + k > bytes.size() ? '=' : kDigits[word >> (18 - 6 * k) & 63];
      }
    }
    return text;
  }

 private:
  template <class T>
  static int component() {
    if constexpr (std::is_same_v<T, float>) return 5126;
    if constexpr (std::is_same_v<T, std::uint8_t>) return 5121;
    if constexpr (std::is_same_v<T, std::int8_t>) return 5120;
    if constexpr (std::is_same_v<T, std::uint16_t>) return 5123;
    if constexpr (std::is_same_v<T, std::int16_t>) return 5122;
    return 5125;
  }
  static std::size_t width(const std::string& type) {
    return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
  }
};

}  // namespace animeme::test
