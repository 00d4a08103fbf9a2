#include "dam/script/script_timeline_internal.h"

#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "dam/script/ipa.h"
#include "dam/script/phones.h"
#include "dam/script/script_text_internal.h"

namespace animeme::dam {
namespace {

using Labels = std::vector<IpaPhone>;

// Upper-case letters and digits alone are more likely a misspelt ARPAbet label than X-SAMPA.
bool may_be_arpabet(std::string_view label) {
  return label.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789") == label.npos;
}

// Labels that only one of the two alphabets has decide which one the script is written in:
// consonants like "s" are in both.
Alphabet guess_alphabet(const std::map<std::string_view, std::int64_t>& labels) {
  std::size_t only_arpabet = 0, only_ipa = 0;
  for (const auto& [label, line] : labels) {
    if (is_silence_spelling(label)) continue;
    const std::string_view known = arpabet_label(label);
    if (known.size() == 2 && label.size() >= 2) {
      ++only_arpabet;
    } else if (known.empty() && !may_be_arpabet(label) && parse_ipa(label)) {
      ++only_ipa;
    }
  }
  return only_ipa > only_arpabet ? Alphabet::ipa : Alphabet::arpabet;
}

Error unknown_label(std::string_view label, std::int64_t line, Alphabet alphabet) {
  std::string message = "unknown phone label " + in_quotes(label);
  if (alphabet == Alphabet::arpabet) {
    message += "; the nearest ARPAbet label is " + std::string(nearest_label(label));
  } else {
    const auto parsed = parse_ipa(label);
    if (!parsed) message += ": " + parsed.error().message;
  }
  return error_at_line(Code::not_found, message, line);
}

std::optional<Labels> map_label(std::string_view label, Alphabet alphabet) {
  if (is_silence_spelling(label)) return Labels{{kSilence, 1.0}};
  if (alphabet == Alphabet::arpabet) {
    const std::string_view known = arpabet_label(label);
    if (!known.empty()) return Labels{{known, 1.0}};
    // One foreign letter in an otherwise English script is still clear; Latin letters are not.
    bool ascii = true;
    for (const char c : label) ascii = ascii && static_cast<unsigned char>(c) < 0x80;
    if (ascii) return std::nullopt;
  }
  auto parsed = parse_ipa(label);
  if (!parsed) return std::nullopt;
  return *std::move(parsed);
}

std::string seconds_text(double seconds) { return format_seconds(seconds) + " s"; }

std::optional<Error> check_times(const RawPhone& phone) {
  const std::string name = "phone " + in_quotes(phone.label);
  if (!std::isfinite(phone.start) || !std::isfinite(phone.end)) {
    return error_at_line(Code::out_of_range, name + " has a time that is not a finite number",
                         phone.line);
  }
  if (phone.start < 0) {
    return error_at_line(Code::syntax,
                         name + " starts at " + seconds_text(phone.start) +
                             ", before the audio; times count from its start and are not negative",
                         phone.line);
  }
  if (phone.end <= phone.start) {
    return error_at_line(Code::syntax,
                         name + " ends at " + seconds_text(phone.end) +
                             ", not after its start at " + seconds_text(phone.start) +
                             "; give it a duration or remove it",
                         phone.line);
  }
  if (phone.end > kMaxScriptSeconds) {
    return error_at_line(Code::out_of_range,
                         name + " ends at " + seconds_text(phone.end) +
                             ", beyond one day; times are in seconds (not samples or ms), and "
                             "longer scripts have to be split",
                         phone.line);
  }
  return std::nullopt;
}

std::optional<Error> check_order(const RawPhone& before, const RawPhone& phone) {
  const std::string names = "phone " + in_quotes(phone.label) + " starts at " +
                            seconds_text(phone.start) + ", before " + in_quotes(before.label);
  if (phone.start <= before.start) {
    return error_at_line(
        Code::syntax,
        names + " (line " + std::to_string(before.line) + ") or with it; sort the phones by time",
        phone.line);
  }
  if (phone.start < before.end - kTimeTolerance - 1e-9) {
    return error_at_line(Code::syntax,
                         names + " (line " + std::to_string(before.line) + ") ends at " +
                             seconds_text(before.end) +
                             "; phones must not overlap, so move one of the two times",
                         phone.line);
  }
  return std::nullopt;
}

// Words keep to one line without blanks at the ends, so that every format can hold them.
std::string clean_word(std::string_view word) {
  std::string out(word);
  for (char& c : out) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
  }
  return std::string(trimmed(out));
}

void append(std::vector<Phone>& phones, Phone phone) {
  const bool silent = phone.label == kSilence;
  phone.word = silent ? std::string() : clean_word(phone.word);
  if (silent && !phones.empty() && phones.back().label == kSilence) {
    phones.back().end = phone.end;
  } else {
    phones.push_back(std::move(phone));
  }
}

// Ends the last phone at `end`, which differs by rounding only: the later entry of the file
// decides. Halves of a very short affricate may begin after it and go.
void move_end(std::vector<Phone>& phones, double end) {
  while (phones.size() > 1 && phones.back().start >= end) phones.pop_back();
  phones.back().end = end;
}

// One interval with the phones that its label stands for.
void append(std::vector<Phone>& phones, const RawPhone& raw, double start, const Labels& labels) {
  if (labels.empty()) {  // a lone length mark: the sound before it goes on
    if (phones.empty()) {
      append(phones, {start, raw.end, std::string(kSilence), {}});
    } else {
      phones.back().end = raw.end;
    }
    return;
  }
  double share = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const double from = i == 0 ? start : phones.back().end;
    share += labels[i].share;
    const double to = i + 1 == labels.size() ? raw.end : start + share * (raw.end - start);
    if (to > from) append(phones, {from, to, std::string(labels[i].label), raw.word});
  }
}

}  // namespace

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kShown = 40;
  std::string out = "\"";
  for (const char c : text.substr(0, kShown)) {
    const auto byte = static_cast<unsigned char>(c);
    out += byte < 0x20 || byte == 0x7F ? '?' : c;
  }
  return out + (text.size() > kShown ? "...\"" : "\"");
}

