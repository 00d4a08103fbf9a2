// Which tiers of a TextGrid are the phones and the words, and the way back.
#include <algorithm>

#include "dam/script/script_text_internal.h"
#include "dam/script/script_timeline_internal.h"
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
                    "the TextGrid has no tier " + in_quotes(name) + "; " + tier_list(grid));
}

Result<const TextGridTier*> choose_phones(const TextGrid& grid) {
  for (const std::string_view name : kPhoneTiers) {
    const Tiers found = tiers_called(grid, name);
    if (found.size() == 1) return found[0];
    if (found.size() > 1) {
      return make_error(Code::not_found,
                        "more than one tier holds phones; name one of them: " + tier_list(grid));
    }
  }
  return make_error(Code::not_found,
                    "the TextGrid has no tier named phones, phone or phonemes; rename or name "
                    "the one to read: " +
                        tier_list(grid));
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
void add_words(std::vector<RawPhone>& raw, const TextGridTier& words) {
  auto word = words.items.begin();
  for (RawPhone& phone : raw) {
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

Result<Script> read_textgrid(std::string_view text, const ScriptOptions& options) {
  const auto grid = parse_textgrid(text);
  if (!grid) return grid.error();
  const auto tier = options.tier.empty() ? choose_phones(*grid) : choose_named(*grid, options.tier);
  if (!tier) return tier.error();
  if ((*tier)->points) {
    return make_error(Code::unsupported,
                      "tier " + in_quotes((*tier)->name) + " holds points; phones need intervals");
  }
  std::vector<RawPhone> raw;
  for (const TextGridItem& item : (*tier)->items) {
    raw.push_back({item.start, item.end, std::string(trimmed(item.text)), {}, item.line});
  }
  if (const TextGridTier* words = choose_words(*grid, **tier)) add_words(raw, *words);
  return make_script(raw, options.alphabet);
}

std::string write_textgrid(const Script& script) {
  TextGrid grid;
  grid.end = script.duration();
  TextGridTier phones{"phones", false, {}}, words{"words", false, {}};
  for (const Phone& phone : script.phones) {
    const bool silent = phone.label == kSilence;
    phones.items.push_back({phone.start, phone.end, silent ? "" : phone.label, 0});
    if (!words.items.empty() && words.items.back().text == phone.word) {
      words.items.back().end = phone.end;
    } else {
      words.items.push_back({phone.start, phone.end, phone.word, 0});
    }
  }
  if (!script.phones.empty()) grid.start = std::min(0.0, script.phones.front().start);
  grid.tiers = {std::move(words), std::move(phones)};
  return format_textgrid(grid);
}

}  // namespace animeme::dam
