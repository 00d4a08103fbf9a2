/// @file
/// What other ways of sending a face put on the wire, message by message: to be counted, and to
/// check senders by.
///
///     const auto packet = animeme::inspect::live_link_packet(weights, {});
///     count(packet.size() + header_bytes(Headers::udp, packet.size()));
///
/// Layouts are from public documents and receivers, named at each function; codec/standards.md,
/// section 4, tells what was taken from where.
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

/// What stands in front of each message, without the network's own (Ethernet).
enum class Headers : std::uint8_t {
  none,       ///< nothing: a file
  udp,        ///< IPv4 (20, again for each further fragment of 1480 bytes) and UDP (8)
  rtp,        ///< the same and RTP (12)
  websocket,  ///< IPv4 (20), TCP without options (20) for each 1460 bytes, and 2 to 10 of WebSocket
};
/// "IP/UDP" ...; "-" for none.
std::string_view headers_name(Headers headers);
/// Bytes of all headers of a message of `size` bytes that is sent for itself. Sources: RFC 791,
/// 768, 3550, 9293, 6455 (from a server: no mask).
std::size_t header_bytes(Headers headers, std::size_t size);

/// The 52 shapes as float32, big endian, and nothing else: 208 bytes.
Message float_weights(const fap::ArkitFrame& weights);
/// Weight `k / (2^bits - 1)` that comes next to one in 0..1 (others are clipped), k.
std::uint32_t weight_level(double weight, int bits);
/// The 52 shapes as levels of `bits` bits (1..16), one behind the other, most significant bit
/// first, and zeros to the byte border.
Message packed_weights(const fap::ArkitFrame& weights, int bits);

/// What a packet of Live Link Face says besides the curves.
struct LiveLinkNames {
  std::string device = "00000000-0000-0000-0000-000000000000";  ///< a UUID as text
  std::string subject = "iPhone";                               ///< as Unreal lists it
  std::int32_t frame = 0;                                       ///< number of the frame
  std::int32_t rate = 60;                                       ///< frames a second
};
/// A UDP packet of Live Link Face: 61 float32 behind version, device, subject and time; 312 bytes
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

/// A message of our own /faps (tools/live/web/README.md): FAPs by number, JSON, with all of `faps`.
std::string faps_message(const fap::Frame& face, const fap::Mask& faps, const fap::Rate& rate,
                         bool intra, std::size_t unit_bytes);

/// Messages packed one by one as permessage-deflate packs them (RFC 7692, the memory of the
/// messages before is kept): raw deflate, flushed, without the last four bytes.
class Deflater {
 public:
  Deflater();                     ///< nothing was sent yet
  Deflater(Deflater&&) noexcept;  ///< movable
  Deflater& operator=(Deflater&&) noexcept;
  ~Deflater();
  /// The next message, packed.
  Message pack(std::span<const std::uint8_t> message);

 private:
  struct Stream;
  std::unique_ptr<Stream> stream_;
};

}  // namespace animeme::inspect
