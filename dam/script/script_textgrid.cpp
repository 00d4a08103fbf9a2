// The phone and word tiers of a TextGrid, read and written.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <span>

#include "dam/script/ipa.h"
#include "dam/script/marks.h"
#include "dam/script/phones.h"
#include "dam/script/script_readers_internal.h"
#include "dam/script/script_values_internal.h"
#include "dam/script/table_text_internal.h"
#include "dam/script/textgrid.h"
#include "dam/script/words.h"

namespace animeme::dam {
namespace {

// The names that programs give to their tiers, in lower case: Montreal, WebMAUS, SPPAS, FAVE,
// TIMIT.
constexpr std::string_view kPhoneTiers[] = {"phones",   "phone", "phonemes",  "phoneme",
                                            "kan-phon", "mau",   "phonalign", "phn"};
// The pronunciation of a word in one label.
constexpr std::string_view kSpellingTiers[] = {"kan-mau", "kan"};
constexpr std::string_view kWordTiers[] = {"words",       "word",   "ort-mau", "ort",
                                           "tokensalign", "tokens", "wrd"};

using Tiers = std::vector<const TextGridTier*>;

bool is_known_tier(std::string_view lower) {
  const auto has = [&](std::span<const std::string_view> names) {
    return std::find(names.begin(), names.end(), lower) != names.end();
  };
  return has(kPhoneTiers) || has(kSpellingTiers) || has(kWordTiers);
}

// Whose tier of this name it is, "Ann - phones", "phones_Ann"; "" for "phones" itself, nothing for
// tiers of other names.
std::optional<std::string> owner_of(const TextGridTier& tier, std::string_view name) {
  constexpr std::string_view kBetween = " -_/:.";
  const std::string lower = lower_case(trimmed(tier.name));
  if (lower == name) return "";
  if (lower.size() <= name.size() || is_known_tier(lower)) return std::nullopt;
  const std::size_t rest = lower.size() - name.size();
  if (lower.ends_with(name) && kBetween.find(lower[rest - 1]) != kBetween.npos) {
    const std::size_t last = lower.find_last_not_of(kBetween, rest - 1);
    return last == std::string::npos ? "" : lower.substr(0, last + 1);
  }
  if (lower.starts_with(name) && kBetween.find(lower[name.size()]) != kBetween.npos) {
    const std::size_t first = lower.find_first_not_of(kBetween, name.size());
    return first == std::string::npos ? "" : lower.substr(first);
  }
  return std::nullopt;
}

// The tiers called `name`, or those of speakers where there are none; of one speaker, if asked for.
Tiers tiers_called(const TextGrid& grid, std::string_view name, std::string_view speaker) {
  Tiers whole, owned;
  for (const TextGridTier& tier : grid.tiers) {
    const auto owner = owner_of(tier, name);
    if (!owner || tier.points) continue;
    if (owner->empty() && speaker.empty()) whole.push_back(&tier);
    if (!owner->empty() && (speaker.empty() || *owner == speaker)) owned.push_back(&tier);
  }
  return whole.empty() ? owned : whole;
}

std::string tier_list(const TextGrid& grid) {
  if (grid.tiers.empty()) return "it has no tiers";
  std::string names;
  for (const TextGridTier& tier : grid.tiers) {
    if (names.size() > 300) return "its tiers are " + names + ", ...";
    names += (names.empty() ? "" : ", ") + in_quotes(tier.name);
  }
  return "its tiers are " + names;
}

Result<const TextGridTier*> choose_named(const TextGrid& grid, const std::string& name) {
  for (const TextGridTier& tier : grid.tiers) {
    if (tier.name == name) return &tier;
  }
  const std::string wanted = lower_case(trimmed(name));
  for (const TextGridTier& tier : grid.tiers) {
    if (lower_case(trimmed(tier.name)) == wanted) return &tier;
  }
  const auto number = parse_number(wanted);
  if (number && *number >= 1 && *number <= double(grid.tiers.size()) &&
      *number == std::floor(*number)) {
    return &grid.tiers[std::size_t(*number) - 1];
  }
  return make_error(Code::not_found,
                    "the file has no tier " + in_quotes(name) + "; " + tier_list(grid));
}

bool has_name_of(const TextGridTier& tier, std::span<const std::string_view> names) {
  return std::any_of(names.begin(), names.end(),
                     [&](std::string_view name) { return owner_of(tier, name).has_value(); });
}

bool has_known_name(const TextGridTier& tier) {
  return has_name_of(tier, kPhoneTiers) || has_name_of(tier, kSpellingTiers) ||
         has_name_of(tier, kWordTiers);
}

// Transcripts have tiers that are called as their speakers are.
bool tiers_are_people(const TextGrid& grid) {
  return std::none_of(grid.tiers.begin(), grid.tiers.end(), has_known_name);
}

// Whose tier it is, as it is spelled; empty: everybody's, or a tier of points.
std::string speaker_of(const TextGridTier& tier, bool by_tier) {
  const std::string_view name = trimmed(tier.name);
  if (tier.points) return {};
  if (by_tier) return std::string(name);
  for (const auto names : {std::span<const std::string_view>(kPhoneTiers),
                           std::span<const std::string_view>(kSpellingTiers),
                           std::span<const std::string_view>(kWordTiers)}) {
    for (const std::string_view known : names) {
      const auto owner = owner_of(tier, known);
      if (!owner || owner->empty()) continue;
      const std::size_t at = lower_case(name).find(*owner);
      return std::string(name.substr(at, owner->size()));
    }
  }
  return {};
}

// The phones; where there are none, the words.
Result<const TextGridTier*> choose_tier(const TextGrid& grid, const std::string& speaker) {
  const std::string owner = lower_case(trimmed(speaker));
  const auto only_one = [&](std::span<const std::string_view> names,
                            std::string_view what) -> Result<const TextGridTier*> {
    for (const std::string_view name : names) {
      const Tiers found = tiers_called(grid, name, owner);
      if (found.size() == 1) return found[0];
      if (found.size() > 1) {
        return make_error(Code::not_found,
                          "more than one tier holds " + std::string(what) +
                              "; name the one to read (--tier, --speaker): " + tier_list(grid));
      }
    }
    return static_cast<const TextGridTier*>(nullptr);
  };
  auto phones = only_one(kPhoneTiers, "phones");
  if (!phones || *phones != nullptr) return phones;
  auto spellings = only_one(kSpellingTiers, "pronunciations");
  if (!spellings || *spellings != nullptr) return spellings;
  auto words = only_one(kWordTiers, "words");
  if (!words || *words != nullptr) return words;
  if (!owner.empty()) {
    for (const TextGridTier& tier : grid.tiers) {
      const bool theirs = !tier.points && lower_case(trimmed(tier.name)) == owner;
      if (theirs && tiers_are_people(grid)) return &tier;
    }
    return make_error(Code::not_found,
                      "no tier holds what " + in_quotes(speaker) + " says; " + tier_list(grid));
  }
  Tiers intervals;
  for (const TextGridTier& tier : grid.tiers) {
    if (!tier.points) intervals.push_back(&tier);
  }
  if (intervals.size() == 1) return intervals[0];
  return make_error(Code::not_found,
                    "the file has no tier named phones, phone, phonemes or words; name the one to "
                    "read by its name or number (--tier): " +
                        tier_list(grid));
}

bool is_word_tier(const TextGridTier& tier) { return has_name_of(tier, kWordTiers); }

// "Ann - phones" wants "Ann - words".
const TextGridTier* choose_words(const TextGrid& grid, const TextGridTier& phones) {
  std::string speaker;
  for (const auto names : {std::span<const std::string_view>(kPhoneTiers),
                           std::span<const std::string_view>(kSpellingTiers)}) {
    for (const std::string_view name : names) {
      if (const auto owner = owner_of(phones, name)) speaker = *owner;
    }
  }
  for (const std::string_view name : kWordTiers) {
    for (const TextGridTier& tier : grid.tiers) {
      if (owner_of(tier, name) == speaker && !tier.points) return &tier;
    }
  }
  return nullptr;
}

// "b Q b" shares the time of its word.
void spread_spellings(std::vector<TimedLabel>& labels) {
  constexpr std::size_t kMostBytes = 1024;
  std::vector<TimedLabel> out;
  for (TimedLabel& label : labels) {
    std::vector<std::string> phones;
    bool known = !is_silence_spelling(label.label) && !is_mark(label.label);
    std::string_view rest = label.label;
    while (known && !rest.empty()) {
      const std::size_t end = std::min(rest.find(' '), rest.size());
      const auto sounds = parse_ipa(rest.substr(0, end), kMostBytes);
      known = sounds.has_value();
      if (!known) break;
      for (const IpaPhone& sound : *sounds) phones.emplace_back(sound.label);
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    if (!known) {
      out.push_back(std::move(label));
      continue;
    }
    const std::size_t first = out.size();
    spread_phones(label, phones, out);
    for (std::size_t i = first; i < out.size(); ++i) out[i].word.clear();
  }
  labels = std::move(out);
}

// The words are in time order in every sane file; in others a word may be missed, no more.
void add_words(std::vector<TimedLabel>& raw, const TextGridTier& words) {
  std::vector<TimedLabel> labels;
  for (const TextGridItem& item : words.items) {
    labels.push_back({item.start, item.end, item.text, {}, item.line, item.column, true});
  }
  attach_words(raw, labels);
}

}  // namespace

bool looks_like_textgrid(std::string_view text) {
  const std::string_view head = text.substr(0, 400);
  return head.starts_with("ooBinaryFile") || head.find("\"ooTextFile") != std::string_view::npos ||
         head.starts_with("File type = ") || head.starts_with("\"Praat chronological TextGrid");
}

Result<Timings> labels_of_everyone(const TextGrid& grid, const ScriptOptions& options) {
  Timings all;
  std::vector<std::string> known;
  const bool by_tier = tiers_are_people(grid);
  for (const TextGridTier& tier : grid.tiers) {
    ScriptOptions one = options;
    one.speaker = speaker_of(tier, by_tier);
    one.everyone = false;
    const bool again =
        std::find(known.begin(), known.end(), lower_case(one.speaker)) != known.end();
    if (one.speaker.empty() || again) continue;
    known.push_back(lower_case(one.speaker));
    auto timings = labels_of_tier(grid, one);
    if (!timings) return timings;
    all.labels.insert(all.labels.end(), std::make_move_iterator(timings->labels.begin()),
                      std::make_move_iterator(timings->labels.end()));
    all.notes = std::move(timings->notes);
  }
  return all;
}

Result<Timings> labels_of_tier(const TextGrid& grid, const ScriptOptions& options) {
  if (options.everyone && options.tier.empty() && options.speaker.empty()) {
    auto all = labels_of_everyone(grid, options);
    if (!all || !all->labels.empty()) return all;
  }
  const auto chosen =
      options.tier.empty() ? choose_tier(grid, options.speaker) : choose_named(grid, options.tier);
  if (!chosen) return chosen.error();
  const TextGridTier& tier = **chosen;
  if (tier.points) {
    return make_error(Code::unsupported,
                      "tier " + in_quotes(tier.name) + " holds points; phones need intervals");
  }
  Timings timings;
  timings.notes = grid.notes;
  for (const TextGridItem& item : tier.items) {
    timings.labels.push_back({item.start,
                              item.end,
                              std::string(trimmed(item.text)),
                              {},
                              item.line,
                              item.column,
                              false,
                              Alphabet::automatic,
                              options.speaker});
  }
  LabelUnit unit = options.unit;
  if (unit == LabelUnit::automatic && is_word_tier(tier)) unit = LabelUnit::words;
  if (unit == LabelUnit::automatic && has_name_of(tier, kPhoneTiers)) unit = LabelUnit::phones;
  if (unit == LabelUnit::automatic && has_name_of(tier, kSpellingTiers)) {
    spread_spellings(timings.labels);
    unit = LabelUnit::phones;
  }
  decide_unit(timings.labels, unit);
  if (!has_words(timings)) {
    if (const TextGridTier* words = choose_words(grid, tier)) add_words(timings.labels, *words);
  }
  return timings;
}

Result<Timings> read_textgrid(std::string_view text, const ScriptOptions& options) {
  const auto grid = parse_textgrid(text);
  if (!grid) return grid.error();
  return labels_of_tier(*grid, options);
}

bool looks_like_mfa_table(std::string_view text) {
  return lower_case(text.substr(0, 21)) == "begin,end,label,type,";
}

// Begin, End, Label, Type, Speaker: tiers that are mixed. A label with a comma is in quotes.
Result<Timings> read_mfa_table(std::string_view text, const ScriptOptions& options) {
  TextGrid grid;
  std::map<std::string, std::size_t> tiers;
  LineReader reader(text);
  Line line;
  reader.next(line);
  while (reader.next(line)) {
    if (trimmed(line.text).empty()) continue;
    const auto fields = split_fields(line.text, ',');
    if (fields.size() < 5) {
      return error_at_line(Code::syntax,
                           "a line holds Begin, End, Label, Type and Speaker between commas",
                           line.number);
    }
    const auto start = parse_seconds(trimmed(fields[0]), line.number, "begin", 1);
    if (!start) return start.error();
    const auto column = [&](std::string_view field) { return field.data() - line.text.data() + 1; };
    const auto end = parse_seconds(trimmed(fields[1]), line.number, "end", column(fields[1]));
    if (!end) return end.error();
    const std::string_view speaker = trimmed(fields.back()), type = trimmed(fields.end()[-2]);
    std::string_view label(
        fields[2].data(),
        std::size_t(fields.end()[-3].data() + fields.end()[-3].size() - fields[2].data()));
    label = trimmed(label);
    if (label.size() >= 2 && label.starts_with('"') && label.ends_with('"')) {
      label = label.substr(1, label.size() - 2);
    }
    const std::string name =
        (speaker.empty() ? "" : std::string(speaker) + " - ") + std::string(type);
    const auto [tier, added] = tiers.try_emplace(name, grid.tiers.size());
    if (added) grid.tiers.push_back({name, false, {}});
    grid.tiers[tier->second].items.push_back(
        {*start, *end, std::string(label), line.number, column(fields[2])});
  }
  return labels_of_tier(grid, options);
}

TextGrid textgrid_of(const Script& script) {
  TextGrid grid;
  grid.end = script.duration();
  TextGridTier phones{"phones", false, {}}, words{"words", false, {}};
  for (const Phone& phone : script.phones) {
    const bool silent = phone.label == kSilence;
    phones.items.push_back({phone.start, phone.end, silent ? "" : phone.label, 0, 0});
  }
  // Between words there is an interval without text.
  const auto pause = [&](double until) {
    const double from = words.items.empty() ? phones.items.front().start : words.items.back().end;
    if (until > from) words.items.push_back({from, until, {}, 0, 0});
  };
  for (ScriptWord& word : words_of(script)) {
    pause(word.start);
    words.items.push_back({word.start, word.end, std::move(word.text), 0, 0});
  }
  if (!phones.items.empty()) pause(phones.items.back().end);
  if (!script.phones.empty()) grid.start = std::min(0.0, script.phones.front().start);
  grid.tiers = {std::move(words), std::move(phones)};
  return grid;
}

std::string write_textgrid(const Script& script) { return format_textgrid(textgrid_of(script)); }

}  // namespace animeme::dam
