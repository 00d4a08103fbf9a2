#include "tools/gltf/detail/glb_file.h"

#include <string>

namespace animeme::gltf {

Result<std::vector<std::uint8_t>> glb_file(nlohmann::json root, std::vector<std::uint8_t> binary) {
  while (binary.size() % 4 != 0) binary.push_back(0);
  root["buffers"] = {{{"byteLength", binary.size()}}};
  std::string text = root.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  while (text.size() % 4 != 0) text += ' ';
  const std::uint64_t total = 12 + 8 + text.size() + 8 + binary.size();
  if (total > UINT32_MAX) {
    return make_error(Code::out_of_range, "the file would be larger than 4 GB");
  }
  std::vector<std::uint8_t> file;
  file.reserve(total);
  const auto put = [&](std::uint32_t value) {
    for (int byte = 0; byte < 4; ++byte) file.push_back(std::uint8_t(value >> (8 * byte)));
  };
  put(0x46546C67);  // "glTF"
  put(2);
  put(std::uint32_t(total));
  put(std::uint32_t(text.size()));
  put(0x4E4F534A);  // "JSON"
  file.insert(file.end(), text.begin(), text.end());
  put(std::uint32_t(binary.size()));
  put(0x004E4942);  // "BIN"
  file.insert(file.end(), binary.begin(), binary.end());
  return file;
}

}  // namespace animeme::gltf
