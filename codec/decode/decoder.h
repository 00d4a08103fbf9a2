/// @file
/// The FBA decoder: push bytes, pull planes.
///
///     animeme::fba::Decoder decoder;
///     decoder.push(bytes);                       // any split, as often as bytes arrive
///     decoder.finish();                          // no more bytes will come
///     for (;;) {
///       animeme::Result<animeme::fba::Event> event = decoder.next();
///       if (!event) {
///         if (event.error().code == animeme::Code::need_data) break;      // push more
///         if (event.error().code == animeme::Code::end_of_stream) break;  // all done
///         report(event.error().describe());      // then continue: the decoder resynchronises
///         continue;
///       }
///       if (event->kind == animeme::fba::Event::Kind::plane) show(event->plane.face);
///       // other kinds: info, once before the planes of an object, and warning
///     }
///
/// Safe for untrusted input: every read is bounded. A decoder takes less than 2 MB for any input
/// (all 66 FAPs and 296 BAPs at ranges of +-1860, every symbol seen: 1.6 MB), plus the bytes that
/// were pushed and not yet read, which are at most a plane once next() asks for more. Time is
/// linear in the bits pushed, however they are split: parsing of an incomplete plane resumes where
/// it stopped.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "codec/syntax/plane.h"
#include "fap/frame.h"
#include "fap/result.h"

/// The FBA bitstream: decoder, encoders, text formats.
namespace animeme::fba {

struct DecodedStream;

/// One decoded plane.
struct Plane {
  bool intra = false;                            ///< decodable without any earlier plane
  ObjectMask object_mask = ObjectMask::nothing;  ///< which of the two below were coded
  TemporalHeader temporal;                       ///< rate and time code in intra planes only
  /// Frame number at the stream's rate: 0 for the first plane, plus 1 and the skipped frames for
  /// each further one.
  std::int64_t number = 0;
  double seconds = 0;  ///< presentation time; follows time codes and changes of the rate
  fap::Rate rate;      ///< rate in force; 30 until the stream sends one
  fap::Frame face;     ///< coded values only; mask = what was coded; number as above
  /// Settings in force, shared by the planes up to the next intra plane; null without a face.
  std::shared_ptr<const FaceSettings> face_settings;
  std::shared_ptr<const BodyFrame> body;              ///< coded values only; null without a body
  std::shared_ptr<const BodySettings> body_settings;  ///< as face_settings; null without a body
  bool start_code = false;                            ///< a plane start code precedes it
  std::int64_t bit_begin = 0;  ///< first bit of the plane header, from the start of the stream
  std::int64_t bit_end = 0;    ///< first bit behind the plane
};

/// Headers before an object. Raw .fba files have the object start code only.
struct StreamInfo {
  std::optional<std::uint8_t> profile_and_level;  ///< 0x61..0x64, codec/bitstream.md, section 13
  std::optional<std::uint8_t> verid;              ///< visual_object_verid
  std::optional<std::uint8_t> priority;           ///< visual_object_priority, 1 is the highest
  bool user_data = false;                         ///< user data is present; it is skipped
  bool old_start_code = false;                    ///< 00000101 in place of 000001BA
  friend bool operator==(const StreamInfo&, const StreamInfo&) = default;
};

/// Result of next(): one of three kinds, each with its own member.
struct Event {
  /// Kind of event.
  enum class Kind : std::uint8_t { info, plane, warning };
  Kind kind = Kind::plane;  ///< selects one of the members below
  StreamInfo info;          ///< kind info: once for each object, before its first plane
  Plane plane;              ///< kind plane
  std::string text;         ///< kind warning: one sentence
  std::int64_t bit = 0;     ///< position of the event
};

/// Decoder of one FBA stream. Not thread safe (use one per stream). A copy has the same state as
/// the original and is independent from then on; do not copy a moved-from one.
class Decoder {
 public:
  Decoder();
  Decoder(const Decoder& other);  ///< continues at the same place of the stream
  Decoder& operator=(const Decoder& other);
  Decoder(Decoder&&) noexcept;  ///< movable
  Decoder& operator=(Decoder&&) noexcept;
  ~Decoder();

  /// Appends bytes of the stream; they are copied.
  void push(std::span<const std::uint8_t> bytes);
  /// No more bytes will come. Further push() calls are ignored.
  void finish();

  /// The next event, or an error:
  ///   need_data      all complete planes were returned; push more or finish()
  ///   end_of_stream  the stream has ended (end code, or finish() and no bits left); carries the
  ///                  bit where it ended: bytes pushed behind that were not read
  ///   truncated      the stream ends in its headers, in a plane or without an end code, or it
  ///                  holds no plane
  ///   syntax         an invalid marker bit, stuffed bit, mask type or header, or the data do not
  ///                  begin like an FBA stream
  ///   out_of_range   a reconstructed value exceeds 32 bits
  ///   unsupported    the plane uses DCT coding (fba_object_coding_type 1)
  /// The last four carry the bit position. After them the decoder resumes at the next intra plane
  /// behind a plane start code or object start code, if there is one. A start code that belongs to
  /// neither planes nor headers (codec/bitstream.md, section 1) ends an object with a warning.
  Result<Event> next();

 private:
  friend Result<DecodedStream> decode(std::span<const std::uint8_t> stream);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A decoded stream.
struct DecodedStream {
  StreamInfo info;                    ///< of the first object
  std::vector<Plane> planes;          ///< those that could be decoded
  fap::Rate rate;                     ///< of the first plane
  std::vector<std::string> warnings;  ///< "bit N: sentence"
};

/// Decodes a raw stream. Fails at the first error (see Decoder::next()); a stream without a single
/// plane is Code::truncated. The stream is not copied; bytes after its end code are ignored with a
/// warning. Memory: some 480 bytes per plane, and 1.2 kB for each with a body; a Decoder needs one
/// plane at a time.
Result<DecodedStream> decode(std::span<const std::uint8_t> stream);

/// The face planes of a decoded stream as a clip: masks say what was coded, numbers include
/// skipped frames.
fap::Sequence face_sequence(const DecodedStream& stream);

}  // namespace animeme::fba
