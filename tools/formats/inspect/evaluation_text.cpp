#include <cmath>

#include "tools/formats/common/text.h"
#include "tools/formats/inspect/evaluation.h"

namespace animeme::inspect {

using tools::format;

namespace {

void add_head(std::string& out, const dam::Evaluation& e) {
  out += format("%zu utterances, %zu frames of speech +-0.2 s (%.1f s)\n\n", e.utterances, e.frames,
                e.seconds);
  out += format("mean NRMSE        %.4f   (RMSE / standard deviation, scored controls)\n", e.nrmse);
  out += format("  of a still face %.4f   (mean pose)\n", e.still_nrmse);
  out += format(
      "  after gain fit  %.4f   (NRMSE after a per-control gain/offset fit; a still face: 1)\n",
      e.fitted_nrmse);
  if (e.silence.frames > 0) {
    out += format("  in silence      %.4f   (%zu frames)\n", e.silence.nrmse, e.silence.frames);
  }
  out += format("mean L2           %.3f\n", e.l2);
  out += format("mean correlation  %.3f\n", e.correlation);
}

void add_spread(std::string& out, const char* what, const dam::TimeSpread& spread) {
  if (spread.count == 0) return;
  out += format("  %-15s %+.0f ms, spread %.0f ms (%zu)\n", what, spread.mean, spread.sd,
                spread.count);
}

void add_mouth(std::string& out, const dam::Evaluation& e) {
  if (e.measures.empty()) return;
  out += format("\n%-17s %8s %8s %8s %8s\n", "mouth", "RMSE", "NRMSE", "max", "corr");
  for (const dam::SeriesScore& one : e.measures) {
    out += format("%-17s %8.1f %8.3f %8.1f %8.3f\n", one.name.c_str(), one.rmse, one.nrmse,
                  one.largest, one.correlation);
  }
  if (e.gap_correlation != 0)
    out += format("  inner_gap within sentences: mean correlation %.3f\n", e.gap_correlation);
}

std::string length_text(const dam::ClosureDurationScore& one) {
  if (!std::isfinite(one.to)) return format("%.0f ms or more", 1000 * one.from);
  if (one.from == 0) return format("under %.0f ms", 1000 * one.to);
  return format("%.0f to %.0f ms", 1000 * one.from, 1000 * one.to);
}

void add_durations(std::string& out, const dam::ClosureScore& closure) {
  const char* what = "closed for";
  for (const dam::ClosureDurationScore& one : closure.durations) {
    if (one.phones == 0) continue;
    out += format("  %-15s %.0f ms (measured %.0f), phones of %s: %zu\n", what, one.predicted,
                  one.measured, length_text(one).c_str(), one.phones);
    what = "";
  }
}

void add_lips(std::string& out, const EvaluationReport& report) {
  const dam::Evaluation& e = report.evaluation;
  if (e.closure.phones + e.contact.phones + e.rounding.phones > 0) out += format("\n");
  if (e.closure.phones > 0) {
    out += format("P B M closed      %.1f %% (recorded %.1f %%) of %zu; gap below %g\n",
                  100 * e.closure.predicted, 100 * e.closure.measured, e.closure.phones,
                  report.closed_gap);
    add_spread(out, "onset", e.closure.onset);
    add_spread(out, "release", e.closure.release);
    add_durations(out, e.closure);
    out += format(
        "false closures    %.1f a minute; other lip closures per minute: synthesised %.1f, "
        "recorded %.1f\n",
        e.closure.false_per_minute, e.closure.stray_predicted_per_minute,
        e.closure.stray_measured_per_minute);
  }
  if (e.contact.phones > 0) {
    out += format("F V contact       %.1f %% (recorded %.1f %%) of %zu; lower lip %+.0f\n",
                  100 * e.contact.predicted, 100 * e.contact.measured, e.contact.phones,
                  e.contact.difference);
  }
  if (e.rounding.phones > 0) {
    out +=
        format("rounded, narrower %.1f (recorded %.1f), %zu phones; RMSE %.1f, correlation %.3f\n",
               e.rounding.predicted, e.rounding.measured, e.rounding.phones, e.rounding.rmse,
               e.rounding.correlation);
  }
}

std::string lag_text(const dam::LagScore& lag) {
  if (!lag.lag) return "none found";
  return format("%+.1f ms", *lag.lag);
}

void add_motion(std::string& out, const dam::Evaluation& e) {
  out += format("\nlag               %s, %s; correlation %.3f\n", lag_text(e.timing.all).c_str(),
                dam::sync_text(e.timing.sync), e.timing.all.correlation);
  out += format("timing error of velocity peaks: %.1f ms (bias %+.1f ms, n = %zu)\n",
                e.timing.misalignment, e.timing.offset, e.timing.extremes);
  out += format(
      "dynamics          velocity %.3f, acceleration %.3f, jerk %.3f, range %.3f of the "
      "recording\n",
      e.dynamics.velocity, e.dynamics.acceleration, e.dynamics.jerk, e.dynamics.range);
  out += format("  correlation     %.3f of velocities\n", e.dynamics.velocity_correlation);
  if (e.group_dynamics.size() < 2) return;
  const char* before = "  velocity of     ";
  for (const dam::DynamicsScore& one : e.group_dynamics) {
    out += format("%s%s %.3f", before, one.name.c_str(), one.velocity);
    before = ", ";
  }
  out += format("\n");
}

void add_context(std::string& out, const char* what, const std::vector<dam::GroupScore>& groups) {
  for (const dam::GroupScore& one : groups) {
    if (one.phones == 0) continue;
    out += format("%-10s %-6s NRMSE %.4f, L2 %.3f, gap RMSE %.1f; %zu phones\n", what,
                  one.name.c_str(), one.nrmse, one.l2, one.gap_rmse, one.phones);
  }
}

void add_difference(std::string& out, const char* what, const dam::ErrorDifference& one,
                    int digits) {
  out += format("%-17s %.*f - %.*f = %+.*f   [%+.*f, %+.*f]   less in %.1f %% of draws\n", what,
                digits, one.a, digits, one.b, digits, one.difference, digits, one.low, digits,
                one.high, 100 * one.below);
}

void add_against(std::string& out, const EvaluationReport& report) {
  if (!report.difference) return;
  const dam::PairedDifference& d = *report.difference;
  out += format("\n%s minus %s, %zu common scored controls, 95 %% of %d draws of %zu sentences\n",
                report.system.c_str(), report.against.c_str(), report.compared_controls, d.draws,
                d.sentences);
  add_difference(out, "NRMSE", d.nrmse, 4);
  add_difference(out, "L2", d.l2, 3);
  if (d.gap_rmse.a > 0 || d.gap_rmse.b > 0) add_difference(out, "gap RMSE", d.gap_rmse, 1);
}

void add_rules(std::string& out, const EvaluationReport& report) {
  if (report.rules.empty()) return;
  out +=
      "\nwhat a rule adds    NRMSE  after gain and offset  inner gap      jaw  gap correlation\n";
  for (const RuleCost& rule : report.rules)
    out += format("  %-15s %+.4f                %+.4f    %+.4f  %+.4f          %+.4f\n",
                  rule.rule.c_str(), rule.nrmse, rule.fitted_nrmse, rule.gap, rule.jaw,
                  rule.gap_correlation);
}

void add_codec(std::string& out, const EvaluationReport& report) {
  if (!report.codec) return;
  const CodecScore& codec = *report.codec;
  out += format("\ncodec             %.2f kbit/s, one stream per sentence\n", codec.kbps);
  out += format("  its error       NRMSE %.4f, L2 %.3f", codec.error.nrmse, codec.error.l2);
  if (!codec.error.measures.empty() && codec.error.measures[0].name == "inner_gap") {
    out += format(", gap RMSE %.2f", codec.error.measures[0].rmse);
  }
  out += format("\n  with synthesis  NRMSE %.4f (before coding %.4f)", codec.total.nrmse,
                report.evaluation.nrmse);
  if (codec.total.closure.phones > 0) {
    out += format(", P B M closed %.1f %%", 100 * codec.total.closure.predicted);
  }
  out += format("\n");
}

void add_controls(std::string& out, const dam::Evaluation& e) {
  out += format("\n%-28s %8s %8s %8s %8s %6s %8s %9s %6s %6s %6s\n", "control", "RMSE", "NRMSE",
                "max", "corr", "gain", "after fit", "velocity", "accel", "jerk", "range");
  std::vector<dam::SeriesScore> series = e.controls;
  series.insert(series.end(), e.measures.begin(), e.measures.end());
  for (std::size_t i = 0; i < series.size(); ++i) {
    const dam::SeriesScore& one = series[i];
    const dam::DynamicsScore& motion = e.series_dynamics[i];
    const char* note = one.scored ? "" : "  (not scored)";
    if (i >= e.controls.size()) note = "  (measure)";
    out += format("%-28s %8.2f %8.3f %8.1f %8.3f %6.2f %8.3f %9.3f %6.3f %6.3f %6.3f%s\n",
                  one.name.c_str(), one.rmse, one.nrmse, one.largest, one.correlation, one.gain,
                  one.fitted_nrmse, motion.velocity, motion.acceleration, motion.jerk, motion.range,
                  note);
  }
}

void add_groups(std::string& out, const char* title, const std::vector<dam::GroupScore>& groups) {
  out += format("\n%-17s %8s %8s %8s %8s %8s\n", title, "phones", "frames", "NRMSE", "L2", "gap");
  for (const dam::GroupScore& one : groups) {
    out += format("%-17s %8zu %8zu %8.4f %8.3f %8.1f\n", one.name.c_str(), one.phones, one.frames,
                  one.nrmse, one.l2, one.gap_rmse);
  }
}

void add_tables(std::string& out, const dam::Evaluation& e) {
  add_controls(out, e);
  add_groups(out, "phoneme", e.breakdown.phones);
  add_groups(out, "viseme", e.breakdown.visemes);
  out += format("\n%-17s %8s %12s %8s\n", "class", "frames", "lag", "corr");
  for (const dam::LagScore& one : e.timing.classes) {
    out += format("%-17s %8zu %12s %8.3f\n", one.name.c_str(), one.frames, lag_text(one).c_str(),
                  one.correlation);
  }
  out += format("\n%-17s %8s %8s %8s %8s\n", "sentence", "frames", "NRMSE", "L2", "gap");
  for (const dam::UtteranceScore& one : e.per_utterance) {
    out += format("%-17s %8zu %8.4f %8.3f %8.1f\n", one.id.c_str(), one.frames, one.nrmse, one.l2,
                  one.gap_rmse);
  }
}

}  // namespace

std::string evaluation_text(const EvaluationReport& report, bool full) {
  std::string out;
  const dam::Evaluation& e = report.evaluation;
  add_head(out, e);
  add_mouth(out, e);
  add_lips(out, report);
  add_motion(out, e);
  if (!e.breakdown.triphones.empty()) out += format("\n");
  add_context(out, "triphones", e.breakdown.triphones);
  add_context(out, "words", e.breakdown.words);
  add_rules(out, report);
  add_codec(out, report);
  add_against(out, report);
  if (full) add_tables(out, e);
  return out;
}

}  // namespace animeme::inspect
