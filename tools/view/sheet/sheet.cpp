#include "tools/view/sheet/sheet.h"

#include <array>

#include "dam/signal/fap_signal.h"
#include "fap/fill.h"
#include "tools/formats/common/text.h"
#include "tools/view/plot/sentences.h"
#include "tools/view/sheet/tables_internal.h"

namespace animeme::sheet {
namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --line: #8884; --bar: #3b7dd8; --rare: #c2410c; }
body { font: 16px/1.45 system-ui, sans-serif; max-width: 1000px; margin: 2rem auto; padding: 0 1rem; }
h1 { margin-bottom: 0; } h3::first-letter { text-transform: uppercase; } h2 { margin-top: 2.2rem; border-bottom: 1px solid var(--line); }
p.about { margin-top: .2rem; opacity: .75; }
table { border-collapse: collapse; } th { text-align: left; font-weight: 600; }
th, td { padding: .15rem .8rem .15rem 0; vertical-align: top; } td.n { text-align: right; font-variant-numeric: tabular-nums; }
table.figures td.n { font-size: 1.25rem; } .rare { color: var(--rare); }
.bar { width: 14rem; height: .8em; margin-top: .35em; background: var(--line); border-radius: .4em; }
.bar div { height: 100%; background: var(--bar); border-radius: .4em; }
.curves { overflow-x: auto; background: #fff; border-radius: .5rem; } .curves svg { display: block; }
iframe { width: 100%; height: 34rem; border: 1px solid var(--line); border-radius: .5rem; }
details summary { cursor: pointer; }
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
         title + "</title>\n<style>" + kStyle + "</style>\n<h1>" + title + "</h1>\n" +
         about(sheet) + figures(*sheet.evaluation) + "<h2>Curves</h2>\n<div class=\"curves\">" +
         *curves + "</div>\n" + *heads +
         "<h2>Phones</h2>\n<p>Errors by phone, largest first; 1 is the error of a mouth that does "
         "not move.</p>\n" +
         sounds(*sheet.evaluation, sheet.model) + "<h2>Controls</h2>\n" +
         controls(*sheet.evaluation) +
         "<h2>Outliers</h2>\n<p>Often they have the wrong labels or tracking errors: check them "
         "first.</p>\n" +
         sentences(*sheet.evaluation, *sheet.pairs) + "</html>\n";
}

}  // namespace animeme::sheet
