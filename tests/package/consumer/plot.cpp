// An empty drawing is a drawing.
#include <animeme/plot/curves.h>

int main() {
  const bool svg = animeme::plot::is_drawing("a.svg");
  return svg && !animeme::plot::curves_svg({}, {}).empty() ? 0 : 1;
}
