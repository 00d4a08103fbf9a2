// What the readers of JSON scripts share: values that know where they stand, and the labels found.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dam/script/script_finish_internal.h"
#include "dam/script/timings.h"
#include "dam/script/viseme_phones.h"
#include "fap/result.h"
#include "tools/formats/common/json.h"

namespace animeme::scripts {

using tools::Json;

/// A value and its way there: the number of its document and JSON pointers, "0/words/3".
struct Node {
  const Json* value = nullptr;
  std::string path;

  bool exists() const { return value != nullptr; }
  bool is_array() const { return exists() && value->is_array(); }
  bool is_object() const { return exists() && value->is_object(); }
  std::size_t size() const { return is_array() ? value->size() : 0; }
  /// The member of one of these names, "_" and case aside; none: not exists().
  Node member(std::initializer_list<std::string_view> names) const;
  Node at(std::size_t index) const;
  /// A number, also one that is written as text; nothing for anything else, or what is not finite.
  std::optional<double> number() const;
  /// A text without blanks at its ends; nothing for anything else.
  std::optional<std::string> text() const;
};

/// Labels, whose `line` is the number of their path until place_labels() has been there.
struct JsonLabels {
  std::vector<dam::TimedLabel> labels;
  std::vector<std::string> paths;
  dam::Alphabet alphabet = dam::Alphabet::automatic;
  std::vector<dam::ScriptNote> notes;  // their lines are numbers of paths, too

  dam::TimedLabel& add(const Node& node, double start, double end, std::string label, bool is_word);
  Error error(Code code, std::string message, const Node& node);
};

/// All objects that `wanted` is true for, not those inside of them; as deep as services nest.
std::vector<Node> find_objects(const std::vector<Node>& roots,
                               const std::function<bool(const Node&)>& wanted);

/// The phone of a viseme. Error: not_found.
Result<std::string> viseme_label(JsonLabels& out, const Node& node, dam::VisemeSet set,
                                 const std::string& name);

/// Whether a character is spoken: a letter or a digit, of any script.
bool is_spoken(char32_t code);

/// Drops words in which nothing is spoken: blanks and punctuation, which some services list as
/// well.
void drop_unspoken(std::vector<dam::TimedLabel>& labels);

/// The times between which the words of a segment are, seconds.
struct Border {
  double start = -1, end = -1;  ///< negative: unknown
};

/// Words whose times are missing (end <= start) get usual lengths between their neighbours and the
/// borders of their segment, or join the one before where there is no room. `borders` is as long as
/// the labels or empty. Those in which nothing is spoken go first.
void give_times(JsonLabels& out, std::vector<Border> borders = {});

/// Sets line and column of all labels and notes, and of `error`, which may be nullptr, by walking
/// through the texts of the documents once. `offsets`: where each begins in `text`.
void place_labels(std::string_view text, const std::vector<std::size_t>& offsets, JsonLabels& out,
                  Error* error);

/// A format: whether the documents are of it, and its reader.
struct JsonFormat {
  dam::ScriptFormat shown;
  bool (*looks_like)(const std::vector<Node>& roots);
  Result<void> (*read)(const std::vector<Node>& roots, const dam::ScriptOptions& options,
                       JsonLabels& out);
  dam::TimeUnit unit = dam::TimeUnit::known;
};

std::span<const JsonFormat> aligner_formats();  ///< Montreal, Gentle, Rhubarb, Kokoro
std::span<const JsonFormat> word_formats();     ///< recognisers: words with times
std::span<const JsonFormat> event_formats();    ///< Azure, Polly
std::span<const JsonFormat> array_formats();    ///< ElevenLabs, Inworld, HeadTTS, Cartesia

}  // namespace animeme::scripts
