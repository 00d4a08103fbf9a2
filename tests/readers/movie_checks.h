// The face of a movie against what was written.
#pragma once

#include "tests/readers/movie.h"
#include "tests/readers/talk.h"

namespace animeme::test {

inline Bytes bytes_of(const BoxFile& file, const MovieSample& sample) {
  const auto start = file.bytes().begin() + std::ptrdiff_t(sample.offset);
  return Bytes(start, start + std::ptrdiff_t(sample.size));
}

inline void expect_face(const BoxFile& file, const Movie& movie, const Talk& talk) {
  const bool video = movie.track("vide") != nullptr;
  const MovieTrack* face = movie.track(video ? "vide" : "meta");
  ASSERT_NE(face, nullptr);
  EXPECT_EQ(face->entry, video ? "mp4v" : "mp4s");
  ASSERT_EQ(face->samples.size(), talk.face.units.size());
  for (std::size_t i = 0; i < face->samples.size(); ++i) {
    const fba::AccessUnit& unit = talk.face.units[i];
    SCOPED_TRACE("unit " + std::to_string(i));
    EXPECT_EQ(to_hex(bytes_of(file, face->samples[i])), to_hex(unit.bytes));
    EXPECT_EQ(face->samples[i].sync, unit.intra);
    // The movie's clock is that of the sound: a late start is rounded down to it.
    EXPECT_NEAR(face->shown_at(face->samples[i].time, movie.timescale),
                double(unit.time) / talk.face.timescale, 1.0 / movie.timescale);
  }
}

}  // namespace animeme::test
