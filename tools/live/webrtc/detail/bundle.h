// Messages of the data channel `animeme.face`: a unit and, against loss, those before it.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace animeme::webrtc {

inline constexpr std::size_t kMostBundle = 1100;  ///< bytes; what fits in one packet

/// Puts them together. Bytes: README.md.
class BundleWriter {
 public:
  /// `hello`: first message of /face; `repeat`: units before the newest that go with it.
  BundleWriter(std::vector<std::uint8_t> hello, int repeat)
      : hello_(std::move(hello)), repeat_(std::size_t(repeat)) {}

  /// The message for a unit, given as a message of /face.
  std::vector<std::uint8_t> push(std::vector<std::uint8_t> unit, bool intra);
  /// Everything since the newest intra plane, for one who comes now.
  std::vector<std::vector<std::uint8_t>> catch_up() const;
  /// A message with one unit, in place of the newest one; `intra`: a receiver may begin with it.
  std::vector<std::uint8_t> alone(std::span<const std::uint8_t> unit, bool intra) const;
  /// Hands over the units since the newest intra plane, as push() got them.
  template <class Take>
  void since_intra(Take take) const {
    for (std::size_t at = intra_; at < recent_.size(); ++at) take(recent_[at]);
  }
  std::int64_t repeated() const { return repeated_; }  ///< units that went again, so far

 private:
  /// Units [first, last) of recent_.
  std::vector<std::uint8_t> write(std::size_t first, std::size_t last) const;
  std::size_t size_of(std::size_t at) const { return 2 + recent_[at].size(); }

  const std::vector<std::uint8_t> hello_;
  const std::size_t repeat_;
  std::deque<std::vector<std::uint8_t>>
      recent_;                // since the newest intra plane, and what may go again
  std::uint32_t number_ = 0;  // of the first of these
  std::size_t intra_ = 0;     // where among them the newest intra plane is
  std::int64_t repeated_ = 0;
};

/// {'E', 1}: no unit comes any more.
std::vector<std::uint8_t> end_message();

}  // namespace animeme::webrtc
