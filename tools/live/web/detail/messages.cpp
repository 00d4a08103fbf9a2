#include "tools/live/web/detail/messages.h"

#include "tools/formats/media/rtp/wire_internal.h"

namespace animeme::web {
namespace {

constexpr std::size_t kHelloHeader = 10;
constexpr std::uint8_t kHasSound = 1;

using media::put;

}  // namespace

std::vector<std::uint8_t> write_hello(const Hello& hello) {
  std::vector<std::uint8_t> out = {'A', kVersion, hello.visual_profile,
                                   std::uint8_t(hello.has_sound ? kHasSound : 0)};
  put(out, hello.timescale, 4);
  put(out, hello.config.size(), 2);
  out.insert(out.end(), hello.config.begin(), hello.config.end());
  return out;
}

Result<Hello> read_hello(std::span<const std::uint8_t> message) {
  if (message.size() < kHelloHeader || message[0] != 'A' ||
      message.size() != kHelloHeader + media::read_big_endian(message, 8, 2)) {
    return make_error(Code::syntax, "the server does not send a face as Animeme does");
  }
  if (message[1] != kVersion) {
    return make_error(Code::unsupported, "the server speaks version " + std::to_string(message[1]) +
                                             ", this program " + std::to_string(kVersion));
  }
  Hello hello;
  hello.visual_profile = message[2];
  hello.has_sound = (message[3] & kHasSound) != 0;
  hello.timescale = std::uint32_t(media::read_big_endian(message, 4, 4));
  hello.config.assign(message.begin() + kHelloHeader, message.end());
  if (hello.timescale == 0) return make_error(Code::syntax, "a time scale of 0");
  return hello;
}

std::vector<std::uint8_t> write_unit(const UnitMessage& unit) {
  std::vector<std::uint8_t> out;
  out.reserve(kUnitHeader + unit.bytes.size());
  put(out, unit.time, 8);
  put(out, unit.duration, 4);
  out.push_back(unit.flags);
  out.insert(out.end(), unit.bytes.begin(), unit.bytes.end());
  return out;
}

Result<UnitMessage> read_unit(std::span<const std::uint8_t> message) {
  if (message.size() <= kUnitHeader || message[0] >= 0x40) {
    return make_error(Code::syntax, "a message of the server is not an access unit");
  }
  return UnitMessage{media::read_big_endian(message, 0, 8),
                     std::uint32_t(media::read_big_endian(message, 8, 4)),
                     message[kFlagsAt],
                     {message.begin() + kUnitHeader, message.end()}};
}

}  // namespace animeme::web
