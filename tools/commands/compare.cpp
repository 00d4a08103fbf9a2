#include "fap/compare.h"

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "fap/tables.h"
#include "tools/commands/common.h"

namespace animeme::tools {

namespace {

struct Options {
  std::string a;
  std::string b;
  bool json = false;
  double max_rms = -1;
};

nlohmann::ordered_json to_json(const fap::Difference& difference) {
  nlohmann::ordered_json json = {
      {"equal", difference.equal()},
      {"frames_a", difference.frames_a},
      {"frames_b", difference.frames_b},
      {"frames_both", difference.frames_both},
      {"same_rate", difference.same_rate},
      {"mask_differences", difference.mask_differences},
      {"value_differences", difference.value_differences},
      {"first_difference", difference.first_difference},
      {"rms_steps", difference.rms_steps},
      {"max_steps", difference.max_steps},
  };
  nlohmann::ordered_json faps = nlohmann::ordered_json::array();
  for (int number = 1; number <= fap::kFapCount; ++number) {
    const fap::FapDifference& one = difference.fap[std::size_t(number)];
    if (one.frames + one.only_a + one.only_b == 0) continue;
    faps.push_back({{"fap", number},
                    {"name", fap::info(number).name},
                    {"frames", one.frames},
                    {"only_a", one.only_a},
                    {"only_b", one.only_b},
                    {"rms", one.rms},
                    {"max", one.max},
                    {"max_frame", one.max_frame},
                    {"rms_steps", one.rms_steps},
                    {"max_steps", one.max_steps}});
  }
  json["faps"] = std::move(faps);
  return json;
}

void print(const fap::Difference& difference) {
  if (difference.equal()) {
    std::printf("equal: %lld frames\n", (long long)difference.frames_a);
    return;
  }
  std::printf("frames: %lld and %lld, %lld in common; rates %s; first difference in frame %lld\n",
              (long long)difference.frames_a, (long long)difference.frames_b,
              (long long)difference.frames_both, difference.same_rate ? "equal" : "DIFFER",
              (long long)difference.first_difference);
  std::printf("error: %.3f quantiser steps RMS, %.1f at most; masks differ in %lld places\n\n",
              difference.rms_steps, difference.max_steps, (long long)difference.mask_differences);
  std::printf("%4s %-24s %8s %8s %8s %10s %10s\n", "FAP", "name", "rms", "max", "frame", "rms/step",
              "max/step");
  for (int number = 1; number <= fap::kFapCount; ++number) {
    const fap::FapDifference& one = difference.fap[std::size_t(number)];
    if (one.differing + one.only_a + one.only_b == 0) continue;
    std::printf("%4d %-24s %8.2f %8lld %8lld %10.3f %10.2f", number,
                std::string(fap::info(number).name).c_str(), one.rms, (long long)one.max,
                (long long)one.max_frame, one.rms_steps, one.max_steps);
    if (one.only_a + one.only_b > 0) {
      std::printf("  (only in a: %lld, only in b: %lld)", (long long)one.only_a,
                  (long long)one.only_b);
    }
    std::printf("\n");
  }
}

Result<int> run(const Options& options) {
  Result<FaceInput> a = read_face(options.a);
  if (!a) return a.error();
  Result<FaceInput> b = read_face(options.b);
  if (!b) return b.error();
  const fap::Difference difference = fap::compare(a->clip, b->clip);
  if (options.json) {
    std::printf("%s\n", to_json(difference).dump(2).c_str());
  } else {
    print(difference);
  }
  const bool ok = options.max_rms < 0
                      ? difference.equal()
                      : difference.rms_steps <= options.max_rms && difference.mask_differences == 0;
  return ok ? kOk : kCheckFailed;
}

Action add(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("a", options->a, "FAP text, FBA stream or container")->required();
  app.add_option("b", options->b, "The same or another form")->required();
  app.add_option("--max-rms", options->max_rms,
                 "Accept up to this error, in quantiser steps RMS over all FAPs")
      ->check(CLI::NonNegativeNumber);
  app.add_flag("--json", options->json, "Machine-readable result");
  return [options] { return run(*options); };
}

}  // namespace

const Command kCompare{
    "compare", "Differences of two clips in FAP units and quantiser steps; exit code 1 if any",
    "  animeme compare talk.fap talk.fba\n"
    "  animeme compare before.fap after.fap --max-rms 0.5 --json",
    add};

}  // namespace animeme::tools
