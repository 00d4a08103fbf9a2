#include "tools/view/sheet/tables_internal.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/formats/common/text.h"
#include "tools/formats/common/xml.h"

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

}  // namespace

std::string safe(const std::string& text) { return tools::escape_xml(text); }

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

std::string sounds(const dam::Evaluation& evaluation, const dam::Model* model) {
  std::vector<dam::GroupScore> phones = evaluation.breakdown.phones;
  std::erase_if(phones, [](const dam::GroupScore& phone) { return phone.frames == 0; });
  if (phones.empty()) return {};
  std::stable_sort(phones.begin(), phones.end(),
                   [](const auto& a, const auto& b) { return a.nrmse > b.nrmse; });
  const double most = phones.front().nrmse;
  std::string html =
      "<table class=\"sounds\"><tr><th>phone</th><th>error</th><th></th><th>here</th>";
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

std::string controls(const dam::Evaluation& e) {
  std::string html =
      "<table "
      "class=\"controls\"><tr><th>control</th><th>similarity</th><th>error</th><th></"
      "th><th>liveliness</th></tr>\n";
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

std::string sentences(const dam::Evaluation& e, const std::vector<dam::SentencePair>& pairs) {
  std::vector<std::size_t> order(e.per_utterance.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return e.per_utterance[a].nrmse > e.per_utterance[b].nrmse;
  });
  std::string html = "<table><tr><th>sentence</th><th>error</th><th>what is said</th></tr>\n";
  for (std::size_t i = 0; i < std::min(kWorstSentences, order.size()); ++i) {
    const dam::UtteranceScore& one = e.per_utterance[order[i]];
    html += "<tr><th>" + safe(one.id) + "</th>" + format("<td class=\"n\">%.2f</td>", one.nrmse) +
            "<td>" + safe(pairs[order[i]].recorded.text) + "</td></tr>\n";
  }
  return html + "</table>\n";
}

}  // namespace animeme::sheet
