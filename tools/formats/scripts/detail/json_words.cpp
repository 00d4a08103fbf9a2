// Lists of words with times, which recognisers and aligners write under many names: where each of
// them keeps its list, what it calls text, start and end, and what it counts in.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "dam/script/script_cues_internal.h"
#include "dam/script/script_text_internal.h"
#include "dam/script/table_text_internal.h"
#include "tools/formats/scripts/detail/json_script.h"

namespace animeme::scripts {

namespace {

using dam::TimedLabel;

// Paths are members and entries between slashes, "0" the first entry and "*" each of them; of names
// between bars the first one that is there counts.
struct WordList {
  std::string_view format;
  std::string_view list;
  std::string_view text, start, end;
  std::string_view length;         // instead of an end
  double rate = 1;                 // of times, a second; 0: frames, as the file says
  std::string_view phones, phone;  // a list in each word, and the text of its entries
  bool pieces = false;             // of words: those that go on have no blank in front
};

constexpr std::string_view kWords = "words";
constexpr std::string_view kStarts = "start|starttime|startts", kEnds = "end|endtime|endts",
                           kTexts = "punctuatedword|word|text";

// The first row that finds words in a file reads it.
constexpr WordList kWordLists[] = {
    {"pocketsphinx", "w", "t", "b", "", "d", 1, "w", "t"},
    {"whispercpp", "transcription/*/tokens", "text", "offsets/from", "offsets/to", "", 1000, "", "",
     true},
    {"whispercpp", "transcription", "text", "offsets/from", "offsets/to", "", 1000},
    {"deepgram", "results/channels/*/alternatives/0/words", kTexts, "start", "end", ""},
    {"aws", "results/items", "alternatives/0/content", "starttime", "endtime", ""},
    {"speechmatics", "results", "alternatives/0/content", "starttime", "endtime", ""},
    {"google", "results/*/alternatives/0/words", "word", "starttime|startoffset",
     "endtime|endoffset", ""},
    {"azure", "nbest/0/words", "word", "offset", "", "duration", 1e7, "phonemes", "phoneme"},
    {"azure", "recognizedphrases/*/nbest/0/words", "word", "offsetinticks", "", "durationinticks",
     1e7},
    {"rev", "monologues/*/elements", "value", "ts", "endts", ""},
    {"aeneas", "fragments", "lines", "begin", "end", ""},
    {"papagayo", "voices/*/phrases/*/words", "text", "startframe", "endframe", "", 0, "phonemes",
     "text"},
    {"vosk", "result", "word", "start", "end", ""},
    {"vosk", "alternatives/0/result", "word", "start", "end", ""},
    {"words", "segments/*/words", kTexts, kStarts, kEnds, ""},
    {"words", "words", kTexts, kStarts, kEnds, ""},
    {"words", "wordsegments", kTexts, kStarts, kEnds, ""},
    {"words", "timestamps", kTexts, kStarts, kEnds, ""},
    {"words", "utterances", kTexts, kStarts, kEnds, ""},
    {"words", "segments", kTexts, kStarts, kEnds, ""},
    {"words", "tokens", kTexts, kStarts, kEnds, ""},
    {"words", "chunks", kTexts, "timestamp/0", "timestamp/1", ""},
    {"words", "", kTexts, kStarts, kEnds, ""},
};

std::string_view take_until(std::string_view& rest, char sign) {
  const std::string_view taken = rest.substr(0, rest.find(sign));
  rest.remove_prefix(std::min(taken.size() + 1, rest.size()));
  return taken;
}

Node step(const Node& node, std::string_view name) {
  if (!name.empty() && name[0] >= '0' && name[0] <= '9') return node.at(std::size_t(name[0] - '0'));
  return node.member({name});
}

Node find(const Node& node, std::string_view names) {
  while (!names.empty()) {
    std::string_view path = take_until(names, '|');
    Node at = node;
    while (!path.empty()) at = step(at, take_until(path, '/'));
    if (at.exists()) return at;
  }
  return {};
}

// Seconds as a number, as text ("0.2", "0.200s", "00:00:00,200"), as an object of seconds and
// nanos.
std::optional<double> time_of(const Node& node) {
  if (const auto number = node.number()) return number;
  if (node.is_object()) {
    const auto seconds = node.member({"seconds"}).number(), nanos = node.member({"nanos"}).number();
    if (seconds || nanos) return seconds.value_or(0) + nanos.value_or(0) * 1e-9;
  }
  const auto text = node.text();
  if (!text) return std::nullopt;
  if (text->ends_with('s')) return dam::parse_number(text->substr(0, text->size() - 1));
  return dam::parse_clock(*text);
}

// A text, or several lines of one.
std::string text_of(const Node& node) {
  if (!node.is_array()) return node.text().value_or("");
  std::string text;
  for (std::size_t i = 0; i < node.size(); ++i) {
    text += (i > 0 ? " " : "") + node.at(i).text().value_or("");
  }
  return text;
}

std::string speaker_of(const Node& node, const std::string& outer) {
  const Node who = find(node, "speaker|speakerlabel|speakerid|speakertag|alternatives/0/speaker");
  if (const auto name = who.text()) return *name;
  const auto number = who.number();
  return number && std::abs(*number) < 1e6 ? std::to_string(std::int64_t(*number)) : outer;
}

// An entry with what is known from around it.
struct Found {
  Node node;
  std::string speaker;
  Border border;
  bool first = false;  // of its list
};

void walk(const Node& node, std::string_view path, Found around, const WordList& names,
          std::vector<Found>& found) {
  around.speaker = speaker_of(node, around.speaker);
  if (names.rate == 0) around.speaker = node.member({"name"}).text().value_or(around.speaker);
  const auto start = time_of(find(node, names.start)), end = time_of(find(node, names.end));
  if (start && end && names.rate > 0) around.border = {*start / names.rate, *end / names.rate};
  if (path.empty()) {
    for (std::size_t i = 0; i < node.size(); ++i) {
      const Node entry = node.at(i);
      if (!entry.is_object()) continue;
      found.push_back({entry, speaker_of(entry, around.speaker), around.border, i == 0});
    }
    return;
  }
  const std::string_view name = take_until(path, '/');
  if (name == "*") {
    for (std::size_t i = 0; i < node.size(); ++i) walk(node.at(i), path, around, names, found);
  } else if (const Node next = step(node, name); next.exists()) {
    walk(next, path, around, names, found);
  }
}

bool has_time(const WordList& names, const Node& node) {
  const bool timed = time_of(find(node, names.start)) || node.member({"score"}).exists();
  return timed && find(node, names.text).exists();
}

// The words of a row; empty: it is another format.
std::vector<Found> words_of(const WordList& names, const std::vector<Node>& roots) {
  std::vector<Found> found;
  for (const Node& root : roots) {
    walk(root, names.list, {}, names, found);
    // A list of results, and words each on a line of their own.
    if (found.empty() && root.is_array() && !names.list.empty()) {
      for (std::size_t i = 0; i < root.size(); ++i) walk(root.at(i), names.list, {}, names, found);
    }
    if (names.list.empty() && root.is_object()) {
      found.push_back({root, speaker_of(root, {}), {}, false});
    }
  }
  const bool any = std::any_of(found.begin(), found.end(),
                               [&](const Found& one) { return has_time(names, one.node); });
  return any ? found : std::vector<Found>{};
}

bool is_punctuation(std::string_view text) {
  while (!text.empty()) {
    if (is_spoken(dam::take_code_point(text))) return false;
  }
  return true;
}

// The phones of a word, or mouths that last to the next one.
Result<void> add_word_phones(const WordList& names, const Node& list, double rate, TimedLabel word,
                             JsonLabels& out) {
  const bool mouths = names.rate == 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Node phone = list.at(i);
    const Node place = mouths ? phone.member({"frame"}) : find(phone, names.start);
    const auto start = time_of(place), length = time_of(find(phone, names.length));
    std::string label = text_of(find(phone, names.phone));
    if (!start || (!mouths && !length)) {
      return out.error(Code::syntax, "a phone of a word needs its times as numbers", phone);
    }
    double end = word.end;
    if (!mouths) end = (*start + *length) / rate;
    if (mouths && i + 1 < list.size()) {
      end = time_of(list.at(i + 1).member({"frame"})).value_or(0) / rate;
    }
    if (mouths) {
      auto read = viseme_label(out, phone, dam::VisemeSet::preston_blair, label);
      if (!read) return read.error();
      label = *std::move(read);
      out.alphabet = dam::Alphabet::arpabet;
    }
    TimedLabel& added = out.add(phone, *start / rate, end, std::move(label), false);
    added.word = word.label;
    added.speaker = word.speaker;
  }
  return {};
}

// Azure leaves out the last frame of each phone: nobody pauses for 10 ms.
void close_gaps(std::vector<TimedLabel>& labels) {
  constexpr double kFrame = 0.0125;
  for (std::size_t i = 1; i < labels.size(); ++i) {
    const double gap = labels[i].start - labels[i - 1].end;
    if (gap > 0 && gap < kFrame) labels[i - 1].end = labels[i].start;
  }
}

Result<void> read_rows(std::string_view format, const std::vector<Node>& roots,
                       const dam::ScriptOptions& options, JsonLabels& out) {
  for (const WordList& names : kWordLists) {
    if (names.format != format) continue;
    const std::vector<Found> found = words_of(names, roots);
    if (found.empty()) continue;
    constexpr double kFrames = 24;
    double rate = names.rate > 0 ? names.rate : kFrames;
    const auto fps = roots[0].member({"fps"}).number();
    if (names.rate == 0 && fps && *fps > 0) rate = *fps;
    if (options.rate > 0 && format != kWords) rate = options.rate;
    std::vector<Border> borders;
    bool phones = false;
    for (const Found& one : found) {
      const Node text_node = find(one.node, names.text);
      const std::string text = text_of(text_node);
      const auto start = time_of(find(one.node, names.start));
      auto end = time_of(find(one.node, names.end));
      if (const auto length = time_of(find(one.node, names.length)); length && start) {
        end = *start + *length;
      }
      if (names.rate == 0 && end) *end += 1;  // the last frame belongs to the word
      const bool same = !out.labels.empty() && !one.first;
      if (text.empty() || (names.pieces && text.starts_with("[_"))) continue;
      // Recognisers list signs by themselves, and pieces of words.
      const bool goes_on =
          names.pieces && text_node.value->is_string() && !text_node.value->text().starts_with(' ');
      if (same &&
          (goes_on || (!start && !one.node.member({"score"}).exists() && is_punctuation(text)))) {
        out.labels.back().label += text;
        if (goes_on && end && !is_punctuation(text)) out.labels.back().end = *end / rate;
        continue;
      }
      const double before = out.labels.empty() ? 0 : out.labels.back().end * rate;
      const double from =
          start.value_or(end ? std::min(before, *end) : 0);  // a start of 0 is left out
      TimedLabel& label = out.add(one.node, from / rate,
                                  (start || end) && end ? *end / rate : from / rate, text, true);
      label.speaker = one.speaker;
      const Node list = find(one.node, names.phones);
      if (list.size() == 0) {
        borders.push_back(one.border);
        continue;
      }
      const TimedLabel word = label;
      out.labels.pop_back();
      if (auto added = add_word_phones(names, list, rate, word, out); !added) return added.error();
      phones = true;
    }
    if (!phones) give_times(out, borders);
    if (phones) close_gaps(out.labels);
    return {};
  }
  return {};
}

template <const std::string_view& format>
bool lists_words(const std::vector<Node>& roots) {
  return std::any_of(std::begin(kWordLists), std::end(kWordLists), [&](const WordList& names) {
    return names.format == format && !words_of(names, roots).empty();
  });
}

template <const std::string_view& format>
Result<void> read_list(const std::vector<Node>& roots, const dam::ScriptOptions& options,
                       JsonLabels& out) {
  return read_rows(format, roots, options, out);
}

constexpr std::string_view kPocketSphinx = "pocketsphinx", kWhisperCpp = "whispercpp",
                           kDeepgram = "deepgram", kAws = "aws", kSpeechmatics = "speechmatics",
                           kGoogle = "google", kAzure = "azure", kRev = "rev", kAeneas = "aeneas",
                           kPapagayo = "papagayo", kVosk = "vosk";

constexpr JsonFormat kWordFormats[] = {
    {{kPocketSphinx, "words and phones of PocketSphinx 5"},
     lists_words<kPocketSphinx>,
     read_list<kPocketSphinx>},
    {{kWhisperCpp, "words or segments of whisper.cpp"},
     lists_words<kWhisperCpp>,
     read_list<kWhisperCpp>},
    {{kDeepgram, "Deepgram"}, lists_words<kDeepgram>, read_list<kDeepgram>},
    {{kAws, "Amazon Transcribe"}, lists_words<kAws>, read_list<kAws>},
    {{kSpeechmatics, "Speechmatics"}, lists_words<kSpeechmatics>, read_list<kSpeechmatics>},
    {{kGoogle, "Google Speech-to-Text"}, lists_words<kGoogle>, read_list<kGoogle>},
    {{kAzure, "viseme and word boundary events, and recognised words, of Azure Speech"},
     lists_words<kAzure>,
     read_list<kAzure>},
    {{kRev, "Rev"}, lists_words<kRev>, read_list<kRev>},
    {{kAeneas, "fragments of aeneas"}, lists_words<kAeneas>, read_list<kAeneas>},
    {{kPapagayo, "words and mouths of Papagayo"}, lists_words<kPapagayo>, read_list<kPapagayo>},
    {{kVosk, "Vosk"}, lists_words<kVosk>, read_list<kVosk>},
    {{kWords, "words with times: WhisperX, Whisper, AssemblyAI, Kokoro-FastAPI and the like"},
     lists_words<kWords>,
     read_list<kWords>,
     dam::TimeUnit::assumed},
};

}  // namespace

std::span<const JsonFormat> word_formats() { return kWordFormats; }

}  // namespace animeme::scripts
