#include "tools/characters/capture/corpus_report.h"

#include <algorithm>

#include "dam/script/words.h"
#include "fap/rate_text.h"
#include "tools/formats/common/text.h"

namespace animeme::tools {

namespace {

struct Totals {
  double seconds = 0;
  std::size_t frames = 0, filled = 0, bilabials = 0, closed = 0, doubtful = 0;
  std::size_t tracked = 0, before = 0, aligned = 0;
};

Totals add_up(const CorpusReport& report) {
  Totals totals;
  for (const SentenceReport& one : report.sentences) {
    totals.seconds += one.seconds;
    totals.frames += one.frames;
    totals.filled += one.filled;
    totals.bilabials += one.closures.phones;
    totals.closed += one.closures.closed;
    totals.doubtful += one.doubts.empty() ? 0 : 1;
    totals.tracked += one.source == "tracked" ? 1 : 0;
    totals.before += one.source == "tracked before" ? 1 : 0;
    totals.aligned += one.script == "aligned" ? 1 : 0;
  }
  return totals;
}

// The nose to the mouth as a share of the distance of the eyes, which no camera changes.
double nose_to_mouth(const fap::Fapu& units) { return units.mns / units.es; }

std::string own_units_text(const CorpusReport& report) {
  if (!report.units) return {};
  std::string text = format("neutral face: %s; IRISD %.4g, ES %.4g, ENS %.4g, MNS %.4g, MW %.4g\n",
                            report.neutral.c_str(), report.units->irisd, report.units->es,
                            report.units->ens, report.units->mns, report.units->mw);
  double least = 0;
  double most = 0;
  std::size_t count = 0;
  for (const SentenceReport& one : report.sentences) {
    if (!one.own_units) continue;
    const double share = nose_to_mouth(*one.own_units) / nose_to_mouth(*report.units);
    least = count == 0 ? share : std::min(least, share);
    most = count == 0 ? share : std::max(most, share);
    ++count;
  }
  if (count > 1) {
    text +=
        format("  the individual recordings have an MNS of %.2f to %.2f times that\n", least, most);
  }
  return text;
}

// Text that tables can hold.
std::string field(const std::string& text) {
  std::string out = text;
  for (char& c : out) {
    if (c == '\t' || c == '\n' || c == '\r') c = ' ';
  }
  return out;
}

Json units_json(const std::optional<fap::Fapu>& units) {
  if (!units) return nullptr;
  return {{"IRISD", units->irisd},
          {"ES", units->es},
          {"ENS", units->ens},
          {"MNS", units->mns},
          {"MW", units->mw}};
}

Json closures_json(std::size_t phones, std::size_t closed) {
  return {{"phones", phones},
          {"closed", closed},
          {"share", phones > 0 ? Json(double(closed) / double(phones)) : Json(nullptr)}};
}

Json sentence_json(const SentenceReport& one) {
  Json closures = closures_json(one.closures.phones, one.closures.closed);
  closures["least_gaps"] = one.closures.gaps;
  return {{"id", one.id},
          {"text", one.text},
          {"fold", one.fold},
          {"seconds", one.seconds},
          {"frames", one.frames},
          {"frames_not_measured", one.filled},
          {"capture", one.source},
          {"script", one.script},
          {"phones", one.phones},
          {"closures", std::move(closures)},
          {"own_units", units_json(one.own_units)},
          {"doubts", one.doubts},
          {"warnings", one.warnings}};
}

}  // namespace

std::string report_text(const CorpusReport& report) {
  const Totals totals = add_up(report);
  std::string text = format("%s: %zu sentences, %.1f s, %zu curves at %s frames a second\n",
                            report.folder.c_str(), report.sentences.size(), totals.seconds,
                            report.controls.size(), fap::format_rate(report.rate).c_str());
  if (totals.tracked + totals.before > 0) {
    text += format("videos: %zu tracked, %zu tracked earlier\n", totals.tracked, totals.before);
  }
  text += own_units_text(report);
  if (totals.filled > 0) {
    text += format("unmeasured frames: %zu of %zu\n", totals.filled, totals.frames);
  }
  if (totals.bilabials > 0) {
    text += format("closed P B M: %zu of %zu (%.1f %%)\n", totals.closed, totals.bilabials,
                   100.0 * double(totals.closed) / double(totals.bilabials));
  }
  if (report.lag) {
    text += format("lips close %.0f ms %s the sound\n", std::abs(1000 * *report.lag),
                   *report.lag < 0 ? "before" : "after");
  }
  for (const std::string& warning : report.warnings) text += "warning: " + warning + "\n";
  for (const SentenceReport& one : report.sentences) {
    if (!one.doubts.empty()) text += "doubtful: " + one.id + ": " + joined(one.doubts, "; ") + "\n";
  }
  for (const SentenceReport& one : report.sentences) {
    if (!one.warnings.empty()) text += "note: " + one.id + ": " + joined(one.warnings, "; ") + "\n";
  }
  for (const LeftOut& one : report.left_out) {
    text += "excluded: " + one.id + " (" + one.stage + "): " + one.why + "\n";
  }
  return text;
}

Json report_json(const CorpusReport& report) {
  const Totals totals = add_up(report);
  return {
      {"folder", report.folder},
      {"sentences", report.sentences.size()},
      {"left_out", json_list(report.left_out,
                             [](const LeftOut& one) {
                               return Json{{"id", one.id}, {"stage", one.stage}, {"why", one.why}};
                             })},
      {"seconds", totals.seconds},
      {"frames", totals.frames},
      {"frames_not_measured", totals.filled},
      {"rate", report.rate.frames_per_second()},
      {"controls", report.controls},
      {"tracked", totals.tracked},
      {"tracked_before", totals.before},
      {"aligned", totals.aligned},
      {"closures", closures_json(totals.bilabials, totals.closed)},
      {"lag_seconds", report.lag ? Json(*report.lag) : Json(nullptr)},
      {"neutral", report.units ? Json(report.neutral) : Json(nullptr)},
      {"units", units_json(report.units)},
      {"doubtful", totals.doubtful},
      {"warnings", report.warnings},
      {"per_sentence", json_list(report.sentences, sentence_json)}};
}

std::string utterance_table(const std::vector<SentenceReport>& sentences,
                            const std::vector<bool>& held_out, int folds) {
  const auto part = [](bool test) { return test ? "\ttest" : "\ttrain"; };
  std::string text = "id\ttext\tsplit\tfold";
  for (int fold = 1; fold <= folds; ++fold) text += "\tfold" + std::to_string(fold) + "_split";
  if (!held_out.empty()) text += "\theldout_word_split";
  text += "\tseconds\tdoubtful\n";
  for (std::size_t i = 0; i < sentences.size(); ++i) {
    const SentenceReport& one = sentences[i];
    text += field(one.id) + "\t" + field(one.text) + part(one.fold == 1) + "\t" +
            std::to_string(one.fold);
    for (int fold = 1; fold <= folds; ++fold) text += part(one.fold == fold);
    if (!held_out.empty()) text += part(held_out[i]);
    text += format("\t%.3f\t%d\n", one.seconds, one.doubts.empty() ? 0 : 1);
  }
  return text;
}

std::string words_of_script(const dam::Script& script) {
  std::string text;
  for (const dam::ScriptWord& word : dam::words_of(script))
    text += (text.empty() ? "" : " ") + word.text;
  return text;
}

}  // namespace animeme::tools
