#include "tools/view/studio/background.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <optional>

#include "fap/detail/text_scanner.h"
#include "tools/formats/files/files.h"
#include "tools/formats/media/picture.h"
#include "tools/view/studio/picture_file.h"

namespace animeme::studio {

namespace {

struct NamedColour {
  std::string_view name;
  std::uint32_t colour;
};

// https://www.w3.org/TR/css-color-4/#named-colors
constexpr NamedColour kNamedColours[] = {
    {"black", 0x000000},   {"silver", 0xC0C0C0}, {"gray", 0x808080}, {"grey", 0x808080},
    {"white", 0xFFFFFF},   {"maroon", 0x800000}, {"red", 0xFF0000},  {"purple", 0x800080},
    {"fuchsia", 0xFF00FF}, {"green", 0x008000},  {"lime", 0x00FF00}, {"olive", 0x808000},
    {"yellow", 0xFFFF00},  {"navy", 0x000080},   {"blue", 0x0000FF}, {"teal", 0x008080},
    {"aqua", 0x00FFFF},    {"orange", 0xFFA500},
};

// "#RGB" or "#RRGGBB".
std::optional<std::uint32_t> hexadecimal(std::string_view text) {
  if (!text.starts_with('#') || (text.size() != 4 && text.size() != 7)) return std::nullopt;
  std::uint32_t colour = 0;
  const char* end = text.data() + text.size();
  const auto [stop, status] = std::from_chars(text.data() + 1, end, colour, 16);
  if (status != std::errc() || stop != end) return std::nullopt;
  if (text.size() == 7) return colour;
  return (colour >> 8 & 15) * 0x110000 | (colour >> 4 & 15) * 0x1100 | (colour & 15) * 0x11;
}

}  // namespace

Result<Background> parse_background(std::string_view text) {
  const std::string plain = fap::detail::lower_case(text);
  if (plain == "none" || plain == "transparent") return Background{Background::Kind::none, 0, {}};
  if (const auto colour = hexadecimal(plain))
    return Background{Background::Kind::colour, *colour, {}};
  const auto* named = std::find_if(std::begin(kNamedColours), std::end(kNamedColours),
                                   [&](const NamedColour& each) { return each.name == plain; });
  if (named != std::end(kNamedColours))
    return Background{Background::Kind::colour, named->colour, {}};
  if (is_picture(tools::extension_of(std::string(text))))
    return Background{Background::Kind::picture, 0, std::string(text)};
  return make_error(Code::invalid_argument,
                    "\"" + std::string(text.substr(0, 60)) +
                        "\" is no background: write none, a colour (#336699, white, lime ...) or a "
                        "picture (.png, .jpg, .webp)");
}

Result<std::shared_ptr<const render::Image>> picture_behind(const Background& background, int width,
                                                            int height) {
  if (background.kind != Background::Kind::picture) return std::shared_ptr<const render::Image>();
  const auto file = tools::read_file(background.path);
  if (!file) return file.error();
  Result<media::Pixels> pixels = media::covering_picture(*file, width, height);
  if (!pixels) return pixels.error().in_file(background.path);
  return std::shared_ptr<const render::Image>(std::make_shared<render::Image>(
      render::Image{pixels->width, pixels->height, std::move(pixels->rgba)}));
}

}  // namespace animeme::studio
