#include "codec/decoder.h"

#include <algorithm>

#include "codec/plane_reader_internal.h"

namespace animeme::fba {

namespace {

constexpr std::size_t kPieceBytes = std::size_t(1) << 14;  // what decode() pushes at a time
constexpr std::size_t kMaxWarnings = 100;

bool is_plane_start(std::uint32_t code) { return code == kPlaneStart || code == kOldPlaneStart; }
bool is_object_start(std::uint32_t code) { return code == kObjectStart || code == kOldObjectStart; }
bool is_header(std::uint32_t code) {
  return code == kSequenceStart || code == kUserData || code == kVisualObject ||
         is_object_start(code);
}

void add_warning(DecodedStream& out, std::int64_t bit, const std::string& text) {
  if (out.warnings.size() >= kMaxWarnings) return;
  out.warnings.push_back("bit " + std::to_string(bit) + ": " + text);
}

// The rate of the stream is that of its first plane.
void note_rate(DecodedStream& out) {
  const Plane& plane = out.planes.back();
  if (out.planes.size() == 1) out.rate = plane.rate;
  if (plane.rate != out.rate && plane.temporal.rate) {
    add_warning(out, plane.bit_begin,
                "the frame rate changes; the first one is kept for all planes");
  }
}

const char* object_type_name(std::uint32_t type) {
  switch (type) {
    case 1:
      return "video";
    case 2:
      return "still texture";
    case 3:
      return "mesh";
    case 5:
      return "3D mesh";
    default:
      return "reserved";
  }
}

}  // namespace

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
  std::int64_t end_bit = -1;      // where the stream ended
  bool spoken = false;            // there has been a plane or an error
  Phase phase = Phase::headers;

  internal::StreamState state;
  internal::ParsedPlane parsed;
  std::shared_ptr<const FaceSettings> face_settings;
  std::shared_ptr<const BodySettings> body_settings;
  std::vector<Event> warnings;

  std::int64_t number = 0;
  fap::Rate rate{30, 1};
  double clock = 0;  // seconds at clock_number
  std::int64_t clock_number = 0;

  std::size_t size_bits() const { return buffer.size() * 8; }
  std::int64_t stream_bit(std::size_t bit) const { return dropped_bits + std::int64_t(bit); }
  bool available(std::size_t bit_end) const { return bit_end <= size_bits(); }
  std::uint32_t code_at(std::size_t bit) const { return BitReader(buffer).peek32(bit); }

  void warn(std::string text, std::size_t bit) {
    Event event;
    event.kind = Event::Kind::warning;
    event.text = std::move(text);
    event.bit = stream_bit(bit);
    warnings.push_back(std::move(event));
  }

  static Error need_data() { return make_error(Code::need_data, "more bytes are needed"); }

  // From here on only an intra plane can be understood.
  void lose() {
    phase = Phase::lost;
    state.face.coding.valid = false;
    state.body.coding.valid = false;
  }

  Error at_end(Code code, std::string message) {
    spoken = true;
    return error_at_bit(code, std::move(message), end_bit);
  }
  Error at(Code code, std::string message, std::size_t bit) {
    spoken = true;
    lose();
    return error_at_bit(code, std::move(message), stream_bit(bit));
  }

  // Forgets bytes that have been read. Half of the buffer at least, so that a long stream takes
  // linear time.
  void trim() {
    const std::size_t bytes = position / 8;
    if (bytes < kPieceBytes || bytes < buffer.size() / 2 || parsed.begun()) return;
    buffer.erase(buffer.begin(), buffer.begin() + std::ptrdiff_t(bytes));
    if (buffer.capacity() > 8 * kPieceBytes && buffer.size() < kPieceBytes) buffer.shrink_to_fit();
    position -= bytes * 8;
    dropped_bits += std::int64_t(bytes) * 8;
  }

  // Runs until there is an event, or a reason why not. True: `plane`, which has to be a new one,
  // has been filled; false: a warning waits.
  Result<bool> advance(Plane& plane) {
    for (;;) {
      if (!warnings.empty()) return false;
      trim();
      const Result<bool> progress = step();
      if (!progress) return progress.error();
      if (!*progress) continue;
      if (const Result<void> filled = fill(plane); !filled) return filled.error();
      return true;
    }
  }

