// A face that speaks clicks, written in every layout that we offer, for the readers of others.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "codec/encode/encode.h"
#include "tests/formats/media/media_support.h"
#include "tests/support/folders.h"
#include "tests/support/random_clip.h"
#include "tools/formats/media/mux.h"

namespace animeme::test {

struct Talk {
  fba::AccessUnits face;
  media::Pcm sound;
  std::vector<std::int64_t> clicks;  ///< samples at which bursts begin
};

/// Bursts off the beat of planes and of audio frames.
inline void add_clicks(Talk& talk, int sample_rate, std::size_t length) {
  std::vector<std::size_t> starts;
  for (std::size_t start = std::size_t(sample_rate) / 2 + 37; start + 4000 < length;
       start += std::size_t(sample_rate) * 3 / 4 + 11) {
    starts.push_back(start);
    talk.clicks.push_back(std::int64_t(start));
  }
  talk.sound = make_clicks(sample_rate, length, starts);
}

/// 2.4 s of a face that walks at random, an intra plane every second.
inline Talk walking_talk(int sample_rate = 48000) {
  Talk talk;
  fap::Sequence clip = random_clip(11, 60);
  clip.rate = {25, 1};
  fba::EncodeOptions options;
  options.intra_seconds = 25 / 25.0;
  const auto stream = fba::encode(clip, options);
  EXPECT_TRUE(stream) << stream.error().describe();
  if (!stream) return talk;
  const auto face = fba::split_access_units(*stream);
  EXPECT_TRUE(face) << face.error().describe();
  if (face) talk.face = *face;
  add_clicks(talk, sample_rate, std::size_t(sample_rate) * 12 / 5);
  return talk;
}

/// A stream of the conformance suite, e.g. one with start codes inside its planes.
inline Talk reference_talk(const std::string& name) {
  Talk talk;
  const fs::path file =
      fs::path(test::kBinaryFolder) / "conformance" / "cases" / name / (name + ".fba");
  const auto face = fba::split_access_units(read_bytes(file.string()));
  EXPECT_TRUE(face) << file << ": " << face.error().describe();
  if (!face) return talk;
  talk.face = *face;
  // As long as the face: qtdemux takes a face of less than a fifth of the sound for a picture.
  const double ticks = double(talk.face.units.back().time + talk.face.units.back().duration);
  add_clicks(talk, 44100, std::size_t(44100 * ticks / talk.face.timescale));
  return talk;
}

/// The bursts are where they belong, or `delay` samples later, within `rounding`.
inline void expect_bursts(const media::Pcm& heard, const Talk& talk, std::int64_t delay,
                          double rounding = 1) {
  ASSERT_GE(talk.clicks.size(), 2u);
  for (const std::int64_t click : talk.clicks) {
    EXPECT_NEAR(double(find_click(heard, click + delay, 3000)), double(click + delay), rounding);
  }
}

/// Times of a transport stream begin so late, seconds, and half of that behind its clock
/// (tools/formats/media/containers.md, section 3.2).
inline constexpr double kTsBegin = 1.4;

struct Layout {
  std::string name;
  std::string extension;
  media::MuxOptions options = {};
  bool face = true;  ///< false: the sound alone

