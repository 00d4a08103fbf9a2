// Session descriptions whose media share one transport.
#pragma once

#include <string>

namespace animeme::webrtc {

/// An offer in which all media of a bundle have the ICE credentials, the fingerprint and the role
/// of its first one. Offers may give each of them its own (RFC 8843, section 7.2: aiortc does), and
/// that of the first one counts when the answer has the bundle; GStreamer refuses them. Text that
/// is none of that stays as it is, byte for byte.
std::string share_transport(const std::string& sdp);

}  // namespace animeme::webrtc
