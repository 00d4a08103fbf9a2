#include "tools/speech/talking/marks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dam/script/script_text_internal.h"
#include "dam/script/textgrid.h"
#include "tools/formats/common/text.h"

namespace animeme::speech {

namespace {

// An interval tier has no gaps.
dam::TextGridTier tier_of(std::string name, const std::vector<Doubt>& parts, double end) {
  dam::TextGridTier tier{std::move(name), false, {}};
  double now = 0;
  for (const Doubt& part : parts) {
    if (part.start > now) tier.items.push_back({now, part.start, "", 0, 0});
    tier.items.push_back({part.start, part.end, part.text, 0, 0});
    now = part.end;
  }
  if (end > now) tier.items.push_back({now, end, "", 0, 0});
  return tier;
}

void add_doubts(const dam::Script& script, const Doubts& doubts, dam::TextGrid& grid) {
  std::vector<Doubt> phones, doubtful;
  for (std::size_t i = 0; i < std::min(script.phones.size(), doubts.confidences.size()); ++i) {
    const dam::Phone& phone = script.phones[i];
    if (phone.label == dam::kSilence || phone.end <= phone.start) continue;
    phones.push_back({phone.start, phone.end, tools::format("%.2f", doubts.confidences[i]), 0});
  }
  for (Doubt one : doubts.doubtful) {
    one.end = std::min(one.end, grid.end);
    if (one.end <= one.start) continue;
    one.text += tools::format(" %.2f", one.confidence);
    doubtful.push_back(std::move(one));
  }
  grid.tiers.push_back(tier_of("confidence", phones, grid.end));
  grid.tiers.push_back(tier_of("doubtful", doubtful, grid.end));
}

}  // namespace

Doubts doubts_of(const std::vector<double>& confidences,
                 const std::vector<voice::AlignedWord>& words) {
  Doubts doubts{confidences, {}};
  for (const voice::AlignedWord& word : words) {
    if (!word.said || word.confidence >= voice::kDoubtful || word.end <= word.start) continue;
    doubts.doubtful.push_back({word.start, word.end, word.text, word.confidence});
  }
  return doubts;
}

Doubts doubts_of(const dam::Script& script, const std::vector<double>& confidences) {
  Doubts doubts{confidences, {}};
  bool before = false;  // the phone before is doubtful
  double weighted = 0;
  for (std::size_t i = 0; i < std::min(script.phones.size(), confidences.size()); ++i) {
    const dam::Phone& phone = script.phones[i];
    const bool now =
        phone.label != dam::kSilence && confidences[i] < kDoubtfulPhone && phone.end > phone.start;
    if (now && !before) {
      doubts.doubtful.push_back({phone.start, phone.end, phone.label, 0});
      weighted = 0;
    } else if (now) {
      doubts.doubtful.back().text += " " + phone.label;
      doubts.doubtful.back().end = phone.end;
    }
    if (now) {
      Doubt& part = doubts.doubtful.back();
      weighted += confidences[i] * (phone.end - phone.start);
      part.confidence = weighted / (part.end - part.start);
    }
    before = now;
  }
  return doubts;
}

std::string write_marked_script(const dam::Script& script,
                                const std::vector<voice::SpeechMark>& marks,
                                std::string_view ending, const Doubts& doubts) {
  std::string text = dam::write_script(script, ending);
  if (marks.empty() && doubts.confidences.empty()) return text;
  const std::string kind = dam::lower_case(ending);
  if (kind == ".vtt") {
    for (const voice::SpeechMark& mark : marks) {
      const auto ms = std::llround(mark.time * 1000);
      std::string name = mark.name;
      std::replace(name.begin(), name.end(), '\n', ' ');
      // An arrow would end the comment.
      for (std::size_t at = 0; (at = name.find("-->", at)) != std::string::npos;) {
        name.replace(at, 3, "- ->");
      }
      text += tools::format("\nNOTE mark %02lld:%02lld:%02lld.%03lld ", (long long)(ms / 3600000),
                            (long long)(ms / 60000 % 60), (long long)(ms / 1000 % 60),
                            (long long)(ms % 1000)) +
              name + "\n";
    }
    return text;
  }
  if (kind != ".textgrid") return text;
  auto grid = dam::parse_textgrid(text);
  if (!grid) return text;
  if (!doubts.confidences.empty()) add_doubts(script, doubts, *grid);
  if (!marks.empty()) {
    dam::TextGridTier tier{"marks", true, {}};
    for (const voice::SpeechMark& mark : marks) {
      tier.items.push_back({mark.time, mark.time, mark.name, 0, 0});
    }
    grid->tiers.push_back(std::move(tier));
  }
  return dam::format_textgrid(*grid);
}

}  // namespace animeme::speech