  bool mp4() const { return extension == ".mp4"; }
  bool segments() const { return extension == ".m3u8" || extension == ".mpd"; }
  bool fragments() const { return options.fragmented || segments(); }
  bool ts() const { return extension == ".ts"; }
  /// Its face is timed metadata, not video.
  bool metadata() const {
    return (mp4() || segments()) && !options.systems &&
           options.face_track == media::FaceTrackType::metadata;
  }
  bool opus() const { return options.audio.codec == media::AudioCodec::opus; }
  /// Samples that a decoder puts out before the sound (tools/formats/media/containers.md,
  /// section 5.1).
  std::int64_t priming() const { return opus() ? 312 : 1024; }
  /// Samples by which face and sound begin late: Matroska and TS cannot say what priming of AAC is
  /// (tools/formats/media/containers.md, section 5.2).
  std::int64_t late() const {
    return mp4() || segments() || extension == ".m4a" || opus() ? 0 : priming();
  }
};

inline std::vector<Layout> layouts() {
  std::vector<Layout> all = {{"mp4", ".mp4"},       {"mp4_opus", ".mp4"},
                             {"fragments", ".mp4"}, {"fragments_opus", ".mp4"},
                             {"mp4_video", ".mp4"}, {"fragments_video", ".mp4"},
                             {"systems", ".mp4"},   {"mkv", ".mkv"},
                             {"mkv_opus", ".mkv"},  {"ts", ".ts"}};
  for (Layout& layout : all) {
    layout.options.fragmented = layout.name.starts_with("fragments");
    layout.options.systems = layout.name == "systems";
    if (layout.name.ends_with("opus")) layout.options.audio.codec = media::AudioCodec::opus;
    if (layout.name.ends_with("video")) layout.options.face_track = media::FaceTrackType::video;
  }
  return all;
}

inline std::vector<Layout> mp4_layouts() {
  std::vector<Layout> some;
  for (const Layout& layout : layouts()) {
    if (layout.mp4()) some.push_back(layout);
  }
  return some;
}

/// Without a face, for players that know none.
inline std::vector<Layout> sound_layouts() {
  std::vector<Layout> all = {
      {"m4a", ".m4a"}, {"mka", ".mka"}, {"webm", ".webm"}, {"opus", ".opus"}};
  for (Layout& layout : all) {
    layout.face = false;
    layout.options.audio.codec = media::usual_codec("sound" + layout.extension);
  }
  return all;
}

/// Playlists beside folders of segments, a second each.
inline std::vector<Layout> segment_layouts() {
  std::vector<Layout> all = {{"hls", ".m3u8"}, {"hls_opus", ".m3u8"}, {"hls_video", ".m3u8"},
                             {"dash", ".mpd"}, {"dash_opus", ".mpd"}, {"dash_video", ".mpd"}};
  for (Layout& layout : all) {
    layout.options.fragment_seconds = 1;
    if (layout.name.ends_with("opus")) layout.options.audio.codec = media::AudioCodec::opus;
    if (layout.name.ends_with("video")) layout.options.face_track = media::FaceTrackType::video;
  }
  return all;
}

inline std::vector<std::string> names_of(const std::vector<Layout>& layouts) {
  std::vector<std::string> names;
  for (const Layout& layout : layouts) names.push_back(layout.name);
  return names;
}

inline Layout layout_of(const std::string& name) {
  for (const auto& list : {layouts(), sound_layouts(), segment_layouts()}) {
    for (const Layout& layout : list) {
      if (layout.name == name) return layout;
    }
  }
  ADD_FAILURE() << "no layout " << name;
  return {};
}

/// Writes the talk into `dir`; the path of the file, empty after a failure of the test.
inline std::string write_talk(const TempDir& dir, const Talk& talk, const Layout& layout) {
  const std::string path = dir.file(layout.name + layout.extension);
  const media::MuxInput input{.face = layout.face ? &talk.face : nullptr, .audio = &talk.sound};
  const auto written = media::write_container(path, input, layout.options);
  EXPECT_TRUE(written) << layout.name << ": " << written.error().describe();
  return written ? path : std::string();
}

/// The units as a container without a place for the configuration has them: TS repeats it in
/// front of each intra plane (tools/formats/media/containers.md, section 3.2).
inline std::vector<Bytes> units_of(const Talk& talk, bool config_in_band) {
  std::vector<Bytes> out;
  for (const fba::AccessUnit& unit : talk.face.units) {
    Bytes bytes = config_in_band && unit.intra ? talk.face.config : Bytes();
    bytes.insert(bytes.end(), unit.bytes.begin(), unit.bytes.end());
    out.push_back(std::move(bytes));
  }
  return out;
}

inline Bytes joined(const std::vector<Bytes>& units) {
  Bytes out;
  for (const Bytes& unit : units) out.insert(out.end(), unit.begin(), unit.end());
  return out;
}

inline std::string to_hex(const Bytes& bytes) {
  std::string out;
  for (const std::uint8_t byte : bytes) {
    out += "0123456789abcdef"[byte >> 4];
    out += "0123456789abcdef"[byte & 15];
  }
  return out;
}

}  // namespace animeme::test
