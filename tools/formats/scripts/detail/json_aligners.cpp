// Lists of objects with times: aligners, recognisers, Rhubarb, Kokoro.
#include <algorithm>

#include "dam/script/ipa.h"
#include "dam/script/textgrid.h"
#include "tools/formats/scripts/detail/json_script.h"

namespace animeme::scripts {

namespace {

const Node* first(const std::vector<Node>& nodes) { return nodes.empty() ? nullptr : &nodes[0]; }

Error lacks_time(JsonLabels& out, const Node& node, std::string_view what) {
  return out.error(Code::syntax,
                   "a " + std::string(what) + " needs its times as numbers: start and end", node);
}

// Montreal aligner: the tiers of a TextGrid, as {name: {entries: [[begin, end, label], ...]}}.

Node tiers_of(const std::vector<Node>& roots) {
  return roots.empty() ? Node{} : roots[0].member({"tiers"});
}

bool is_mfa(const std::vector<Node>& roots) { return tiers_of(roots).is_object(); }

Result<void> read_mfa(const std::vector<Node>& roots, const dam::ScriptOptions& options,
                      JsonLabels& out) {
  const Node tiers = tiers_of(roots);
  dam::TextGrid grid;
  if (!tiers.is_object()) return out.error(Code::syntax, "there is no member \"tiers\"", roots[0]);
  for (const auto& [name, value] : tiers.value->items()) {
    const Node tier{&value, tiers.path + "/" + name};
    const Node entries = tier.member({"entries"});
    dam::TextGridTier& read = grid.tiers.emplace_back(dam::TextGridTier{name, false, {}});
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const Node entry = entries.at(i);
      const auto start = entry.at(0).number(), end = entry.at(1).number();
      const auto label = entry.at(2).text();
      if (!start || !end || !label) {
        return out.error(Code::syntax, "an entry of a tier is [begin, end, label]", entry);
      }
      out.paths.push_back(entry.path);
      read.items.push_back({*start, *end, *label, std::int64_t(out.paths.size()), 0});
    }
  }
  auto timings = dam::labels_of_tier(grid, options);
  if (!timings) return timings.error();
  out.labels = std::move(timings->labels);
  return {};
}

// Rhubarb.

bool is_rhubarb(const std::vector<Node>& roots) {
  return !roots.empty() && roots[0].member({"mouthcues"}).is_array();
}

Result<void> read_rhubarb(const std::vector<Node>& roots, const dam::ScriptOptions&,
                          JsonLabels& out) {
  const Node cues = roots[0].member({"mouthcues"});
  out.alphabet = dam::Alphabet::arpabet;
  for (std::size_t i = 0; i < cues.size(); ++i) {
    const Node cue = cues.at(i);
    const auto start = cue.member({"start"}).number(), end = cue.member({"end"}).number();
    if (!start || !end) return lacks_time(out, cue, "mouth cue");
    auto label =
        viseme_label(out, cue, dam::VisemeSet::rhubarb, cue.member({"value"}).text().value_or(""));
    if (!label) return label.error();
    out.add(cue, *start, *end, *std::move(label), false);
  }
  return {};
}

// Gentle: words with a start and phones with durations. What it did not find has no times.

bool is_gentle(const std::vector<Node>& roots) {
  const Node words = roots.empty() ? Node{} : roots[0].member({"words"});
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words.at(i).member({"phones"}).is_array()) return true;
    if (words.at(i).member({"case"}).text()) return true;
  }
  return false;
}

