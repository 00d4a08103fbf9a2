// What one message of a speech service holds.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/formats/media/pcm.h"

namespace animeme::speech {

/// A message, taken apart.
struct PieceMessage {
  std::string utterance;            ///< its name; empty: that of all pieces without a name
  std::string text;                 ///< what is said
  bool text_goes_on = false;        ///< `text` is to be added to what came before
  std::string language;             ///< empty: not said
  std::vector<std::uint8_t> bytes;  ///< of the sound
  std::string file;                 ///< path of the sound
  std::optional<media::Pcm> pcm;    ///< the sound, where it came as samples
  std::string coding;               ///< name of the coding of `bytes`; empty: not said
  double sample_rate = 0;           ///< Hz; 0: not said
  int channels = 0;                 ///< 0: not said
  std::string labels;               ///< times of words, phones or visemes, or what may be that
  bool labels_given = false;        ///< `labels` is a "script": certainly times
  bool labels_are_events = false;   ///< it is one event: nothing else is in the message
  enum class From : std::uint8_t { unknown, piece, utterance };
  From times_from = From::unknown;  ///< where its times count from
  bool last = false;                ///< the utterance ends
  bool small_talk = false;          ///< it is a message of a service about other things
  std::string error;                ///< the service says that something is wrong

  bool has_sound() const { return !bytes.empty() || !file.empty() || pcm; }
  /// Whether it says how the sound of others is stored.
  bool has_format() const { return !coding.empty() || sample_rate > 0 || channels > 0; }
};

/// Reads a message. Errors: those of parse_object(); syntax (a member of a wrong type, invalid
/// base64), invalid_argument (a rate, channels or "times_from" that cannot be).
Result<PieceMessage> read_message(std::string_view json);

}  // namespace animeme::speech
