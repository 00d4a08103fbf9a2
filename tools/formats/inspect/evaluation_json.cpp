#include <cmath>

#include "tools/formats/common/json.h"
#include "tools/formats/inspect/evaluation.h"
#include "tools/formats/inspect/left_out.h"

namespace animeme::inspect {

using tools::Json;
using tools::json_list;

namespace {

Json series_json(const dam::SeriesScore& one) {
  return {{"name", one.name},
          {"scored", one.scored},
          {"rmse", one.rmse},
          {"nrmse", one.nrmse},
          {"max", one.largest},
          {"correlation", one.correlation},
          {"gain", one.gain},
          {"offset", one.offset},
          {"nrmse_after_gain_and_offset", one.fitted_nrmse}};
}

// The measures of a region by name.
Json measures_json(const dam::RegionScore& region) {
  Json json = Json::object();
  for (const dam::SeriesScore& one : region.measures) {
    json[one.name] = series_json(one);
    json[one.name].erase("name");
    json[one.name].erase("scored");
  }
  return json;
}

Json spread_json(const dam::TimeSpread& spread) {
  return {{"count", spread.count}, {"mean_ms", spread.mean}, {"sd_ms", spread.sd}};
}

Json duration_json(const dam::ClosureDurationScore& one) {
  return {{"from_ms", 1000 * one.from},
          {"to_ms", std::isfinite(one.to) ? Json(1000 * one.to) : Json(nullptr)},
          {"phones", one.phones},
          {"measured_ms", one.measured},
          {"predicted_ms", one.predicted}};
}

Json closure_json(const dam::ClosureScore& closure) {
  return {{"phones", closure.phones},
          {"measured", closure.measured},
          {"predicted", closure.predicted},
          {"false_closures", closure.false_closures},
          {"false_per_minute", closure.false_per_minute},
          {"stray_measured", closure.stray_measured},
          {"stray_measured_per_minute", closure.stray_measured_per_minute},
          {"stray_predicted", closure.stray_predicted},
          {"stray_predicted_per_minute", closure.stray_predicted_per_minute},
          {"onset", spread_json(closure.onset)},
          {"release", spread_json(closure.release)},
          {"durations", json_list(closure.durations, duration_json)}};
}

Json lag_json(const dam::LagScore& lag) {
  return {{"name", lag.name},
          {"frames", lag.frames},
          {"lag_ms", lag.lag ? Json(*lag.lag) : Json(nullptr)},
          {"correlation", lag.correlation}};
}

Json timing_json(const dam::TimingScore& timing) {
  Json json = lag_json(timing.all);
  json.erase("name");
  json["sync"] = dam::sync_text(timing.sync);
  json["extremes"] = timing.extremes;
  json["misalignment_ms"] = timing.misalignment;
  json["offset_ms"] = timing.offset;
  json["classes"] = json_list(timing.classes, lag_json);
  return json;
}

Json dynamics_json(const dam::DynamicsScore& one) {
  return {{"name", one.name},
          {"scored", one.scored},
          {"velocity", one.velocity},
          {"acceleration", one.acceleration},
          {"jerk", one.jerk},
          {"range", one.range},
          {"velocity_correlation", one.velocity_correlation}};
}

Json all_dynamics_json(const dam::Evaluation& result) {
  Json json = dynamics_json(result.dynamics);
  json.erase("name");
  json.erase("scored");
  json["groups"] = json_list(result.group_dynamics, dynamics_json);
  json["series"] = json_list(result.series_dynamics, dynamics_json);
  return json;
}

Json group_json(const dam::GroupScore& one) {
  return {{"name", one.name},   {"phones", one.phones}, {"frames", one.frames},
          {"nrmse", one.nrmse}, {"l2", one.l2},         {"gap_rmse", one.gap_rmse}};
}

Json silence_json(const dam::RegionScore& silence) {
  return {{"frames", silence.frames},
          {"mean_nrmse", silence.nrmse},
          {"still_face_nrmse", silence.still_nrmse},
          {"mean_nrmse_after_gain_and_offset", silence.fitted_nrmse},
          {"mean_l2", silence.l2},
          {"mean_correlation", silence.correlation},
          {"measures", measures_json(silence)},
          {"controls", json_list(silence.controls, series_json)}};
}

Json utterance_json(const dam::UtteranceScore& one) {
  return {{"id", one.id}, {"frames", one.frames},     {"nrmse", one.nrmse},
          {"l2", one.l2}, {"gap_rmse", one.gap_rmse}, {"gap_correlation", one.gap_correlation}};
}

Json scores_json(const dam::Evaluation& result) {
  return {{"utterances", result.utterances},
          {"frames", result.frames},
          {"seconds", result.seconds},
          {"mean_nrmse", result.nrmse},
          {"still_face_nrmse", result.still_nrmse},
          {"mean_nrmse_after_gain_and_offset", result.fitted_nrmse},
          {"mean_l2", result.l2},
          {"mean_correlation", result.correlation},
          {"gap_correlation_within_sentences", result.gap_correlation},
          {"closure", closure_json(result.closure)},
          {"contact",
           {{"phones", result.contact.phones},
            {"level", result.contact.level},
            {"measured", result.contact.measured},
            {"predicted", result.contact.predicted},
            {"difference", result.contact.difference}}},
          {"rounding",
           {{"phones", result.rounding.phones},
            {"measured", result.rounding.measured},
            {"predicted", result.rounding.predicted},
            {"rmse", result.rounding.rmse},
            {"correlation", result.rounding.correlation}}},
          {"timing", timing_json(result.timing)},
          {"dynamics", all_dynamics_json(result)},
          {"measures", measures_json(result)},
          {"controls", json_list(result.controls, series_json)},
          {"silence", silence_json(result.silence)},
          {"by_phone", json_list(result.breakdown.phones, group_json)},
          {"by_viseme", json_list(result.breakdown.visemes, group_json)},
          {"by_triphone", json_list(result.breakdown.triphones, group_json)},
          {"by_word", json_list(result.breakdown.words, group_json)},
          {"per_utterance", json_list(result.per_utterance, utterance_json)}};
}

Json difference_json(const dam::ErrorDifference& one) {
  return {{"a", one.a},     {"b", one.b},       {"difference", one.difference},
          {"low", one.low}, {"high", one.high}, {"share_of_draws_below_0", one.below}};
}

}  // namespace

std::string evaluation_json(const EvaluationReport& report) {
  Json json = {{"system", report.system}, {"closed_gap", report.closed_gap}};
  json["blanks"] = *Json::parse(blanks_json(report.left_out));
  json["glitches"] = *Json::parse(glitches_json(report.glitches));
  json.update(scores_json(report.evaluation));
  if (report.difference) {
    json["against"] = {{"system", report.against},
                       {"sentences", report.difference->sentences},
                       {"controls", report.compared_controls},
                       {"draws", report.difference->draws},
                       {"coverage", 0.95},
                       {"nrmse", difference_json(report.difference->nrmse)},
                       {"l2", difference_json(report.difference->l2)},
                       {"gap_rmse", difference_json(report.difference->gap_rmse)}};
  }
  for (const RuleCost& rule : report.rules)
    json["rules"][rule.rule] = {{"nrmse", rule.nrmse},
                                {"fitted_nrmse", rule.fitted_nrmse},
                                {"gap_correlation", rule.gap_correlation},
                                {"gap_nrmse", rule.gap},
                                {"jaw_nrmse", rule.jaw}};
  if (report.codec) {
    json["codec"] = {{"bytes", report.codec->bytes},
                     {"kbps", report.codec->kbps},
                     {"error", scores_json(report.codec->error)},
                     {"total", scores_json(report.codec->total)}};
  }
  return tools::pretty(json);
}

}  // namespace animeme::inspect
