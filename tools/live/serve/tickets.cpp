#include "tools/live/serve/tickets.h"

#include <array>
#include <charconv>

#include "conformance/sha256.h"

namespace animeme::serve {
namespace {

constexpr std::size_t kBlock = 64;  // bytes of SHA-256

std::string bytes_of(std::string_view hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    unsigned value = 0;
    std::from_chars(hex.data() + i, hex.data() + i + 2, value, 16);
    bytes += char(value);
  }
  return bytes;
}

}  // namespace

std::string hmac_sha256(std::string_view key, std::string_view text) {
  std::string block(key);
  if (block.size() > kBlock) block = bytes_of(conformance::sha256(block));
  block.resize(kBlock);
  std::string inner = block, outer = block;
  for (char& c : inner) c = char(c ^ 0x36);
  for (char& c : outer) c = char(c ^ 0x5C);
  return conformance::sha256(outer + bytes_of(conformance::sha256(inner + std::string(text))));
}

bool same_secret(std::string_view one, std::string_view other) {
  unsigned different = one.size() == other.size() ? 0 : 1;
  for (std::size_t i = 0; i < one.size() && !other.empty(); ++i) {
    different |= unsigned(one[i] ^ other[i % other.size()]);
  }
  return different == 0;
}

std::string Tickets::make(std::string_view head, std::int64_t expires) const {
  const std::string until = std::to_string(expires);
  return until + "-" + hmac_sha256(token_, "animeme ticket\n" + std::string(head) + "\n" + until);
}

bool Tickets::allows(std::string_view head, std::string_view ticket, std::int64_t now) const {
  std::int64_t expires = 0;
  const std::size_t dash = ticket.find('-');
  if (token_.empty() || dash == std::string_view::npos) return false;
  const auto read = std::from_chars(ticket.data(), ticket.data() + dash, expires);
  if (read.ec != std::errc() || read.ptr != ticket.data() + dash) return false;
  return same_secret(make(head, expires), ticket) && now < expires;
}

}  // namespace animeme::serve
