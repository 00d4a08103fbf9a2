#include "tools/live/webrtc/detail/bundle.h"

#include <algorithm>

namespace animeme::webrtc {
namespace {

constexpr std::size_t kHeader = 9, kMostUnits = 255;
constexpr std::size_t kMostRecent =
    512;  // units: streams without intra planes have to end somewhere

void put(std::vector<std::uint8_t>& bytes, std::uint64_t value, int size) {
  for (int i = size - 1; i >= 0; --i) bytes.push_back(std::uint8_t(value >> (8 * i)));
}

}  // namespace

std::vector<std::uint8_t> BundleWriter::push(std::vector<std::uint8_t> unit, bool intra) {
  const std::size_t most = intra ? repeat_ : kMostRecent - 1;
  while (recent_.size() > most) {
    recent_.pop_front();
    ++number_;
    if (intra_ > 0) --intra_;
  }
  if (intra) intra_ = recent_.size();
  recent_.push_back(std::move(unit));
  std::size_t first = recent_.size() - 1, size = kHeader + hello_.size() + size_of(first);
  for (std::size_t again = 0; again < repeat_ && first > 0; ++again) {
    size += size_of(first - 1);
    if (size > kMostBundle) break;
    --first;
  }
  repeated_ += std::int64_t(recent_.size() - 1 - first);
  return write(first, recent_.size());
}

std::vector<std::vector<std::uint8_t>> BundleWriter::catch_up() const {
  std::vector<std::vector<std::uint8_t>> messages;
  for (std::size_t first = intra_; first < recent_.size();) {
    std::size_t last = first, size = kHeader + hello_.size();
    do {
      size += size_of(last++);
    } while (last < recent_.size() && last - first < kMostUnits &&
             size + size_of(last) <= kMostBundle);
    messages.push_back(write(first, last));
    first = last;
  }
  return messages;
}

std::vector<std::uint8_t> BundleWriter::alone(std::span<const std::uint8_t> unit,
                                              bool intra) const {
  std::vector<std::uint8_t> bytes{'B', 1};
  put(bytes, number_ + recent_.size() - 1, 4);
  put(bytes, 1, 1);
  put(bytes, intra ? hello_.size() : 0, 2);
  if (intra) bytes.insert(bytes.end(), hello_.begin(), hello_.end());
  put(bytes, unit.size(), 2);
  bytes.insert(bytes.end(), unit.begin(), unit.end());
  return bytes;
}

std::vector<std::uint8_t> BundleWriter::write(std::size_t first, std::size_t last) const {
  std::vector<std::uint8_t> bytes{'B', 1};
  put(bytes, number_ + first, 4);
  put(bytes, last - first, 1);
  const bool entry = first <= intra_ && intra_ < last;  // who begins here has to know what it is
  put(bytes, entry ? hello_.size() : 0, 2);
  if (entry) bytes.insert(bytes.end(), hello_.begin(), hello_.end());
  for (std::size_t at = first; at < last; ++at) {
    put(bytes, recent_[at].size(), 2);
    bytes.insert(bytes.end(), recent_[at].begin(), recent_[at].end());
  }
  return bytes;
}

std::vector<std::uint8_t> end_message() { return {'E', 1}; }

}  // namespace animeme::webrtc
