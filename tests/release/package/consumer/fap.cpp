// A text file with no frames comes back as it was.
#include <animeme/fap/text.h>

int main() {
  const auto clip = animeme::fap::read_text("2.1 empty 25 0\n");
  return clip && animeme::fap::write_text(*clip) == "2.1 empty 25 0\n" ? 0 : 1;
}
