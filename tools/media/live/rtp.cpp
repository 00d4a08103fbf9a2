#include "tools/media/live/rtp.h"

namespace animeme::media {

Result<std::unique_ptr<LiveSink>> make_rtp_sink(const std::string&, const RtpOptions&) {
  return make_error(Code::unsupported, "RTP is not built in yet");
}

Result<std::unique_ptr<LiveSource>> make_rtp_source(const std::string&, const RtpReceiveOptions&) {
  return make_error(Code::unsupported, "RTP is not built in yet");
}

}  // namespace animeme::media
