// The readers of scripts, one a format or a family of them, and the lines that they walk along.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dam/script/ipa.h"
#include "dam/script/script_text_internal.h"
#include "dam/script/timings.h"

namespace animeme::dam {

/// How write_webvtt() begins where it writes phones for want of words.
inline constexpr std::string_view kPhonesHeader = "WEBVTT phones";

/// A reader; `text` is UTF-8. It sets neither `format` nor what looks_like_words() decides.
using ReadLabels = Result<Timings> (*)(std::string_view text, const ScriptOptions& options);

Result<Timings> read_textgrid(std::string_view text, const ScriptOptions& options);
Result<Timings> read_mfa_table(std::string_view text, const ScriptOptions& options);
Result<Timings> read_tsv(std::string_view text, const ScriptOptions& options);
Result<Timings> read_htk(std::string_view text, const ScriptOptions& options);
Result<Timings> read_timit(std::string_view text, const ScriptOptions& options);
Result<Timings> read_plain_labels(std::string_view text, const ScriptOptions& options);
Result<Timings> read_esps(std::string_view text, const ScriptOptions& options);
Result<Timings> read_pho(std::string_view text, const ScriptOptions& options);
Result<Timings> read_ctm(std::string_view text, const ScriptOptions& options);
Result<Timings> read_phseg(std::string_view text, const ScriptOptions& options);
Result<Timings> read_flite(std::string_view text, const ScriptOptions& options);
Result<Timings> read_rhubarb_tsv(std::string_view text, const ScriptOptions& options);
Result<Timings> read_rhubarb_xml(std::string_view text, const ScriptOptions& options);
Result<Timings> read_moho(std::string_view text, const ScriptOptions& options);
Result<Timings> read_papagayo(std::string_view text, const ScriptOptions& options);
Result<Timings> read_subtitles(std::string_view text, const ScriptOptions& options);
Result<Timings> read_lrc(std::string_view text, const ScriptOptions& options);
Result<Timings> read_ass(std::string_view text, const ScriptOptions& options);
Result<Timings> read_ttml(std::string_view text, const ScriptOptions& options);

/// Do they feel responsible for this text?
bool looks_like_textgrid(std::string_view text);
bool looks_like_mfa_table(std::string_view text);
bool looks_like_tsv(std::string_view text);
bool looks_like_htk(std::string_view text);
bool looks_like_timit(std::string_view text);
bool looks_like_plain_labels(std::string_view text);
bool looks_like_esps(std::string_view text);
bool looks_like_pho(std::string_view text);
bool looks_like_ctm(std::string_view text);
bool looks_like_phseg(std::string_view text);
bool looks_like_flite(std::string_view text);
bool looks_like_rhubarb_tsv(std::string_view text);
bool looks_like_rhubarb_xml(std::string_view text);
bool looks_like_moho(std::string_view text);
bool looks_like_papagayo(std::string_view text);
bool looks_like_subtitles(std::string_view text);
bool looks_like_lrc(std::string_view text);
bool looks_like_ass(std::string_view text);
bool looks_like_ttml(std::string_view text);

/// Whether the phones of a label are one sound: no syllable, nor letters that happen to be a word.
bool is_one_sound(std::string_view label, const std::vector<IpaPhone>& phones);

/// Whether a label can only be a phone of pinyin, "iang4".
bool is_phone_of_a_set(std::string_view label);

/// Where all labels are pinyin or Japanese phones, and are not ARPAbet: their IPA.
void phones_of_sets_to_ipa(std::vector<TimedLabel>& labels);

/// Marks the labels as words where `unit` says so, or where most of them cannot be phones.
void decide_unit(std::vector<TimedLabel>& labels, LabelUnit unit);

/// A line cut at blanks and tabs.
struct LabelRow {
  std::int64_t line = 0;
  std::string_view text;
  std::vector<std::string_view> fields;

  std::int64_t column(std::size_t field) const { return fields[field].data() - text.data() + 1; }
  /// The rest of the line from a field on, without blanks at its end.
  std::string_view from(std::size_t field) const;
  /// An error at a field; at the line if there is no such field.
  Error error(Code code, std::string message, std::size_t field) const;
  /// A field as a number of seconds, divided by `rate`. Errors: syntax (no number, or the field is
  /// not there), out_of_range (not finite).
  Result<double> seconds(std::size_t field, std::string_view what, double rate = 1) const;
  bool is_number(std::size_t field) const;
  bool is_integer(std::size_t field) const;
  /// A label with its place.
  TimedLabel label_at(std::size_t field, double start, double end) const;
};

/// Takes the lines with content off a text; those that begin with `comment` are passed over.
class LabelRows {
 public:
  explicit LabelRows(std::string_view text, std::string_view comment = {})
      : reader_(text), comment_(comment) {}
  bool next(LabelRow& row);

 private:
  LineReader reader_;
  std::string_view comment_;
};

/// The first lines with content, at most `most`.
std::vector<LabelRow> first_rows(std::string_view text, std::size_t most,
                                 std::string_view comment = {});

/// Recordings of one file: which of them is read. Errors: not_found (no such recording, or several
/// and none named; the message lists them).
Result<std::string> choose_recording(const std::vector<std::string>& names,
                                     const std::string& wanted);

/// `name` or, if that is empty, an error that says what the file lacks.
Error nothing_in(std::string_view format);

/// How long the last of events without an end lasts at most.
double longest_event(const TimedLabel& label);

/// The rate of the options, or the usual one.
inline double rate_or(const ScriptOptions& options, double usual) {
  return options.rate > 0 ? options.rate : usual;
}

}  // namespace animeme::dam
