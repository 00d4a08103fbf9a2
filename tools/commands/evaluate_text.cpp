#include <cstdio>

#include "tools/commands/evaluate_report.h"

namespace animeme::tools {

namespace {

void print_head(const dam::Evaluation& e) {
  std::printf("%zu utterances, %zu frames of speech +-0.2 s (%.1f s)\n\n", e.utterances, e.frames,
              e.seconds);
  std::printf("mean NRMSE        %.4f   (RMSE / standard deviation, scored controls)\n", e.nrmse);
  std::printf("  of a still face %.4f   (mean pose)\n", e.still_nrmse);
  if (e.silence.frames > 0) {
    std::printf("  in silence      %.4f   (%zu frames)\n", e.silence.nrmse, e.silence.frames);
  }
  std::printf("mean L2           %.3f\n", e.l2);
  std::printf("mean correlation  %.3f\n", e.correlation);
}

void print_spread(const char* what, const dam::TimeSpread& spread) {
  if (spread.count == 0) return;
  std::printf("  %-15s %+.0f ms, spread %.0f ms (%zu)\n", what, spread.mean, spread.sd,
              spread.count);
}

void print_mouth(const dam::Evaluation& e) {
  if (e.measures.empty()) return;
  std::printf("\n%-17s %8s %8s %8s %8s\n", "mouth", "RMSE", "NRMSE", "max", "corr");
  for (const dam::SeriesScore& one : e.measures) {
    std::printf("%-17s %8.1f %8.3f %8.1f %8.3f\n", one.name.c_str(), one.rmse, one.nrmse,
                one.largest, one.correlation);
  }
  if (e.gap_correlation != 0)
    std::printf("  inner_gap within sentences: correlation %.3f in the mean\n", e.gap_correlation);
}

void print_lips(const EvaluateReport& report) {
  const dam::Evaluation& e = report.evaluation;
  if (e.closure.phones + e.contact.phones + e.rounding.phones > 0) std::printf("\n");
  if (e.closure.phones > 0) {
    std::printf("P B M closed      %.1f %% (measured %.1f %%) of %zu; gap below %g\n",
                100 * e.closure.predicted, 100 * e.closure.measured, e.closure.phones,
                report.closed_gap);
    print_spread("onset", e.closure.onset);
    print_spread("release", e.closure.release);
    std::printf("false closures    %.1f a minute; closed elsewhere: made %.1f, measured %.1f\n",
                e.closure.false_per_minute, e.closure.stray_predicted_per_minute,
                e.closure.stray_measured_per_minute);
  }
  if (e.contact.phones > 0) {
    std::printf("F V contact       %.1f %% (measured %.1f %%) of %zu; lower lip %+.0f\n",
                100 * e.contact.predicted, 100 * e.contact.measured, e.contact.phones,
                e.contact.difference);
  }
  if (e.rounding.phones > 0) {
    std::printf("rounded, narrower %.1f (measured %.1f), %zu phones; RMSE %.1f, correlation %.3f\n",
                e.rounding.predicted, e.rounding.measured, e.rounding.phones, e.rounding.rmse,
                e.rounding.correlation);
  }
}

std::string lag_text(const dam::LagScore& lag) {
  if (!lag.lag) return "none found";
  char text[32];
  std::snprintf(text, sizeof text, "%+.1f ms", *lag.lag);
  return text;
}

void print_motion(const dam::Evaluation& e) {
  std::printf("\nlag               %s, %s; correlation %.3f\n", lag_text(e.timing.all).c_str(),
              dam::sync_text(e.timing.sync), e.timing.all.correlation);
  std::printf("extremes apart    %.1f ms (%+.1f ms), %zu of velocity\n", e.timing.misalignment,
              e.timing.offset, e.timing.extremes);
  std::printf(
      "dynamics          velocity %.3f, acceleration %.3f, jerk %.3f, range %.3f of the "
      "recording\n",
      e.dynamics.velocity, e.dynamics.acceleration, e.dynamics.jerk, e.dynamics.range);
  std::printf("  correlation     %.3f of velocities\n", e.dynamics.velocity_correlation);
}

void print_context(const char* what, const std::vector<dam::GroupScore>& groups) {
  for (const dam::GroupScore& one : groups) {
    if (one.phones == 0) continue;
    std::printf("%-10s %-6s NRMSE %.4f, L2 %.3f, gap RMSE %.1f; %zu phones\n", what,
                one.name.c_str(), one.nrmse, one.l2, one.gap_rmse, one.phones);
  }
}

void print_difference(const char* what, const dam::ErrorDifference& one, int digits) {
  std::printf("%-17s %.*f - %.*f = %+.*f   [%+.*f, %+.*f]   less in %.1f %% of draws\n", what,
              digits, one.a, digits, one.b, digits, one.difference, digits, one.low, digits,
              one.high, 100 * one.below);
}

void print_against(const EvaluateReport& report) {
  if (!report.difference) return;
  const dam::PairedDifference& d = *report.difference;
  std::printf("\n%s less %s, %zu scored controls in common, 95 %% of %d draws of %zu sentences\n",
              report.system.c_str(), report.against.c_str(), report.compared_controls, d.draws,
              d.sentences);
  print_difference("NRMSE", d.nrmse, 4);
  print_difference("L2", d.l2, 3);
  if (d.gap_rmse.a > 0 || d.gap_rmse.b > 0) print_difference("gap RMSE", d.gap_rmse, 1);
}

void print_codec(const EvaluateReport& report) {
  if (!report.codec) return;
  const CodecScore& codec = *report.codec;
  std::printf("\ncodec             %.2f kbit/s, a stream a sentence\n", codec.kbps);
  std::printf("  its error       NRMSE %.4f, L2 %.3f", codec.error.nrmse, codec.error.l2);
  if (!codec.error.measures.empty() && codec.error.measures[0].name == "inner_gap") {
    std::printf(", gap RMSE %.2f", codec.error.measures[0].rmse);
  }
  std::printf("\n  with synthesis  NRMSE %.4f (before coding %.4f)", codec.total.nrmse,
              report.evaluation.nrmse);
  if (codec.total.closure.phones > 0) {
    std::printf(", P B M closed %.1f %%", 100 * codec.total.closure.predicted);
  }
  std::printf("\n");
}

void print_controls(const dam::Evaluation& e) {
  std::printf("\n%-28s %8s %8s %8s %8s %9s %6s %6s %6s\n", "control", "RMSE", "NRMSE", "max",
              "corr", "velocity", "accel", "jerk", "range");
  std::vector<dam::SeriesScore> series = e.controls;
  series.insert(series.end(), e.measures.begin(), e.measures.end());
  for (std::size_t i = 0; i < series.size(); ++i) {
    const dam::SeriesScore& one = series[i];
    const dam::DynamicsScore& motion = e.series_dynamics[i];
    const char* note = one.scored ? "" : "  (not scored)";
    if (i >= e.controls.size()) note = "  (measure)";
    std::printf("%-28s %8.2f %8.3f %8.1f %8.3f %9.3f %6.3f %6.3f %6.3f%s\n", one.name.c_str(),
                one.rmse, one.nrmse, one.largest, one.correlation, motion.velocity,
                motion.acceleration, motion.jerk, motion.range, note);
  }
}

void print_groups(const char* title, const std::vector<dam::GroupScore>& groups) {
  std::printf("\n%-17s %8s %8s %8s %8s %8s\n", title, "phones", "frames", "NRMSE", "L2", "gap");
  for (const dam::GroupScore& one : groups) {
    std::printf("%-17s %8zu %8zu %8.4f %8.3f %8.1f\n", one.name.c_str(), one.phones, one.frames,
                one.nrmse, one.l2, one.gap_rmse);
  }
}

void print_tables(const dam::Evaluation& e) {
  print_controls(e);
  print_groups("phoneme", e.breakdown.phones);
  print_groups("viseme", e.breakdown.visemes);
  std::printf("\n%-17s %8s %12s %8s\n", "class", "frames", "lag", "corr");
  for (const dam::LagScore& one : e.timing.classes) {
    std::printf("%-17s %8zu %12s %8.3f\n", one.name.c_str(), one.frames, lag_text(one).c_str(),
                one.correlation);
  }
  std::printf("\n%-17s %8s %8s %8s %8s\n", "sentence", "frames", "NRMSE", "L2", "gap");
  for (const dam::UtteranceScore& one : e.per_utterance) {
    std::printf("%-17s %8zu %8.4f %8.3f %8.1f\n", one.id.c_str(), one.frames, one.nrmse, one.l2,
                one.gap_rmse);
  }
}

}  // namespace

void print_evaluation(const EvaluateReport& report, bool full) {
  const dam::Evaluation& e = report.evaluation;
  print_head(e);
  print_mouth(e);
  print_lips(report);
  print_motion(e);
  if (!e.breakdown.triphones.empty()) std::printf("\n");
  print_context("triphones", e.breakdown.triphones);
  print_context("words", e.breakdown.words);
  print_codec(report);
  print_against(report);
  if (full) print_tables(e);
}

}  // namespace animeme::tools
