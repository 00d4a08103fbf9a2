// Component engines: nothing is sent.
#include <animeme/engines/engines.h>

int main() {
  const auto sink = animeme::engines::make_engine_sink("livelink://127.0.0.1:11111?rate=60");
  return sink && !animeme::engines::make_engine_sink("livelink://127.0.0.1?rat=60") ? 0 : 1;
}
