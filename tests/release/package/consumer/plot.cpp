// Curves as SVG.
#include <animeme/plot/curves.h>

int main() {
  animeme::plot::Panel panel;
  panel.seconds = 1;
  panel.rows.push_back({"jaw", "", "", {{{0, 1}, {1, 2}}}});
  const auto svg = animeme::plot::curves_svg({panel}, {});
  return svg.find("<polyline") != std::string::npos ? 0 : 1;
}
