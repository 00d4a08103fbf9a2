// Program tables of a transport stream: which packets carry the face, which the sound.
// Source: tools/formats/media/containers.md, section 3.2; the tables are those of ISO/IEC 13818-1.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace animeme::media {

inline constexpr std::size_t kTsPacket = 188;
inline constexpr std::size_t kTsCrcSize = 4;  ///< bytes behind a section
inline constexpr std::uint8_t kTsSync = 0x47;
inline constexpr int kTsNoPid = 0x1FFF;  ///< of packets that only fill

/// Of a section with its checksum: 0. Of one without: the checksum.
std::uint32_t ts_crc(std::span<const std::uint8_t> section);

/// Collects the sections of one PID, which may lie across packets and share them.
class TsSections {
 public:
  /// Takes the payload of a packet; `begins`: payload_unit_start_indicator. Returns the sections
  /// that are now complete and whose checksum is right.
  std::vector<std::vector<std::uint8_t>> push(std::span<const std::uint8_t> payload, bool begins);
  /// Packets were lost.
  void reset() { open_ = false; }

 private:
  void take(std::vector<std::vector<std::uint8_t>>& complete);

  std::vector<std::uint8_t> bytes_;
  bool open_ = false;
};

/// PAT: PIDs of the program maps, in order. nullopt: not a PAT that is in force.
std::optional<std::vector<int>> read_pat(std::span<const std::uint8_t> section);

enum class TsCodec : std::uint8_t { none, adts, opus };

/// What a program has for us.
struct TsProgram {
  int face = kTsNoPid;   ///< stream type 0x10
  int sound = kTsNoPid;  ///< the first one that we can read
  TsCodec sound_codec = TsCodec::none;
  int channels = 0;  ///< Opus: as the descriptor says

  friend bool operator==(const TsProgram&, const TsProgram&) = default;
};

/// PMT. nullopt: not one that is in force.
std::optional<TsProgram> read_pmt(std::span<const std::uint8_t> section);

/// A packet that says that no program is left: a PAT without entries.
std::array<std::uint8_t, kTsPacket> end_of_programs(unsigned continuity_counter, unsigned version);

}  // namespace animeme::media
