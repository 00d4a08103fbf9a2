#include "tools/view/sheet/sheet.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "dam/signal/fap_signal.h"
#include "fap/fill.h"
#include "tools/formats/common/text.h"
#include "tools/formats/common/xml.h"
#include "tools/view/plot/sentences.h"

namespace animeme::sheet {

namespace {

using tools::format;

constexpr std::uint32_t kRare = 12;  // examples
constexpr std::size_t kWorstSentences = 8;

std::string row(const std::string& name, const std::string& value, const std::string& says) {
  return "<tr><th>" + name + "</th><td class=\"n\">" + value + "</td><td>" + says + "</td></tr>\n";
}

const char* alike(double correlation) {
  if (correlation >= 0.8) return "moves like the recording";
  if (correlation >= 0.65) return "moves mostly like the recording";
  if (correlation >= 0.45) return "follows the recording, with visible differences";
  return "has little to do with the recording";
}

const char* lively(double ratio) {
  if (ratio < 0.6) return "much calmer than the recording; --style raises it";
  if (ratio < 0.85) return "calmer than the recording";
  if (ratio <= 1.15) return "as lively as the recording";
  return "livelier than the recording";
}

std::string closures(const dam::ClosureScore& score) {
  if (score.phones == 0) return {};
  const bool fewer = score.predicted < score.measured - 0.02;
  return row("P, B, M closed", format("%.1f %%", 100 * score.predicted),
             format("of %zu; the recording closes %.1f %%%s", score.phones, 100 * score.measured,
                    fewer ? ": open lips are the most visible error" : "")) +
         row("other lip closures", format("%.1f", score.false_per_minute),
             "per minute where the recording stays open");
}

std::string contacts(const dam::ContactScore& score) {
  if (score.phones == 0) return {};
  return row("F, V on the teeth", format("%.1f %%", 100 * score.predicted),
             format("of %zu; the recording %.1f %%", score.phones, 100 * score.measured));
}

std::string timing(const dam::TimingScore& score) {
  if (!score.all.lag) return {};
  return row("synchronisation", format("%+.0f ms", *score.all.lag), dam::sync_text(score.sync));
}

std::uint32_t examples_of(const dam::Model* model, const std::string& phone) {
  const std::int32_t p = model != nullptr ? model->find_phone(phone) : -1;
  return p < 0 ? 0 : model->phones[std::size_t(p)].examples;
}

std::string bar(double share) {
  return format("<div class=\"bar\"><div style=\"width:%.1f%%\"></div></div>",
                100 * std::clamp(share, 0.0, 1.0));
}

// Escaped for HTML.
std::string safe(const std::string& text) { return tools::escape_xml(text); }

// The figures that people ask for first, each with a sentence of what it says.
std::string figures(const dam::Evaluation& e) {
  std::string html = "<table class=\"figures\">\n";
  html += row("similarity", format("%.2f", e.correlation),
              std::string(alike(e.correlation)) + " (mean correlation; 1 is the same)");
  html += row("error", format("%.2f", e.nrmse),
              format("relative to the motion of the face; a still face has %.2f", e.still_nrmse));
  html += closures(e.closure) + contacts(e.contact) + timing(e.timing);
  html += row("liveliness", format("%.2f", e.dynamics.velocity), lively(e.dynamics.velocity));
  html += row("measured on", format("%zu", e.utterances),
              format("sentences, %.0f s of speech", e.seconds));
  return html + "</table>\n";
}

// Bars of error by sound, the largest first; what training had few examples of is marked. `model`
// may be nothing.
std::string sounds(const dam::Evaluation& evaluation, const dam::Model* model) {
  std::vector<dam::GroupScore> phones = evaluation.breakdown.phones;
  std::erase_if(phones, [](const dam::GroupScore& phone) { return phone.frames == 0; });
  if (phones.empty()) return {};
  std::stable_sort(phones.begin(), phones.end(),
                   [](const auto& a, const auto& b) { return a.nrmse > b.nrmse; });
  const double most = phones.front().nrmse;
  std::string html =
      "<table class=\"sounds\"><tr><th>phone</th><th>error</th><td></td><th>here</th>";
  html += model != nullptr ? "<th>in training</th></tr>\n" : "</tr>\n";
  for (const dam::GroupScore& phone : phones) {
    html += "<tr><th>" + safe(phone.name) + "</th>" +
            format("<td class=\"n\">%.2f</td>", phone.nrmse) + "<td>" + bar(phone.nrmse / most) +
            "</td>" + format("<td class=\"n\">%zu</td>", phone.phones);
    if (model != nullptr) {
      const std::uint32_t examples = examples_of(model, phone.name);
      html += examples == 0      ? "<td class=\"rare\">none: uses a similar phone</td>"
              : examples < kRare ? format("<td class=\"rare\">%u: record more</td>", examples)
                                 : format("<td class=\"n\">%u</td>", examples);
    }
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

// Error, likeness and liveliness of each control.
std::string controls(const dam::Evaluation& e) {
  std::string html =
      "<table class=\"controls names\"><tr><th>control</th><th>similarity</th><th>error</th>"
      "<td></td><th>liveliness</th></tr>\n";
  for (std::size_t c = 0; c < e.controls.size(); ++c) {
    const dam::SeriesScore& control = e.controls[c];
    if (control.nrmse == 0 && control.correlation == 0) continue;
    html += "<tr><th>" + safe(control.name) + "</th>" +
            format("<td class=\"n\">%.2f</td><td class=\"n\">%.2f</td><td>", control.correlation,
                   control.nrmse) +
            bar(control.nrmse) + "</td>";
    html += c < e.series_dynamics.size()
                ? format("<td class=\"n\">%.2f</td></tr>\n", e.series_dynamics[c].velocity)
                : std::string("<td></td></tr>\n");
  }
  return html + "</table>\n";
}

// The sentences with the largest errors, with what is said in them.
std::string sentences(const dam::Evaluation& e, const std::vector<dam::SentencePair>& pairs) {
  std::vector<std::size_t> order(e.per_utterance.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return e.per_utterance[a].nrmse > e.per_utterance[b].nrmse;
  });
  std::string html =
      "<table class=\"names\"><tr><th>sentence</th><th>error</th><th>what is said</th></tr>\n";
  for (std::size_t i = 0; i < std::min(kWorstSentences, order.size()); ++i) {
    const dam::UtteranceScore& one = e.per_utterance[order[i]];
    html += "<tr><th>" + safe(one.id) + "</th>" + format("<td class=\"n\">%.2f</td>", one.nrmse) +
            "<td>" + safe(pairs[order[i]].recorded.text) + "</td></tr>\n";
  }
  return html + "</table>\n";
}

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --line: #8884; --bar: #3b7dd8; --rare: #b4380a; }
@media (prefers-color-scheme: dark) { :root { --rare: #fb923c; } }
body { font: 16px/1.45 system-ui, sans-serif; max-width: 1000px; margin: 2rem auto; padding: 0 1rem; }
h1 { margin-bottom: 0; } h3::first-letter { text-transform: uppercase; } h2 { margin-top: 2.2rem; border-bottom: 1px solid var(--line); }
h1, h3, p, th, td { overflow-wrap: anywhere; }
p.about { margin-top: .2rem; opacity: .75; }
table { border-collapse: collapse; } th { text-align: left; font-weight: 600; }
th, td { padding: .15rem .8rem .15rem 0; vertical-align: top; } td.n { text-align: right; font-variant-numeric: tabular-nums; }
table.figures td.n { font-size: 1.25rem; } .rare { color: var(--rare); }
.bar { width: clamp(2rem, 18vw, 14rem); height: .8em; margin-top: .35em; background: var(--line); border-radius: .4em; }
.bar div { height: 100%; background: var(--bar); border-radius: .4em; }
.curves { overflow-x: auto; background: #fff; border-radius: .5rem; } .curves svg { display: block; }
iframe { box-sizing: border-box; width: 100%; height: 34rem; border: 1px solid var(--line); border-radius: .5rem; }
@media (max-width: 600px) {
  body { margin: 1rem auto; padding: 0 .8rem; } th, td { padding-right: .5rem; }
  .names th { font-size: .85rem; }
}
)";

/// The motion of a signal, complete, as a page shows it.
Result<fap::Sequence> shown(const dam::Signal& signal) {
  const auto clip = dam::to_sequence(signal);
  if (!clip) return clip;
  fap::FillOptions whole;
  whole.complete = true;
  return fap::fill(*clip, whole);
}

/// A sentence on the head, in a page of its own.
Result<std::string> sample(const Sheet& sheet, std::size_t number, const char* which) {
  const dam::SentencePair& pair = (*sheet.pairs)[number];
  viewer::Page page{.head = sheet.head,
                    .rig = sheet.rig,
                    .clips = {},
                    .sound = {},
                    .script = pair.recorded.script};
  const std::array<std::pair<const dam::Signal*, const char*>, 2> sides = {
      {{&pair.recorded.signal, "recorded"}, {&pair.synthesised, "made"}}};
  for (const auto& [signal, name] : sides) {
    auto motion = shown(*signal);
    if (!motion) return std::move(motion).error();
    page.clips.push_back({std::move(*motion), 0, name});
  }
  if (sheet.sound) page.sound = sheet.sound(pair.recorded.id);
  const auto html = viewer::make_page(page);
  if (!html) return html.error();
  const dam::UtteranceScore& score = sheet.evaluation->per_utterance[number];
  return "<h3>" + safe(which) + ": " + safe(pair.recorded.id) +
         tools::format(", error %.2f", score.nrmse) + "</h3>\n<p>" + safe(pair.recorded.text) +
         "</p>\n<iframe loading=\"lazy\" title=\"" + safe(pair.recorded.id) + "\" srcdoc=\"" +
         safe(*html) + "\"></iframe>\n";
}

Result<std::string> samples(const Sheet& sheet) {
  if (sheet.head == nullptr || sheet.rig == nullptr) return std::string();
  const std::string begin = "<h2>On the head</h2>\n";
  if (!dam::to_sequence((*sheet.pairs)[0].synthesised))
    return begin +
           "<p>The controls of this character are neither FAPs nor ARKit shapes, so no head "
           "shows them here.</p>\n";
  std::string html = begin;
  for (const auto& [place, number] : plot::chosen_sentences(*sheet.evaluation)) {
    const auto one = sample(sheet, number, place);
    if (!one) return one;
    html += *one;
  }
  return html;
}

std::string about(const Sheet& sheet) {
  std::string text = "<p class=\"about\">measured on " + safe(sheet.corpus);
  if (sheet.model != nullptr) {
    text += tools::format("; method %s, %zu controls, %zu phones",
                          std::string(dam::method_name(sheet.model->method)).c_str(),
                          sheet.model->controls.size(), sheet.model->phones.size());
    if (!sheet.model->provenance.empty()) text += "<br>" + safe(sheet.model->provenance);
    if (!sheet.model->attribution.empty()) text += "<br>" + safe(sheet.model->attribution);
  }
  return text + "</p>\n";
}

}  // namespace

Result<std::string> make_sheet(const Sheet& sheet) {
  if (sheet.pairs == nullptr || sheet.evaluation == nullptr || sheet.pairs->empty() ||
      sheet.evaluation->per_utterance.size() != sheet.pairs->size())
    return make_error(Code::invalid_argument, "a sheet needs sentences and their evaluation");
  const auto curves = plot::sentences_svg(*sheet.pairs, *sheet.evaluation);
  if (!curves) return curves.error();
  const auto heads = samples(sheet);
  if (!heads) return heads.error();
  const std::string title = safe(sheet.title);
  return "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src "
         "'unsafe-inline' 'wasm-unsafe-eval'; "
         "style-src 'unsafe-inline'; img-src data:; media-src data: blob:; frame-src "
         "'self'\">\n<title>" +
         title + "</title>\n<style>" + kStyle + "</style>\n<main>\n<h1>" + title + "</h1>\n" +
         about(sheet) + figures(*sheet.evaluation) +
         "<h2>Curves</h2>\n<div class=\"curves\" role=\"region\" aria-label=\"Curves of the best, "
         "the median and the worst sentence\" tabindex=\"0\">" +
         *curves + "</div>\n" + *heads +
         "<h2>Phones</h2>\n<p>Errors by phone, largest first; 1 is the error of a mouth that does "
         "not move.</p>\n" +
         sounds(*sheet.evaluation, sheet.model) + "<h2>Controls</h2>\n" +
         controls(*sheet.evaluation) +
         "<h2>Outliers</h2>\n<p>Often they have the wrong labels or tracking errors: check them "
         "first.</p>\n" +
         sentences(*sheet.evaluation, *sheet.pairs) + "</main>\n</html>\n";
}

}  // namespace animeme::sheet
