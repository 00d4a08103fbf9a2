// Lists side by side, one of labels, one of starts, one of ends or durations: ElevenLabs, Inworld,
// HeadTTS, Cartesia. A stream of them is one object a line.
#include <algorithm>

#include "dam/script/script_text_internal.h"
#include "dam/script/words.h"
#include "tools/formats/scripts/detail/json_script.h"

namespace animeme::scripts {

namespace {

using dam::TimedLabel;

enum class Kind : std::uint8_t { phones, visemes, words, characters };

struct Lists {
  std::string_view format;
  Kind kind;
  std::string_view labels, starts, ends, durations;  // one of the last two
  double rate;                                       // of the numbers, a second
};

// Of the rows that fit an object the first of a kind counts; visemes and phones before words.
constexpr Lists kLists[] = {
    {"elevenlabs", Kind::characters, "characters", "characterstarttimesseconds",
     "characterendtimesseconds", "", 1},
    {"elevenlabs", Kind::characters, "chars", "charstarttimesms", "", "charsdurationsms", 1000},
    {"elevenlabs", Kind::characters, "chars", "charstarttimesms", "", "chardurationsms", 1000},
    {"inworld", Kind::words, "words", "wordstarttimeseconds", "wordendtimeseconds", "", 1},
    {"inworld", Kind::characters, "characters", "characterstarttimeseconds",
     "characterendtimeseconds", "", 1},
    {"headtts", Kind::visemes, "visemes", "vtimes", "", "vdurations", 1000},
    {"headtts", Kind::words, "words", "wtimes", "", "wdurations", 1000},
    {"cartesia", Kind::phones, "phonemes", "start", "end", "", 1},
    {"cartesia", Kind::words, "words", "start", "end", "", 1},
};

bool fits(const Lists& lists, const Node& node) {
  return node.member({lists.labels}).is_array() && node.member({lists.starts}).is_array() &&
         node.member({lists.ends.empty() ? lists.durations : lists.ends}).is_array();
}

Result<std::vector<TimedLabel>> read_lists(const Lists& lists, const Node& node, double usual_rate,
                                           JsonLabels& out) {
  const bool by_end = !lists.ends.empty();
  const Node labels = node.member({lists.labels}), starts = node.member({lists.starts});
  const Node others = node.member({by_end ? lists.ends : lists.durations});
  if (labels.size() != starts.size() || labels.size() != others.size()) {
    return out.error(Code::syntax, "the lists of labels and of their times differ in length", node);
  }
  std::vector<TimedLabel> found;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const Node label = labels.at(i);
    const auto start = starts.at(i).number(), other = others.at(i).number();
    if (!start || !other)
      return out.error(Code::syntax, "a time that is not a number", starts.at(i));
    if (!label.value->is_string())
      return out.error(Code::syntax, "a label that is not text", label);
    const double from = *start / usual_rate;
    const double to = by_end ? *other / usual_rate : from + *other / usual_rate;
    out.paths.push_back(label.path);
    found.push_back({from,
                     to,
                     label.value->get<std::string>(),
                     {},
                     std::int64_t(out.paths.size()),
                     0,
                     lists.kind == Kind::words || lists.kind == Kind::characters});
  }
  return found;
}

// Blanks part words, and what is neither letter nor digit has no time in them: a comma takes that
// of the pause behind it.
std::vector<TimedLabel> join_characters(const std::vector<TimedLabel>& characters) {
  std::vector<TimedLabel> words;
  bool inside = false;
  for (const TimedLabel& character : characters) {
    std::string_view rest = character.label;
    const char32_t code = rest.empty() ? U' ' : dam::take_code_point(rest);
    if (code <= U' ' || code == 0xA0 || code == 0x3000) {
      inside = false;
      continue;
    }
    const bool letter = is_spoken(code);
    if (!inside && !letter) continue;
    if (!inside) {
      words.push_back(character);
      inside = true;
      continue;
    }
    words.back().label += character.label;
    if (letter) words.back().end = std::max(words.back().end, character.end);
  }
  return words;
}

// Inworld: the phones of some words; "[silence]" is one of them, and blanks are words.
Result<void> add_phones(const Node& node, std::vector<TimedLabel>& words, JsonLabels& out) {
  const Node details = node.member({"phoneticdetails"});
  std::vector<std::vector<TimedLabel>> phones(words.size());
  for (std::size_t i = 0; i < details.size(); ++i) {
    const auto index = details.at(i).member({"wordindex"}).number();
    const Node list = details.at(i).member({"phones"});
    if (!index || *index < 0 || *index >= double(words.size())) {
      return out.error(Code::syntax, "wordIndex does not refer to a word", details.at(i));
    }
    for (std::size_t k = 0; k < list.size(); ++k) {
      const Node phone = list.at(k);
      const auto start = phone.member({"starttimeseconds"}).number();
      const auto length = phone.member({"durationseconds"}).number();
      const auto symbol = phone.member({"phonesymbol"}).text();
      if (!start || !length || !symbol) {
        return out.error(Code::syntax,
                         "a phone needs phoneSymbol, startTimeSeconds and durationSeconds", phone);
      }
      if (*length <= 0) continue;
      out.paths.push_back(phone.path);
      phones[std::size_t(*index)].push_back(
          {*start, *start + *length, symbol->starts_with('[') ? "" : *symbol,
           words[std::size_t(*index)].label, std::int64_t(out.paths.size()), 0, false});
    }
  }
  std::vector<TimedLabel> all;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (phones[i].empty()) {
      all.push_back(words[i]);
    } else {
      all.insert(all.end(), phones[i].begin(), phones[i].end());
    }
  }
  words = std::move(all);
  return {};
}

