// The click test: bursts at known samples must come back beside the planes they belong to.
// Source: tools/formats/media/containers.md, section 5.3.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/formats/media/media_support.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/mux.h"

namespace animeme::test {

/// One way from face and sound to a file.
struct ClickPath {
  const char* name;
  const char* extension;
  media::AudioCodec codec;
  bool fragmented = false;
  bool systems = false;
  double limit = 0.001;  ///< the largest error, seconds; 0: one sample
};

inline constexpr media::AudioCodec kAac = media::AudioCodec::aac;
inline constexpr media::AudioCodec kOpus = media::AudioCodec::opus;

/// All that are offered for a face.
inline constexpr ClickPath kClickPaths[] = {
    {"mp4", ".mp4", kAac, false, false, 0},
    {"mp4", ".mp4", kOpus, false, false, 0},
    {"mp4, fragmented", ".mp4", kAac, true, false, 0},
    {"mp4, fragmented", ".mp4", kOpus, true, false, 0},
    {"mp4, Systems", ".mp4", kAac, false, true, 0},
    {"HLS", ".m3u8", kAac, false, false, 0},
    {"HLS", ".m3u8", kOpus, false, false, 0},
    {"DASH", ".mpd", kAac, false, false, 0},
    {"DASH", ".mpd", kOpus, false, false, 0},
    {"mkv", ".mkv", kAac},
    {"mkv", ".mkv", kOpus},
    {"ts", ".ts", kAac},
};

/// Seconds; of several bursts and planes the ones that are farthest off.
struct ClickOffsets {
  double sound = 0;   ///< where a burst is heard, less where it was put in
  double face = 0;    ///< where the first plane lies
  double error = 0;   ///< sound less face
  double jitter = 0;  ///< of planes against the first one
  int sample_rate = 0;
};

/// Writes 4 s of bursts and planes to `path` and reads them again.
inline Result<ClickOffsets> measure_clicks(const std::string& path, const ClickPath& way,
                                           int sample_rate) {
  const fba::AccessUnits face = make_face(100);
  std::vector<std::size_t> starts;
  for (std::size_t k = 1; k < 8; ++k) starts.push_back(k * std::size_t(sample_rate) / 2 + 37);
  const media::Pcm sound = make_clicks(sample_rate, 4 * std::size_t(sample_rate), starts);
  media::MuxOptions options;
  options.audio.codec = way.codec;
  options.fragmented = way.fragmented;
  options.systems = way.systems;
  auto written = media::write_container(path, {.face = &face, .audio = &sound}, options);
  if (!written) return written.error();
  const Result<media::Container> back = media::read_container(path);
  if (!back) return back.error();
  const Result<media::Pcm> heard = media::read_audio(path);
  if (!heard) return heard.error();
  if (back->face.units.size() != face.units.size()) {
    return make_error(Code::internal, "planes were lost");
  }
  ClickOffsets out;
  out.sample_rate = heard->sample_rate;
  const double ticks = back->face.timescale;
  out.face = double(back->face.units[0].time) / ticks;
  for (const std::size_t start : starts) {
    const double put = double(start) / sample_rate;
    const auto near = std::int64_t((put + out.face) * heard->sample_rate);
    const double offset = double(find_click(*heard, near, 3000)) / heard->sample_rate - put;
    if (std::abs(offset - out.face) >= std::abs(out.error)) {
      out.sound = offset;
      out.error = offset - out.face;
    }
  }
  for (std::size_t i = 0; i < face.units.size(); ++i) {
    const double off = double(back->face.units[i].time) / ticks - out.face - double(i) / 25;
    out.jitter = std::max(out.jitter, std::abs(off));
  }
  return out;
}

}  // namespace animeme::test
