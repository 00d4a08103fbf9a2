#include "tools/formats/media/rtp/sdp.h"

#include <algorithm>

#include "tools/formats/media/rtp/sdp_internal.h"

namespace animeme::media {
namespace {

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\r' || c == '\n' || c == '\0'; }, ' ');
  return text.empty() ? " " : text;
}

std::string attribute(const std::string& text) { return "a=" + text + "\r\n"; }

std::string connection(const std::string& address) {
  return (address.find(':') == std::string::npos ? "IN IP4 " : "IN IP6 ") + address;
}

// Multicast addresses of version 4 have a time to live, and no others (RFC 8866, 5.7).
std::string connection(const RtpTrack& track) {
  const std::size_t dot = track.address.find('.');
  const int first =
      dot > 3 ? 0 : int(to_number(std::string_view(track.address).substr(0, dot), 255).value_or(0));
  const bool multicast = first >= 224 && first < 240;
  return connection(track.address) + (multicast ? "/" + std::to_string(track.ttl) : "");
}

std::string media_lines(const RtpTrack& track, const char* kind, const std::string& map,
                        const std::string& parameters) {
  const std::string type = std::to_string(track.payload_type);
  std::string out = std::string("m=") + kind + " " + std::to_string(track.port) + " RTP/AVP " +
                    type + "\r\nc=" + connection(track) + "\r\n";
  if (track.rtcp_port != track.port + 1)
    out += attribute("rtcp:" + std::to_string(track.rtcp_port));
  out += attribute("rtpmap:" + type + " " + map);
  return out + attribute("fmtp:" + type + " " + parameters);
}

std::string clock_lines(const RtpTrack& track, const std::string& cname) {
  std::string out;
  if (track.ssrc) {
    out += attribute("ssrc:" + std::to_string(*track.ssrc) + " cname:" + one_line(cname));
  }
  if (track.clock_offset) {
    out += attribute("mediaclk:direct=" + std::to_string(*track.clock_offset));
  }
  return out;
}

std::string face_lines(const RtpFaceTrack& face, const std::string& cname) {
  std::string parameters = "profile-level-id=" + std::to_string(int(face.visual_profile));
  if (!face.config.empty()) parameters += "; config=" + to_hex(face.config);
  std::string out = media_lines(face, "video", "MP4V-ES/90000", parameters);
  // What the sender answers, with the next plane (RFC 4585, RFC 5104).
  const std::string feedback = "rtcp-fb:" + std::to_string(face.payload_type);
  out += attribute(feedback + " nack pli") + attribute(feedback + " ccm fir");
  out += clock_lines(face, cname);
  if (face.timescale != 0)
    out += attribute("x-animeme:timescale=" + std::to_string(face.timescale));
  if (face.bundle_id != 0) {
    out += attribute("extmap:" + std::to_string(face.bundle_id) + " " + kBundleExtension);
  }
  return out;
}

std::string audio_lines(const RtpAudioTrack& audio, const std::string& cname) {
  const AudioFormat& format = audio.format;
  std::string own = "x-animeme:priming=" + std::to_string(format.priming) +
                    "; frame=" + std::to_string(format.frame_samples);
  std::string map;
  std::string parameters;
  if (format.codec == AudioCodec::opus) {
    map = "opus/48000/2";
    parameters = std::string("sprop-stereo=") + (format.channels == 2 ? "1" : "0");
    own += "; head=" + to_hex(format.config);
  } else {
    map = "mpeg4-generic/" + std::to_string(audio.clock) + "/" + std::to_string(format.channels);
    // 40 and 41: AAC profile, level 1 (mono to stereo up to 24 kHz) and 2 (48 kHz).
    parameters = std::string("streamType=5; profile-level-id=") +
                 (audio.clock <= 24000 ? "40" : "41") +
                 "; mode=AAC-hbr; sizelength=" + std::to_string(audio.fields.size_bits) +
                 "; indexlength=" + std::to_string(audio.fields.index_bits) +
                 "; indexdeltalength=" + std::to_string(audio.fields.index_delta_bits) +
                 "; config=" + to_hex(format.config);
  }
  return media_lines(audio, "audio", map, parameters) + clock_lines(audio, cname) + attribute(own);
}

}  // namespace

std::string to_hex(std::span<const std::uint8_t> bytes) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  std::string out;
  for (const std::uint8_t byte : bytes) {
    out += kDigits[byte >> 4];
    out += kDigits[byte & 15];
  }
  return out;
}

std::string write_sdp(const RtpSession& session) {
  const RtpTrack* first = nullptr;
  if (session.audio) first = &*session.audio;
  if (session.face) first = &*session.face;
  if (first == nullptr) return {};
  const std::string id = std::to_string(first->ssrc.value_or(0));
  std::string out = "v=0\r\no=- " + id + " 1 " + connection(first->address) + "\r\n";
  out += "s=" + one_line(session.name) + "\r\nt=0 0\r\n" + attribute("tool:animeme");
  // Both media clocks run on one clock of the sender, whose second 0 is time 0.
  if (first->clock_offset) out += attribute("ts-refclk:private");
  if (session.face) out += face_lines(*session.face, session.cname);
  if (session.audio) out += audio_lines(*session.audio, session.cname);
  return out;
}

}  // namespace animeme::media
