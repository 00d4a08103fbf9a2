/// @file
/// Live transports by address.
///
///     auto sink = open_sink("rtp://192.0.2.7:5004", {.rtp = {.sdp_path = "talk.sdp"}});
///     auto source = open_source("talk.sdp");
///
/// | address | transport |
/// |---|---|
/// | rtp://host:port | RTP; sound on port + 2 |
/// | talk.sdp (receive only) | RTP as the session description says |
/// | udp://, srt:// | MPEG transport stream, ts_live.h |
#pragma once

#include <memory>
#include <string>

#include "fap/result.h"
#include "tools/formats/media/live/live.h"
#include "tools/formats/media/live/ts_live.h"
#include "tools/formats/media/rtp/rtp.h"

namespace animeme::media {

/// Each transport reads its own part.
struct SinkOptions {
  RtpOptions rtp;  ///< for rtp://
  TsOptions ts;    ///< for udp:// and srt://
};
/// Each transport reads its own part.
struct SourceOptions {
  RtpReceiveOptions rtp;  ///< for RTP
  TsOptions ts;           ///< for udp:// and srt://
};

/// A sink for `url`, not yet started. Errors: invalid_argument (unknown kind of address; the
/// message lists the known ones), those of the transport.
Result<std::unique_ptr<LiveSink>> open_sink(const std::string& url,
                                            const SinkOptions& options = {});

/// A source for `where`, a URL or the path of a session description; already listening. Errors:
/// as open_sink(), not_found.
Result<std::unique_ptr<LiveSource>> open_source(const std::string& where,
                                                const SourceOptions& options = {});

}  // namespace animeme::media
