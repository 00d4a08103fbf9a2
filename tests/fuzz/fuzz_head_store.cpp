// Files of the cache of heads, with the build and the sum that they should have: somebody may have
// made them. Whatever is restored moves.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "fap/head/rig.h"
#include "tools/view/studio/head_store.h"

namespace {

using namespace animeme;

// The name of the build, with its length.
const std::string& head_of_file() {
  static const std::string head = [] {
    const std::string empty = studio::store_head({});
    std::uint64_t length = 0;
    std::memcpy(&length, empty.data(), sizeof length);
    return empty.substr(0, sizeof length + std::size_t(length));
  }();
  return head;
}

std::string with_sum(std::string bytes) {
  std::uint64_t sum = 0xCBF29CE484222325u;
  for (std::size_t i = 0; i < bytes.size(); i += sizeof sum) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, std::min(sizeof word, bytes.size() - i));
    sum = (sum ^ word) * 0x100000001B3u;
  }
  bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string rest(reinterpret_cast<const char*>(data), size);
  const auto head = studio::restore_head(with_sum(head_of_file() + rest));
  if (!head) return 0;
  const head::Rig rig = head::make_rig(*head);
  fap::Frame frame;
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) frame.set(fap, 700);
  head::pose(rig, frame);
  return 0;
}