  Event take_warning() {
    Event event = std::move(warnings.front());
    warnings.erase(warnings.begin());
    return event;
  }

  // One step; true: a plane was parsed and waits in `parsed`.
  Result<bool> step() {
    switch (phase) {
      case Phase::headers:
        return read_header();
      case Phase::user_data:
        return skip_to(false);
      case Phase::planes:
        return read_plane();
      case Phase::lost:
        return skip_to(true);
      case Phase::ended:
        break;
    }
    if (!spoken) return at_end(Code::truncated, "the stream holds no plane");
    return error_at_bit(Code::end_of_stream, "the stream is over", end_bit);
  }

  Result<bool> read_header() {
    if (!available(position + 32)) {
      if (!finished) return need_data();
      const bool empty = stream_bit(position) == 0 && buffer.empty();
      return at(Code::truncated, empty ? "the stream is empty" : "the stream ends in its headers",
                size_bits());
    }
    const std::uint32_t code = code_at(position);
    if (is_object_start(code)) {
      position += 32;
      phase = Phase::planes;
    } else if (is_plane_start(code)) {
      phase = Phase::planes;  // a unit taken out of a stream; read_plane() finds the code
    } else if (code == kSequenceStart) {
      if (!available(position + 40)) return need_more("headers");
      position += 40;
      phase = Phase::user_data;
    } else if (code == kUserData) {
      position += 32;
      phase = Phase::user_data;
    } else if (code == kVisualObject) {
      return read_visual_object();
    } else if (code == kSequenceEnd) {
      end(position + 32);
    } else {
      return at(Code::syntax,
                "this is not an FBA stream: it does not begin with a start code of one "
                "(000001BA, or 000001B0 and 000001B5 headers)",
                position);
    }
    return false;
  }

  Result<bool> need_more(const char* where) {
    if (!finished) return need_data();
    return at(Code::truncated, std::string("the stream ends in its ") + where, size_bits());
  }

  Result<bool> read_visual_object() {
    if (!available(position + 48)) return need_more("headers");
    BitReader in(buffer, position + 32);
    if (in.bit() != 0) in.bits(7);  // verid, priority
    const std::uint32_t type = in.bits(4);
    if (type != 4) {
      return at(Code::unsupported,
                std::string("the visual object is of type ") + object_type_name(type) +
                    ", not face and body animation",
                position + 32);
    }
    position += 40;
    phase = Phase::user_data;  // stuffing, then the next start code
    return false;
  }

  // Byte-wise search for a start code: any header (skipping user data), or, when lost, an intra
  // plane behind a plane start code or a new object.
  Result<bool> skip_to(bool lost) {
    std::size_t byte = (position + 7) / 8;
    for (; byte + 5 <= buffer.size(); ++byte) {
      if (buffer[byte] != 0 || buffer[byte + 1] != 0 || buffer[byte + 2] != 1) continue;
      const std::uint32_t code = code_at(byte * 8);
      const bool intra_plane = is_plane_start(code) && (buffer[byte + 4] & 0x80) != 0;
      const bool found = lost ? intra_plane || is_object_start(code)
                              : is_header(code) || is_plane_start(code) || code == kSequenceEnd;
      if (!found) continue;
      position = byte * 8;
      phase = Phase::headers;
      return false;
    }
    position = byte * 8;
    if (!finished) return need_data();
    if (byte + 4 == buffer.size() && code_at(byte * 8) == kSequenceEnd) {
      end((byte + 4) * 8);
      return false;
    }
    end(size_bits());
    if (lost) return false;
    return at_end(Code::truncated, "the stream ends in its headers");
  }

  void end(std::size_t bit) {
    position = bit;
    phase = Phase::ended;
    end_bit = stream_bit(bit);
  }

  // 0 and then 1s from `bit` to `border`.
  bool is_stuffing(std::size_t bit, std::size_t border) const {
    BitReader in(buffer, bit);
    if (in.bit() != 0) return false;
    while (in.position() < border) {
      if (in.bit() == 0) return false;
    }
    return true;
  }

