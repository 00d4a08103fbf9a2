#include "fap/compare.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "fap/tables.h"
#include "tools/commands/common.h"
#include "tools/inspect/body_difference.h"

namespace animeme::tools {

namespace {

struct Options {
  std::string a;
  std::string b;
  bool json = false;
  double max_rms = -1;
};

// What faces and bodies have in common.
template <class Difference>
nlohmann::ordered_json summary_json(const Difference& difference) {
  return {{"equal", difference.equal()},
          {"frames_a", difference.frames_a},
          {"frames_b", difference.frames_b},
          {"frames_both", difference.frames_both},
          {"same_rate", difference.same_rate},
          {"mask_differences", difference.mask_differences},
          {"value_differences", difference.value_differences},
          {"first_difference", difference.first_difference},
          {"rms_steps", difference.rms_steps},
          {"max_steps", difference.max_steps}};
}

nlohmann::ordered_json to_json(const fap::Difference& difference) {
  nlohmann::ordered_json json = summary_json(difference);
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

template <class One>
void print_only(const One& one) {
  if (one.only_a + one.only_b > 0) {
    std::printf("  (only in a: %lld, only in b: %lld)", (long long)one.only_a,
                (long long)one.only_b);
  }
  std::printf("\n");
}

void print_rows(const fap::Difference& difference) {
  std::printf("%4s %-24s %8s %8s %8s %10s %10s\n", "FAP", "name", "rms", "max", "frame", "rms/step",
              "max/step");
  for (int number = 1; number <= fap::kFapCount; ++number) {
    const fap::FapDifference& one = difference.fap[std::size_t(number)];
    if (one.differing + one.only_a + one.only_b == 0) continue;
    std::printf("%4d %-24s %8.2f %8lld %8lld %10.3f %10.2f", number,
                std::string(fap::info(number).name).c_str(), one.rms, (long long)one.max,
                (long long)one.max_frame, one.rms_steps, one.max_steps);
    print_only(one);
  }
}

nlohmann::ordered_json to_json(const inspect::BodyDifference& difference) {
  nlohmann::ordered_json json = summary_json(difference);
  nlohmann::ordered_json baps = nlohmann::ordered_json::array();
  for (int number = 1; number <= fba::kBapCount; ++number) {
    const inspect::BapDifference& one = difference.bap[std::size_t(number)];
    if (one.frames + one.only_a + one.only_b == 0) continue;
    const double step = inspect::bap_step(number);
    baps.push_back({{"bap", number},
                    {"frames", one.frames},
                    {"only_a", one.only_a},
                    {"only_b", one.only_b},
                    {"rms", one.rms()},
                    {"max", one.max},
                    {"max_frame", one.max_frame},
                    {"rms_steps", one.rms() / step},
                    {"max_steps", double(one.max) / step}});
  }
  json["baps"] = std::move(baps);
  return json;
}

void print_rows(const inspect::BodyDifference& difference) {
  std::printf("%4s %8s %8s %8s %10s %10s\n", "BAP", "rms", "max", "frame", "rms/step", "max/step");
  for (int number = 1; number <= fba::kBapCount; ++number) {
    const inspect::BapDifference& one = difference.bap[std::size_t(number)];
    if (one.differing + one.only_a + one.only_b == 0) continue;
    const double step = inspect::bap_step(number);
    std::printf("%4d %8.2f %8lld %8lld %10.3f %10.2f", number, one.rms(), (long long)one.max,
                (long long)one.max_frame, one.rms() / step, double(one.max) / step);
    print_only(one);
  }
}

template <class Difference>
void print(const Difference& difference, const char* what) {
  if (difference.equal()) {
    std::printf("equal: %lld %sframes\n", (long long)difference.frames_a, what);
    return;
  }
  std::printf("%sframes: %lld and %lld, %lld in common; rates %s; first difference in frame %lld\n",
              what, (long long)difference.frames_a, (long long)difference.frames_b,
              (long long)difference.frames_both, difference.same_rate ? "equal" : "DIFFER",
              (long long)difference.first_difference);
  std::printf("error: %.3f quantiser steps RMS, %.1f at most; masks differ in %lld places\n\n",
              difference.rms_steps, difference.max_steps, (long long)difference.mask_differences);
  print_rows(difference);
}

// What two inputs can be compared in. Text holds one half only, which says nothing about the
// other half.
struct Common {
  bool face = false;
  bool body = false;
};
Common in_common(const MotionInput& a, const MotionInput& b) {
  const auto can_hold_face = [](const MotionInput& m) { return m.kind != FileKind::bap_text; };
  const auto can_hold_body = [](const MotionInput& m) {
    return m.kind == FileKind::bap_text || !m.stream.empty();
  };
  const bool bodies = !a.body.frames.empty() || !b.body.frames.empty();
  const bool only_bodies = a.face.frames.empty() && b.face.frames.empty() && bodies;
  return {can_hold_face(a) && can_hold_face(b) && !only_bodies,
          can_hold_body(a) && can_hold_body(b) && bodies};
}

// A text against a stream that codes nothing of its kind.
Result<void> check_half(const MotionInput& text, const MotionInput& other,
                        const std::string& other_path) {
  if (!text.stream.empty()) return {};
  if (text.kind != FileKind::bap_text) return require_face(other, other_path);
  if (!other.body.frames.empty() || other.kind == FileKind::bap_text) return {};
  return make_error(Code::not_found, "this has no body to compare with BAP text")
      .in_file(other_path);
}

Result<int> run(const Options& options) {
  Result<MotionInput> a = read_motion(options.a);
  if (!a) return a.error();
  Result<MotionInput> b = read_motion(options.b);
  if (!b) return b.error();
  if (auto ok = check_half(*a, *b, options.b); !ok) return ok.error();
  if (auto ok = check_half(*b, *a, options.a); !ok) return ok.error();
  const Common common = in_common(*a, *b);
  fap::Difference face;
  std::optional<inspect::BodyDifference> body;
  if (common.face) face = fap::compare(a->face, b->face);
  if (common.body) body = inspect::compare_bodies(a->body, b->body);
  const bool equal = face.equal() && (!body || body->equal());
  if (options.json) {
    nlohmann::ordered_json json = to_json(face);
    json["equal"] = equal;
    json["face_compared"] = common.face;
    if (body) json["body"] = to_json(*body);
    std::printf("%s\n", json.dump(2).c_str());
  } else {
    if (common.face) print(face, "");
    if (common.face && body) std::printf("\n");
    if (body) print(*body, "body ");
  }
  const auto accepted = [&](const auto& difference) {
    if (options.max_rms < 0) return difference.equal();
    return difference.rms_steps <= options.max_rms && difference.mask_differences == 0;
  };
  return accepted(face) && (!body || accepted(*body)) ? kOk : kCheckFailed;
}

Action add(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("a", options->a, "FAP or BAP text, FBA stream or container")->required();
  app.add_option("b", options->b, "The same or another form")->required();
  app.add_option("--max-rms", options->max_rms,
                 "Accept up to this error, in quantiser steps RMS over all FAPs, and over all BAPs")
      ->check(CLI::NonNegativeNumber);
  app.add_flag("--json", options->json, "Machine-readable result");
  return [options] { return run(*options); };
}

}  // namespace

const Command kCompare{
    "compare", "Differences of two clips in FAP units and quantiser steps; exit code 1 if any",
    "  animeme compare talk.fap talk.fba\n"
    "  animeme compare body.bap dance.fba\n"
    "  animeme compare before.fap after.fap --max-rms 0.5 --json",
    add};

}  // namespace animeme::tools
