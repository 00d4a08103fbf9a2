// Packets in a temporary file, which nobody else sees and which ends with the process.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <vector>

#include "fap/result.h"

namespace animeme::media {

class PacketStore {
 public:
  struct Head {
    std::int64_t time = 0, duration = 0;
    std::uint32_t size = 0;
    bool sync = false;
  };

  static Result<PacketStore> make();
  Result<void> add(Head head, std::span<const std::uint8_t> bytes);  // sets head.size
  /// What was added can be read from the first packet on, and nothing more is added. Error: io.
  Result<void> rewind();
  /// False: there are no more. Error: io.
  Result<bool> next(Head& head, std::vector<std::uint8_t>& bytes);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace animeme::media
