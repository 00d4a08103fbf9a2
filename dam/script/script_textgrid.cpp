// The phone and word tiers of a TextGrid, read and written.
#include <algorithm>
#include <map>
#include <span>

#include "dam/script/script_readers_internal.h"
#include "dam/script/script_values_internal.h"
#include "dam/script/table_text_internal.h"
#include "dam/script/textgrid.h"

namespace animeme::dam {
namespace {

constexpr std::string_view kPhoneTiers[] = {"phones", "phone", "phonemes"};
constexpr std::string_view kWordTiers[] = {"words", "word"};

using Tiers = std::vector<const TextGridTier*>;

// The tiers called `name`, or "SPEAKER - name" where there are none (multi-speaker alignments).
Tiers tiers_called(const TextGrid& grid, std::string_view name) {
  Tiers whole, suffix;
  for (const TextGridTier& tier : grid.tiers) {
    const std::string lower = lower_case(trimmed(tier.name));
    if (lower == name) whole.push_back(&tier);
    if (lower.ends_with(" - " + std::string(name))) suffix.push_back(&tier);
  }
  return whole.empty() ? suffix : whole;
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
  return make_error(Code::not_found,
                    "the file has no tier " + in_quotes(name) + "; " + tier_list(grid));
}

// The phones; where there are none, the words.
Result<const TextGridTier*> choose_tier(const TextGrid& grid) {
  const auto only_one = [&](std::span<const std::string_view> names,
                            std::string_view what) -> Result<const TextGridTier*> {
    for (const std::string_view name : names) {
      const Tiers found = tiers_called(grid, name);
      if (found.size() == 1) return found[0];
      if (found.size() > 1) {
        return make_error(Code::not_found,
                          "more than one tier holds " + std::string(what) +
                              "; name the one to read (--tier): " + tier_list(grid));
      }
    }
    return static_cast<const TextGridTier*>(nullptr);
  };
  auto phones = only_one(kPhoneTiers, "phones");
  if (!phones || *phones != nullptr) return phones;
  auto words = only_one(kWordTiers, "words");
  if (!words || *words != nullptr) return words;
  return make_error(Code::not_found,
                    "the file has no tier named phones, phone, phonemes or words; name the one to "
                    "read (--tier): " +
                        tier_list(grid));
}

bool is_word_tier(const TextGridTier& tier) {
  const std::string own = lower_case(trimmed(tier.name));
  return std::any_of(std::begin(kWordTiers), std::end(kWordTiers), [&](std::string_view name) {
    return own == name || own.ends_with(" - " + std::string(name));
  });
}

// "Ann - phones" wants "Ann - words".
const TextGridTier* choose_words(const TextGrid& grid, const TextGridTier& phones) {
  const std::string own = lower_case(trimmed(phones.name));
  const std::size_t dash = own.rfind(" - ");
  const std::string speaker = dash == std::string::npos ? "" : own.substr(0, dash + 3);
  for (const std::string_view name : kWordTiers) {
    for (const TextGridTier& tier : grid.tiers) {
      if (lower_case(trimmed(tier.name)) == speaker + std::string(name) && !tier.points)
        return &tier;
    }
  }
  return nullptr;
}

// The words are in time order in every sane file; in others a word may be missed, no more.
void add_words(std::vector<TimedLabel>& raw, const TextGridTier& words) {
  auto word = words.items.begin();
  for (TimedLabel& phone : raw) {
    const double middle = 0.5 * (phone.start + phone.end);
    while (word != words.items.end() && word->end <= middle) ++word;
    if (word == words.items.end()) return;
    if (word->start <= middle) phone.word = word->text;
  }
}

}  // namespace

bool looks_like_textgrid(std::string_view text) {
  const std::string_view head = text.substr(0, 400);
  return head.starts_with("ooBinaryFile") || head.find("\"ooTextFile") != std::string_view::npos ||
         head.starts_with("File type = ") || head.starts_with("\"Praat chronological TextGrid");
}

Result<Timings> labels_of_tier(const TextGrid& grid, const ScriptOptions& options) {
  const auto chosen = options.tier.empty() ? choose_tier(grid) : choose_named(grid, options.tier);
  if (!chosen) return chosen.error();
  const TextGridTier& tier = **chosen;
  if (tier.points) {
    return make_error(Code::unsupported,
                      "tier " + in_quotes(tier.name) + " holds points; phones need intervals");
  }
  Timings timings;
  for (const TextGridItem& item : tier.items) {
    timings.labels.push_back(
        {item.start, item.end, std::string(trimmed(item.text)), {}, item.line, item.column, false});
  }
  const bool named = options.tier.empty() || is_word_tier(tier);
  const LabelUnit by_name = is_word_tier(tier) ? LabelUnit::words : LabelUnit::phones;
  decide_unit(timings.labels,
              named && options.unit == LabelUnit::automatic ? by_name : options.unit);
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
    if (!words.items.empty() && words.items.back().text == phone.word) {
      words.items.back().end = phone.end;
    } else {
      words.items.push_back({phone.start, phone.end, phone.word, 0, 0});
    }
  }
  if (!script.phones.empty()) grid.start = std::min(0.0, script.phones.front().start);
  grid.tiers = {std::move(words), std::move(phones)};
  return grid;
}

std::string write_textgrid(const Script& script) { return format_textgrid(textgrid_of(script)); }

}  // namespace animeme::dam
