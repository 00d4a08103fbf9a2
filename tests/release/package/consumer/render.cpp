// A PNG of one pixel, by zlib.
#include <animeme/render/png.h>

int main() {
  const auto png = animeme::render::png_of({1, 1, {1, 2, 3, 255}});
  return png && png->size() > 8 ? 0 : 1;
}