const Lists* lists_of(const Node& node, std::string_view format, Kind kind) {
  const auto found = std::find_if(std::begin(kLists), std::end(kLists), [&](const Lists& lists) {
    return lists.format == format && lists.kind == kind && fits(lists, node);
  });
  return found == std::end(kLists) ? nullptr : &*found;
}

Result<std::vector<TimedLabel>> read_piece(std::string_view format, const Node& node,
                                           const dam::ScriptOptions& options, JsonLabels& out) {
  std::vector<TimedLabel> words;
  for (const Kind kind : {Kind::phones, Kind::visemes, Kind::words, Kind::characters}) {
    const Lists* lists = lists_of(node, format, kind);
    if (lists == nullptr) continue;
    auto found = read_lists(*lists, node, options.rate > 0 ? options.rate : lists->rate, out);
    if (!found) return found.error();
    if (kind == Kind::characters) return join_characters(*found);
    if (kind == Kind::words && format == "inworld") {
      if (auto added = add_phones(node, *found, out); !added) return added.error();
    }
    if (kind != Kind::visemes) return found;
    const Lists* names = lists_of(node, format, Kind::words);
    if (names != nullptr) {
      auto read = read_lists(*names, node, options.rate > 0 ? options.rate : names->rate, out);
      if (!read) return read.error();
      words = std::move(*read);
    }
    out.alphabet = dam::Alphabet::arpabet;
    for (TimedLabel& label : *found) {
      const Node viseme{nullptr, out.paths[std::size_t(label.line - 1)]};
      auto phone = viseme_label(out, viseme, dam::VisemeSet::oculus, label.label);
      if (!phone) return phone.error();
      label.label = *std::move(phone);
    }
    dam::attach_words(*found, words);
    return found;
  }
  return words;
}

bool fits_any(std::string_view format, const Node& node) {
  return std::any_of(std::begin(kLists), std::end(kLists), [&](const Lists& lists) {
    return lists.format == format && fits(lists, node);
  });
}

// Of an alignment in two ways the normalised one has the numbers and signs as they are spoken.
void keep_normalised(std::vector<Node>& pieces) {
  const auto normalised = [](const Node& piece) {
    return piece.path.find("/normalized") != std::string::npos;
  };
  if (std::none_of(pieces.begin(), pieces.end(), normalised)) return;
  std::erase_if(pieces, [&](const Node& piece) { return !normalised(piece); });
}

// Pieces of a stream either count from its beginning or each from its own.
Result<void> read_pieces(std::string_view format, const std::vector<Node>& roots,
                         const dam::ScriptOptions& options, JsonLabels& out) {
  std::vector<Node> pieces =
      find_objects(roots, [&](const Node& node) { return fits_any(format, node); });
  keep_normalised(pieces);
  std::vector<TimedLabel> all;
  double offset = 0;
  for (const Node& piece : pieces) {
    auto found = read_piece(format, piece, options, out);
    if (!found) return found.error();
    if (found->empty()) continue;
    const double reached = all.empty() ? 0 : all.back().end;
    if (found->front().start + offset < reached - dam::kTimeTolerance) offset = reached;
    for (TimedLabel& label : *found) {
      label.start += offset;
      label.end += offset;
      all.push_back(std::move(label));
    }
  }
  out.labels = std::move(all);
  if (std::any_of(out.labels.begin(), out.labels.end(),
                  [](const TimedLabel& label) { return !label.is_word; })) {
    return {};
  }
  give_times(out);
  return {};
}

template <const std::string_view& format>
bool looks_like(const std::vector<Node>& roots) {
  return !find_objects(roots, [](const Node& node) { return fits_any(format, node); }).empty();
}

template <const std::string_view& format>
Result<void> read(const std::vector<Node>& roots, const dam::ScriptOptions& options,
                  JsonLabels& out) {
  return read_pieces(format, roots, options, out);
}

constexpr std::string_view kElevenLabs = "elevenlabs", kInworld = "inworld", kHeadTts = "headtts",
                           kCartesia = "cartesia";

constexpr JsonFormat kArrays[] = {
    {{kElevenLabs, "characters with times of ElevenLabs"},
     looks_like<kElevenLabs>,
     read<kElevenLabs>},
    {{kInworld, "words and phones with times of Inworld"}, looks_like<kInworld>, read<kInworld>},
    {{kHeadTts, "visemes and words of HeadTTS and TalkingHead"},
     looks_like<kHeadTts>,
     read<kHeadTts>},
    {{kCartesia, "phonemes or words with times of Cartesia"},
     looks_like<kCartesia>,
     read<kCartesia>},
};

}  // namespace

std::span<const JsonFormat> array_formats() { return kArrays; }

}  // namespace animeme::scripts
