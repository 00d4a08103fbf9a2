#include "tools/formats/inspect/adaptation.h"

#include <algorithm>

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
               {"ridge_factor", report.ridge},
               {"controls", controls}};
  if (report.error > 0) {
    json["held_out_error"] = report.error;
    json["held_out_error_of_base"] = report.base_error;
    json["held_out_error_of_own_alone"] = report.own_error;
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
  if (report.error > 0)
    text += format(
        "cross-validation error: %.1f %% of the variance for the base with gains only, %.1f %% in "
        "total\n",
        100 * report.base_error, 100 * report.error);
  text += report.ridge > 0 ? format("own curves, ridge factor %g\n", report.ridge)
                           : std::string("no own curves, since they did not help\n");
  if (report.own_error > 0 && report.own_error < report.error)
    text += format(
        "trained on these sentences alone it is %.1f %%: omit --base, unless they lack "
        "phones\n",
        100 * report.own_error);
  std::string little;
  for (const dam::AdaptedControl& control : report.controls)
    if (control.base < kLittle) little += " " + control.name;
  if (!little.empty()) text += "the base hardly predicts: " + little + "\n";
  return text + output + ": adapted";
}

}  // namespace animeme::inspect
