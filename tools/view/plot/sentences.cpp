#include "tools/view/plot/sentences.h"

#include <algorithm>
#include <numeric>

#include "dam/signal/closure.h"
#include "dam/signal/fap_signal.h"
#include "tools/formats/common/text.h"
#include "tools/view/plot/curves.h"

namespace animeme::plot {

namespace {

constexpr const char* kInnerGap = "inner gap";

// A curve of the picture: a weighted sum of channels.
struct SentenceCurve {
  std::string title, subtitle;
  std::vector<std::pair<std::string, double>> parts;
};

std::string channel_of(const std::vector<std::string>& names, int fap) {
  for (const std::string& name : names) {
    if (dam::fap_of_channel(name) == fap) return name;
  }
  return {};
}

// Jaw, gap and width as far as both sides have their FAPs; else the first three controls.
std::vector<SentenceCurve> curves_of(const dam::SentencePair& pair) {
  std::vector<std::string> both;
  for (const std::string& name : pair.synthesised.names) {
    const auto& recorded = pair.recorded.signal.names;
    if (std::find(recorded.begin(), recorded.end(), name) != recorded.end()) both.push_back(name);
  }
  std::vector<SentenceCurve> curves;
  const auto add = [&](const char* title, const char* subtitle,
                       std::initializer_list<std::pair<int, double>> faps) {
    SentenceCurve curve{title, subtitle, {}};
    for (const auto& [fap, weight] : faps) {
      if (channel_of(both, fap).empty()) return;
      curve.parts.emplace_back(channel_of(both, fap), weight);
    }
    curves.push_back(std::move(curve));
  };
  add("jaw", "FAP 3", {{3, 1}});
  add(kInnerGap, "-(FAP 4 + FAP 5)", {{4, -1}, {5, -1}});
  add("width", "FAP 6 + FAP 7", {{6, 1}, {7, 1}});
  if (!curves.empty()) return curves;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, both.size()); ++i) {
    curves.push_back({both[i], "", {{both[i], 1}}});
  }
  return curves;
}

Points points(const dam::Signal& signal, const SentenceCurve& curve) {
  Points out;
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    double value = 0;
    for (const auto& [name, weight] : curve.parts) {
      const auto at = std::find(signal.names.begin(), signal.names.end(), name);
      value += weight * signal.at(i, std::size_t(at - signal.names.begin()));
    }
    out.emplace_back(signal.rate.seconds(double(i)), value);
  }
  return out;
}

// When the lips are shut for P, B and M.
Stretches closures(const dam::Signal& signal, const dam::Script& script) {
  constexpr double kReach = 0.2;  // seconds from the least gap
  Stretches stretches;
  const auto lips = dam::inner_lip_channels(signal.names);
  if (!lips) return stretches;
  for (const dam::Phone& phone : script.phones) {
    if (!dam::is_bilabial(phone.label)) continue;
    const auto shut = dam::closed_span(signal, phone, *lips, kReach);
    if (!shut) continue;
    const double at = double(signal.first_frame + shut->least);
    stretches.emplace_back(signal.rate.seconds(at - shut->before),
                           signal.rate.seconds(at + shut->after));
  }
  return stretches;
}

Panel panel_of(const char* place, const dam::SentencePair& pair, double nrmse) {
  Panel panel;
  const std::string& text = pair.recorded.text;
  panel.heading = std::string(place) + ": " + pair.recorded.id +
                  (text.empty() ? "" : " \"" + text + "\"") +
                  tools::format("  (NRMSE %.3f)", nrmse);
  panel.seconds = pair.synthesised.rate.seconds(double(pair.synthesised.frames()));
  panel.script = &pair.recorded.script;
  panel.names_below = true;
  for (const SentenceCurve& curve : curves_of(pair)) {
    panel.rows.push_back({curve.title,
                          curve.subtitle,
                          "",
                          {points(pair.recorded.signal, curve), points(pair.synthesised, curve)}});
    if (curve.title != kInnerGap) continue;
    const dam::Script& script = pair.recorded.script;
    panel.rows.back().unit = "bars: P B M shut";
    panel.rows.back().bars = {closures(pair.recorded.signal, script),
                              closures(pair.synthesised, script)};
  }
  return panel;
}

}  // namespace

std::vector<ChosenSentence> chosen_sentences(const dam::Evaluation& evaluation) {
  std::vector<std::size_t> order(evaluation.per_utterance.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return evaluation.per_utterance[a].nrmse < evaluation.per_utterance[b].nrmse;
  });
  std::vector<ChosenSentence> chosen;
  if (!order.empty()) chosen.push_back({"best", order.front()});
  if (order.size() > 2) chosen.push_back({"median", order[order.size() / 2]});
  if (order.size() > 1) chosen.push_back({"worst", order.back()});
  return chosen;
}

Result<std::string> sentences_svg(const std::vector<dam::SentencePair>& pairs,
                                  const dam::Evaluation& evaluation) {
  std::vector<Panel> panels;
  for (const auto& [place, index] : chosen_sentences(evaluation)) {
    panels.push_back(panel_of(place, pairs[index], evaluation.per_utterance[index].nrmse));
    if (panels.back().seconds > kLongest) {
      return make_error(Code::out_of_range,
                        "sentence '" + pairs[index].recorded.id + "' is too long to draw");
    }
  }
  return curves_svg(panels, {"recorded", "made"});
}

}  // namespace animeme::plot
