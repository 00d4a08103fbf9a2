#include <CLI/CLI.hpp>
#include <cstdio>

#include "tools/commands/common.h"
#include "tools/inspect/comparison.h"

namespace animeme::tools {

namespace {

struct CompareOptions {
  std::string a;
  std::string b;
  bool json = false;
  double max_rms = -1;
};

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

Result<int> run(const CompareOptions& options) {
  Result<MotionInput> a = read_motion(options.a);
  if (!a) return a.error();
  Result<MotionInput> b = read_motion(options.b);
  if (!b) return b.error();
  if (auto ok = check_half(*a, *b, options.b); !ok) return ok.error();
  if (auto ok = check_half(*b, *a, options.a); !ok) return ok.error();
  const Common common = in_common(*a, *b);
  inspect::Comparison comparison;
  if (common.face) comparison.face = fap::compare(a->face, b->face);
  if (common.body) comparison.body = inspect::compare_bodies(a->body, b->body);
  const std::string text = options.json ? inspect::comparison_json(comparison) + "\n"
                                        : inspect::comparison_text(comparison);
  std::fputs(text.c_str(), stdout);
  const auto accepted = [&](const auto& difference) {
    if (options.max_rms < 0 || !difference) return !difference || difference->equal();
    return difference->rms_steps <= options.max_rms && difference->mask_differences == 0;
  };
  return accepted(comparison.face) && accepted(comparison.body) ? kOk : kCheckFailed;
}

void add_options(CLI::App& app, CompareOptions& options) {
  app.add_option("a", options.a, "FAP or BAP text, FBA stream or container")->required();
  app.add_option("b", options.b, "The same or another form")->required();
  app.add_option("--max-rms", options.max_rms,
                 "Accept up to this error, in quantiser steps RMS over all FAPs, and over all BAPs")
      ->check(CLI::NonNegativeNumber);
  app.add_flag("--json", options.json, "Machine-readable result");
}

}  // namespace

const Command kCompare{
    "compare", "Differences of two clips in FAP units and quantiser steps; exit code 1 if any",
    "  animeme compare talk.fap talk.fba\n"
    "  animeme compare body.bap dance.fba\n"
    "  animeme compare before.fap after.fap --max-rms 0.5 --json",
    set_up<CompareOptions>};

}  // namespace animeme::tools
