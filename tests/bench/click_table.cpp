// Prints how far sound and face are moved, and how far apart they end up, in every container and
// codec that is offered: the table of tools/formats/media/README.md.
#include <cstdio>

#include "tests/formats/media/click_measure.h"

int main() {
  using namespace animeme;
  const test::TempDir dir;
  std::printf(
      "| written | sound | rate | sound at | face at | error |\n|---|---|---|---|---|---|\n");
  bool good = true;
  for (const test::ClickPath& way : test::kClickPaths) {
    for (const int rate : {48000, 16000}) {
      const auto offsets =
          test::measure_clicks(dir.file(std::string("talk") + way.extension), way, rate);
      if (!offsets) {
        std::fprintf(stderr, "%s: %s\n", way.name, offsets.error().describe().c_str());
        good = false;
        continue;
      }
      std::printf("| %s | %s | %d | %.3f ms | %.3f ms | %.3f ms |\n", way.name,
                  media::name_of(way.codec), rate, offsets->sound * 1000, offsets->face * 1000,
                  offsets->error * 1000);
    }
  }
  return good ? 0 : 1;
}
