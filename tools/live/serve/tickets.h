/// @file
/// Tickets that let somebody watch one head for some time, without a store of them.
///
///     const Tickets tickets(token);
///     const std::string ticket = tickets.make("anna", now + 3600);   // "1764240000-9f86d0..."
///     tickets.allows("anna", ticket, now);
///
/// A ticket is EXPIRES-SIGNATURE: seconds since 1970, and HMAC-SHA256 (RFC 2104) in hexadecimal
/// digits, with the token of the server as its key, of "animeme ticket\n" NAME "\n" EXPIRES. So
/// whoever has the token can make them, and all processes with this token accept them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace animeme::serve {

/// HMAC-SHA256 as 64 lower-case hexadecimal digits.
std::string hmac_sha256(std::string_view key, std::string_view text);

/// Compares in a time that does not tell how much of it is right.
bool same_secret(std::string_view one, std::string_view other);

/// Makes and checks tickets. Thread safe.
class Tickets {
 public:
  /// `token`: not empty, else no ticket is valid.
  explicit Tickets(std::string token) : token_(std::move(token)) {}
  /// A ticket for `head` until `expires`, seconds since 1970.
  std::string make(std::string_view head, std::int64_t expires) const;
  /// Whether a ticket is one for `head`, and has not expired at `now`.
  bool allows(std::string_view head, std::string_view ticket, std::int64_t now) const;

 private:
  const std::string token_;
};

}  // namespace animeme::serve
