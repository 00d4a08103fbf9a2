#include "tools/formats/media/detail/sound/audio_headers.h"
#include "tools/formats/media/detail/tracks/face_header.h"
#include "tools/formats/media/rtp/sdp_internal.h"

namespace animeme::media {
namespace {

constexpr std::size_t kMaxText = 1 << 16;
constexpr std::size_t kMaxMedia = 32;
constexpr std::uint32_t kMaxPort = 65534;
constexpr std::uint32_t kMaxRate = 1000000;

Error bad_line(const char* what, std::int64_t line) {
  return error_at_line(Code::syntax, std::string("the session description has ") + what, line);
}

class SdpReader {
 public:
  Result<void> line(std::string_view text, std::int64_t number) {
    if (text.size() < 2 || text[1] != '=') return {};
    const std::string_view value = trim(text.substr(2));
    const char kind = text[0];
    if (kind == 'v' && value != "0") return bad_line("a version other than 0", number);
    if (kind == 'v') version_ = true;
    if (kind == 's') name = std::string(value);
    if (kind == 'c') connection(value);
    if (kind == 'm') return medium(value, number);
    if (kind == 'a' && !media.empty()) return attribute(value, media.back(), number);
    return {};
  }
  bool is_description() const { return version_ && !media.empty(); }

  std::string name;
  std::vector<SdpMedium> media;

 private:
  // IN IP4 address/ttl
  void connection(std::string_view value) {
    take_until(value, ' ');
    take_until(value, ' ');
    RtpTrack& about = media.empty() ? all_ : media.back();
    about.address = std::string(take_until(value, '/'));
    about.ttl = int(to_number(take_until(value, '/'), 255).value_or(0));
  }

  // video 5004 RTP/AVP 96 97
  Result<void> medium(std::string_view value, std::int64_t number) {
    if (media.size() >= kMaxMedia) return bad_line("too many media", number);
    SdpMedium next;
    next.line = number;
    next.kind = lower_case(take_until(value, ' '));
    std::string_view port = take_until(value, ' ');
    const auto port_number = to_number(take_until(port, '/'), kMaxPort);
    if (!port_number) return bad_line("no port number up to 65534 in its m= line", number);
    next.port = int(*port_number);
    take_until(value, ' ');
    const auto type = to_number(take_until(value, ' '), 127);
    next.payload_type = type ? int(*type) : -1;
    next.address = all_.address;
    next.ttl = all_.ttl;
    media.push_back(std::move(next));
    return {};
  }

  static Result<void> attribute(std::string_view value, SdpMedium& medium, std::int64_t number) {
    const std::string key = lower_case(take_until(value, ':'));
    if (key == "rtpmap") return rtpmap(value, medium, number);
    if (key == "fmtp") {
      if (is_for(take_until(value, ' '), medium)) medium.format = read_parameters(value);
    } else if (key == "x-animeme") {
      medium.own = read_parameters(value);
    } else if (key == "rtcp") {
      const auto port = to_number(take_until(value, ' '), kMaxPort + 1);
      if (!port) return bad_line("no port number in its a=rtcp line", number);
      medium.rtcp_port = int(*port);
    } else if (key == "ssrc") {
      medium.ssrc = to_number(take_until(value, ' '), ~0u);
      if (take_until(value, ':') == "cname") medium.cname = std::string(trim(value));
    } else if (key == "mediaclk") {
      take_until(value, '=');
      medium.clock_offset = to_number(take_until(value, ' '), ~0u);
    } else if (key == "extmap") {
      const auto id = to_number(take_until(value, ' '), 255);
      if (id && trim(value) == kBundleExtension) medium.bundle_id = int(*id);
    }
    return {};
  }

  static bool is_for(std::string_view type, const SdpMedium& medium) {
    const auto number = to_number(type, 127);
    return number && int(*number) == medium.payload_type;
  }

  // 96 MP4V-ES/90000
  static Result<void> rtpmap(std::string_view value, SdpMedium& medium, std::int64_t number) {
    if (!is_for(take_until(value, ' '), medium)) return {};
    medium.encoding = lower_case(take_until(value, '/'));
    const auto clock = to_number(take_until(value, '/'), kMaxRate);
    if (!clock || *clock == 0) return bad_line("no clock rate in its a=rtpmap line", number);
    medium.clock = *clock;
    medium.channels = to_number(take_until(value, '/'), 8).value_or(1);
    return {};
  }

