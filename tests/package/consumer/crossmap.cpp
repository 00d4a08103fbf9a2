// A table of controls, as the artist edits it.
#include <animeme/crossmap/keys.h>

int main() {
  const auto table = animeme::crossmap::read_control_table("key,jawOpen\nrest,0\nAA,0.7\n");
  return table && !animeme::crossmap::write_control_table(*table).empty() ? 0 : 1;
}
