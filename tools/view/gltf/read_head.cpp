#include "tools/view/gltf/read_head.h"

#include <filesystem>
#include <new>

#include "tools/view/gltf/detail/head_reader.h"

namespace animeme::gltf {
namespace {

Error no_memory_for_head() {
  return make_error(Code::out_of_range,
                    "there is not enough memory for this head: reduce its meshes and pictures");
}

}  // namespace

Result<HeadFile> read_head_and_vertices(std::span<const std::uint8_t> bytes,
                                        const ReadOptions& options) {
  try {
    Result<MovedHead> moved = read_moved_head(bytes, options);
    if (!moved) return moved.error();
    return std::move(moved->file);
  } catch (const std::bad_alloc&) {
    return no_memory_for_head();
  }
}

Result<HeadFile> read_head_and_vertices(const std::string& path, ReadOptions options) {
  Result<Bytes> bytes = no_memory_for_head();
  try {
    bytes = bytes_of(path, options.limits.bytes);
  } catch (const std::bad_alloc&) {
  }
  if (!bytes) return std::move(bytes.error()).in_file(path);
  if (!options.load) {
    options.load =
        files_of(std::filesystem::path(path).parent_path().string(), options.limits.bytes);
  }
  Result<HeadFile> file = read_head_and_vertices(*bytes, options);
  if (!file) return std::move(file.error()).in_file(path);
  file->source.name = std::filesystem::path(path).stem().string();
  return file;
}

Result<head::Source> read_head(std::span<const std::uint8_t> bytes, const ReadOptions& options) {
  Result<HeadFile> file = read_head_and_vertices(bytes, options);
  if (!file) return file.error();
  return std::move(file->source);
}

Result<head::Source> read_head_file(const std::string& path, ReadOptions options) {
  Result<HeadFile> file = read_head_and_vertices(path, std::move(options));
  if (!file) return file.error();
  return std::move(file->source);
}

}  // namespace animeme::gltf
