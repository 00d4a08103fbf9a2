#include "tools/live/webrtc/detail/feed.h"

#include <utility>

#include "tools/live/web/detail/messages.h"
#include "tools/live/web/web.h"

namespace animeme::webrtc {

using media::LiveTrack;

Feed::Feed(const media::LiveInfo& info, std::vector<std::uint8_t> hello,
           const WebRtcOptions& options)
    : timescale_(info.timescale),
      sample_rate_(info.audio ? info.audio->sample_rate : 0),
      bundles_(std::move(hello), options.repeat),
      audio_repeat_(options.audio_repeat) {}

Result<Feed> Feed::make(const media::LiveInfo& info, const WebRtcOptions& options) {
  if (info.audio && info.audio->codec != media::AudioCodec::opus) {
    return make_error(Code::unsupported, std::string("WebRTC carries Opus, and this sound is ") +
                                             media::name_of(info.audio->codec) +
                                             "; write --audio-codec opus");
  }
  return Feed(info,
              web::write_hello(
                  {info.visual_profile, info.audio.has_value(), info.timescale, info.face_config}),
              options);
}

void Feed::push(const media::LiveUnit& unit, std::string_view values) {
  is_sound_ = unit.track == LiveTrack::audio;
  values_.clear();
  if (is_sound_) {
    message_ = unit.bytes;
    rtp_time_ = std::uint32_t(unit.time + std::int64_t(sample_rate_) * web::kWebTimeZero);
    redundant_.push(message_, rtp_time_);
    return;
  }
  const std::int64_t time = unit.time + std::int64_t(timescale_) * web::kWebTimeZero;
  const std::uint8_t flags = unit.intra ? web::kIntra : 0;
  time_ = std::uint64_t(time);
  duration_ = std::uint32_t(unit.duration);
  if (fan_out_) fan_out_->push(unit.bytes);
  message_ = bundles_.push(
      web::write_unit({std::uint64_t(time), std::uint32_t(unit.duration), flags, unit.bytes}),
      unit.intra);
  values_ = values;
  if (!values.empty()) newest_values_ = values;
}

void Feed::send(Receiver& receiver, const char* label, std::span<const std::uint8_t> message,
                bool text) {
  if (!receiver.peer->send(label, message, text)) {
    ++stats_.dropped;
    return;
  }
  ++stats_.packets;
  stats_.bytes += std::int64_t(message.size());
}

void Feed::begin_reliable(Receiver& receiver) {
  if (!fan_out_) {
    fan_out_.emplace();
    bundles_.since_intra([this](const std::vector<std::uint8_t>& message) {
      fan_out_->push(std::span(message).subspan(web::kUnitHeader));
    });
  }
  receiver.reliable = ++last_reliable_;
  give_reliable(receiver);
}

/// The newest unit of the face; who cannot get it begins anew with the next.
void Feed::give_reliable(Receiver& receiver) {
  if (!fan_out_->ready()) return;
  const fba::FanOut::Unit unit = fan_out_->unit_for(receiver.reliable);
  const std::uint8_t flags = unit.intra ? web::kIntra : 0;
  const auto message = bundles_.alone(
      web::write_unit({time_, duration_, flags, {unit.bytes.begin(), unit.bytes.end()}}),
      unit.intra);
  const std::int64_t before = stats_.dropped;
  send(receiver, kFace, message, false);
  if (stats_.dropped != before) fan_out_->forget(receiver.reliable);
}

void Feed::forget(const Receiver& receiver) {
  if (fan_out_ && receiver.reliable != 0) fan_out_->forget(receiver.reliable);
}

/// True if that channel is open; `known` if what it begins with has been sent before.
bool Feed::begins(Receiver& receiver, const char* label, bool& known) {
  return receiver.peer->has_channel(label) && !std::exchange(known, true);
}

void Feed::give(Receiver& receiver) {
  const auto text = [](const std::string& json) {
    return std::span(reinterpret_cast<const std::uint8_t*>(json.data()), json.size());
  };
  // The newest unit is among those that a newcomer begins with.
  if (begins(receiver, kFace, receiver.face)) {
    if (receiver.peer->is_reliable(kFace)) {
      begin_reliable(receiver);
    } else {
      for (const auto& message : bundles_.catch_up()) send(receiver, kFace, message, false);
    }
  } else if (receiver.reliable != 0 && !is_sound_) {
    give_reliable(receiver);
  } else if (receiver.face && !is_sound_) {
    send(receiver, kFace, message_, false);
    stats_.repeated = bundles_.repeated();
  }
  if (begins(receiver, kValues, receiver.values)) {
    if (!newest_values_.empty()) send(receiver, kValues, text(newest_values_), true);
  } else if (receiver.values && !is_sound_ && !values_.empty()) {
    send(receiver, kValues, text(values_), true);
  }
  if (is_sound_) give_sound(receiver);
}

void Feed::give_sound(Receiver& receiver) {
  receiver.loss = receiver.peer->reported_loss();
  int repeats = 0;
  if (receiver.types.redundant >= 0) {
    repeats = audio_repeat_ >= 0 ? audio_repeat_ : receiver.gauge.repeats(receiver.loss);
  }
  ++stats_.packets;
  if (repeats == 0) {
    receiver.peer->send_sound(message_, rtp_time_, false);
    stats_.bytes += std::int64_t(message_.size());
    return;
  }
  const std::vector<std::uint8_t> payload = redundant_.payload(repeats, receiver.types.opus);
  receiver.peer->send_sound(payload, rtp_time_, true);
  stats_.bytes += std::int64_t(payload.size());
}

double Feed::needs_fec(const Receiver& receiver) const {
  const bool repeats = receiver.types.redundant >= 0 && audio_repeat_ != 0;
  return receiver.types.fec && !repeats ? receiver.loss : 0;
}

void Feed::tell(Receiver& receiver, std::string_view json) {
  if (!receiver.values) return;
  receiver.peer->send(kValues, {reinterpret_cast<const std::uint8_t*>(json.data()), json.size()},
                      true);
}

void Feed::end(Receiver& receiver) {
  if (receiver.face) receiver.peer->send(kFace, end_message(), false);
  tell(receiver, R"({"end":true})");
}

}  // namespace animeme::webrtc
