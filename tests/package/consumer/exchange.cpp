// A script becomes visemes.
#include <animeme/exchange/visemes.h>

int main() {
  const animeme::dam::Script script{{{0, 1, "AA", "a"}}};
  return animeme::exchange::script_events(script).empty() ? 1 : 0;
}