  Result<bool> read_plane() {
    if (!after_start_code && !parsed.begun()) {
      Result<bool> moved = plane_border();
      if (!moved) return moved;
      // A warning is told before the plane that it stands in front of.
      if (*moved || !warnings.empty()) return false;
    }
    BitReader in(buffer, position);
    const Result<void> done = internal::parse_plane(in, state, finished, parsed);
    if (!done) {
      Error error = done.error();
      if (error.code == Code::need_data) return error;
      const bool started = after_start_code;
      after_start_code = false;
      // The next start code lies behind the header of this plane at the earliest.
      const std::size_t bit = error.where.bit >= 0 ? std::size_t(error.where.bit) : position;
      if (started) position += 8;
      return at(error.code, std::move(error.message), bit);
    }
    plane_begin = position;
    plane_end = in.position();
    had_start_code = after_start_code;
    after_start_code = false;
    position = plane_end;
    return true;
  }

  // Section 1: is it a start code that follows, behind 1 to 8 stuffing bits? True: something other
  // than a plane was found and the phase has changed.
  Result<bool> plane_border() {
    const std::size_t border = (position / 8 + 1) * 8;
    if (!available(border + 32)) {
      if (!finished) return need_data();
      const bool stuffed = border == size_bits() && is_stuffing(position, border);
      if (stuffed && had_start_code) {
        // Access units one after the other: each is complete in itself.
        warn("the stream has no end code", size_bits());
        end(size_bits());
        return true;
      }
      if (stuffed || position >= size_bits()) {
        return at(Code::truncated, "the stream ends without an end code, it may have been cut off",
                  size_bits());
      }
      // Fewer bits than a start code are left: an end code without stuffing, or a last plane.
    }
    if (position % 8 == 0 && available(position + 32)) {
      // Writers that leave out the stuffing byte at a byte border.
      const std::uint32_t code = code_at(position);
      if (is_plane_start(code)) {
        consume_start_code(position);
        return false;
      }
      if (code == kSequenceEnd) {
        end(position + 32);
        return true;
      }
    }
    if (!available(border + 32)) return false;
    const std::uint32_t code = code_at(border);
    if ((is_plane_start(code) || code == kSequenceEnd) && short_plane_before(border)) return false;
    if (is_plane_start(code)) {
      if (!is_stuffing(position, border)) {
        warn("the stuffing before a plane start code is not 0 and 1s", position);
      }
      consume_start_code(border);
    } else if (code == kSequenceEnd) {
      end(border + 32);
      return true;
    } else if (is_header(code) && is_stuffing(position, border)) {
      position = border;
      phase = Phase::headers;
      return true;
    } else if ((code >> 8) == 1 && is_stuffing(position, border) && !plane_like_the_last()) {
      foreign_code(code, border);
      return true;
    }
    return false;
  }

  // Stuffing (0, then 1s) can be the beginning of a predictive plane with a body, and zeros in such
  // a plane the beginning of a start code. Where planes like it came before, it is one more: an
  // encoder that does not look at its output may write that.
  bool plane_like_the_last() const {
    const ObjectMask mask = ObjectMask(BitReader(buffer, position).bits(3) & 3U);
    return has_body(mask) && mask == last_mask;
  }

  // A start code of something else ends the object. Another one may follow.
  void foreign_code(std::uint32_t code, std::size_t bit) {
    constexpr const char* kDigits = "0123456789ABCDEF";
    const std::string digits{kDigits[code >> 4 & 15], kDigits[code & 15]};
    warn("the start code 000001" + digits + " does not belong to a face or body and ends it", bit);
    position = bit + 32;
    lose();
  }

  // Planes of a few bits may lie between here and the border where a start code stands; the bits
  // are then not those of stuffing, but planes and stuffing. Planes so short change no state.
  bool short_plane_before(std::size_t border) {
    if (is_stuffing(position, border)) return false;
    BitReader in(std::span<const std::uint8_t>(buffer).first(border / 8), position);
    do {
      if (!internal::parse_plane(in, state, true, parsed)) return false;
      if (in.position() >= border) return false;
    } while (!is_stuffing(in.position(), border));
    return true;
  }

  void consume_start_code(std::size_t bit) {
    position = bit + 32;
    after_start_code = true;
  }

