#include <meshoptimizer.h>

#include "tools/view/gltf/detail/extensions.h"
#include "tools/view/gltf/detail/unpack.h"

namespace animeme::gltf {
namespace {

// Bytes of an element that come out of one that goes in, at most: a block of vertices has two bits
// for every 16 bytes.
constexpr std::size_t kMostShrunk = 64;
constexpr std::size_t kMostStride = 256;

struct Packed {
  std::span<const std::uint8_t> bytes;
  std::size_t count = 0;   // elements
  std::size_t stride = 0;  // bytes of one
  std::string mode, filter;
};

Error meshopt_error(std::size_t view, const std::string& what, Code code = Code::syntax) {
  return make_error(code, "buffer view " + std::to_string(view) + " is compressed by meshopt and " +
                              what + ": export the file again, or without compression");
}

Result<Packed> packed_of(const File& file, const Json& extension, std::size_t view) {
  Packed packed;
  const std::size_t buffer = whole_or(member(extension, "buffer"), file.buffers.size());
  const std::size_t offset = whole_or(member(extension, "byteOffset"), 0);
  const auto length = whole(member(extension, "byteLength"));
  const auto count = whole(member(extension, "count"));
  const auto stride = whole(member(extension, "byteStride"));
  if (!length || !count || !stride)
    return meshopt_error(view, "lacks byteLength, count or byteStride");
  if (buffer >= file.buffers.size() || offset > file.buffers[buffer].size() ||
      *length > file.buffers[buffer].size() - offset) {
    return meshopt_error(view, "is outside its buffer", Code::truncated);
  }
  packed.bytes = file.buffers[buffer].subspan(offset, *length);
  packed.count = *count;
  packed.stride = *stride;
  packed.mode = text_or(member(extension, "mode"));
  packed.filter = text_or(member(extension, "filter"), "NONE");
  return packed;
}

// What cannot be is found before memory is asked for.
Result<void> check_packed(const Packed& packed, std::size_t view) {
  const bool vertices = packed.mode == "ATTRIBUTES";
  const bool triangles = packed.mode == "TRIANGLES";
  if (!vertices && !triangles && packed.mode != "INDICES") {
    return meshopt_error(view,
                         "has the mode \"" + packed.mode.substr(0, 30) + "\", which is not known",
                         Code::unsupported);
  }
  if (packed.count == 0) return meshopt_error(view, "is empty");
  if (vertices) {
    if (packed.stride == 0 || packed.stride % 4 != 0 || packed.stride > kMostStride) {
      return meshopt_error(view, "has elements of " + std::to_string(packed.stride) + " bytes");
    }
    if (packed.count / kMostShrunk > packed.bytes.size())
      return meshopt_error(view, "is too short");
  } else {
    if (packed.stride != 2 && packed.stride != 4) {
      return meshopt_error(view, "has indices of " + std::to_string(packed.stride) + " bytes");
    }
    if (triangles && packed.count % 3 != 0) return meshopt_error(view, "ends within a triangle");
    if (packed.count / (triangles ? 3 : 1) > packed.bytes.size())
      return meshopt_error(view, "is too short");
  }
  const std::string& filter = packed.filter;
  const bool fits =
      filter == "NONE" ||
      (vertices && ((filter == "OCTAHEDRAL" && (packed.stride == 4 || packed.stride == 8)) ||
                    (filter == "QUATERNION" && packed.stride == 8) || filter == "EXPONENTIAL"));
  if (!fits) {
    return meshopt_error(view,
                         "has the filter \"" + filter.substr(0, 30) + "\", which does not fit",
                         Code::unsupported);
  }
  return {};
}

bool decode_packed(const Packed& packed, Bytes& out) {
  const std::uint8_t* in = packed.bytes.data();
  const std::size_t size = packed.bytes.size(), count = packed.count, stride = packed.stride;
  if (packed.mode == "TRIANGLES") {
    return meshopt_decodeIndexBuffer(out.data(), count, stride, in, size) == 0;
  }
  if (packed.mode == "INDICES") {
    return meshopt_decodeIndexSequence(out.data(), count, stride, in, size) == 0;
  }
  if (meshopt_decodeVertexBuffer(out.data(), count, stride, in, size) != 0) return false;
  if (packed.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), count, stride);
  if (packed.filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), count, stride);
  if (packed.filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), count, stride);
  return true;
}

}  // namespace

bool can_unpack_meshopt() { return true; }

Result<void> unpack_meshopt(File& file) {
  const std::size_t views = list(file.root, "bufferViews").size();
  for (std::size_t i = 0; i < views; ++i) {
    Json& entry = file.root["bufferViews"][i];
    const Json& extension = meshopt_of(entry);
    if (extension.is_null()) continue;
    const auto packed = packed_of(file, extension, i);
    if (!packed) return packed.error();
    if (auto fine = check_packed(*packed, i); !fine) return fine;
    const std::size_t bytes = packed->count * packed->stride;
    if (auto fine = file.budget->take_bytes(bytes); !fine) return fine;
    // The filters work on whole blocks.
    Bytes out(bytes);
    if (!decode_packed(*packed, out)) return meshopt_error(i, "cannot be read");
    file.owned.push_back(std::move(out));
    entry.erase("extensions");
    entry["buffer"] = file.buffers.size();
    entry["byteOffset"] = 0U;
    entry["byteLength"] = bytes;
    file.buffers.emplace_back(file.owned.back());
  }
  return {};
}

}  // namespace animeme::gltf