std::string format_seconds(double seconds) {
  char buffer[64];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, seconds).ptr;
  return {buffer, end};
}

Result<double> parse_seconds(std::string_view field, std::int64_t line, std::string_view what) {
  std::string_view digits = field;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range || (error == std::errc() && !std::isfinite(value))) {
    return error_at_line(Code::out_of_range,
                         "the " + std::string(what) + " time " + in_quotes(field) +
                             " is not a finite number of seconds",
                         line);
  }
  if (error != std::errc() || end != digits.data() + digits.size()) {
    std::string message = "the " + std::string(what) + " time " + in_quotes(field) +
                          " is not a number; write seconds with a decimal point, like 0.25";
    return error_at_line(Code::syntax, message, line);
  }
  return value == 0 ? 0.0 : value;  // no negative zero
}

Result<Script> make_script(const std::vector<RawPhone>& raw, Alphabet alphabet) {
  if (raw.empty()) {
    return make_error(Code::truncated, "the script holds no phones; align or type at least one");
  }
  std::map<std::string_view, std::int64_t> lines;
  for (const RawPhone& phone : raw) lines.try_emplace(phone.label, phone.line);
  if (alphabet == Alphabet::automatic) alphabet = guess_alphabet(lines);
  std::map<std::string_view, Labels> mapped;
  for (const RawPhone& phone : raw) {
    if (mapped.contains(phone.label)) continue;
    auto labels = map_label(phone.label, alphabet);
    if (!labels) return unknown_label(phone.label, phone.line, alphabet);
    mapped.emplace(phone.label, *std::move(labels));
  }
  Script script;
  const RawPhone* before = nullptr;
  for (const RawPhone& phone : raw) {
    if (const auto error = check_times(phone)) return *error;
    if (before != nullptr) {
      if (const auto error = check_order(*before, phone)) return *error;
    }
    const double reached = script.duration();
    double start = phone.start;
    if (start - reached > kTimeTolerance) {
      append(script.phones, {reached, start, std::string(kSilence), {}});
    } else if (before == nullptr) {
      start = 0;
    } else {
      move_end(script.phones, start);
    }
    append(script.phones, phone, start, mapped[phone.label]);
    before = &phone;
  }
  return script;
}

}  // namespace animeme::dam
