#include "tools/formats/inspect/adaptation.h"

#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"
#include "tools/formats/inspect/left_out.h"
#include "tools/formats/inspect/training.h"

namespace animeme::inspect {
namespace {

using tools::format;
using tools::Json;

/// A control of which the base explains less than this is named.
constexpr double kLittle = 0.1;

Json error_json(const dam::HeldOutError& error) {
  return {{"nrmse", error.nrmse}, {"correlation", error.correlation}};
}

}  // namespace

std::string adaptation_json(const std::string& output, const std::string& base,
                            const dam::Model& model, const dam::AdaptReport& report,
                            const dam::LeftOut& left_out) {
  Json controls = Json::array();
  for (const dam::AdaptedControl& control : report.controls) {
    Json one = {{"name", control.name}, {"explained_by_base", control.base}};
    if (control.same_name) one["gain"] = control.gain;
    controls.push_back(one);
  }
  Json json = {{"output", output},
               {"base", base},
               {"utterances", report.sentences},
               {"speech_seconds", report.seconds},
               {"phones", model.phones.size()},
               {"base_share", report.base_share},
               {"ridge_factor", report.ridge},
               {"own_ridge_factor", report.own_ridge},
               {"controls", controls}};
  if (report.error.nrmse > 0) {
    json["held_out"] = {{"adapted", error_json(report.error)},
                        {"base", error_json(report.base_error)},
                        {"own_alone", error_json(report.own_error)},
                        {"still", error_json(report.still_error)}};
  }
  json["blanks"] = *Json::parse(blanks_json(left_out));
  json["glitches"] = *Json::parse(glitches_json(report.glitches));
  json["alignment"] = *Json::parse(alignment_json(report.alignment));
  json["warnings"] = report.warnings;
  return tools::pretty(json);
}

std::string adaptation_text(const std::string& output, const std::string& base,
                            const dam::Model& model, const dam::AdaptReport& report) {
  std::string text = format("%zu utterances (%.1f s of speech) on %s, %zu phones, %zu controls\n",
                            report.sentences, report.seconds, base.c_str(), model.phones.size(),
                            report.controls.size());
  if (report.error.nrmse > 0) {
    const auto one = [](const char* what, const dam::HeldOutError& error) {
      return format("  %-30s NRMSE %.3f, correlation %.3f\n", what, error.nrmse, error.correlation);
    };
    text += "on held-out sentences, offsets kept:\n" + one("this model", report.error) +
            one("the base with gains", report.base_error) +
            one("these sentences alone", report.own_error) +
            format("  %-30s NRMSE %.3f\n", "a still face", report.still_error.nrmse);
  }
  text += format("%.0f %% of the base, %.0f %% of own curves", 100 * report.base_share,
                 100 * (1 - report.base_share));
  text += report.ridge > 0 ? format("; curves on top of the base, ridge factor %g\n", report.ridge)
                           : std::string("\n");
  std::string little;
  for (const dam::AdaptedControl& control : report.controls)
    if (control.base < kLittle) little += " " + control.name;
  if (!little.empty()) text += "the base hardly predicts: " + little + "\n";
  return text + output + ": adapted";
}

}  // namespace animeme::inspect
