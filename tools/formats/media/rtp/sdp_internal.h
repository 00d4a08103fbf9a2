// One medium of a session description, as it was read.
#pragma once

#include <cstdint>
#include <string>

#include "tools/formats/media/detail/tracks/words_internal.h"
#include "tools/formats/media/rtp/sdp.h"

namespace animeme::media {

/// One medium as it was read, before anybody asks whether it is for us. What was not said: an empty
/// address, rtcp_port 0, payload_type -1.
struct SdpMedium : RtpTrack {
  std::string kind;      // "video", "audio" ...
  std::string encoding;  // lower case; empty: no rtpmap
  std::uint32_t channels = 1;
  Parameters format;  // a=fmtp
  Parameters own;     // a=x-animeme
  std::string cname;
  int bundle_id = 0;
  std::int64_t line = 0;
};

}  // namespace animeme::media
