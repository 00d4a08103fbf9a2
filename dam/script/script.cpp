#include "dam/script/script.h"

#include <algorithm>
#include <cmath>

#include "dam/script/phones.h"
#include "dam/script/script_finish_internal.h"
#include "dam/script/script_readers_internal.h"
#include "dam/script/script_values_internal.h"
#include "dam/script/timings.h"

namespace animeme::dam {
namespace {

struct Format {
  ScriptFormat shown;
  bool (*looks_like)(std::string_view text);
  ReadLabels read;
  TimeUnit unit = TimeUnit::known;
};

// The first that recognises the text reads it: strict tests before lenient ones.
constexpr Format kFormats[] = {
    {{"textgrid", "Praat TextGrid, long or short"},
     looks_like_textgrid,
     read_textgrid,
     TimeUnit::assumed},
    {{"subtitles", "SubRip, WebVTT and SubViewer"}, looks_like_subtitles, read_subtitles},
    {{"ass", "dialogue and karaoke of ASS"}, looks_like_ass, read_ass},
    {{"lrc", "lyrics, with and without times of words"}, looks_like_lrc, read_lrc},
    {{"ttml", "captions in XML: TTML, DFXP"}, looks_like_ttml, read_ttml},
    {{"rhubarb", "mouth cues of Rhubarb Lip Sync"}, looks_like_rhubarb_xml, read_rhubarb_xml},
    {{"moho", "switch data of Moho, Papagayo and Rhubarb"}, looks_like_moho, read_moho},
    {{"papagayo", "words and mouths of Papagayo"}, looks_like_papagayo, read_papagayo},
    {{"mfa", "Montreal Forced Aligner"}, looks_like_mfa_table, read_mfa_table, TimeUnit::assumed},
    {{"esps", "ESPS labels, as Festival writes them"}, looks_like_esps, read_esps},
    {{"phseg", "phones or words of PocketSphinx"}, looks_like_phseg, read_phseg},
    {{"tsv", "a table whose header names start_s, end_s and phone or word"},
     looks_like_tsv,
     read_tsv,
     TimeUnit::assumed},
    {{"rhubarb", {}}, looks_like_rhubarb_tsv, read_rhubarb_tsv},
    {{"flite", "phones and their ends, as flite -psdur prints them"}, looks_like_flite, read_flite},
    {{"ctm", "CTM of NIST and Kaldi"}, looks_like_ctm, read_ctm, TimeUnit::assumed},
    {{"htk", "HTK labels and master label files"}, looks_like_htk, read_htk},
    {{"timit", "TIMIT, in samples"}, looks_like_timit, read_timit},
    {{"labels", "lines of start, end and label in seconds, as Audacity writes them"},
     looks_like_plain_labels,
     read_plain_labels,
     TimeUnit::assumed},
    {{"pho", "MBROLA"}, looks_like_pho, read_pho},
};

std::vector<ScriptFormat> shown_formats() {
  std::vector<ScriptFormat> shown;
  for (const Format& format : kFormats) {
    if (!format.shown.title.empty()) shown.push_back(format.shown);
  }
  return shown;
}

Error unknown_format() {
  std::string names;
  for (const ScriptFormat& format : text_script_formats()) {
    names += (names.empty() ? "" : ", ") + std::string(format.name);
  }
  return error_at_line(Code::syntax,
                       "not a phoneme script of a known format; known text formats: " + names, 1);
}

// The one that is named and recognises the text, else the one that is named.
Result<const Format*> choose_format(std::string_view utf8, std::string_view name) {
  const Format* named = nullptr;
  for (const Format& format : kFormats) {
    if (!name.empty() && format.shown.name != name) continue;
    if (named == nullptr) named = &format;
    if (format.looks_like(utf8)) return &format;
  }
  if (!name.empty() && named != nullptr) return named;
  if (name.empty()) return unknown_format();
  return make_error(Code::invalid_argument, "there is no script format named " + in_quotes(name) +
                                                "; " + unknown_format().message);
}

}  // namespace

std::span<const ScriptFormat> text_script_formats() {
  static const std::vector<ScriptFormat> shown = shown_formats();
  return shown;
}

bool looks_like_script(std::string_view utf8) {
  return std::any_of(std::begin(kFormats), std::end(kFormats),
                     [&](const Format& format) { return format.looks_like(utf8); });
}

Result<Timings> read_timings(std::string_view text, const ScriptOptions& options) {
  if (!(options.rate >= 0) || !std::isfinite(options.rate)) {
    return make_error(Code::invalid_argument, "the rate of a script must be a number above 0");
  }
  OddBytes odd;
  const std::string utf8 = to_utf8(text, &odd);
  if (utf8.find_first_not_of(" \t\r\n") == std::string::npos) {
    return make_error(Code::truncated, "the script is empty; align or type at least one phone");
  }
  const auto format = choose_format(utf8, options.format);
  if (!format) return format.error();
  auto timings = (*format)->read(utf8, options);
  if (!timings) return timings.error();
  note_odd_bytes(timings->notes, odd);
  timings->format = (*format)->shown.name;
  if (options.alphabet != Alphabet::automatic) timings->alphabet = options.alphabet;
  if (auto done = finish_labels(*timings, options, (*format)->unit); !done) return done.error();
  return timings;
}

Result<Script> read_script(std::string_view text, const ScriptOptions& options,
                           std::vector<ScriptNote>* notes) {
  const auto timings = read_timings(text, options);
  if (!timings) return timings.error();
  if (notes != nullptr) *notes = timings->notes;
  return make_script(*timings);
}

Result<void> check_script(const Script& script) {
  if (script.phones.empty()) return make_error(Code::truncated, "the script holds no phones");
  double reached = 0;
  for (std::size_t i = 0; i < script.phones.size(); ++i) {
    const Phone& phone = script.phones[i];
    const std::string name = "phone " + std::to_string(i + 1) + " " + in_quotes(phone.label);
    const auto refuse = [&](const std::string& what) {
      return make_error(Code::invalid_argument, name + " " + what);
    };
    if (find_phone(phone.label) == nullptr) return refuse("has no label of dam/script/phones.h");
    if (!(phone.start >= 0) || !(phone.end <= kMaxScriptSeconds)) {
      return refuse("has a time outside 0 s to one day");
    }
    if (!(phone.end > phone.start)) return refuse("does not end after its start");
    if (phone.start < reached - kTimeTolerance) return refuse("overlaps the previous phone");
    reached = phone.end;
  }
  return {};
}

Result<void> check_against_audio(const Script& script, double audio_seconds) {
  constexpr double kAllowed = 0.05;
  // Some TTS engines report more silence at the end than they produce.
  const auto last = std::find_if(script.phones.rbegin(), script.phones.rend(),
                                 [](const Phone& phone) { return phone.label != kSilence; });
  const double seconds = last == script.phones.rend() ? 0 : last->end;
  if (!std::isfinite(audio_seconds) || audio_seconds < seconds - kAllowed) {
    return make_error(Code::out_of_range,
                      "the script lasts " + format_seconds(seconds) + " s but the audio only " +
                          format_seconds(audio_seconds) +
                          " s; use the recording that the script was made from");
  }
  return {};
}

}  // namespace animeme::dam
