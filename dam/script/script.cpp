#include "dam/script/script.h"

#include <cmath>

#include "dam/script/phones.h"
#include "dam/script/script_text_internal.h"
#include "dam/script/script_timeline_internal.h"

namespace animeme::dam {
namespace {

struct Format {
  std::string_view name;
  bool (*looks_like)(std::string_view text);
  Result<Script> (*read)(std::string_view text, const ScriptOptions& options);
};

// The first that recognises the text reads it: strict tests before lenient ones.
constexpr Format kFormats[] = {
    {"Praat TextGrid", looks_like_textgrid, read_textgrid},
    {"TSV with a header line (start_s, end_s, phone)", looks_like_tsv, read_tsv},
};

Error unknown_format() {
  std::string names;
  for (const Format& format : kFormats) {
    if (!names.empty()) names += ", ";
    names += format.name;
  }
  return error_at_line(Code::syntax, "not a phoneme script of a known format; these are: " + names,
                       1);
}

}  // namespace

Result<Script> read_script(std::string_view text, const ScriptOptions& options) {
  const std::string utf8 = to_utf8(text);
  if (utf8.find_first_not_of(" \t\r\n") == std::string::npos) {
    return make_error(Code::truncated, "the script is empty; align or type at least one phone");
  }
  for (const Format& format : kFormats) {
    if (format.looks_like(utf8)) return format.read(utf8, options);
  }
  return unknown_format();
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
    if (phone.start < reached - kTimeTolerance) return refuse("overlaps the phone before it");
    reached = phone.end;
  }
  return {};
}

Result<void> check_against_audio(const Script& script, double audio_seconds) {
  constexpr double kAllowed = 0.05;
  if (!std::isfinite(audio_seconds) || audio_seconds < script.duration() - kAllowed) {
    return make_error(Code::out_of_range,
                      "the script lasts " + format_seconds(script.duration()) +
                          " s but the audio only " + format_seconds(audio_seconds) +
                          " s; use the recording that the script was made from");
  }
  return {};
}

}  // namespace animeme::dam
