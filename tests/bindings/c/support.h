// What the tests of the C interface share. Everything of ours in here comes from animeme.h.
#pragma once

#include <animeme/animeme.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fap/frame.h"

namespace animeme::test {

struct FreeC {
  void operator()(animeme_decoder* handle) const { animeme_decoder_free(handle); }
  void operator()(animeme_clip* handle) const { animeme_clip_free(handle); }
  void operator()(animeme_encoder* handle) const { animeme_encoder_free(handle); }
  void operator()(animeme_receiver* handle) const { animeme_receiver_free(handle); }
  void operator()(animeme_arkit* handle) const { animeme_arkit_free(handle); }
  void operator()(animeme_model* handle) const { animeme_model_free(handle); }
  void operator()(animeme_speech* handle) const { animeme_speech_free(handle); }
};
template <class Handle>
using C = std::unique_ptr<Handle, FreeC>;

using Bytes = std::vector<std::uint8_t>;

/// An empty frame of the C interface.
inline animeme_frame empty_frame() {
  animeme_frame frame;
  animeme_frame_init(&frame, sizeof frame);
  return frame;
}

inline animeme_frame c_frame(const fap::Frame& from) {
  animeme_frame to = empty_frame();
  to.number = from.number;
  for (std::size_t fap = 1; fap <= fap::kFapCount; ++fap) {
    to.present[fap - 1] = from.mask[fap];
    if (from.mask[fap] && fap >= fap::kFirstLowLevel) to.value[fap - 1] = from.value[fap];
  }
  const auto& [select1, select2, blend, def] = from.viseme;
  const std::int32_t viseme[] = {select1, select2, blend, def};
  if (from.mask[1]) std::copy(std::begin(viseme), std::end(viseme), to.viseme);
  const fap::Expression& e = from.expression;
  const std::int32_t shown[] = {e.select1,    e.intensity1, e.select2,
                                e.intensity2, e.init_face,  e.def};
  if (from.mask[2]) std::copy(std::begin(shown), std::end(shown), to.expression);
  return to;
}

inline C<animeme_clip> c_clip(const fap::Sequence& from) {
  animeme_clip* clip = nullptr;
  animeme_error error;
  EXPECT_EQ(animeme_clip_new(from.rate.num, from.rate.den, &clip, &error), ANIMEME_OK);
  for (const fap::Frame& frame : from.frames) {
    const animeme_frame one = c_frame(frame);
    EXPECT_EQ(animeme_clip_add(clip, &one, &error), ANIMEME_OK) << error.message;
  }
  return C<animeme_clip>(clip);
}

/// What a FAP text would show of a frame: number, what is present, values.
inline void expect_same(const animeme_frame& got, const fap::Frame& want) {
  const animeme_frame made = c_frame(want);
  EXPECT_EQ(got.number, made.number);
  for (std::size_t i = 0; i < ANIMEME_FAP_COUNT; ++i) {
    ASSERT_EQ(got.present[i], made.present[i]) << "FAP " << i + 1 << " of frame " << got.number;
    ASSERT_EQ(got.value[i], made.value[i]) << "FAP " << i + 1 << " of frame " << got.number;
  }
  EXPECT_TRUE(std::equal(std::begin(got.viseme), std::end(got.viseme), made.viseme));
  EXPECT_TRUE(std::equal(std::begin(got.expression), std::end(got.expression), made.expression));
}

inline void expect_same(const animeme_clip* got, const fap::Sequence& want) {
  ASSERT_EQ(animeme_clip_count(got), want.frames.size());
  for (std::size_t i = 0; i < want.frames.size(); ++i) {
    animeme_frame frame = empty_frame();
    ASSERT_EQ(animeme_clip_get(got, i, &frame, nullptr), ANIMEME_OK);
    expect_same(frame, want.frames[i]);
    if (testing::Test::HasFailure()) return;
  }
}

/// What a decoder gives out, an entry a call: the status, and the bytes of frame, body and error.
inline std::vector<std::string> everything(animeme_decoder* decoder,
                                           std::span<const std::uint8_t> bytes,
                                           const std::vector<std::size_t>& pieces = {}) {
  std::vector<std::string> all;
  bool ended = false;
  const auto pull = [&] {
    while (!ended) {
      animeme_frame frame = empty_frame();
      animeme_body body;
      animeme_body_init(&body, sizeof body);
      animeme_error error{};
      const animeme_status status = animeme_decoder_next(decoder, &frame, &body, &error);
      if (status == ANIMEME_NEED_DATA) return;
      std::string entry = std::to_string(status);
      entry.append(reinterpret_cast<const char*>(&frame), sizeof frame);
      entry.append(reinterpret_cast<const char*>(&body), sizeof body);
      if (status < 0) entry += error.message;
      all.push_back(entry);
      ended = status == ANIMEME_END;
    }
  };
  std::size_t at = 0;
  for (const std::size_t size : pieces) {
    const std::size_t taken = std::min(size, bytes.size() - at);
    EXPECT_EQ(animeme_decoder_push(decoder, bytes.data() + at, taken, nullptr), ANIMEME_OK);
    at += taken;
    pull();
  }
  EXPECT_EQ(animeme_decoder_push(decoder, bytes.data() + at, bytes.size() - at, nullptr),
            ANIMEME_OK);
  EXPECT_EQ(animeme_decoder_finish(decoder, nullptr), ANIMEME_OK);
  pull();
  return all;
}

}  // namespace animeme::test