Result<void> read_gentle(const std::vector<Node>& roots, const dam::ScriptOptions&,
                         JsonLabels& out) {
  const Node words = roots[0].member({"words"});
  out.alphabet = dam::Alphabet::arpabet;
  std::string before;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const Node word = words.at(i);
    const auto start = word.member({"start"}).number(), end = word.member({"end"}).number();
    if (!start) continue;
    const std::string text = word.member({"word", "alignedword"}).text().value_or("");
    const Node phones = word.member({"phones"});
    // A word that is in no dictionary has one phone called "oov".
    const bool unknown =
        phones.size() == 0 || phones.at(0).member({"phone"}).text().value_or("").starts_with("oov");
    if (unknown) {
      if (!end) return lacks_time(out, word, "word");
      out.add(word, *start, *end, text, true);
      continue;
    }
    double reached = *start;
    for (std::size_t k = 0; k < phones.size(); ++k) {
      const Node phone = phones.at(k);
      const auto length = phone.member({"duration"}).number();
      const auto label = phone.member({"phone"}).text();
      if (!length || !label) {
        return out.error(Code::syntax, "a phone needs its duration and its name", phone);
      }
      dam::TimedLabel& added = out.add(phone, reached, reached + *length, *label, false);
      added.word = text;
      if (k == 0 && text == before) added.link = dam::WordLink::again;
      reached += *length;
    }
    before = text;
  }
  return {};
}

// Kokoro: tokens with the phonemes of each word, in letters of their own for diphthongs.

bool has_phonemes(const Node& token) {
  return token.member({"phonemes"}).text() &&
         token.member({"startts", "start", "starttime"}).exists();
}

std::vector<Node> tokens_of(const std::vector<Node>& roots) {
  return find_objects(roots, has_phonemes);
}

bool is_kokoro(const std::vector<Node>& roots) { return first(tokens_of(roots)) != nullptr; }

constexpr std::size_t kLongestWord = 1024;  // bytes of IPA

// Misaki's capitals to IPA.
std::string ipa_of_misaki(std::string_view phonemes) {
  constexpr std::pair<char, std::string_view> kCapitals[] = {
      {'A', "eɪ"}, {'I', "aɪ"}, {'W', "aʊ"}, {'Y', "ɔɪ"}, {'O', "oʊ"}, {'Q', "əʊ"}, {'T', "ɾ"}};
  constexpr std::string_view kWeak = "ᵊ";  // the vowel of "rhythm"
  std::string out;
  while (!phonemes.empty()) {
    const auto found = std::find_if(std::begin(kCapitals), std::end(kCapitals),
                                    [&](const auto& entry) { return entry.first == phonemes[0]; });
    const bool weak = phonemes.starts_with(kWeak);
    if (weak) {
      out += "ə";
    } else if (found != std::end(kCapitals)) {
      out += found->second;
    } else {
      out += phonemes[0];
    }
    phonemes.remove_prefix(weak ? kWeak.size() : 1);
  }
  return out;
}

Result<void> read_kokoro(const std::vector<Node>& roots, const dam::ScriptOptions&,
                         JsonLabels& out) {
  std::vector<dam::TimedLabel> phones;
  for (const Node& token : tokens_of(roots)) {
    const auto start = token.member({"startts", "start", "starttime"}).number();
    const auto end = token.member({"endts", "end", "endtime"}).number();
    if (!start || !end || *end <= *start) continue;  // punctuation has no time
    const Node phonemes = token.member({"phonemes"});
    const std::string ipa = ipa_of_misaki(*phonemes.text());
    const auto sounds = dam::parse_ipa(ipa, kLongestWord);
    if (!sounds) return out.error(sounds.error().code, sounds.error().message, phonemes);
    std::vector<std::string> labels;
    for (const dam::IpaPhone& sound : *sounds) labels.emplace_back(sound.label);
    const dam::TimedLabel word =
        out.add(token, *start, *end, token.member({"text", "word"}).text().value_or(""), true);
    dam::spread_phones(word, labels, phones);
  }
  out.labels = std::move(phones);
  return {};
}

constexpr JsonFormat kAligners[] = {
    {{"mfa", "Montreal Forced Aligner"}, is_mfa, read_mfa, dam::TimeUnit::assumed},
    {{"rhubarb", "mouth cues of Rhubarb Lip Sync"}, is_rhubarb, read_rhubarb},
    {{"gentle", "Gentle"}, is_gentle, read_gentle, dam::TimeUnit::assumed},
    {{"kokoro", "tokens of Kokoro with their phonemes"},
     is_kokoro,
     read_kokoro,
     dam::TimeUnit::assumed},
};

}  // namespace

std::span<const JsonFormat> aligner_formats() { return kAligners; }

}  // namespace animeme::scripts
