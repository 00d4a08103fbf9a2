#include "tools/view/studio/vowel_chart.h"

#include <cmath>
#include <string_view>

#include "dam/script/ipa.h"
#include "dam/script/phones.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/synthesise.h"
#include "fap/fill.h"
#include "tools/formats/common/text.h"
#include "tools/formats/common/xml.h"
#include "tools/formats/files/base64.h"
#include "tools/view/render/png.h"

namespace animeme::studio {
namespace {

struct Place {
  std::string_view ipa;
  int row, column;
};
constexpr Place kChart[] = {{"", 3, 0},  {"i", 0, 0}, {"y", 0, 1}, {"ɨ", 0, 2}, {"ʉ", 0, 3},
                            {"ɯ", 0, 4}, {"u", 0, 5}, {"ɪ", 1, 0}, {"ʏ", 1, 1}, {"ʊ", 1, 5},
                            {"e", 2, 0}, {"ø", 2, 1}, {"ɘ", 2, 2}, {"ɵ", 2, 3}, {"ɤ", 2, 4},
                            {"o", 2, 5}, {"ə", 3, 2}, {"ɛ", 4, 0}, {"œ", 4, 1}, {"ɜ", 4, 2},
                            {"ɞ", 4, 3}, {"ʌ", 4, 4}, {"ɔ", 4, 5}, {"æ", 5, 0}, {"ɐ", 5, 2},
                            {"a", 6, 0}, {"ɶ", 6, 1}, {"ɑ", 6, 4}, {"ɒ", 6, 5}};

constexpr double kAround = 0.5, kHeldFor = 0.3;  // seconds, as dam/speaking/poses.h
constexpr int kRate = 100;

// Its phones between pauses, in the order of their time.
dam::Script script_of(const std::vector<dam::IpaPhone>& phones) {
  dam::Script script;
  double at = kAround;
  script.phones.push_back({0, at, std::string(dam::kSilence), ""});
  for (const dam::IpaPhone& phone : phones) {
    const double end = at + phone.share * kHeldFor;
    script.phones.push_back({at, end, std::string(phone.label), ""});
    at = end;
  }
  script.phones.push_back({at, at + kAround, std::string(dam::kSilence), ""});
  return script;
}

// Adds a frame of all controls to the poses.
Result<void> add_pose(const dam::Model& model, const std::vector<dam::IpaPhone>& phones,
                      dam::Signal& poses) {
  if (phones.empty()) {
    for (const dam::Control& control : model.controls) poses.values.push_back(control.rest);
    return {};
  }
  dam::SynthesisOptions options;
  options.rate = {kRate, 1};
  options.articulation = std::nullopt;
  const auto signal = dam::synthesise(model, script_of(phones), options);
  if (!signal) return signal.error();
  const auto middle = std::size_t(std::lround((kAround + kHeldFor / 2) * kRate));
  for (std::size_t c = 0; c < model.controls.size(); ++c) {
    poses.values.push_back(signal->at(middle, c));
  }
  return {};
}

Result<ChartVowel> vowel_at(const Place& place, std::vector<dam::IpaPhone>& phones) {
  ChartVowel vowel{.ipa = std::string(place.ipa), .name = "rest", .row = place.row};
  vowel.column = place.column;
  if (place.ipa.empty()) return vowel;
  auto said = dam::parse_ipa(place.ipa);
  if (!said) return said.error();
  phones = std::move(*said);
  const auto sounds = dam::parse_ipa_sounds(place.ipa);
  if (!sounds) return sounds.error();
  vowel.name = dam::describe(sounds->front().heard.front());
  for (const dam::IpaPhone& phone : phones) {
    vowel.phones += (vowel.phones.empty() ? "" : " ") + std::string(phone.label);
  }
  return vowel;
}

constexpr int kMargin = 16, kText = 38, kGap = 8, kHead = 44;
constexpr const char* kRowNames[kChartRows] = {"close",    "near-close", "close-mid", "mid",
                                               "open-mid", "near-open",  "open"};
constexpr const char* kColumnNames[] = {"front", "central", "back"};

std::string text_at(double x, double y, const char* style, const std::string& text) {
  return tools::format("<text x=\"%.0f\" y=\"%.0f\" %s>", x, y, style) + tools::escape_xml(text) +
         "</text>\n";
}

}  // namespace

Result<std::vector<ChartVowel>> chart_vowels(const dam::Model& model) {
  std::vector<ChartVowel> vowels;
  dam::Signal poses;
  poses.rate = {kRate, 1};
  for (const dam::Control& control : model.controls) poses.names.push_back(control.name);
  for (const Place& place : kChart) {
    std::vector<dam::IpaPhone> phones;
    auto vowel = vowel_at(place, phones);
    if (!vowel) return vowel.error();
    if (auto added = add_pose(model, phones, poses); !added) return added.error();
    vowels.push_back(std::move(*vowel));
  }
  const auto clip = dam::to_sequence(poses);
  if (!clip) return clip.error();
  const auto filled = fap::fill(*clip, {.complete = true});
  if (!filled) return filled.error();
  for (std::size_t i = 0; i < vowels.size(); ++i) {
    ChartVowel& vowel = vowels[i];
    vowel.frame = filled->frames[i];
    const auto value = [&](int fap) { return double(vowel.frame.value[std::size_t(fap)]); };
    vowel.gap = 0 - (value(4) + value(5));
    vowel.width = value(6) + value(7);
    vowel.forward = (value(16) + value(17)) / 2;
  }
  return vowels;
}

Result<std::string> vowel_chart_svg(const HeadLook& look, std::span<const ChartVowel> vowels,
                                    const tools::Log& log) {
  auto view = HeadView::make(look, log);
  if (!view) return view.error();
  const int wide = look.width + kGap, tall = look.height + kText + kGap, left = kMargin + 80;
  const int width = left + kChartColumns * wide + kMargin;
  const int height = kHead + kChartRows * tall + kMargin;
  std::string body;
  for (int k = 0; k < 3; ++k) {
    body += text_at(left + (2 * k + 1) * wide, 26, "font-weight=\"bold\" font-size=\"15\"",
                    std::string(kColumnNames[k]) + ": unrounded, rounded");
  }
  for (int k = 0; k < kChartRows; ++k) {
    body += text_at(kMargin, kHead + k * tall + look.height / 2.0,
                    "text-anchor=\"start\" font-weight=\"bold\"", kRowNames[k]);
  }
  for (const ChartVowel& vowel : vowels) {
    const auto png = render::png_of(view->draw(vowel.frame));
    if (!png) return png.error();
    const int x = left + vowel.column * wide, y = kHead + vowel.row * tall;
    body += tools::format("<image x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" href=\"", x, y,
                          look.width, look.height) +
            "data:image/png;base64," + tools::base64_of(*png) + "\"/>\n";
    const double middle = x + look.width / 2.0;
    body += text_at(middle, y + look.height + 16, "font-weight=\"bold\" font-size=\"15\"",
                    vowel.ipa.empty() ? vowel.name : vowel.ipa + "  " + vowel.phones);
    body += text_at(middle, y + look.height + 31, "fill=\"#555\" font-size=\"11\"",
                    tools::format("gap %.0f, width %+.0f", vowel.gap, vowel.width));
  }
  return tools::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
             "viewBox=\"0 0 %d %d\" font-family=\"sans-serif\" font-size=\"12\" "
             "text-anchor=\"middle\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
             width, height, width, height) +
         body + "</svg>\n";
}

}  // namespace animeme::studio
