// Prints how near the raised cosines of write_fdp() come to our own rig, for each group of FAPs:
// the table of fap/xml/README.md. Arguments: names of heads and numbers of regions.
#include <cstdio>
#include <cstdlib>

#include "tests/xml/fdp_measure.h"

namespace {

using namespace animeme;

bool print(const head::Head& head, const head::Rig& rig, int regions) {
  const head::FdpOptions options{.name = head.name, .regions = regions};
  const auto files = head::write_fdp(head, rig, options);
  const auto measure = files ? test::measure_fdp(rig, *files, options.scale) : files.error();
  if (!measure) {
    std::fprintf(stderr, "%s\n", measure.error().describe().c_str());
    return false;
  }
  std::printf(
      "\n%s, at most %d regions a FAP: %zu regions, %zu + %zu bytes, at most %zu influences a "
      "vertex\n\n",
      head.name.c_str(), regions, measure->regions, files->fdp.size(), files->wrl.size(),
      measure->most_influences);
  std::printf("| FAPs | moves, RMS | error, RMS | largest error |\n|---|---|---|---|\n");
  const auto row = [](const char* name, const test::FdpError& e) {
    if (e.vertices > 0) {
      std::printf("| %s | %.3f cm | %.3f cm | %.3f cm |\n", name, e.move, e.rms, e.largest);
    }
  };
  for (std::size_t g = 0; g < measure->groups.size(); ++g) {
    row(std::string(fap::kGroups[g].name).c_str(), measure->groups[g]);
  }
  row("all", measure->all);
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  bool good = true;
  const std::string name = argc > 1 ? argv[1] : "woman";
  const auto parameters = head::head_parameters(name);
  if (!parameters) {
    std::fprintf(stderr, "there is no head %s\n", name.c_str());
    return 2;
  }
  const head::Head head = *head::make_head(*parameters);
  const head::Rig rig = head::make_rig(head);
  for (int i = 2; i < std::max(argc, 3); ++i) {
    good = print(head, rig, i < argc ? std::atoi(argv[i]) : head::FdpOptions().regions) && good;
  }
  return good ? 0 : 1;
}
