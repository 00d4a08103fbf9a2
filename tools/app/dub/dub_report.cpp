#include "tools/app/dub/dub_report.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "tools/formats/common/text.h"

namespace animeme::dub {

using tools::Json;

namespace {

// 0 where it is missing or something else.
double number_in(const Json& json, const char* name) {
  const Json* value = json.find(name);
  return value != nullptr && value->is_number() ? value->get<double>() : 0;
}

std::optional<double> confidence_in(const Json& json) {
  const Json* value = json.find("confidence");
  return value != nullptr && value->is_number() ? std::optional(value->get<double>())
                                                : std::nullopt;
}

CueClosures closures_in(const Json& json) {
  const Json* value = json.find("closures");
  if (value == nullptr || !value->is_object()) return {};
  return {std::size_t(number_in(*value, "phones")), std::size_t(number_in(*value, "closed"))};
}

std::string text_in(const Json& json, const char* name) {
  const Json* value = json.find(name);
  return value != nullptr && value->is_string() ? value->text() : "";
}

std::size_t count_of(double value) { return value > 0 ? std::size_t(value) : 0; }

CueRow cue_of(const Json& cue) {
  CueRow row;
  row.text = text_in(cue, "text");
  row.start = number_in(cue, "start");
  row.wanted = number_in(cue, "end") - row.start;
  row.said = number_in(cue, "said");
  row.made = number_in(cue, "seconds");
  row.speed = number_in(cue, "speed");
  row.pauses_cut = number_in(cue, "pauses_cut");
  row.late = number_in(cue, "late");
  row.cut = count_of(number_in(cue, "cut_characters"));
  row.confidence = confidence_in(cue);
  row.closures = closures_in(cue);
  return row;
}

Json optional_json(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json closures_json(const CueClosures& closures) {
  return {{"phones", closures.phones}, {"closed", closures.closed}};
}

Json language_json(const LanguageRow& row) {
  Json json = {{"id", row.id},       {"lang", row.lang},       {"speaker", row.speaker},
               {"state", row.state}, {"outputs", row.outputs}, {"seconds", row.seconds},
               {"cues", row.cues},   {"late_cues", row.late}};
  json["cut_characters"] = row.cut;
  json["most_late"] = row.most_late;
  json["speed"] = {{"slowest", row.slowest}, {"mean", row.mean_speed}, {"fastest", row.fastest}};
  json["confidence"] = optional_json(row.confidence);
  json["closures"] = closures_json(row.closures);
  if (!row.error.empty()) json["error"] = row.error;
  if (!row.warnings.empty()) json["warnings"] = row.warnings;
  return json;
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + "\"";
}

}  // namespace

void add_language(DubReport& report, LanguageRow row, const Json& told) {
  const std::size_t language = report.languages.size();
  row.seconds = number_in(told, "seconds");
  row.confidence = confidence_in(told);
  row.closures = closures_in(told);
  const Json* cues = told.find("cues");
  const std::size_t known = cues != nullptr && cues->is_array() ? cues->size() : 0;
  double said = 0, weighted = 0;
  for (std::size_t i = 0; i < known; ++i) {
    CueRow cue = cue_of((*cues)[i]);
    cue.language = language;
    cue.number = i + 1;
    row.slowest = i == 0 ? cue.speed : std::min(row.slowest, cue.speed);
    row.fastest = i == 0 ? cue.speed : std::max(row.fastest, cue.speed);
    said += cue.made;
    weighted += cue.made * cue.speed;
    row.late += cue.cut > 0 ? 1 : 0;
    row.cut += cue.cut;
    row.most_late = std::max(row.most_late, cue.late);
    report.cues.push_back(std::move(cue));
  }
  if (said > 0) row.mean_speed = weighted / said;
  row.cues = known;
  if (known == 0) {
    CueRow whole;
    whole.language = language;
    whole.made = row.seconds;
    whole.confidence = row.confidence;
    whole.closures = row.closures;
    report.cues.push_back(std::move(whole));
  }
  report.languages.push_back(std::move(row));
}

void sort_cues(DubReport& report) {
  const auto badness = [](const CueRow& cue) {
    // In steps that one can see, so that what is equally bad stays in order.
    return std::make_tuple(cue.cut > 0 ? std::lround(cue.late * 1000) : 0L,
                           cue.closures.phones - std::min(cue.closures.closed, cue.closures.phones),
                           cue.confidence ? std::lround((1 - *cue.confidence) * 100) : 0L,
                           cue.speed > 0 ? std::lround(std::abs(std::log(cue.speed)) * 100) : 0L);
  };
  std::stable_sort(report.cues.begin(), report.cues.end(),
                   [&](const CueRow& a, const CueRow& b) { return badness(a) > badness(b); });
}

std::string report_csv(const DubReport& report) {
  std::string text =
      "lang,speaker,id,cue,start,wanted,said,made,speed,pauses_cut,late,cut_characters,confidence,"
      "pbm,pbm_closed,text\r\n";
  for (const CueRow& cue : report.cues) {
    const LanguageRow& row = report.languages[cue.language];
    text += csv_field(row.lang) + "," + csv_field(row.speaker) + "," + csv_field(row.id) + "," +
            (cue.number > 0 ? std::to_string(cue.number) : "") + "," +
            tools::format("%.3f,", cue.start) +
            (cue.wanted ? tools::format("%.3f", *cue.wanted) : "") +
            tools::format(",%.3f,%.3f,%.3f,%.3f,%.3f,%zu,", cue.said, cue.made, cue.speed,
                          cue.pauses_cut, cue.late, cue.cut) +
            (cue.confidence ? tools::format("%.3f", *cue.confidence) : "") +
            tools::format(",%zu,%zu,", cue.closures.phones, cue.closures.closed) +
            csv_field(cue.text) + "\r\n";
  }
  return text;
}

Json summary_json(const DubReport& report) {
  Json json = Json::object();
  json["languages"] = tools::json_list(report.languages, language_json);
  if (!report.film.name.empty()) {
    json["film"] = {
        {"file", report.film.name}, {"bytes", report.film.bytes}, {"made_from", report.film.hash}};
  }
  return json;
}

Json report_json(const DubReport& report) {
  Json json = summary_json(report);
  json["cues"] = tools::json_list(report.cues, [&](const CueRow& cue) -> Json {
    const LanguageRow& row = report.languages[cue.language];
    return {{"lang", row.lang},
            {"speaker", row.speaker},
            {"id", row.id},
            {"cue", cue.number},
            {"text", cue.text},
            {"start", cue.start},
            {"wanted", optional_json(cue.wanted)},
            {"said", cue.said},
            {"made", cue.made},
            {"speed", cue.speed},
            {"pauses_cut", cue.pauses_cut},
            {"late", cue.late},
            {"cut_characters", cue.cut},
            {"confidence", optional_json(cue.confidence)},
            {"closures", closures_json(cue.closures)}};
  });
  return json;
}

FilmFile film_of(const Json& report) {
  const Json* film = report.find("film");
  if (film == nullptr || !film->is_object()) return {};
  return {text_in(*film, "file"), std::uint64_t(count_of(number_in(*film, "bytes"))),
          text_in(*film, "made_from")};
}

}  // namespace animeme::dub
