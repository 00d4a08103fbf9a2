// The MPEG-4_video_descriptor that libavformat leaves out of a transport stream's program map.
// Source: tools/formats/media/containers.md, section 3.2; ISO/IEC 13818-1, sections 2.4.4
// and 2.6.36.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace animeme::media {

/// Looks through a stream of 188-byte packets, cut anywhere, and gives each stream of type 0x10 in
/// a program map the descriptor `1B 01 <profile>`. All else passes as it is, also what is no
/// transport stream, and a map that has one already or no room in its packet.
class ProgramMapFilter {
 public:
  explicit ProgramMapFilter(std::uint8_t profile) : profile_(profile) {}

  /// The packets that are complete with these bytes.
  std::vector<std::uint8_t> push(std::span<const std::uint8_t> bytes);

 private:
  void rewrite(std::span<std::uint8_t> packet);

  std::uint8_t profile_;
  std::vector<std::uint8_t> rest_;
  std::vector<int> map_pids_;
};

}  // namespace animeme::media
