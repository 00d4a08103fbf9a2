/// @file
/// What a client says to a head bit by bit: sound, lines and pieces, by a WebSocket or in a body.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "fap/result.h"
#include "tools/formats/media/pcm.h"
#include "tools/live/serve/head.h"
#include "tools/live/web/web_server.h"
#include "tools/speech/talking/sound_bytes.h"

namespace animeme::serve {

/// What bytes are.
struct IntakeFormat {
  /// Kind of the bytes of a body, or of binary messages.
  enum class Kind : std::uint8_t {
    lines,  ///< text, commands and pieces, one in each line; or JSON as a whole
    wav,    ///< sound with a header, as it comes
    bare,   ///< samples
    file,   ///< a whole file of any other format that FFmpeg reads
  };
  Kind kind = Kind::lines;  ///< kind
  speech::BareSound bare;   ///< of samples
  bool big_endian = false;  ///< of samples of 16 bits (audio/L16)
  std::string id;           ///< of the utterance; empty: it gets one
};

/// By the media type of a body and the query of its address: `?pcm=24000`, `mulaw` ... as --pcm,
/// `?id=NAME`; else "audio/wav", "audio/L16;rate=16000;channels=1" (RFC 2586), "audio/PCMU" and
/// "audio/PCMA" (RFC 4856), other audio and "application/octet-stream" as files, all others as
/// lines. Errors: invalid_argument (a rate that cannot be).
Result<IntakeFormat> intake_format(const std::string& type, const std::string& query);

/// The value of a name in the query of an address; empty: it is not there.
std::string query_value(const std::string& query, const std::string& name);

/// Works in a thread of its server, not in that of the web server. Thread safe.
class SayIntake : public web::Intake, public std::enable_shared_from_this<SayIntake> {
 public:
  /// What it needs of its server.
  struct Services {
    std::function<void(std::function<void()>)> post;  ///< runs jobs, one behind the other
    std::function<bool()> full;                       ///< all heads together have enough sound
    /// Says lines as a request does, and gives its answer.
    std::function<web::ServerReply(std::string body)> say;
  };
  /// `name`: of utterances without one. Sound is refused, also that of files, behind `most_bytes`
  /// bytes of a file.
  SayIntake(std::shared_ptr<Head> head, IntakeFormat format, bool socket, std::string name,
            Services services, web::ServerAnswer answer);

  static constexpr std::size_t kMostFile = std::size_t(8) << 20;  ///< bytes of what is read whole

  void take(std::string bytes, bool text) override;
  bool full() const override;
  void end(bool whole) override;

 private:
  void work(const std::string& bytes, bool text);
  void take_line(const std::string& line);
  Result<void> take_sound(const std::string& bytes);
  Result<void> flush(bool last);
  void finish(bool whole);
  void fail(const Error& error);

  const std::shared_ptr<Head> head_;
  const IntakeFormat format_;
  const bool socket_;
  const std::string name_;
  const Services services_;
  const web::ServerAnswer answer_;
  std::atomic<std::size_t> waiting_ = 0;  // bytes that were taken and not worked on

  // Of the thread that works.
  std::optional<speech::SoundBytes> sound_;
  std::vector<float> samples_;
  std::string rest_, id_;
  std::uint64_t utterances_ = 0;
  double seconds_ = 0;  // of sound
  std::optional<web::ServerReply> refusal_;
  tools::Json ids_ = tools::Json::array();
  std::size_t lines_ = 0;
};

}  // namespace animeme::serve
