#include "codec/decode/decoder_internal.h"

namespace animeme::fba {

namespace {

bool is_header(std::uint32_t code) {
  return code == kSequenceStart || code == kUserData || code == kVisualObject ||
         is_object_start(code);
}

// Types 0 to 5; 4 is face and body animation.
constexpr const char* kObjectTypes[] = {"reserved", "video", "still texture",
                                        "mesh",     "",      "3D mesh"};

}  // namespace

Result<bool> Decoder::Impl::read_header() {
  if (!available(position + 32)) return need_more();
  const std::uint32_t code = code_at(position);
  if (is_object_start(code)) {
    info.old_start_code = code == kOldObjectStart;
    tell_info();
    position += 32;
    phase = Phase::planes;
    first_plane = true;
  } else if (is_plane_start(code)) {
    if (!info_told) tell_info();
    phase = Phase::planes;  // a unit taken out of a stream; read_plane() finds the code
  } else if (code == kSequenceStart) {
    if (!available(position + 40)) return need_more();
    info.profile_and_level = std::uint8_t(BitReader(buffer, position + 32).bits(8));
    position += 40;
    phase = Phase::user_data;
  } else if (code == kUserData) {
    info.user_data = true;
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

Result<bool> Decoder::Impl::need_more() {
  if (!finished) return need_data();
  const bool empty = stream_bit(position) == 0 && buffer.empty();
  return at(Code::truncated, empty ? "the stream is empty" : "the stream ends in its headers",
            size_bits());
}

Result<bool> Decoder::Impl::read_visual_object() {
  if (!available(position + 48)) return need_more();
  BitReader in(buffer, position + 32);
  if (in.bit() != 0) {
    info.verid = std::uint8_t(in.bits(4));
    info.priority = std::uint8_t(in.bits(3));
  }
  const std::uint32_t type = in.bits(4);
  if (type != 4) {
    const std::string name = type < std::size(kObjectTypes) ? kObjectTypes[type] : "reserved";
    return at(Code::unsupported,
              "the visual object is of type " + name + ", not face and body animation",
              position + 32);
  }
  position += 40;
  phase = Phase::user_data;  // stuffing, then the next start code
  return false;
}

Result<bool> Decoder::Impl::skip_to(bool lost) {
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

void Decoder::Impl::end(std::size_t bit) {
  position = bit;
  phase = Phase::ended;
  end_bit = stream_bit(bit);
}

Result<bool> Decoder::Impl::plane_border() {
  const std::size_t border = (position / 8 + 1) * 8;
  if (!available(border + 32)) {
    if (!finished) return need_data();
    const bool stuffed = border == size_bits() && BitReader(buffer, position).at_stuffing();
    if (stuffed && had_start_code) {
      // Access units one after the other: each is complete in itself.
      warn("the stream has no end code", size_bits());
      end(size_bits());
      return true;
    }
    if (stuffed || position >= size_bits()) {
      return at(Code::truncated, "the stream ends without an end code; it may be truncated",
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
  if (is_plane_start(code) || code == kSequenceEnd || is_header(code)) {
    if (!BitReader(buffer, position).at_stuffing()) {
      // An object is over behind a plane only: its first one comes whatever follows.
      if (first_plane && !is_plane_start(code)) return false;
      warn(
          "the bits before a start code are taken for stuffing, as the standard requires, although "
          "they are not 0 and 1s; if they were meant as a plane, it is lost",
          position);
    }
    if (is_plane_start(code)) {
      consume_start_code(border);
      return false;
    }
    if (code == kSequenceEnd) {
      end(border + 32);
    } else {
      position = border;
      phase = Phase::headers;
    }
    return true;
  }
  if ((code >> 8) == 1 && BitReader(buffer, position).at_stuffing() && !plane_like_the_last()) {
    foreign_code(code, border);
    return true;
  }
  return false;
}

bool Decoder::Impl::plane_like_the_last() const {
  const ObjectMask mask = ObjectMask(BitReader(buffer, position).bits(3) & 3U);
  return has_body(mask) && mask == last_mask;
}

void Decoder::Impl::foreign_code(std::uint32_t code, std::size_t bit) {
  constexpr const char* kDigits = "0123456789ABCDEF";
  const std::string digits{kDigits[code >> 4 & 15], kDigits[code & 15]};
  warn("the start code 000001" + digits + " does not belong to a face or body and ends it", bit);
  position = bit + 32;
  lose();
}

void Decoder::Impl::consume_start_code(std::size_t bit) {
  position = bit + 32;
  after_start_code = true;
}

}  // namespace animeme::fba
