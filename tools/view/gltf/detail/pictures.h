// The pictures of a file, each decoded once and only if something shows it.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fap/head/picture.h"
#include "tools/view/gltf/detail/file.h"

namespace animeme::gltf {

using head::Colour;
using head::Picture;
using head::TexelKind;
using head::Uv;

/// The base colour texture of a material: of it, or of the specular extension that came before.
const Json& base_texture_of(const Json& material);

/// The image of a texture: that of EXT_texture_webp before its own. Nothing: of another format.
std::optional<std::size_t> image_of(const Json& texture);

/// Gives pictures. What they have in all is bounded by ReadLimits::texels as they are in the file,
/// and by 24 pictures of 1024 x 1024 as they are kept, none larger than 2048 x 2048: films show no
/// more of a head. Those that are left out are noted once.
class Pictures {
 public:
  Pictures(const File& file, const LoadFile& load, std::vector<std::string>& notes);

  /// Null if it is left out.
  std::shared_ptr<const Picture> of(std::size_t image, TexelKind kind);

 private:
  Result<std::shared_ptr<const Picture>> picture_of(const Json& image, TexelKind kind);
  Result<std::shared_ptr<const Picture>> decode(std::span<const std::uint8_t> bytes,
                                                TexelKind kind);

  void leave_out(std::string note);

  const File& file_;
  const LoadFile& load_;
  std::vector<std::string>& notes_;
  std::int64_t most_kept_ = 0;  ///< texels of one picture
  std::size_t left_out_ = 0;
  std::size_t more_ = 0;  ///< the note that counts the others
  /// By where they are: several images may name the same bytes.
  std::map<std::string, std::shared_ptr<const Picture>> pictures_;
};

}  // namespace animeme::gltf
