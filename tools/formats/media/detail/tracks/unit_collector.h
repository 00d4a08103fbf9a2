// From packets of the face stream to access units.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "codec/decode/decoder.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"
#include "tools/formats/media/detail/tracks/plane_cutter.h"

namespace animeme::media {

class UnitCollector {
 public:
  /// `config`: from the file's header, may be empty. `shared`: a packet may hold several units.
  UnitCollector(const ReadOptions& options, std::vector<std::uint8_t> config, bool shared);

  /// Takes one packet. Errors: out_of_range (limits).
  Result<void> add(const AVPacket& packet, AVRational time_base);

  /// From now on units are not collected: each is handed over once the next one is there. Errors of
  /// `take` end add().
  void pass_on(TakeUnit take) { take_ = std::move(take); }
  /// Instead of finish(): hands over the last unit. False: finish() would have repaired something
  /// or warned, or find_gaps() have found a gap.
  Result<bool> finish_passing(std::int64_t shift, bool find_gaps, FaceSummary& result);

  /// Units may be missing without a trace: where times leave room for them, they are. `noticed`:
  /// the demuxer had complaints, so that this holds in front of intra planes, too.
  void find_gaps(bool noticed);
  /// Durations, time shift (subtracted, in ticks), configuration, warnings. Errors: syntax (no
  /// unit could be read).
  Result<void> finish(std::int64_t shift, Container& result);

  bool empty() const { return units_.empty(); }
  std::size_t count() const { return passed_ + units_.size() + std::size_t(lost_); }
  std::int64_t first_time() const { return passed_ > 0 ? first_time_ : units_.front().time; }
  AVRational time_base() const { return base_; }

 private:
  void lose();
  Result<void> pass(fba::AccessUnit& unit);
  Result<void> repair(Container& result);
  Error too_long() const;
  bool continues(const AVPacket& packet) const;
  Result<void> append(std::span<const std::uint8_t> bytes);
  void set_durations();

  ReadOptions options_;
  std::vector<std::uint8_t> config_;
  std::optional<PlaneCutter> cutter_;  // of shared packets
  std::vector<fba::AccessUnit> units_;
  std::vector<std::size_t> gaps_;  // units with lost ones before them
  AVRational base_{1, 1};
  std::size_t bytes_ = 0;
  std::int64_t lost_ = 0;
  std::int64_t lost_before_ = 0;  // the last unit
  std::int64_t late_ = 0;         // units whose time does not ascend
  std::int64_t last_duration_ = 0;
  bool wait_for_intra_ = true;

  TakeUnit take_;           // empty: units are collected
  std::size_t passed_ = 0;  // units
  std::int64_t first_time_ = 0;
  std::int64_t last_passed_duration_ = 0;
  fba::Decoder decoder_;     // of what is passed on
  std::size_t decoded_ = 0;  // planes
  bool intact_ = true;
  fap::Rate rate_{30, 1};  // of the plane before
  double expected_ = 0;    // time of the next unit, seconds
  bool jumps_ = false;     // a unit comes later
};

/// Notes what is missing behind the last unit; there has to be one.
void add_damage_at_end(Container& file, std::string reason, std::int64_t frames = 0);

}  // namespace animeme::media
