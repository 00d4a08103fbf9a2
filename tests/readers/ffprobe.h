// Asking ffprobe for the packets of a face, and comparing them.
#pragma once

#include <string>
#include <vector>

#include "tests/readers/readers_support.h"
#include "tests/readers/talk.h"

namespace animeme::test {

/// What ffprobe says of the face. In TS the parser for MPEG-4 video would glue the units
/// (tools/formats/media/containers.md, section 2.3).
inline Json ask_ffprobe(const std::string& path, const Layout& layout, const std::string& options) {
  const std::string raw = path.ends_with(".ts") ? "-fflags noparse " : "";
  return run_json("ffprobe -v error " + raw + "-of json -select_streams " +
                  (layout.metadata() ? "d " : "v ") + options + " '" + path + "'");
}

inline void expect_packets(const Talk& talk, const Layout& layout, const Json& packets) {
  const bool mp4 = layout.mp4() || layout.segments();
  const std::vector<Bytes> units = units_of(talk, layout.ts());
  ASSERT_EQ(packets.size(), units.size());
  // mkv rounds the shift and each time to 1 ms.
  const double shift =
      double(layout.late()) / talk.sound.sample_rate + (layout.ts() ? kTsBegin : 0);
  const double rounding = mp4 ? 1e-6 : layout.ts() ? 1.1 / 90000 : 0.001;
  for (std::size_t i = 0; i < units.size(); ++i) {
    const fba::AccessUnit& unit = talk.face.units[i];
    const Json& packet = packets[i];
    SCOPED_TRACE("unit " + std::to_string(i));
    EXPECT_EQ(to_hex(from_dump(packet["data"])), to_hex(units[i]));
    const double time = double(unit.time) / talk.face.timescale;
    EXPECT_NEAR(std::stod(packet["pts_time"].get<std::string>()), time + shift, rounding);
    if (mp4 && !layout.fragments()) {
      EXPECT_EQ(packet["duration"], unit.duration);
    }
    // PES packets have no key flag, and FFmpeg gives all data one.
    if (!layout.ts() && !layout.metadata()) {
      EXPECT_EQ(packet["flags"], unit.intra ? "K_" : "__");
    }
  }
}

}  // namespace animeme::test