  bool version_ = false;
  RtpTrack all_;  // address and ttl of those that have none of their own
};

std::vector<std::uint8_t> bytes_of(const Parameters& parameters, std::string_view key) {
  const auto found = parameters.find(key);
  if (found == parameters.end() || found->second.size() > 2 * kMaxConfig) return {};
  return from_hex(found->second).value_or(std::vector<std::uint8_t>());
}

void common(const SdpMedium& medium, RtpTrack& track) {
  track = medium;
  if (track.rtcp_port == 0) track.rtcp_port = track.port + 1;
}

// Empty: taken; else why not.
std::string take_face(const SdpMedium& medium, RtpSession& session) {
  if (medium.encoding != "mp4v-es") return "its coding '" + medium.encoding + "' is not MP4V-ES";
  if (medium.clock != kFaceClock) return "its clock is not 90000";
  RtpFaceTrack face;
  common(medium, face);
  face.config = bytes_of(medium.format, "config");
  const VisualHeaders headers = read_visual_headers(face.config);
  if (!face.config.empty() && headers.kind != VisualKind::face) {
    return "its configuration is that of a film, not of a face";
  }
  const auto profile = number_of(medium.format, "profile-level-id", 255);
  if (headers.profile != 0) face.visual_profile = headers.profile;
  if (profile && *profile > 1) face.visual_profile = std::uint8_t(*profile);  // 1: FFmpeg, always
  face.timescale = number_of(medium.own, "timescale", kMaxTimescale).value_or(0);
  face.bundle_id = medium.bundle_id;
  session.face = std::move(face);
  return {};
}

std::string aac_format(const SdpMedium& medium, RtpAudioTrack& audio) {
  const auto mode = medium.format.find("mode");
  const std::string name = mode == medium.format.end() ? "" : lower_case(mode->second);
  if (name != "aac-hbr" && name != "aac-lbr") return "its mode is neither AAC-hbr nor AAC-lbr";
  audio.format.codec = AudioCodec::aac;
  audio.format.config = bytes_of(medium.format, "config");
  const auto facts = read_aac_config(audio.format.config);
  if (!facts) return "it has no configuration of AAC";
  audio.format.frame_samples = facts->frame_samples;
  audio.format.channels = facts->channels > 0 ? facts->channels : int(medium.channels);
  audio.fields.size_bits = int(number_of(medium.format, "sizelength", 16).value_or(0));
  audio.fields.index_bits = int(number_of(medium.format, "indexlength", 8).value_or(0));
  audio.fields.index_delta_bits = int(number_of(medium.format, "indexdeltalength", 8).value_or(0));
  if (audio.fields.size_bits == 0) return "it does not say how long the sizes are (sizelength)";
  for (const char* field : {"ctsdeltalength", "dtsdeltalength", "randomaccessindication",
                            "streamstateindication", "auxiliarydatasizelength"}) {
    if (number_of(medium.format, field, ~0u).value_or(0) != 0) {
      return std::string("it uses ") + field + ", which is not known here";
    }
  }
  return {};
}

std::string opus_format(const SdpMedium& medium, RtpAudioTrack& audio) {
  if (medium.clock != 48000) return "its clock is not 48000";
  audio.format.codec = AudioCodec::opus;
  audio.format.frame_samples = 0;
  audio.format.channels = number_of(medium.format, "sprop-stereo", 1).value_or(0) == 1 ? 2 : 1;
  audio.format.config = bytes_of(medium.own, "head");
  if (audio.format.config.size() < 19) {
    audio.format.config = opus_head(audio.format.channels, 0);
  }
  return {};
}

std::string take_audio(const SdpMedium& medium, RtpSession& session) {
  RtpAudioTrack audio;
  common(medium, audio);
  audio.format.sample_rate = int(medium.clock);
  std::string reason = "its coding '" + medium.encoding + "' is neither mpeg4-generic nor opus";
  if (medium.encoding == "mpeg4-generic") reason = aac_format(medium, audio);
  if (medium.encoding == "opus") reason = opus_format(medium, audio);
  if (!reason.empty()) return reason;
  constexpr std::uint32_t kMostSamples = 1 << 20;
  audio.format.priming = int(number_of(medium.own, "priming", kMostSamples).value_or(0));
  const auto frame = number_of(medium.own, "frame", kMostSamples);
  if (frame && audio.format.codec == AudioCodec::opus) audio.format.frame_samples = int(*frame);
  session.audio = std::move(audio);
  return {};
}

std::string take(const SdpMedium& medium, RtpSession& session) {
  if (medium.port == 0) return "it is switched off (port 0)";
  if (medium.kind == "video") {
    return session.face ? "there is a face already" : take_face(medium, session);
  }
  if (medium.kind == "audio") {
    return session.audio ? "there is a sound already" : take_audio(medium, session);
  }
  return "it is neither video nor audio";
}

}  // namespace

Result<RtpSession> read_sdp(std::string_view text) {
  if (text.size() > kMaxText) return bad_line("more than 64 kB", 0);
  SdpReader reader;
  for (std::int64_t number = 1; !text.empty(); ++number) {
    if (auto ok = reader.line(take_until(text, '\n'), number); !ok) return ok.error();
  }
  if (!reader.is_description()) {
    return make_error(Code::syntax,
                      "this is not a session description: it lacks v=0 or an m= line");
  }
  RtpSession session;
  session.name = reader.name;
  for (const SdpMedium& medium : reader.media) {
    const std::string reason = take(medium, session);
    if (!reason.empty()) {
      session.ignored.push_back("the " + medium.kind + " of line " + std::to_string(medium.line) +
                                " is left out: " + reason);
    } else if (!medium.cname.empty()) {
      session.cname = medium.cname;
    }
  }
  if (session.face || session.audio) return session;
  std::string message = "there is nothing to receive";
  for (const std::string& sentence : session.ignored) message += "; " + sentence;
  return make_error(Code::unsupported, message);
}

}  // namespace animeme::media
