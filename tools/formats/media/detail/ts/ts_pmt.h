// The descriptors that libavformat leaves out of a transport stream's program map: the
// MPEG-4_video_descriptor, and the language of a face. Source: tools/formats/media/containers.md,
// section 3.2; ISO/IEC 13818-1, sections 2.4.4, 2.6.18 and 2.6.36.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace animeme::media {

/// Looks through a stream of 188-byte packets, cut anywhere, and gives each stream of type 0x10 in
/// a program map the descriptor `1B 01 <profile>`, and the first, the second ... of them the
/// ISO_639_language_descriptor `0A 04 <code> 00` of its language. All else passes as it is, also
/// what is no transport stream, and a map that has one already or no room in its packet.
class ProgramMapFilter {
 public:
  /// `languages`: of the faces in their order, three letters each; empty: not known.
  explicit ProgramMapFilter(std::uint8_t profile, std::vector<std::string> languages = {})
      : profile_(profile), languages_(std::move(languages)) {}

  /// The packets that are complete with these bytes.
  std::vector<std::uint8_t> push(std::span<const std::uint8_t> bytes);

 private:
  void rewrite(std::span<std::uint8_t> packet);

  std::uint8_t profile_;
  std::vector<std::string> languages_;
  std::vector<std::uint8_t> rest_;
  std::vector<int> map_pids_;
};

/// Bytes of a program map with so many faces and sounds, of which `labelled` have a language. It
/// has to fit in a packet for ProgramMapFilter: kMostProgramMap at most.
std::size_t program_map_bytes(std::size_t faces, std::size_t sounds, std::size_t labelled);
inline constexpr std::size_t kMostProgramMap = 183;  ///< see program_map_bytes()

}  // namespace animeme::media
