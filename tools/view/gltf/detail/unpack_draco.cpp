#include <draco/compression/decode.h>

#include <new>

#include "tools/view/gltf/detail/unpack.h"

namespace animeme::gltf {
namespace {

constexpr const char* kExtension = "KHR_draco_mesh_compression";

Error draco_error(const std::string& what, Code code = Code::syntax) {
  return make_error(code, "a mesh is compressed by Draco and " + what +
                              ": export the file again, or without compression");
}

// Numbers at the head of the data: what will be made of them is known before memory is asked for.
// Source: Draco's bitstream specification, sections "header", "sequential" and "edgebreaker".
class DracoHead {
 public:
  explicit DracoHead(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  bool read() {
    constexpr std::string_view kDracoMagic = "DRACO";
    for (const char c : kDracoMagic) {
      if (byte() != std::uint8_t(c)) return false;
    }
    const int major = byte(), minor = byte();
    varint_ = major > 2 || (major == 2 && minor >= 2);
    byte();  // a mesh or a cloud of points: the library looks
    const bool edgebreaker = byte() == 1;
    byte();
    if ((byte() & 0x80) != 0) return false;  // metadata in front: no exporter of glTF writes it
    if (edgebreaker) {
      byte();                 // kind of traversal
      if (!varint_) fixed();  // new vertices
      points = number();
      faces = number();
    } else {
      faces = number();
      points = number();
    }
    return good_;
  }

  std::uint64_t points = 0, faces = 0;

 private:
  std::uint8_t byte() {
    if (rest_.empty()) {
      good_ = false;
      return 0;
    }
    const std::uint8_t first = rest_.front();
    rest_ = rest_.subspan(1);
    return first;
  }
  std::uint64_t fixed() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 32; shift += 8) value |= std::uint64_t(byte()) << shift;
    return value;
  }
  std::uint64_t number() {
    if (!varint_) return fixed();
    std::uint64_t value = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      const std::uint8_t part = byte();
      value |= std::uint64_t(part & 0x7F) << shift;
      if ((part & 0x80) == 0) return value;
    }
    good_ = false;
    return value;
  }

  std::span<const std::uint8_t> rest_;
  bool varint_ = true;
  bool good_ = true;
};

std::size_t components_of(const Json& accessor) {
  const std::string type = text_or(member(accessor, "type"));
  if (type == "SCALAR") return 1;
  return type.starts_with("VEC") && type.size() == 4 ? std::size_t(type[3] - '0') : 0;
}

// Values of all points in the type of the accessor.
template <class T>
bool values_of(const draco::PointAttribute& attribute, std::size_t points, std::size_t components,
               Bytes& out) {
  out.resize(points * components * sizeof(T));
  std::vector<T> value(components);
  for (std::size_t i = 0; i < points; ++i) {
    const auto index = attribute.mapped_index(draco::PointIndex(std::uint32_t(i)));
    if (!attribute.ConvertValue<T>(index, std::int8_t(components), value.data())) return false;
    std::memcpy(out.data() + i * components * sizeof(T), value.data(), components * sizeof(T));
  }
  return true;
}

bool values_of(const draco::PointAttribute& attribute, std::size_t points, std::size_t type,
               std::size_t components, Bytes& out) {
  switch (type) {
    case 5120:
      return values_of<std::int8_t>(attribute, points, components, out);
    case 5121:
      return values_of<std::uint8_t>(attribute, points, components, out);
    case 5122:
      return values_of<std::int16_t>(attribute, points, components, out);
    case 5123:
      return values_of<std::uint16_t>(attribute, points, components, out);
    case 5125:
      return values_of<std::uint32_t>(attribute, points, components, out);
    case 5126:
      return values_of<float>(attribute, points, components, out);
    default:
      return false;
  }
}

// One primitive.
class Unpacking {
 public:
  explicit Unpacking(File& file) : file_(file) {}

