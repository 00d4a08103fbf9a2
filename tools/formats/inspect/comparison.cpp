#include "tools/formats/inspect/comparison.h"

#include "fap/tables.h"
#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"

namespace animeme::inspect {

using tools::format;

namespace {

using tools::Json;

// What faces and bodies have in common.
template <class Difference>
Json summary_json(const Difference& difference) {
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

Json to_json(const fap::Difference& difference) {
  Json json = summary_json(difference);
  Json faps = Json::array();
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
std::string only_text(const One& one) {
  if (one.only_a + one.only_b == 0) return "\n";
  return format("  (only in a: %lld, only in b: %lld)\n", (long long)one.only_a,
                (long long)one.only_b);
}

std::string rows_text(const fap::Difference& difference) {
  std::string text = format("%4s %-24s %8s %8s %8s %10s %10s\n", "FAP", "name", "rms", "max",
                            "frame", "rms/step", "max/step");
  for (int number = 1; number <= fap::kFapCount; ++number) {
    const fap::FapDifference& one = difference.fap[std::size_t(number)];
    if (one.differing + one.only_a + one.only_b == 0) continue;
    text += format("%4d %-24s %8.2f %8lld %8lld %10.3f %10.2f", number,
                   std::string(fap::info(number).name).c_str(), one.rms, (long long)one.max,
                   (long long)one.max_frame, one.rms_steps, one.max_steps);
    text += only_text(one);
  }
  return text;
}

Json to_json(const BodyDifference& difference) {
  Json json = summary_json(difference);
  Json baps = Json::array();
  for (int number = 1; number <= fba::kBapCount; ++number) {
    const BapDifference& one = difference.bap[std::size_t(number)];
    if (one.frames + one.only_a + one.only_b == 0) continue;
    const double step = bap_step(number);
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

std::string rows_text(const BodyDifference& difference) {
  std::string text =
      format("%4s %8s %8s %8s %10s %10s\n", "BAP", "rms", "max", "frame", "rms/step", "max/step");
  for (int number = 1; number <= fba::kBapCount; ++number) {
    const BapDifference& one = difference.bap[std::size_t(number)];
    if (one.differing + one.only_a + one.only_b == 0) continue;
    const double step = bap_step(number);
    text += format("%4d %8.2f %8lld %8lld %10.3f %10.2f", number, one.rms(), (long long)one.max,
                   (long long)one.max_frame, one.rms() / step, double(one.max) / step);
    text += only_text(one);
  }
  return text;
}

template <class Difference>
std::string text_of(const Difference& difference, const char* what) {
  if (difference.equal()) {
    return format("equal: %lld %sframes\n", (long long)difference.frames_a, what);
  }
  return format(
             "%sframes: %lld and %lld, %lld in common; rates %s; first difference in frame %lld\n",
             what, (long long)difference.frames_a, (long long)difference.frames_b,
             (long long)difference.frames_both, difference.same_rate ? "equal" : "DIFFER",
             (long long)difference.first_difference) +
         format("error: %.3f quantiser steps RMS, maximum %.1f; masks differ in %lld places\n\n",
                difference.rms_steps, difference.max_steps,
                (long long)difference.mask_differences) +
         rows_text(difference);
}

}  // namespace

std::string comparison_json(const Comparison& comparison, bool damaged) {
  Json json = to_json(comparison.face.value_or(fap::Difference()));
  json["equal"] = comparison.equal();
  json["damaged"] = damaged;
  json["face_compared"] = comparison.face.has_value();
  if (comparison.body) json["body"] = to_json(*comparison.body);
  return tools::pretty(json);
}

std::string comparison_text(const Comparison& comparison) {
  std::string text;
  if (comparison.face) text += text_of(*comparison.face, "");
  if (comparison.face && comparison.body) text += "\n";
  if (comparison.body) text += text_of(*comparison.body, "body ");
  return text;
}

}  // namespace animeme::inspect
