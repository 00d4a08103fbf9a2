#include "tools/formats/media/rtp/rtp_packetizer.h"

#include <utility>

#include "tools/formats/media/detail/ffmpeg/invalid.h"
#include "tools/formats/media/rtp/rtp_units.h"
#include "tools/formats/media/rtp/wire_internal.h"

namespace animeme::media {

RtpPacketizer::RtpPacketizer(LiveTrack track, const LiveInfo& info, const RtpOptions& options,
                             const RtpIdentity& identity, std::uint8_t payload_type)
    : track_(track),
      identity_(identity),
      payload_type_(payload_type),
      clock_(kFaceClock),
      timescale_(info.timescale),
      mtu_(std::size_t(options.mtu)),
      most_(options.bundle) {
  if (track == LiveTrack::face) {
    if (options.config_in_band) config_ = info.face_config;
    return;
  }
  clock_ = timescale_ = std::uint32_t(info.audio->sample_rate);
  opus_ = info.audio->codec == AudioCodec::opus;
  most_ = opus_ ? 1 : options.audio_bundle;
}

std::int64_t RtpPacketizer::ticks(const LiveUnit& unit) const {
  return track_ == LiveTrack::face ? from_timescale(unit.time, timescale_) : unit.time;
}

Result<void> RtpPacketizer::check(const LiveUnit& unit) const {
  if (unit.bytes.empty()) return invalid("a unit without bytes cannot be sent");
  if (track_ == LiveTrack::face) return {};
  if (!opus_ && unit.bytes.size() > kMaxAacFrame) {
    return invalid("an AAC frame has more than 8191 bytes");
  }
  if (opus_ && unit.bytes.size() + kRtpHeaderSize > mtu_) {
    return invalid("an Opus packet does not fit into a datagram; raise mtu or lower the bit rate");
  }
  return {};
}

bool RtpPacketizer::fits(const LiveUnit& unit) const {
  if (units_.empty()) return true;
  const std::size_t count = units_.size() + 1;
  const std::size_t bytes = bytes_ + unit.bytes.size();
  if (track_ == LiveTrack::audio) return kRtpHeaderSize + aac_packet_size(count, bytes) <= mtu_;
  return !unit.intra && rtp_header_size(count) + config_.size() + bytes <= mtu_;
}

void RtpPacketizer::add(const LiveUnit& unit) {
  units_.push_back(unit);
  bytes_ += unit.bytes.size();
}

std::vector<RtpPayload> RtpPacketizer::face_payloads(RtpPacket& packet) const {
  ByteVector bytes;
  if (units_.front().intra) bytes = config_;
  const std::int64_t begin = ticks(units_.front());
  std::size_t before = 0;
  for (std::size_t i = 0; i < units_.size(); ++i) {
    if (i > 0) {
      packet.bundle.push_back(
          {std::uint16_t(bytes.size() - before), std::uint32_t(ticks(units_[i]) - begin)});
      before = bytes.size();
    }
    append(bytes, units_[i].bytes);
  }
  return split_plane(bytes, mtu_ - rtp_header_size(units_.size()));
}

std::vector<RtpPayload> RtpPacketizer::audio_payloads() const {
  // The mark of an Opus packet means the begin of speech after silence.
  if (opus_) return {{units_.front().bytes, false}};
  std::vector<ByteVector> frames;
  for (const LiveUnit& unit : units_) frames.push_back(unit.bytes);
  return pack_aac(frames, mtu_ - kRtpHeaderSize);
}

std::vector<std::vector<std::uint8_t>> RtpPacketizer::flush() {
  std::vector<ByteVector> out;
  if (units_.empty()) return out;
  RtpPacket packet;
  packet.payload_type = payload_type_;
  packet.ssrc = identity_.ssrc;
  packet.timestamp = std::uint32_t(identity_.offset + ticks(units_.front()));
  std::vector<RtpPayload> payloads =
      track_ == LiveTrack::face ? face_payloads(packet) : audio_payloads();
  for (RtpPayload& payload : payloads) {
    packet.sequence = identity_.sequence++;
    packet.marker = payload.marker;
    packet.payload = std::move(payload.bytes);
    ++packets_;
    octets_ += std::uint32_t(packet.payload.size());
    out.push_back(write_rtp(packet));
  }
  units_.clear();
  bytes_ = 0;
  return out;
}

}  // namespace animeme::media