  Result<void> run(Json& primitive) {
    const Json extension = member(primitive, "extensions", kExtension);
    const auto view = whole(member(extension, "bufferView"));
    if (!view) return draco_error("lacks its bufferView");
    const auto bytes = view_of(file_, *view);
    if (!bytes) return bytes.error();
    const auto indices = whole(member(primitive, "indices"));
    const auto positions = whole(member(primitive, "attributes", "POSITION"));
    if (!indices || !positions) return draco_error("lacks indices or POSITION");
    const std::size_t most_indices = count_of(*indices), most_points = count_of(*positions);
    DracoHead head(*bytes);
    if (!head.read()) return draco_error("cannot be read");
    if (head.faces > most_indices / 3 || head.points > most_points) {
      return draco_error("has more vertices or triangles than its accessors say");
    }
    if (auto fine = file_.budget->take_bytes(4 * most_indices + 16 * most_points); !fine) {
      return fine;
    }
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) return draco_error("cannot be read");
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
    const std::size_t points = mesh->num_points();
    if (std::size_t(mesh->num_faces()) * 3 != most_indices || points != most_points) {
      return draco_error("has other counts than its accessors say");
    }
    const Json& wanted = member(extension, "attributes");
    if (!wanted.is_object()) return draco_error("lacks its attributes");
    for (const auto& [name, id] : wanted.items()) {
      const auto accessor = whole(member(primitive, "attributes", name.c_str()));
      const auto number = whole(id);
      const draco::PointAttribute* attribute =
          number ? mesh->GetAttributeByUniqueId(std::uint32_t(*number)) : nullptr;
      if (!accessor || attribute == nullptr)
        return draco_error("lacks \"" + name.substr(0, 30) + "\"");
      const Json& entry = file_.entry("accessors", *accessor);
      const std::size_t components = components_of(entry);
      Bytes out;
      if (components == 0 || count_of(*accessor) != points ||
          !values_of(*attribute, points, whole_or(member(entry, "componentType"), 0), components,
                     out)) {
        return draco_error("its \"" + name.substr(0, 30) + "\" cannot be read");
      }
      put(*accessor, std::move(out));
    }
    return put_indices(*mesh, *indices);
  }

 private:
  std::size_t count_of(std::size_t accessor) const {
    return whole_or(member(file_.entry("accessors", accessor), "count"), 0);
  }

  Result<void> put_indices(const draco::Mesh& mesh, std::size_t accessor) {
    Json& entry = file_.root["accessors"][accessor];
    Bytes out;
    for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f) {
      for (const draco::PointIndex& corner : mesh.face(f)) {
        const std::uint32_t index = corner.value();
        for (int shift = 0; shift < 32; shift += 8) out.push_back(std::uint8_t(index >> shift));
      }
    }
    entry["componentType"] = 5125U;
    put(accessor, std::move(out));
    return {};
  }

  // An accessor of plain values of its own.
  void put(std::size_t accessor, Bytes values) {
    Json& entry = file_.root["accessors"][accessor];
    const std::size_t size = values.size();
    file_.owned.push_back(std::move(values));
    Json view = {{"buffer", file_.buffers.size()}, {"byteOffset", 0U}, {"byteLength", size}};
    file_.buffers.emplace_back(file_.owned.back());
    entry["bufferView"] = list(file_.root, "bufferViews").size();
    entry["byteOffset"] = 0U;
    file_.root["bufferViews"].push_back(std::move(view));
  }

  File& file_;
};

}  // namespace

bool can_unpack_draco() { return true; }

Result<void> unpack_draco(File& file) {
  const std::size_t meshes = list(file.root, "meshes").size();
  for (std::size_t m = 0; m < meshes; ++m) {
    const std::size_t primitives = list(file.root["meshes"][m], "primitives").size();
    for (std::size_t p = 0; p < primitives; ++p) {
      Json& primitive = file.root["meshes"][m]["primitives"][p];
      if (!member(primitive, "extensions", kExtension).is_object()) continue;
      try {
        if (auto done = Unpacking(file).run(primitive); !done) return done;
      } catch (const std::bad_alloc&) {
        return draco_error("needs more memory than available", Code::out_of_range);
      }
      primitive["extensions"].erase(kExtension);
    }
  }
  return {};
}

}  // namespace animeme::gltf
