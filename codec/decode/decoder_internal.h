// State and functions of the decoder, shared by its sources. Not installed API.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/decode/decoder.h"
#include "codec/decode/plane_reader_internal.h"
#include "codec/syntax/bits.h"
#include "codec/syntax/plane.h"

namespace animeme::fba {

namespace internal {

inline constexpr std::size_t kPieceBytes = std::size_t(1) << 14;  // what decode() pushes at a time

// The warning behind a plane in which other bits behind it would change values.
inline constexpr std::string_view kUnsettled =
    "the last values of a plane depend on the bits behind it, as no encoder writes them; they are "
    "probably damaged";

// Whether the bytes behind an end code are another stream.
inline bool begins_stream(std::span<const std::uint8_t> bytes) {
  const std::uint32_t code = BitReader(bytes).peek32(0);
  return code == kSequenceStart || is_object_start(code);
}

}  // namespace internal

struct Decoder::Impl {
  enum class Phase : std::uint8_t {
    headers,    // at a byte border, a start code is due
    user_data,  // skipping to the next start code
    planes,     // at a plane border, anywhere in a byte
    lost,       // after an error: looking for the next intra plane
    ended,
  };

  std::vector<std::uint8_t> buffer;
  std::int64_t dropped_bits = 0;  // bits before buffer[0]
  std::size_t position = 0;       // bit in buffer
  bool finished = false;
  bool after_start_code = false;  // the plane to come has its start code consumed
  bool first_plane = false;       // it is the first of its object
  std::int64_t end_bit = -1;      // where the stream ended
  bool spoken = false;            // there has been a plane or an error
  Phase phase = Phase::headers;

  internal::StreamState state;
  internal::ParsedPlane parsed;
  std::size_t plane_begin = 0;  // of the plane in `parsed`, bits in buffer
  std::size_t plane_end = 0;
  bool had_start_code = false;                 // it stood behind one
  ObjectMask last_mask = ObjectMask::nothing;  // of the plane before
  std::shared_ptr<FaceSettings> face_settings;
  std::shared_ptr<BodySettings> body_settings;
  std::shared_ptr<BodyFrame> body;  // of the last plane that had one
  std::vector<Event> waiting;       // returned before anything else
  StreamInfo info;                  // of the headers read so far
  bool info_told = false;

  std::int64_t number = 0;
  fap::Rate rate{30, 1};
  double clock = 0;  // seconds at clock_number
  std::int64_t clock_number = 0;

  std::size_t size_bits() const { return buffer.size() * 8; }
  std::int64_t stream_bit(std::size_t bit) const { return dropped_bits + std::int64_t(bit); }
  bool available(std::size_t bit_end) const { return bit_end <= size_bits(); }
  std::uint32_t code_at(std::size_t bit) const { return BitReader(buffer).peek32(bit); }

  // decoder.cpp: events, planes, time.

  void warn(std::string text, std::size_t bit);

  // The headers are over: an object begins, or a plane that was taken out of one.
  void tell_info();

  static Error need_data() { return internal::need_more_data(); }

  // From here on only an intra plane can be decoded.
  void lose();

  Error at_end(Code code, std::string message);
  Error at(Code code, std::string message, std::size_t bit);

  // Forgets bytes that have been read. Half of the buffer at least, so that a long stream takes
  // linear time.
  void trim();

  // Runs until there is an event, or a reason why not. True: `plane`, which has to be a new one,
  // has been filled; false: an event waits.
  Result<bool> advance(Plane& plane);
  Event take_waiting();

  Result<bool> read_plane();
  // The plane that was parsed, applied to the state.
  Result<void> fill(Plane& plane);
  void tell_time(Plane& plane);

  // One step; true: a plane was parsed and waits in `parsed`.
  Result<bool> step();

  // decoder_borders.cpp: headers, start codes and what lies between planes.

  Result<bool> read_header();
  Result<bool> need_more();
  Result<bool> read_visual_object();

  // Byte-wise search for a start code: any header (skipping user data), or, when lost, an intra
  // plane behind a plane start code or a new object.
  Result<bool> skip_to(bool lost);
  void end(std::size_t bit);

  // codec/bitstream.md, section 1: is it a start code that follows, behind 1 to 8 stuffing bits?
  // True: something other than a plane was found and the phase has changed.
  Result<bool> plane_border();

  // Stuffing (0, then 1s) can be the beginning of a predictive plane with a body, and zeros in such
  // a plane the beginning of a start code. Where planes like it came before, it is one more: an
  // encoder that does not look at its output may write that.
  bool plane_like_the_last() const;

  // A start code of something else ends the object. Another one may follow.
  void foreign_code(std::uint32_t code, std::size_t bit);

  void consume_start_code(std::size_t bit);
};

}  // namespace animeme::fba
