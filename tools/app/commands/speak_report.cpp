#include <cstdio>
#include <filesystem>
#include <vector>

#include "tools/app/commands/common.h"
#include "tools/app/commands/speak_parts.h"

namespace animeme::tools {

namespace {

// Phones inside words, or all of them, lie where they usually do instead of where they were heard.
bool is_approximate(const speech::Spoken& spoken) {
  return spoken.times == speech::TimesFrom::words ||
         (spoken.alignment && spoken.alignment->approximate);
}

Json confidence_of(const speech::Spoken& spoken) {
  if (spoken.heard) return spoken.heard->confidence;
  return spoken.alignment ? Json(spoken.alignment->confidence) : Json(nullptr);
}

Json doubtful_words(const speech::Spoken& spoken) {
  Json list = Json::array();
  if (!spoken.alignment) return list;
  for (const voice::AlignedWord& word : spoken.alignment->words) {
    if (word.confidence >= voice::kDoubtful) continue;
    list.push_back({{"word", word.text},
                    {"start", word.start},
                    {"end", word.end},
                    {"confidence", word.confidence}});
  }
  return list;
}

struct RecognisedPhone {
  dam::Phone phone;
  double confidence = 0;
};

std::vector<RecognisedPhone> heard_phones(const speech::Spoken& spoken) {
  std::vector<RecognisedPhone> all;
  for (std::size_t i = 0; i < spoken.script.phones.size(); ++i) {
    all.push_back({spoken.script.phones[i], spoken.heard->confidences[i]});
  }
  return all;
}

Json numbers_of(const fap::Mask& faps) {
  Json list = Json::array();
  for (std::size_t fap = 1; fap < faps.size(); ++fap)
    if (faps[fap]) list.push_back(fap);
  return list;
}

Json language_json(const voice::SpokenLanguage& part) {
  return {{"start", part.start}, {"end", part.end},   {"language", part.language},
          {"voice", part.voice}, {"text", part.text}, {"by_itself", part.by_itself}};
}

Json closures_json(const std::optional<LipClosures>& lips, double start, double end) {
  if (!lips) return {};
  const ClosedLips count = lips->between(start, end);
  return {{"phones", count.phones}, {"closed", count.closed}};
}

Json cue_json(const speech::FittedCue& one, const ShownFace& shown) {
  return {{"text", one.cue.text},
          {"start", one.cue.start},
          {"end", one.cue.end},
          {"said", one.start},
          {"seconds", one.seconds},
          {"speed", one.speed},
          {"late", one.late},
          {"pauses_cut", one.shortened},
          {"cut_characters", one.cut},
          {"confidence", one.confidence ? Json(*one.confidence) : Json(nullptr)},
          {"closures", closures_json(shown.lips, one.start, one.start + one.seconds)}};
}

Json over_json(const dam::OverReport& over) {
  return {{"end", over.end},
          {"moments", json_list(over.time.moments(),
                                [](const dam::BentMoment& one) -> Json {
                                  return {{"time", one.time}, {"source", one.source}};
                                })},
          {"kept", numbers_of(over.kept)},
          {"filled", numbers_of(over.filled)}};
}

// A file beside an output names it without the folder, which may be moved.
std::string name_beside(const std::string& output, const std::string& file) {
  const std::filesystem::path path(output);
  return path.parent_path() == std::filesystem::path(file).parent_path() ? path.filename().string()
                                                                         : output;
}

}  // namespace

Json report_json(const SpeakOptions& options, const speech::Spoken& spoken,
                 const dam::SynthesisReport& synthesis, const ShownFace& shown) {
  Json replaced = Json::object();
  for (const auto& [label, by] : synthesis.replaced) replaced[label] = by;
  const bool heard = spoken.heard.has_value();
  Json json = {{"output", options.outputs.front()},
               {"voice", spoken.voice},
               {"times", speech::name_of(spoken.times)},
               {"approximate", is_approximate(spoken)},
               {"confidence", confidence_of(spoken)},
               {"doubtful_words", doubtful_words(spoken)},
               {"seconds", shown.seconds},
               {"frames", shown.frames},
               {"phones", synthesis.phones},
               {"replaced_phones", synthesis.replaced_phones},
               {"replaced", replaced},
               {"closures_forced", synthesis.closures},
               {"lip_tooth_forced", synthesis.lip_tooth_contacts},
               {"closures", closures_json(shown.lips, 0, 1e9)},
               {"recognised", heard},
               {"languages", json_list(spoken.languages, language_json)},
               {"marks", json_list(spoken.marks,
                                   [](const voice::SpeechMark& mark) -> Json {
                                     return {{"time", mark.time}, {"name", mark.name}};
                                   })},
               {"warnings", spoken.warnings}};
  if (options.outputs.size() > 1) json["outputs"] = options.outputs;
  if (shown.over) json["over"] = over_json(*shown.over);
  if (!spoken.cues.empty()) {
    json["cues"] = json_list(
        spoken.cues, [&](const speech::FittedCue& one) -> Json { return cue_json(one, shown); });
  }
  if (heard) {
    json["warnings"] = spoken.heard->warnings;
    json["heard"] = json_list(heard_phones(spoken), [](const RecognisedPhone& one) -> Json {
      return {{"start", one.phone.start},
              {"end", one.phone.end},
              {"phone", one.phone.label},
              {"confidence", one.confidence}};
    });
    json["words"] = json_list(spoken.heard->words, [](const voice::RecognisedWord& one) -> Json {
      return {{"word", one.text},
              {"start", one.start},
              {"end", one.end},
              {"confidence", one.confidence}};
    });
  }
  return json;
}

Result<void> give_report(const SpeakOptions& options, Json json) {
  if (options.json) std::printf("%s\n", pretty(json).c_str());
  if (options.report.empty()) return {};
  json["output"] = name_beside(options.outputs.front(), options.report);
  if (json.contains("outputs")) {
    for (Json& one : json["outputs"]) one = name_beside(one.text(), options.report);
  }
  return write_file(options.report, pretty(json) + "\n");
}

}  // namespace animeme::tools
