// Events of speech services, which tell when something begins: Azure Speech, Amazon Polly.
#include <algorithm>

#include "dam/script/words.h"
#include "tools/formats/scripts/detail/json_script.h"

namespace animeme::scripts {

namespace {

using dam::TimedLabel;

// A viseme or a phone lasts to the next one; a word at most as long as it usually takes.
double longest(const TimedLabel& label) {
  return label.is_word ? 0.2 + 0.1 * double(label.label.size()) : 0.15;
}

// Visemes if there are any, with the words that they belong to; else the words.
void keep_best(std::vector<TimedLabel> visemes, std::vector<TimedLabel> words, JsonLabels& out) {
  const auto by_start = [](const TimedLabel& a, const TimedLabel& b) { return a.start < b.start; };
  std::stable_sort(visemes.begin(), visemes.end(), by_start);
  std::stable_sort(words.begin(), words.end(), by_start);
  dam::end_at_next_start(visemes, longest);
  dam::end_at_next_start(words, longest);
  if (visemes.empty()) {
    out.labels = std::move(words);
    return;
  }
  dam::attach_words(visemes, words);
  out.alphabet = dam::Alphabet::arpabet;
  out.labels = std::move(visemes);
}

// The label that add() put at the end.
TimedLabel taken(JsonLabels& out) {
  TimedLabel label = std::move(out.labels.back());
  out.labels.pop_back();
  return label;
}

// Azure: the arguments of events, as the libraries of its languages name them, or the messages that
// they come from.

Node offset_of(const Node& event) {
  return event.member({"audiooffset", "offset", "audiooffsetms", "offsetms"});
}
Node azure_text(const Node& event) {
  const Node text = event.member({"text"});
  return text.is_object() ? text.member({"text"}) : text;
}

bool is_azure_event(const Node& node) {
  if (!offset_of(node).number()) return false;
  return node.member({"visemeid"}).exists() || azure_text(node).text().has_value();
}

bool is_azure(const std::vector<Node>& roots) {
  return !find_objects(roots, is_azure_event).empty();
}

// Most of Azure counts units of 100 ns, batch synthesis milliseconds, and who keeps events often
// makes seconds of them. Events are 20 ms to a few seconds apart: 200,000 and more of the first, 20
// and more of the second.
double azure_rate(const std::vector<Node>& events) {
  std::vector<double> offsets;
  for (const Node& event : events) offsets.push_back(*offset_of(event).number());
  std::sort(offsets.begin(), offsets.end());
  if (offsets.size() < 2) return offsets.empty() || offsets[0] < 50000 ? 1000 : 1e7;
  const double apart = (offsets.back() - offsets.front()) / double(offsets.size() - 1);
  return apart > 20000 ? 1e7 : apart > 8 ? 1000 : 1;
}

Result<void> read_azure(const std::vector<Node>& roots, const dam::ScriptOptions& options,
                        JsonLabels& out) {
  const std::vector<Node> events = find_objects(roots, is_azure_event);
  const double rate = options.rate > 0 ? options.rate : azure_rate(events);
  std::vector<TimedLabel> visemes, words;
  for (const Node& event : events) {
    const double start = *offset_of(event).number() / rate;
    const Node id = event.member({"visemeid"});
    if (id.exists()) {
      const auto number = id.number();
      std::string name = number ? std::to_string(std::int64_t(std::clamp(*number, -1.0, 1e6)))
                                : std::string("(none)");
      auto label = viseme_label(out, event, dam::VisemeSet::azure, name);
      if (!label) return label.error();
      out.add(event, start, start, *std::move(label), false);
      visemes.push_back(taken(out));
      continue;
    }
    const Node nested = event.member({"text"});
    std::string kind = event.member({"boundarytype"}).text().value_or("");
    if (nested.is_object()) kind = nested.member({"boundarytype"}).text().value_or(kind);
    if (!kind.empty() && kind.find("Word") == std::string::npos) continue;  // a comma, a sentence
    const double length = event.member({"duration"}).number().value_or(0) / rate;
    out.add(event, start, start + std::max(length, 0.0), *azure_text(event).text(), true);
    words.push_back(taken(out));
  }
  keep_best(std::move(visemes), std::move(words), out);
  return {};
}

// Polly: a JSON a line, milliseconds.

bool is_polly_mark(const Node& node) {
  const auto type = node.member({"type"}).text();
  return type && node.member({"time"}).number() && node.member({"value"}).exists();
}

bool is_polly(const std::vector<Node>& roots) {
  return !find_objects(roots, is_polly_mark).empty();
}

Result<void> read_polly(const std::vector<Node>& roots, const dam::ScriptOptions& options,
                        JsonLabels& out) {
  const double rate = options.rate > 0 ? options.rate : 1000;
  std::vector<TimedLabel> visemes, words;
  for (const Node& mark : find_objects(roots, is_polly_mark)) {
    const double start = *mark.member({"time"}).number() / rate;
    const std::string type = *mark.member({"type"}).text();
    const std::string value = mark.member({"value"}).text().value_or("");
    if (type == "viseme") {
      auto label = viseme_label(out, mark, dam::VisemeSet::polly, value);
      if (!label) return label.error();
      out.add(mark, start, start, *std::move(label), false);
      visemes.push_back(taken(out));
    } else if (type == "word") {
      out.add(mark, start, start, value, true);
      words.push_back(taken(out));
    }
  }
  keep_best(std::move(visemes), std::move(words), out);
  return {};
}

constexpr JsonFormat kEvents[] = {
    {{"polly", "speech marks of Amazon Polly"}, is_polly, read_polly},
    {{"azure", "viseme and word boundary events of Azure Speech"}, is_azure, read_azure},
};

}  // namespace

std::span<const JsonFormat> event_formats() { return kEvents; }

}  // namespace animeme::scripts
