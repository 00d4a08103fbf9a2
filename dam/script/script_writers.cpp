// Scripts for MBROLA and as subtitles. TSV and TextGrids are written beside their readers.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "dam/script/script.h"
#include "dam/script/script_readers_internal.h"
#include "dam/script/script_text_internal.h"
#include "dam/script/script_values_internal.h"

namespace animeme::dam {
namespace {

struct Writer {
  std::string_view ending;
  std::string (*write)(const Script& script);
};

constexpr Writer kWriters[] = {{".TextGrid", write_textgrid},
                               {".tsv", write_script_tsv},
                               {".pho", write_pho},
                               {".vtt", write_webvtt}};

std::string clock(double seconds) {
  const auto total = std::int64_t(std::llround(seconds * 1000));
  char text[40];
  std::snprintf(text, sizeof text, "%02d:%02d:%02d.%03d", int(total / 3600000),
                int(total / 60000 % 60), int(total / 1000 % 60), int(total % 1000));
  return text;
}

std::string escaped(std::string_view word) {
  std::string out;
  for (const char c : word) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else {
      out += c;
    }
  }
  return out;
}

// Phones of one word, or one phone where no word is known.
struct Spoken {
  double start = 0, end = 0;
  std::string_view text;
};

bool names_words(const Script& script) {
  return std::any_of(script.phones.begin(), script.phones.end(),
                     [](const Phone& phone) { return !phone.word.empty(); });
}

// What is said without a pause.
std::vector<std::vector<Spoken>> phrases_of(const Script& script) {
  const bool words = names_words(script);
  std::vector<std::vector<Spoken>> phrases;
  bool pause = true;
  for (const Phone& phone : script.phones) {
    const std::string_view text = words ? phone.word : phone.label;
    const bool silent = phone.label == kSilence || text.empty();
    if (!silent && pause) phrases.emplace_back();
    if (!silent) {
      auto& phrase = phrases.back();
      if (words && !phrase.empty() && phrase.back().text == text) {
        phrase.back().end = phone.end;
      } else {
        phrase.push_back({phone.start, phone.end, text});
      }
    }
    pause = silent;
  }
  return phrases;
}

}  // namespace

std::string write_pho(const Script& script) {
  std::string out = "; phones in ARPAbet, milliseconds\n";
  std::int64_t written = 0;  // microseconds: what is rounded does not add up
  for (const Phone& phone : script.phones) {
    const auto until = std::max<std::int64_t>(written + 1, std::llround(phone.end * 1e6));
    out += (phone.label == kSilence ? "_" : phone.label) + ' ' +
           format_seconds(double(until - written) / 1000) + '\n';
    written = until;
  }
  return out;
}

std::string write_webvtt(const Script& script) {
  const bool words = names_words(script);
  std::string out = std::string(words ? "WEBVTT" : kPhonesHeader) + "\n";
  for (const auto& phrase : phrases_of(script)) {
    out += "\n" + clock(phrase.front().start) + " --> " + clock(phrase.back().end) + "\n";
    for (const Spoken& spoken : phrase) {
      if (&spoken != &phrase.front()) out += " ";
      out += "<" + clock(spoken.start) + ">" + escaped(spoken.text);
    }
    out += "\n";
  }
  return out;
}

std::vector<std::string> script_endings() {
  std::vector<std::string> endings;
  for (const Writer& writer : kWriters) endings.emplace_back(writer.ending);
  return endings;
}

std::string write_script(const Script& script, std::string_view ending) {
  for (const Writer& writer : kWriters) {
    if (lower_case(writer.ending) == lower_case(ending)) return writer.write(script);
  }
  return write_textgrid(script);
}

}  // namespace animeme::dam
