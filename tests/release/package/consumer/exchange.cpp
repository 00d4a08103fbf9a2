// A table of ARKit's curves comes back from what is written for Live Link Face.
#include <animeme/exchange/arkit.h>

int main() {
  using namespace animeme::exchange;
  const auto take = read_arkit_table("time_s,jawOpen,jawLeft\n0,0,0\n0.04,1,0\n");
  if (!take) return 1;
  return read_arkit_table(write_live_link(fit_arkit(take->clip)), {take->clip.rate, false}) ? 0 : 1;
}
