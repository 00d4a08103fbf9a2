// Compiles against the headers of dam and links its library, both without Eigen.
#include <animeme/dam/script.h>
#include <animeme/dam/signal.h>
#include <animeme/fap/text.h>

int main() {
  const animeme::dam::Script script{{{0, 1, "AA", "a"}}};
  const auto clip = animeme::fap::read_text("2.1 empty 25 0\n");
  return clip && !animeme::dam::write_textgrid(script).empty() ? 0 : 1;
}
