/// @file
/// Messages of other face protocols, for measuring their size and for testing senders.
///
///     const auto packet = animeme::inspect::live_link_packet(weights, {});
///     count(packet.size() + header_bytes(Headers::udp, packet.size()));
///
/// Layouts are from public documents and receivers, named at each function; codec/standards.md,
/// section 4, lists the sources.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fap/arkit.h"
#include "fap/frame.h"
#include "fap/rate.h"

namespace animeme::inspect {

/// Bytes of a message.
using Message = std::vector<std::uint8_t>;

/// Headers before each message, excluding Ethernet.
enum class Headers : std::uint8_t {
  none,       ///< nothing: a file
  udp,        ///< IPv4 (20, again for each further fragment of 1480 bytes) and UDP (8)
  rtp,        ///< the same and RTP (12)
  websocket,  ///< IPv4 (20), TCP without options (20) for each 1460 bytes, and 2 to 10 of WebSocket
};
/// "IP/UDP" ...; "-" for none.
std::string_view headers_name(Headers headers);
/// Total bytes of headers of a message of `size` bytes that is sent separately. Sources: RFC 791,
/// 768, 3550, 9293, 6455 (from a server: no mask).
std::size_t header_bytes(Headers headers, std::size_t size);

/// Only the 52 shapes as float32, big endian: 208 bytes.
Message float_weights(const fap::ArkitFrame& weights);
/// The k for which `k / (2^bits - 1)` is nearest to a weight, which is clipped to 0..1.
std::uint32_t weight_level(double weight, int bits);
/// The 52 shapes as levels of `bits` bits (1..16), packed, most significant bit first, padded with
/// zeros to a byte.
Message packed_weights(const fap::ArkitFrame& weights, int bits);

/// Fields of a Live Link Face packet besides the curves.
struct LiveLinkNames {
  std::string device = "00000000-0000-0000-0000-000000000000";  ///< a UUID as text
  std::string subject = "iPhone";                               ///< name in Unreal's list
  std::int32_t frame = 0;                                       ///< number of the frame
  std::int32_t rate = 60;                                       ///< frames a second
};
/// A UDP packet of Live Link Face: 61 float32 after version, device, subject and time; 312 bytes
/// with these names. Sources: JimWest/PyLiveLinkFace, pylivelinkface/pylivelinkface.py;
/// shun126/livelinkface_arkit_receiver, __init__.py.
Message live_link_packet(const fap::ArkitFrame& weights, const LiveLinkNames& names);

/// An OSC bundle of the VMC protocol: /VMC/Ext/Blend/Val with name and float32 for each of the 52
/// shapes, then /VMC/Ext/Blend/Apply; names as "EyeBlinkLeft". Sources: the OSC 1.0 specification;
/// sh-akira/VirtualMotionCaptureProtocol, docs/marionette-spec.markdown.
Message vmc_bundle(const fap::ArkitFrame& weights);

/// An Avatar Animation Unit of MPEG's ARF with the 52 shapes as indices and float32 weights,
/// without confidences: 326 bytes. Source: AmmarkoV/ARFPlayer, doc/ARF.md, which gives the fields
/// from the FDIS text of ISO/IEC 23090-39.
Message arf_unit(const fap::ArkitFrame& weights, std::uint32_t time);

/// The JSON of a viseme event of Azure Speech: {"FrameIndex":0,"BlendShapes":[[55 numbers], ...]},
/// the 52 shapes and three rolls, with at most `decimals` (1..6). Source:
/// MicrosoftDocs/azure-ai-docs, how-to-speech-synthesis-viseme.md.
std::string azure_event(std::span<const fap::ArkitFrame> frames, std::size_t first, int decimals);

/// A message of Animeme's /faps (tools/live/web/README.md): FAPs by number, JSON, with all of
/// `faps`.
std::string faps_message(const fap::Frame& face, const fap::Mask& faps, const fap::Rate& rate,
                         bool intra, std::size_t unit_bytes);

/// Compresses messages one by one like permessage-deflate (RFC 7692, with context takeover): raw
/// deflate, flushed, without the last four bytes.
class Deflater {
 public:
  Deflater();                     ///< starts a new context
  Deflater(Deflater&&) noexcept;  ///< movable
  Deflater& operator=(Deflater&&) noexcept;
  ~Deflater();
  /// Compresses the next message.
  Message pack(std::span<const std::uint8_t> message);

 private:
  struct Stream;
  std::unique_ptr<Stream> stream_;
};

}  // namespace animeme::inspect
