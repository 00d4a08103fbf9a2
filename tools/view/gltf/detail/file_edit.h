// A glTF file that is written back with something added: its text and its buffers stay byte by
// byte, what is new stands behind them.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "tools/view/gltf/detail/file.h"
#include "tools/view/gltf/detail/json_text.h"

namespace animeme::gltf {

/// A file in three parts, to be written one after the other; the middle one is borrowed.
struct EditedFile {
  Bytes front;
  std::span<const std::uint8_t> middle;
  Bytes back;
};

/// Buffers are not opened, so those that are compressed or lie elsewhere will do.
class FileEdit {
 public:
  /// `bytes` have to outlive the result. Errors: those of chunks_of() and open_json().
  static Result<FileEdit> open(std::span<const std::uint8_t> bytes, const ReadLimits& limits);

  /// The original JSON.
  const File& file() const { return file_; }
  /// True for .glb and .vrm.
  bool is_binary() const { return binary_; }

  /// A new view of these bytes; its number.
  std::size_t view(std::span<const std::uint8_t> bytes);
  /// A new accessor of floats; its number. `type`: "SCALAR", "VEC3" ... `bounds`: with min and max.
  std::size_t floats(std::span<const float> values, const char* type, bool bounds = false);
  /// One more entry of a list of the root ("animations"); its number.
  std::size_t add(const char* list, const Json& entry);
  /// Names an extension in extensionsUsed, unless it is there.
  void use(const std::string& extension);
  /// One more entry of a list in an extension of the root, or of a scene; its number.
  std::size_t add_to_extension(const std::string& extension, const char* list, const Json& entry);
  std::size_t add_to_scene(std::size_t scene, const std::string& extension, const char* list,
                           const Json& entry);
  /// Other members ("translation":[0,0,0]) in the place of `matrix` of a node.
  void replace_matrix(std::size_t node, const std::string& members);

  /// The file. Errors: out_of_range (larger than 4 GB), syntax (what should grow is no list).
  Result<EditedFile> finish();

 private:
  bool extends_binary() const;
  std::size_t chunk_size() const;  // with its padding
  void add_buffer();
  bool merge(JsonText::Span into, const Json& more);

  FileEdit(File file, std::string_view text) : file_(std::move(file)), text_(text) {}

  File file_;
  JsonText text_;
  bool binary_ = false;
  std::optional<std::span<const std::uint8_t>> chunk_;
  std::span<const std::uint8_t> others_;
  Bytes data_;                  // all that is new
  Json more_ = Json::object();  // members and entries that the root gets
  std::map<std::size_t, Json> more_of_scenes_;
};

}  // namespace animeme::gltf
