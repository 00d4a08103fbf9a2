#include "tools/view/studio/background.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <optional>

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

std::optional<int> digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return std::nullopt;
}

// "#RGB" or "#RRGGBB".
std::optional<std::uint32_t> hexadecimal(std::string_view text) {
  if (!text.starts_with('#') || (text.size() != 4 && text.size() != 7)) return std::nullopt;
  std::uint32_t colour = 0;
  for (const char c : text.substr(1)) {
    const auto value = digit(c);
    if (!value) return std::nullopt;
    colour = colour << 4 | std::uint32_t(*value);
    if (text.size() == 4) colour = colour << 4 | std::uint32_t(*value);
  }
  return colour;
}

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](char c) { return char(std::tolower(static_cast<unsigned char>(c))); });
  return out;
}

}  // namespace

Result<Background> parse_background(std::string_view text) {
  const std::string plain = lower(text);
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
