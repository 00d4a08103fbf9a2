#include "dam/script/marks.h"

#include <algorithm>
#include <iterator>

#include "dam/script/phones.h"
#include "dam/script/script_text_internal.h"

namespace animeme::dam {
namespace {

// Names of SPPAS, Kaldi and TIMIT that are words nowhere.
constexpr std::string_view kMarkNames[] = {"gb", "spn", "nsn", "brth", "vocnoise", "blank_audio"};

// What phones are never called. Lower case.
constexpr std::string_view kPhoneMarks[] = {"@@",   "*",    "+",   "fp",     "lg",  "lau",  "unk",
                                            "oov",  "usb",  "nib", "dummy",  "xxx", "yyy",  "hes",
                                            "fil",  "iver", "bkg", "bn",     "gbg", "crap", "inh",
                                            "lips", "lip",  "exh", "cutoff", "sta", "int",  "err"};
// Nor anything that one of these is a part of.
constexpr std::string_view kPhoneMarkParts[] = {"noise",   "laugh", "breath", "cough",    "music",
                                                "garbage", "click", "smack",  "unknown",  "filler",
                                                "silence", "trans", "pause",  "exclude",  "speech",
                                                "inhale",  "exhal", "sigh",   "unintell", "inaud"};

// How the words for sounds that people make, and for what is not understood, begin. Only such as
// begin nothing else in the languages that most texts are in.
constexpr std::string_view kSoundStems[] = {
    "laugh", "giggl", "chuckl", "sigh", "cough", "sniff", "sob", "gasp", "groan", "grunt", "cries",
    "crying", "clears", "clearing", "breath", "inhal", "exhal", "snort", "scream", "whisper",
    "yawn", "humming", "hums", "whistl", "applau", "music", "noise", "silence", "pause", "click",
    "beep", "inaudib", "unintel", "crosstalk", "cheer", "clap", "snicker", "moan", "sneez", "gulp",
    "swallow", "shout", "mumbl", "murmur", "pant", "blank_audio", "smack", "snor", "chatter",
    "indistinct",
    // German
    "lacht", "lachen", "gelächter", "kichert", "kichern", "seufz", "husten", "hustet", "räusper",
    "stöhn", "schluchz", "flüster", "musik", "beifall", "geräusch", "unverständlich",
    // French
    "rires", "soupir", "tousse", "toux", "musique", "bruit", "sanglot", "chuchot",
    // Spanish, Portuguese, Italian
    "risas", "risos", "risat", "risad", "suspir", "sospir", "tosse", "música", "ruido", "ruído",
    "rumore", "susurr", "sussurr", "aplauso", "silencio", "silêncio", "silenzio",
    // Dutch
    "gelach", "zucht", "hoest", "muziek", "fluister", "snikt"};

constexpr std::size_t kLongestMark = 200;  // bytes; what is longer is an aside
constexpr std::size_t kLongestName = 60;   // of a mark that we do not know

char closing_bracket(char open) {
  switch (open) {
    case '[':
      return ']';
    case '(':
      return ')';
    case '{':
      return '}';
    case '<':
      return '>';
    case '*':
      return '*';
    default:
      return 0;
  }
}

// "clears throat", "LAUGHTER", "speaks softly, sighs".
bool names_a_sound(std::string_view inside) {
  const std::string text = lower_case(inside);
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (!is_letter_or_digit(text[at]) || (at > 0 && is_letter_or_digit(text[at - 1]))) continue;
    const std::string_view word = std::string_view(text).substr(at);
    for (const std::string_view stem : kSoundStems) {
      if (word.starts_with(stem)) return true;
    }
  }
  return false;
}

bool is_known_mark(std::string_view inside) {
  const std::string name = lower_case(inside);
  return names_a_sound(inside) || name == "unk" || name == "sic";
}

// Of what stands in square brackets in prose, some is said: "[he] came", "press [Enter]", "[1]". A
// mark of a name that we do not know stands where a sentence begins or behind its end, and what
// follows it does not go on with the sentence.
bool stands_alone(std::string_view text, std::size_t at, std::size_t end) {
  const std::string_view inside = text.substr(at + 1, end - at - 2);
  if (std::none_of(inside.begin(), inside.end(), is_letter) || inside.size() > kLongestName) {
    return false;
  }
  constexpr std::string_view kBlank = " \t\r\n";
  const std::size_t before = text.substr(0, at).find_last_not_of(kBlank);
  constexpr std::string_view kEnds[] = {".",  "!", "?", "…", "。", "！",
                                        "？", "]", ")", "*", "”",  "\""};
  const std::string_view left = text.substr(0, before + 1);
  const bool begins = before == std::string_view::npos ||
                      text.substr(before + 1, at - before - 1).find('\n') != text.npos ||
                      std::any_of(std::begin(kEnds), std::end(kEnds),
                                  [&](std::string_view sign) { return left.ends_with(sign); });
  if (!begins) return false;
  if (end < text.size() && kBlank.find(text[end]) == kBlank.npos) return false;  // "[H]e", a link
  const std::size_t after = text.find_first_not_of(kBlank, end);
  return after == std::string_view::npos || !(text[after] >= 'a' && text[after] <= 'z');
}

// Where the mark that begins at `at` ends, one behind its last character; 0: none begins there.
std::size_t end_of_mark(std::string_view text, std::size_t at, MarksOf from) {
  const char open = text[at], close = closing_bracket(open);
  if (close == 0) return 0;
  int depth = 0;
  const std::size_t last = std::min(text.size(), at + kLongestMark);
  for (std::size_t i = at; i < last; ++i) {
    const bool ends = text[i] == close && (open != close || i > at);
    if (!ends) {
      depth += text[i] == open ? 1 : 0;
      continue;
    }
    if (--depth > 0) continue;
    const std::string_view inside = text.substr(at + 1, i - at - 1);
    const bool all = from == MarksOf::captions && open != '*' && trimmed(inside).size() > 0;
    const bool alone = from == MarksOf::prose && open == '[' && stands_alone(text, at, i + 1);
    return all || alone || is_known_mark(inside) ? i + 1 : 0;
  }
  return 0;
}

// "++NOISE++", "+SPN+".
bool is_between(std::string_view label, char sign) {
  const std::size_t first = label.find_first_not_of(sign), last = label.find_last_not_of(sign);
  return first != std::string_view::npos && first > 0 && last + 1 < label.size();
}

bool lists(std::span<const std::string_view> list, std::string_view name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

}  // namespace

bool is_mark(std::string_view label) {
  label = trimmed(label);
  if (label.size() < 2 || is_silence_spelling(label)) return false;
  if (lists(kMarkNames, label) || lists(kMarkNames, lower_case(label).substr(0, 16))) {
    return label != "GB";  // of memory
  }
  const char close = closing_bracket(label[0]);
  if (close != 0 && label.back() == close && label.size() > 2) {
    // "(a) or (b)" is none.
    const std::size_t end = label.find(close, 1);
    const bool whole = end + 1 == label.size() || label.find(label[0], 1) < end;
    if (whole) return true;
  }
  return is_between(label, '+') || label.starts_with("&=") || label.starts_with("%%");
}

bool is_mark_among_phones(std::string_view label) {
  if (is_mark(label)) return true;
  std::string name = lower_case(trimmed(label.substr(0, 64)));
  // Kaldi says where in a word.
  if (name.size() > 2 && name[name.size() - 2] == '_') name.resize(name.size() - 2);
  while (name.size() > 2 && name.back() >= '0' && name.back() <= '9') name.pop_back();
  if (lists(kMarkNames, name) || lists(kPhoneMarks, name)) return true;
  // A recording that nobody could cut is not closed either: "[loud".
  if (name.size() > 2 && (name[0] == '[' || name[0] == '<' || name[0] == '%')) return true;
  return std::any_of(std::begin(kPhoneMarkParts), std::end(kPhoneMarkParts),
                     [&](std::string_view part) { return name.find(part) != std::string::npos; });
}

Unmarked without_marks(std::string_view text, MarksOf from) {
  Unmarked out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = end_of_mark(text, at, from);
    if (end == 0) {
      out.text += text[at++];
      continue;
    }
    if (out.count++ == 0) out.mark = text.substr(at, end - at);
    at = end;
    const bool blank = out.text.empty() || out.text.back() == ' ' || out.text.back() == '\n';
    while (blank && at < text.size() && text[at] == ' ') ++at;
    const bool ends = at < text.size() && std::string_view(".,;:!?").find(text[at]) != text.npos;
    if (ends && !out.text.empty() && out.text.back() == ' ') out.text.pop_back();
  }
  return out;
}

}  // namespace animeme::dam