  // The plane that was parsed, applied to the state.
  Result<void> fill(Plane& plane) {
    plane.intra = parsed.intra;
    plane.object_mask = last_mask = parsed.object_mask;
    plane.temporal = parsed.temporal;
    plane.start_code = had_start_code;
    plane.bit_begin = stream_bit(plane_begin);
    plane.bit_end = stream_bit(plane_end);
    tell_time(plane);
    spoken = true;

    std::shared_ptr<BodyFrame> body;
    if (has_body(plane.object_mask)) {
      body = std::make_shared<BodyFrame>();
      body->number = plane.number;
    }
    const Result<void> applied = internal::apply_plane(parsed, state, plane.face, body.get());
    if (!applied) return at(applied.error().code, applied.error().message, plane_begin);
    if (has_face(plane.object_mask)) {
      if (plane.intra) face_settings = std::make_shared<FaceSettings>(state.face_settings);
      plane.face_settings = face_settings;
    }
    if (body) {
      if (plane.intra) body_settings = std::make_shared<BodySettings>(state.body_settings);
      plane.body_settings = body_settings;
      plane.body = std::move(body);
    }
    return {};
  }

  void tell_time(Plane& plane) {
    const double now = clock + rate.seconds(double(number - clock_number));
    const TemporalHeader& temporal = parsed.temporal;
    if (temporal.rate || temporal.time_code) {
      clock = now;
      clock_number = number;
    }
    if (temporal.rate) rate = temporal.rate->rate();
    if (temporal.time_code) {
      const TimeCode& code = *temporal.time_code;
      clock = code.hours * 3600.0 + code.minutes * 60.0 + code.seconds;
    }
    plane.number = number;
    plane.face.number = number;
    plane.rate = rate;
    plane.seconds = clock + rate.seconds(double(number - clock_number));
    number += 1 + std::int64_t(temporal.skip.value_or(0));
  }

  std::size_t plane_begin = 0;
  std::size_t plane_end = 0;
  bool had_start_code = false;
  ObjectMask last_mask = ObjectMask::nothing;  // of the plane before
};

Decoder::Decoder() : impl_(std::make_unique<Impl>()) {}
Decoder::Decoder(const Decoder& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
Decoder& Decoder::operator=(const Decoder& other) {
  impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}
Decoder::Decoder(Decoder&&) noexcept = default;
Decoder& Decoder::operator=(Decoder&&) noexcept = default;
Decoder::~Decoder() = default;

void Decoder::push(std::span<const std::uint8_t> bytes) {
  if (impl_->finished) return;
  impl_->buffer.insert(impl_->buffer.end(), bytes.begin(), bytes.end());
}

void Decoder::finish() { impl_->finished = true; }

Result<Event> Decoder::next() {
  Result<Event> event{Event{}};
  const Result<bool> plane = impl_->advance(event->plane);
  if (!plane) return plane.error();
  if (!*plane) return impl_->take_warning();
  event->bit = event->plane.bit_begin;
  return event;
}

Result<DecodedStream> decode(std::span<const std::uint8_t> stream) {
  Decoder decoder;
  DecodedStream out;
  std::size_t pushed = 0;
  for (;;) {
    out.planes.emplace_back();  // filled in place
    const Result<bool> filled = decoder.impl_->advance(out.planes.back());
    if (filled && *filled) {
      note_rate(out);
      continue;
    }
    out.planes.pop_back();
    if (filled) {
      const Event warning = decoder.impl_->take_warning();
      add_warning(out, warning.bit, warning.text);
      continue;
    }
    const Error& error = filled.error();
    if (error.code == Code::need_data) {
      const std::size_t count = std::min(kPieceBytes, stream.size() - pushed);
      decoder.push(stream.subspan(pushed, count));
      pushed += count;
      if (pushed == stream.size()) decoder.finish();
      continue;
    }
    if (error.code != Code::end_of_stream) return error;
    const std::int64_t ignored = std::int64_t(stream.size()) - error.where.bit / 8;
    if (ignored > 0) {
      add_warning(out, error.where.bit,
                  std::to_string(ignored) + " bytes after the end code are ignored");
    }
    return out;
  }
}

fap::Sequence face_sequence(const DecodedStream& stream) {
  fap::Sequence sequence;
  sequence.rate = stream.rate;
  for (const Plane& plane : stream.planes) {
    if (has_face(plane.object_mask)) sequence.frames.push_back(plane.face);
  }
  return sequence;
}

}  // namespace animeme::fba
