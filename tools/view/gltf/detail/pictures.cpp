#include "tools/view/gltf/detail/pictures.h"

#include <algorithm>
#include <set>

#include "tools/view/gltf/detail/budget.h"
#include "tools/view/gltf/detail/picture_decoder.h"

namespace animeme::gltf {
namespace {

constexpr std::int64_t kMostKept = 2048 * 2048;  // texels of one picture
constexpr std::int64_t kMostKeptInAll = 6 * kMostKept;

// Where the bytes of an image are. Those that it brings itself are not compared with others.
std::string source_of(std::size_t number, const Json& image) {
  if (const auto view = whole(member(image, "bufferView"))) return "view " + std::to_string(*view);
  const Json& uri = member(image, "uri");
  const bool elsewhere = uri.is_string() && !is_data_uri(uri.text());
  return elsewhere ? "uri " + text_or(uri) : "image " + std::to_string(number);
}

// How many pictures the materials name.
std::size_t count_pictures(const File& file) {
  std::set<std::size_t> images;
  for (const Json& material : list(file.root, "materials")) {
    for (const Json* info :
         {&base_texture_of(material), &member(material, "normalTexture"),
          &member(material, "occlusionTexture"), &member(material, "emissiveTexture"),
          &member(material, "pbrMetallicRoughness", "metallicRoughnessTexture"),
          &member(material, "extensions", "VRMC_materials_mtoon", "shadeMultiplyTexture")}) {
      const auto texture = whole(member(*info, "index"));
      if (!texture) continue;
      if (const auto image = image_of(file.entry("textures", *texture))) images.insert(*image);
    }
  }
  return images.size();
}

}  // namespace

const Json& base_texture_of(const Json& material) {
  const Json& base = member(material, "pbrMetallicRoughness");
  if (!base.is_null()) return member(base, "baseColorTexture");
  return member(material, "extensions", "KHR_materials_pbrSpecularGlossiness", "diffuseTexture");
}

std::optional<std::size_t> image_of(const Json& texture) {
  const auto webp = whole(member(texture, "extensions", "EXT_texture_webp", "source"));
  return webp ? webp : whole(member(texture, "source"));
}

Pictures::Pictures(const File& file, const LoadFile& load, std::vector<std::string>& notes)
    : file_(file), load_(load), notes_(notes) {
  const auto count = std::int64_t(std::max<std::size_t>(count_pictures(file), 1));
  most_kept_ = std::clamp(kMostKeptInAll / count, std::int64_t(1), kMostKept);
}

std::shared_ptr<const Picture> Pictures::of(std::size_t image, TexelKind kind) {
  const Json& entry = file_.entry("images", image);
  const std::string source = source_of(image, entry) + (kind == TexelKind::value ? " value" : "");
  const auto [place, is_new] = pictures_.try_emplace(source);
  if (!is_new) return place->second;
  auto picture = picture_of(entry, kind);
  if (picture) return place->second = std::move(*picture);
  const std::string name = text_or(member(entry, "name"), text_or(member(entry, "uri")));
  leave_out("texture " + std::to_string(image) + " \"" + name.substr(0, 60) +
            "\" is left out: " + picture.error().message);
  return nullptr;
}

void Pictures::leave_out(std::string note) {
  constexpr std::size_t kMostNotes = 5;
  if (++left_out_ > kMostNotes) {
    note = std::to_string(left_out_ - kMostNotes) + " more textures are left out, too";
    if (left_out_ > kMostNotes + 1) return void(notes_[more_] = std::move(note));
    more_ = notes_.size();
  }
  notes_.push_back(std::move(note));
}

Result<std::shared_ptr<const Picture>> Pictures::picture_of(const Json& image, TexelKind kind) {
  if (const auto view = whole(member(image, "bufferView"))) {
    const auto bytes = view_of(file_, *view);
    if (!bytes) return bytes.error();
    return decode(*bytes, kind);
  }
  const auto bytes = resolve(text_or(member(image, "uri")), load_);
  if (!bytes) return bytes.error();
  return decode(*bytes, kind);
}

Result<std::shared_ptr<const Picture>> Pictures::decode(std::span<const std::uint8_t> bytes,
                                                        TexelKind kind) {
  const auto size = size_of_picture(bytes);
  if (!size) return size.error();
  if (auto fine = file_.budget->take_texels(std::size_t(size->texels())); !fine) {
    return fine.error();
  }
  auto decoded = decode_picture(bytes, most_kept_);
  if (!decoded) return decoded.error();
  return std::make_shared<const Picture>(
      head::Texels{decoded->width, decoded->height, std::move(decoded->rgba)}, kind,
      std::vector<std::uint8_t>(bytes.begin(), bytes.end()), type_of_picture(bytes));
}

}  // namespace animeme::gltf
