// Scripts for MBROLA and as subtitles. TSV and TextGrids are written beside their readers.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "dam/script/captions.h"
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
                               {".vtt", write_webvtt},
                               {".srt", write_srt}};

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

// The words of a line with their times. A time after a word says where it ends, if the next one
// does not begin there.
void append_line(std::string& out, const std::vector<ScriptWord>& line, double until) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    const ScriptWord& word = line[i];
    if (i > 0 && blank_between(line[i - 1].text, word.text)) out += ' ';
    out += '<' + clock(word.start) + '>' + escaped(word.text);
    const double next = i + 1 < line.size() ? line[i + 1].start : until;
    if (clock(next) != clock(word.end)) out += '<' + clock(word.end) + '>';
  }
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

std::string caption_webvtt(const Caption& caption) {
  std::string out;
  for (std::size_t i = 0; i < caption.lines.size(); ++i) {
    const bool last = i + 1 == caption.lines.size();
    if (i > 0) out += '\n';
    append_line(out, caption.lines[i], last ? caption.end : caption.lines[i + 1].front().start);
  }
  return out;
}

std::string write_webvtt(const Script& script) {
  const bool words = std::any_of(script.phones.begin(), script.phones.end(),
                                 [](const Phone& phone) { return !phone.word.empty(); });
  std::string out = std::string(words ? "WEBVTT" : kPhonesHeader) + "\n";
  for (const Caption& caption : captions_of(script)) {
    out += "\n" + clock(caption.start) + " --> " + clock(caption.end) + "\n" +
           caption_webvtt(caption) + "\n";
  }
  return out;
}

std::string write_srt(const Script& script) {
  std::string out;
  int number = 0;
  for (const Caption& caption : captions_of(script)) {
    std::string times = clock(caption.start) + " --> " + clock(caption.end);
    std::replace(times.begin(), times.end(), '.', ',');
    if (++number > 1) out += '\n';
    out += std::to_string(number) + "\n" + times + "\n" + caption_text(caption) + "\n";
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
