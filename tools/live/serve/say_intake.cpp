#include "tools/live/serve/say_intake.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "tools/formats/media/audio.h"
#include "tools/formats/media/detail/tracks/words_internal.h"

namespace animeme::serve {
namespace {

using tools::Json;
using Kind = IntakeFormat::Kind;

constexpr double kLeastSound = 0.06;                      // seconds that are said at once
constexpr std::size_t kMostWaiting = 256 * 1024;          // bytes
constexpr std::size_t kFullSound = std::size_t(4) << 20;  // bytes of sound that wait for the head

web::ServerReply refused(unsigned status, const std::string& sentence) {
  return {status, Json{{"error", sentence}}.dump() + "\n"};
}

// The value of a parameter of a media type, such as "rate=16000".
std::string parameter(const std::string& type, std::string_view name) {
  for (std::size_t at = type.find(';'); at != std::string::npos; at = type.find(';', at + 1)) {
    const std::size_t begin = type.find_first_not_of("; \t", at);
    if (begin == std::string::npos || !std::string_view(type).substr(begin).starts_with(name)) {
      continue;
    }
    const std::size_t equals = begin + name.size();
    if (equals >= type.size() || type[equals] != '=') continue;
    return std::string(media::trim(type.substr(equals + 1, type.find(';', equals) - equals - 1)));
  }
  return {};
}

std::string bare_text(const std::string& type, const std::string& usual_rate) {
  std::string text = parameter(type, "rate");
  if (text.empty()) text = usual_rate;
  const std::string channels = parameter(type, "channels");
  return channels.empty() ? text : text + ":" + channels;
}

}  // namespace

std::string query_value(const std::string& query, const std::string& name) {
  for (std::size_t at = 0; at < query.size();) {
    const std::size_t end = std::min(query.find('&', at), query.size());
    const std::string part = query.substr(at, end - at);
    if (part.starts_with(name + "=")) return part.substr(name.size() + 1);
    at = end + 1;
  }
  return {};
}

Result<IntakeFormat> intake_format(const std::string& type, const std::string& query) {
  IntakeFormat format;
  format.id = query_value(query, "id");
  const std::string kind =
      media::lower_case(std::string(media::trim(type.substr(0, type.find(';')))));
  std::string bare = query_value(query, "pcm");
  if (bare.empty()) {
    if (kind == "audio/l16") {
      bare = bare_text(type, "44100");
      format.big_endian = true;
    } else if (kind == "audio/pcm") {
      bare = bare_text(type, "24000");
    } else if (kind == "audio/pcmu" || kind == "audio/basic") {
      bare = "mulaw";
    } else if (kind == "audio/pcma") {
      bare = "alaw";
    }
  }
  if (!bare.empty()) {
    const Result<speech::BareSound> read = speech::parse_bare_sound(bare);
    if (!read) return read.error();
    format.kind = Kind::bare;
    format.bare = *read;
  } else if (kind == "audio/wav" || kind == "audio/x-wav" || kind == "audio/wave" ||
             kind == "audio/vnd.wave") {
    format.kind = Kind::wav;
  } else if (kind.starts_with("audio/") || kind == "application/octet-stream") {
    format.kind = Kind::file;
  }
  return format;
}

SayIntake::SayIntake(std::shared_ptr<Head> head, IntakeFormat format, bool socket, std::string name,
                     Services services, web::ServerAnswer answer)
    : head_(std::move(head)),
      format_(std::move(format)),
      socket_(socket),
      name_(std::move(name)),
      services_(std::move(services)),
      answer_(std::move(answer)) {}

void SayIntake::take(std::string bytes, bool text) {
  const std::size_t size = bytes.size();
  waiting_ += size;
  services_.post([self = shared_from_this(), bytes = std::move(bytes), text, size] {
    self->work(bytes, text);
    self->waiting_ -= size;
  });
}

bool SayIntake::full() const {
  return waiting_ > kMostWaiting || head_->sound_waiting() > kFullSound || services_.full();
}

void SayIntake::end(bool whole) {
  services_.post([self = shared_from_this(), whole] { self->finish(whole); });
}

void SayIntake::fail(const Error& error) {
  if (socket_) {
    answer_({200, Json{{"event", "error"}, {"why", error.describe()}}.dump()});
  } else if (!refusal_) {
    refusal_ = refused(400, error.describe());
  }
}

void SayIntake::work(const std::string& bytes, bool is_text) {
  if (refusal_) return;
  if (socket_ && is_text) return take_line(bytes);
  if (format_.kind == Kind::wav || format_.kind == Kind::bare) {
    if (auto ok = take_sound(bytes); !ok) fail(ok.error());
    return;
  }
  if (socket_) {
    return fail(make_error(Code::invalid_argument,
                           "binary messages are sound; put its format into the address: "
                           "?pcm=24000, ?pcm=mulaw"));
  }
  if (rest_.size() + bytes.size() > kMostFile) {
    refusal_ = refused(413, "This has more than 8 MB; send it in parts.");
    return;
  }
  rest_ += bytes;
  if (format_.kind == Kind::file) return;
  // JSON as a whole is told from lines by its first line.
  const std::size_t first = rest_.find_first_not_of(" \t\r\n");
  if (first == std::string::npos || rest_[first] == '[') return;
  const bool text = rest_[first] != '{' && rest_.find('\n') == std::string::npos;
  if (text && rest_.size() > HeadLines::kMostBytes) {
    refusal_ = refused(413, "A line of text has 64 kB at most.");
    return;
  }
  for (std::size_t end = rest_.find('\n'); end != std::string::npos; end = rest_.find('\n')) {
    const std::string line = rest_.substr(0, end);
    const std::string_view begun = media::trim(line);
    if (lines_ == 0 && begun.starts_with('{') && !Json::parse(line)) return;
    rest_.erase(0, end + 1);
    take_line(line);
    if (refusal_) return;
  }
}

void SayIntake::take_line(const std::string& line) {
  if (media::trim(line).empty()) return;
  // The end of an utterance of sound is that of the samples that came before it.
  if (const Result<Json> json = Json::parse(line); json && json->is_object() && json->size() == 1) {
    const Json* done = json->find("done");
    if (done != nullptr && done->is_boolean() && done->get<bool>() && sound_) {
      if (auto ok = flush(true); !ok) fail(ok.error());
      return;
    }
  }
  ++lines_;
  web::ServerReply reply = services_.say(line);
  if (reply.status >= 300) {
    if (socket_) {
      const Result<Json> json = Json::parse(reply.body);
      const bool told = json && json->contains("error");
      answer_({200, Json{{"event", "error"},
                         {"why", told ? (*json)["error"].text() : std::string("it is refused")},
                         {"status", reply.status}}
                        .dump()});
    } else {
      refusal_ = std::move(reply);
    }
    return;
  }
  if (const Result<Json> json = Json::parse(reply.body); json && json->contains("ids")) {
    for (const Json& id : (*json)["ids"]) ids_.push_back(id);
  }
}

Result<void> SayIntake::take_sound(const std::string& bytes) {
  if (!sound_) {
    const bool bare = format_.kind == Kind::bare;
    sound_.emplace(bare ? std::optional(format_.bare) : std::nullopt);
    ++utterances_;
    id_ = format_.id.empty() || utterances_ > 1
              ? name_ + (utterances_ > 1 ? "-" + std::to_string(utterances_) : "")
              : format_.id;
    ids_.push_back(id_);
  }
  std::string swapped;
  if (format_.big_endian) {
    swapped = std::exchange(rest_, {}) + bytes;
    if (swapped.size() % 2 != 0) {
      rest_ = swapped.back();
      swapped.pop_back();
    }
    for (std::size_t i = 0; i + 1 < swapped.size(); i += 2) std::swap(swapped[i], swapped[i + 1]);
  }
  const std::string& heard = format_.big_endian ? swapped : bytes;
  auto ok =
      sound_->push({reinterpret_cast<const std::uint8_t*>(heard.data()), heard.size()}, samples_);
  if (!ok) return ok;
  const int rate = sound_->sample_rate();
  if (rate == 0 || double(samples_.size()) < kLeastSound * rate) return {};
  return flush(false);
}

Result<void> SayIntake::flush(bool last) {
  if (!sound_) return {};
  media::Pcm pcm{std::max(sound_->sample_rate(), 1000), std::exchange(samples_, {})};
  seconds_ += pcm.duration();
  if (last) sound_.reset();
  return head_->say_sound(id_, std::move(pcm), last);
}

void SayIntake::finish(bool whole) {
  if (!refusal_ && sound_) {
    if (whole && sound_->sample_rate() == 0) {
      fail(make_error(Code::invalid_argument, "there is no sound in it"));
    } else if (auto ok = flush(true); !ok) {
      fail(ok.error());
    }
  }
  if (!whole || socket_) return;
  if (!refusal_ && format_.kind == Kind::file) {
    const media::ReadAudioOptions limit{.max_seconds = 600};
    auto pcm = media::read_audio(
        std::span(reinterpret_cast<const std::uint8_t*>(rest_.data()), rest_.size()), limit);
    id_ = format_.id.empty() ? name_ : format_.id;
    if (!pcm) {
      fail(pcm.error());
    } else {
      seconds_ = pcm->duration();
      ids_.push_back(id_);
      if (auto ok = head_->say_sound(id_, std::move(*pcm), true); !ok) fail(ok.error());
    }
  }
  if (!refusal_ && format_.kind == Kind::lines) {
    if (lines_ == 0) return answer_(services_.say(rest_));
    take_line(rest_);
  }
  if (refusal_) return answer_(std::move(*refusal_));
  Json reply{{"ids", ids_}};
  if (format_.kind == Kind::lines) {
    reply["lines"] = lines_;
  } else {
    reply["seconds"] = std::round(seconds_ * 1000) / 1000;
  }
  reply["seconds_waiting"] = std::round(head_->seconds_waiting() * 10) / 10;
  answer_({202, reply.dump() + "\n"});
}

}  // namespace animeme::serve
