// Pictures of every kind that is decoded.
#include "tests/fuzz/seeds.h"
#include "tests/support/picture_writer.h"

namespace animeme::fuzz {

void make_pictures(Folder folder) {
  for (const bool interlaced : {false, true}) {
    const std::string kind = interlaced ? "interlaced_" : "";
    for (const int depth : {1, 2, 4, 8, 16}) {
      const auto rows = [&](int channels) { return texels((9 * depth * channels + 7) / 8, 7, 1); };
      const auto add = [&](const std::string& name, int colour, int channels, bool clear = false) {
        folder.add(kind + name + std::to_string(depth) + ".png",
                   test::png_as(rows(channels), 9, 7,
                                {.colour = colour,
                                 .depth = depth,
                                 .interlaced = interlaced,
                                 .transparent = clear}));
      };
      add("grey_", PNG_COLOR_TYPE_GRAY, 1);
      if (depth <= 8) add("palette_", PNG_COLOR_TYPE_PALETTE, 1, depth % 4 == 0);
      if (depth < 8) continue;
      add("rgb_", PNG_COLOR_TYPE_RGB, 3);
      add("rgba_", PNG_COLOR_TYPE_RGBA, 4);
      add("grey_alpha_", PNG_COLOR_TYPE_GRAY_ALPHA, 2);
    }
  }
  for (const int components : {1, 3, 4}) {
    for (const bool progressive : {false, true}) {
      for (const bool full : {false, true}) {
        for (const int side : {7, 20}) {
          folder.add("c" + std::to_string(components) + (progressive ? "_progressive" : "") +
                         (full ? "_full_" : "_") + std::to_string(side) + ".jpg",
                     test::jpeg_as(texels(side, side, components), side, side,
                                   {.components = components,
                                    .quality = 30,
                                    .progressive = progressive,
                                    .full_colour = full}));
        }
      }
    }
  }
  folder.add("separate.jpg",
             test::jpeg_as(texels(9, 7, 3), 9, 7, {.quality = 30, .separate = true}));
  folder.add("symbols.jpg", test::jpeg_with_too_many_symbols());
  folder.add("no_tables.jpg", test::jpeg_without_tables());
  for (const float quality : {-1.0f, 0.0f, 50.0f, 100.0f}) {
    for (const int side : {1, 9, 20}) {
      Bytes rgba = texels(side, side, 4);
      const std::string name = std::to_string(int(quality)) + "_" + std::to_string(side) + ".webp";
      folder.add("alpha_" + name, test::webp_as(rgba, side, side, quality));
      for (std::size_t i = 3; i < rgba.size(); i += 4) rgba[i] = 255;
      folder.add("plain_" + name, test::webp_as(rgba, side, side, quality));
    }
  }
}

}  // namespace animeme::fuzz
