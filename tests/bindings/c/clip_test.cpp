// Clips, encoders, filling, ARKit and speech of the C interface against the libraries behind it.
#include <cstddef>
#include <cstring>

#include "codec/encode/encode.h"
#include "codec/encode/live.h"
#include "dam/model/builtin.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/idle_motion.h"
#include "dam/speaking/moods.h"
#include "dam/speaking/synthesise.h"
#include "fap/arkit.h"
#include "fap/fill.h"
#include "fap/text.h"
#include "tests/bindings/c/support.h"
#include "tests/support/files.h"
#include "tests/support/folders.h"
#include "tests/support/random_clip.h"

namespace animeme::test {
namespace clip_test {
namespace {

const std::string kSample = std::string(test::kSourceFolder) + "/tests/data/grid_s1_sample/";

Bytes encoded(const animeme_clip* clip, const animeme_encode_options* options) {
  std::uint8_t* bytes = nullptr;
  std::size_t size = 0;
  animeme_error error{};
  EXPECT_EQ(animeme_clip_encode(clip, options, &bytes, &size, &error), ANIMEME_OK) << error.message;
  Bytes copy(bytes, bytes + size);
  animeme_free(bytes);
  return copy;
}

TEST(CEncoder, ClipsBecomeTheBytesOfTheLibrary) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const fap::Sequence clip = random_clip(seed, 50, true);
    animeme_encode_options options;
    animeme_encode_options_init(&options, sizeof options, std::uint32_t(seed % 3));
    fba::EncodeOptions want = seed % 3 == 0   ? fba::EncodeOptions{}
                              : seed % 3 == 1 ? fba::file_options()
                                              : fba::live_options();
    if (seed % 3 == 2) want.stream.plane_start_codes = fba::PlaneStartCodes::all;
    options.fap_quant = want.fap_quant = int(seed);
    if (seed % 4 == 0) options.max_rms = want.max_rms = 5;
    if (seed % 4 == 1) options.max_bits_per_second = want.max_bits_per_second = 9000;
    if (seed % 5 == 0) options.still_below = want.still_below = 50;
    const auto stream = fba::encode(clip, want);
    ASSERT_TRUE(stream) << stream.error().describe();
    EXPECT_EQ(encoded(c_clip(clip).get(), &options), *stream);
  }
}

TEST(CEncoder, WithoutOptionsClipsAreFiles) {
  const fap::Sequence clip = random_clip(3, 40);
  EXPECT_EQ(encoded(c_clip(clip).get(), nullptr), *fba::encode(clip, fba::file_options()));
}

TEST(CEncoder, LiveUnitsAreThoseOfTheLibrary) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const fap::Sequence clip = random_clip(seed, 120);
    animeme_encode_options options;
    animeme_encode_options_init(&options, sizeof options, ANIMEME_PRESET_LIVE);
    options.rate_num = clip.rate.num;
    options.rate_den = clip.rate.den;
    options.fap_quant = 2;
    options.start_codes = std::uint32_t(seed % 3);
    fba::LiveOptions want{.rate = clip.rate, .fap_quant = 2};
    want.plane_start_codes = fba::PlaneStartCodes(seed % 3);
    fba::LiveEncoder live(want);
    animeme_encoder* made = nullptr;
    ASSERT_EQ(animeme_encoder_new(&options, &made, nullptr), ANIMEME_OK);
    const C<animeme_encoder> encoder(made);
    const std::uint8_t* bytes = nullptr;
    std::size_t size = 0;
    for (const fap::Frame& frame : clip.frames) {
      const auto unit = live.write(frame, std::uint32_t(frame.number % 3));
      ASSERT_TRUE(unit) << unit.error().describe();
      const animeme_frame one = c_frame(frame);
      std::int32_t intra = -1;
      animeme_error error{};
      ASSERT_EQ(animeme_encoder_write(made, &one, nullptr, std::uint32_t(frame.number % 3), &bytes,
                                      &size, &intra, &error),
                ANIMEME_OK)
          << error.message;
      ASSERT_EQ(Bytes(bytes, bytes + size), *unit);
      ASSERT_EQ(intra, live.intra() ? 1 : 0);
      animeme_frame shown = empty_frame();
      ASSERT_EQ(animeme_encoder_shown(made, &shown, nullptr), ANIMEME_OK);
      expect_same(shown, live.reconstruction());
    }
    ASSERT_EQ(animeme_encoder_finish(made, &bytes, &size, nullptr), ANIMEME_OK);
    EXPECT_EQ(Bytes(bytes, bytes + size), live.finish());
    EXPECT_EQ(animeme_encoder_finish(made, &bytes, &size, nullptr), ANIMEME_INVALID_ARGUMENT);
    EXPECT_EQ(bytes, nullptr);
  }
}

TEST(CEncoder, BodiesComeBack) {
  animeme_encoder* made = nullptr;
  animeme_decoder* undo = nullptr;
  ASSERT_EQ(animeme_encoder_new(nullptr, &made, nullptr), ANIMEME_OK);
  ASSERT_EQ(animeme_decoder_new(&undo, nullptr), ANIMEME_OK);
  const C<animeme_encoder> encoder(made);
  const C<animeme_decoder> decoder(undo);
  animeme_body body;
  animeme_body_init(&body, sizeof body);
  body.present[0] = 1;
  body.value[0] = 512;
  animeme_frame face = empty_frame();
  face.present[2] = 1;
  const std::uint8_t* bytes = nullptr;
  std::size_t size = 0;
  ASSERT_EQ(animeme_encoder_write(made, &face, &body, 0, &bytes, &size, nullptr, nullptr),
            ANIMEME_OK);
  animeme_decoder_push(undo, bytes, size, nullptr);
  ASSERT_EQ(animeme_encoder_finish(made, &bytes, &size, nullptr), ANIMEME_OK);
  animeme_decoder_push(undo, bytes, size, nullptr);
  animeme_body back;
  animeme_body_init(&back, sizeof back);
  ASSERT_EQ(animeme_decoder_next(undo, &face, &back, nullptr), ANIMEME_OK);
  EXPECT_EQ(face.flags, ANIMEME_FRAME_INTRA | ANIMEME_FRAME_FACE | ANIMEME_FRAME_BODY);
  EXPECT_EQ(back.present[0], 1);
  EXPECT_EQ(back.present[1], 0);
  EXPECT_NEAR(back.value[0], 512, 256);
}

TEST(CEncoder, ValuesThatCannotBeLeaveTheStreamAsItWas) {
  animeme_encode_options options;
  animeme_encode_options_init(&options, sizeof options, ANIMEME_PRESET_LIVE);
  options.fap_quant = 0;
  animeme_encoder* made = nullptr;
  ASSERT_EQ(animeme_encoder_new(&options, &made, nullptr), ANIMEME_OK);
  const C<animeme_encoder> encoder(made);
  animeme_frame frame = empty_frame();
  frame.present[2] = 1;
  frame.value[2] = 100'000;
  const std::uint8_t* bytes = nullptr;
  std::size_t size = 0;
  animeme_error error{};
  EXPECT_EQ(animeme_encoder_write(made, &frame, nullptr, 0, &bytes, &size, nullptr, &error),
            ANIMEME_OUT_OF_RANGE);
  EXPECT_NE(std::string(error.message), "");
  EXPECT_EQ(bytes, nullptr);
  frame.value[2] = 100;
  EXPECT_EQ(animeme_encoder_write(made, &frame, nullptr, 0, &bytes, &size, nullptr, &error),
            ANIMEME_OK);
  EXPECT_GT(size, 4U);
}

TEST(CEncoder, OptionsAreLookedAtWhenItIsMade) {
  for (const int wrong : {0, 1, 2, 3}) {
    animeme_encode_options options;
    animeme_encode_options_init(&options, sizeof options, ANIMEME_PRESET_LIVE);
    if (wrong == 0) options.fap_quant = 32;
    if (wrong == 1) options.rate_num = 999;
    if (wrong == 2) options.start_codes = 3;
    if (wrong == 3) options.size = 3;
    animeme_encoder* made = nullptr;
    animeme_error error{};
    EXPECT_EQ(animeme_encoder_new(&options, &made, &error), ANIMEME_INVALID_ARGUMENT) << wrong;
    EXPECT_EQ(made, nullptr);
    EXPECT_GT(std::string(error.message).size(), 10U);
  }
}

TEST(CClip, TextGoesBothWays) {
  const fap::Sequence clip = random_clip(4, 30, true);
  char* text = nullptr;
  std::size_t length = 0;
  const auto made = c_clip(clip);
  ASSERT_EQ(animeme_clip_to_text(made.get(), &text, &length, nullptr), ANIMEME_OK);
  EXPECT_EQ(std::string(text), std::string(text, length));
  animeme_clip* again = nullptr;
  ASSERT_EQ(animeme_clip_from_text(text, length, &again, nullptr), ANIMEME_OK);
  animeme_free(text);
  expect_same(C<animeme_clip>(again).get(), clip);
}

TEST(CClip, ErrorsOfTextHaveTheirPlace) {
  const std::string text = "2.1 a 25 1\n0 0 x\n";
  animeme_clip* clip = nullptr;
  animeme_error error;
  EXPECT_EQ(animeme_clip_from_text(text.data(), text.size(), &clip, &error), ANIMEME_SYNTAX);
  EXPECT_EQ(clip, nullptr);
  EXPECT_EQ(error.line, 2);
  EXPECT_EQ(error.column, 5);
  EXPECT_EQ(error.bit, -1);
  EXPECT_EQ(std::string(error.message).find("line 2:5: "), 0U) << error.message;
}

TEST(CClip, LongMessagesAreCutBetweenLetters) {
  std::string text = "2.1 a 25 1\n0 0 ";
  for (int i = 0; i < 400; ++i) text += "\u00fc";
  animeme_clip* clip = nullptr;
  animeme_error error;
  EXPECT_LT(animeme_clip_from_text(text.data(), text.size(), &clip, &error), 0);
  const std::string message = error.message;
  EXPECT_LT(message.size(), sizeof error.message);
  const auto last = std::uint8_t(message.back());
  EXPECT_TRUE(last < 0x80 || (last & 0xC0) == 0x80) << "half a letter at the end";
}

TEST(CClip, NumbersAscend) {
  animeme_clip* made = nullptr;
  ASSERT_EQ(animeme_clip_new(25, 1, &made, nullptr), ANIMEME_OK);
  const C<animeme_clip> clip(made);
  animeme_frame frame = empty_frame();
  frame.number = 5;
  EXPECT_EQ(animeme_clip_add(made, &frame, nullptr), ANIMEME_OK);
  EXPECT_EQ(animeme_clip_add(made, &frame, nullptr), ANIMEME_INVALID_ARGUMENT);
  EXPECT_EQ(animeme_clip_count(made), 1U);
  EXPECT_EQ(animeme_clip_get(made, 1, &frame, nullptr), ANIMEME_OUT_OF_RANGE);
}

TEST(CFill, ClipsAreFilledAsByTheLibrary) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const fap::Sequence clip = random_clip(seed, 30, true);
    for (const std::uint32_t flags : {0U, ANIMEME_FILL_INTERPOLATE, ANIMEME_FILL_EXPAND,
                                      ANIMEME_FILL_COMPLETE | ANIMEME_FILL_KEEP_HIGH_LEVEL}) {
      fap::FillOptions options;
      options.interpolate = flags == ANIMEME_FILL_INTERPOLATE;
      options.expand = flags == ANIMEME_FILL_EXPAND;
      options.complete = options.keep_high_level = (flags & ANIMEME_FILL_COMPLETE) != 0;
      animeme_clip* filled = nullptr;
      ASSERT_EQ(animeme_clip_fill(c_clip(clip).get(), flags, &filled, nullptr), ANIMEME_OK);
      expect_same(C<animeme_clip>(filled).get(), *fap::fill(clip, options));
    }
  }
}

TEST(CFill, AReceiverEndsWithTheFilledClip) {
  // A stream whose right sides are left to the receiver.
  fap::Sequence clip = random_clip(5, 40);
  for (fap::Frame& frame : clip.frames) {
    frame.mask.reset();
    for (const int fap : {3, 19, 20, 31, 32}) frame.set(fap, frame.value[3] + fap / 20);
  }
  const auto stream = *fba::encode(clip, fba::file_options());
  animeme_clip* decoded = nullptr;
  ASSERT_EQ(animeme_clip_decode(stream.data(), stream.size(), &decoded, nullptr), ANIMEME_OK);
  const C<animeme_clip> coded(decoded);
  animeme_clip* made = nullptr;
  ASSERT_EQ(animeme_clip_fill(decoded, ANIMEME_FILL_COMPLETE, &made, nullptr), ANIMEME_OK);
  const C<animeme_clip> filled(made);
  animeme_receiver* receiver = nullptr;
  ASSERT_EQ(animeme_receiver_new(ANIMEME_FILL_COMPLETE, &receiver, nullptr), ANIMEME_OK);
  const C<animeme_receiver> owner(receiver);
  std::size_t next = 0;
  for (std::size_t i = 0; i < animeme_clip_count(made); ++i) {
    animeme_frame want = empty_frame();
    animeme_frame got = empty_frame();
    animeme_frame in = empty_frame();
    ASSERT_EQ(animeme_clip_get(made, i, &want, nullptr), ANIMEME_OK);
    const bool there = next < animeme_clip_count(decoded) &&
                       animeme_clip_get(decoded, next, &in, nullptr) == ANIMEME_OK &&
                       in.number == want.number;
    next += there ? 1 : 0;
    ASSERT_EQ(animeme_receiver_next(receiver, there ? &in : nullptr, &got, nullptr), ANIMEME_OK);
    for (std::size_t fap = 0; fap < ANIMEME_FAP_COUNT; ++fap) {
      ASSERT_EQ(got.value[fap], want.value[fap]) << "FAP " << fap + 1 << ", frame " << want.number;
    }
  }
  EXPECT_GT(next, 10U);
}

TEST(CArkit, FitsAsTheLibraryDoes) {
  const fap::Sequence clip = *fap::fill(random_clip(6, 12), {.complete = true});
  animeme_arkit* made = nullptr;
  ASSERT_EQ(animeme_arkit_new(&made, nullptr), ANIMEME_OK);
  const C<animeme_arkit> arkit(made);
  fap::ArkitFitter fitter;
  for (const fap::Frame& frame : clip.frames) {
    const animeme_frame one = c_frame(frame);
    float weights[ANIMEME_ARKIT_COUNT];
    ASSERT_EQ(animeme_arkit_fit(made, &one, weights, ANIMEME_ARKIT_COUNT, nullptr), ANIMEME_OK);
    const fap::ArkitFrame want = fitter.fit(frame);
    for (std::size_t i = 0; i < want.size(); ++i) ASSERT_EQ(weights[i], float(want[i])) << i;
  }
  EXPECT_STREQ(animeme_arkit_name(0), "eyeBlinkLeft");
  EXPECT_EQ(animeme_arkit_name(61), nullptr);
  float jaw[ANIMEME_ARKIT_SHAPES] = {};
  for (int i = 0; i < ANIMEME_ARKIT_SHAPES; ++i) {
    if (std::string(animeme_arkit_name(i)) == "jawOpen") jaw[i] = 1;
  }
  animeme_frame open = empty_frame();
  ASSERT_EQ(animeme_arkit_to_frame(jaw, ANIMEME_ARKIT_SHAPES, &open, nullptr), ANIMEME_OK);
  EXPECT_GT(open.value[2], 100);
}

class CSpeech : public testing::Test {
 protected:
  void SetUp() override {
    animeme_model* made = nullptr;
    ASSERT_EQ(animeme_model_builtin(&made, nullptr), ANIMEME_OK);
    model.reset(made);
    const auto bytes = read_bytes(kSample + "phonemes/prac8p.tsv");
    text.assign(bytes.begin(), bytes.end());
  }
  C<animeme_clip> speak(const animeme_speak_options* options) const {
    animeme_clip* clip = nullptr;
    animeme_error error{};
    EXPECT_EQ(animeme_speak(model.get(), text.data(), text.size(), options, &clip, &error),
              ANIMEME_OK)
        << error.message;
    return C<animeme_clip>(clip);
  }
  C<animeme_model> model;
  std::string text;
};

TEST_F(CSpeech, SpeaksAsTheLibraryDoes) {
  const auto builtin = dam::builtin_model();
  const auto script = dam::read_script(text);
  ASSERT_TRUE(script);
  dam::SynthesisOptions options;
  options.articulation = 1;
  options.tongue = options.symmetric_rest = true;
  auto signal = dam::synthesise(*builtin, *script, options);
  ASSERT_TRUE(signal);
  ASSERT_TRUE(dam::add_idle_motion(*signal, *script));
  expect_same(speak(nullptr).get(), *dam::to_sequence(*signal));
  EXPECT_NE(std::string(animeme_model_attribution(model.get())).find("GRID"), std::string::npos);
}

TEST_F(CSpeech, Moods) {
  const auto script = dam::read_script(text);
  ASSERT_TRUE(script);
  dam::SynthesisOptions synthesis;
  synthesis.articulation = 1;
  synthesis.tongue = synthesis.symmetric_rest = true;
  auto signal = dam::synthesise(*dam::builtin_model(), *script, synthesis);
  ASSERT_TRUE(signal);
  ASSERT_TRUE(dam::add_idle_motion(*signal, *script));
  ASSERT_TRUE(dam::add_moods(*signal, *script, dam::MoodTrack(dam::Mood{"joy", 0.5})));
  animeme_speak_options options;
  animeme_speak_options_init(&options, sizeof options);
  EXPECT_EQ(options.mood[0], 0);
  std::strcpy(options.mood, "joy:0.5");
  expect_same(speak(&options).get(), *dam::to_sequence(*signal));
  const auto refused = [&](animeme_status status) {
    animeme_clip* clip = nullptr;
    animeme_error error;
    EXPECT_EQ(animeme_speak(model.get(), text.data(), text.size(), &options, &clip, &error), status)
        << error.message;
    EXPECT_EQ(clip, nullptr);
  };
  std::strcpy(options.mood, "jooy");
  refused(ANIMEME_NOT_FOUND);
  std::memset(options.mood, 'x', sizeof options.mood);  // without an end
  refused(ANIMEME_NOT_FOUND);
  options.size = offsetof(animeme_speak_options, mood);  // of a program that does not know it
  EXPECT_NE(speak(&options).get(), nullptr);
}

TEST_F(CSpeech, TheTongueMovesUnlessItIsTurnedOff) {
  const auto tongue_of = [&](const animeme_speak_options& options) {
    const auto clip = speak(&options);
    int most = 0, present = 0;
    animeme_frame frame = empty_frame();
    for (std::size_t i = 0; i < animeme_clip_count(clip.get()); ++i) {
      EXPECT_EQ(animeme_clip_get(clip.get(), i, &frame, nullptr), ANIMEME_OK);
      present += frame.present[43];
      most = std::max(most, std::abs(frame.value[43]));  // FAP 44
    }
    return std::pair(present > 0, most);
  };
  animeme_speak_options options;
  animeme_speak_options_init(&options, sizeof options);
  EXPECT_EQ(options.tongue, 1U);
  EXPECT_TRUE(tongue_of(options).first);
  EXPECT_GT(tongue_of(options).second, 100);
  options.size = offsetof(animeme_speak_options, tongue);  // of a program that does not know it
  EXPECT_TRUE(tongue_of(options).first);
  animeme_speak_options_init(&options, sizeof options);
  options.tongue = 0;
  EXPECT_FALSE(tongue_of(options).first);
}

TEST_F(CSpeech, LooksAndStaysStill) {
  animeme_speak_options options;
  animeme_speak_options_init(&options, sizeof options);
  std::strcpy(options.look, "20,-5");
  std::strcpy(options.still, "head,brows");
  options.idle_motion = 0.5;
  const auto script = dam::read_script(text);
  ASSERT_TRUE(script);
  dam::SynthesisOptions synthesis;
  synthesis.articulation = 1;
  synthesis.tongue = synthesis.symmetric_rest = true;
  auto signal = dam::synthesise(*dam::builtin_model(), *script, synthesis);
  ASSERT_TRUE(signal);
  dam::IdleMotionOptions idle;
  idle.liveliness = 0.5;
  idle.look = *dam::parse_look("20,-5");
  idle.still.head = idle.still.brows = true;
  ASSERT_TRUE(dam::add_idle_motion(*signal, *script, idle));
  expect_same(speak(&options).get(), *dam::to_sequence(*signal));
  const auto refused = [&](animeme_status status) {
    animeme_clip* clip = nullptr;
    animeme_error error;
    EXPECT_EQ(animeme_speak(model.get(), text.data(), text.size(), &options, &clip, &error), status)
        << error.message;
  };
  std::strcpy(options.look, "up");
  refused(ANIMEME_SYNTAX);
  std::strcpy(options.look, "0,80");
  refused(ANIMEME_OUT_OF_RANGE);
  options.look[0] = 0;
  std::strcpy(options.still, "ears");
  refused(ANIMEME_NOT_FOUND);
}

class CSpeechInMoods : public CSpeech, public testing::WithParamInterface<const char*> {};

TEST_P(CSpeechInMoods, AStreamHasTheSameFramesAndOutlivesItsModel) {
  animeme_speak_options options;
  animeme_speak_options_init(&options, sizeof options);
  options.idle_motion = -1;
  std::strcpy(options.mood, GetParam());
  const auto want = speak(&options);
  animeme_speech* made = nullptr;
  ASSERT_EQ(animeme_speech_new(model.get(), &options, &made, nullptr), ANIMEME_OK);
  const C<animeme_speech> speech(made);
  model.reset();
  std::size_t next = 0;
  std::size_t early = 0;
  const auto pull = [&](animeme_status last) {
    animeme_frame got = empty_frame();
    animeme_frame expected = empty_frame();
    animeme_status status = ANIMEME_OK;
    while ((status = animeme_speech_next(made, &got, nullptr)) == ANIMEME_OK) {
      ASSERT_EQ(animeme_clip_get(want.get(), next++, &expected, nullptr), ANIMEME_OK);
      ASSERT_TRUE(std::equal(std::begin(got.value), std::end(got.value), expected.value)) << next;
      ASSERT_TRUE(std::equal(std::begin(got.present), std::end(got.present), expected.present));
      ASSERT_EQ(got.number, expected.number);
      ASSERT_EQ(got.seconds, expected.seconds);
    }
    EXPECT_EQ(status, last);
  };
  const auto script = dam::read_script(text);
  ASSERT_TRUE(script);
  for (const dam::Phone& phone : script->phones) {
    animeme_error said{};
    ASSERT_EQ(animeme_speech_push(made, phone.start, phone.end, phone.label.c_str(), &said),
              ANIMEME_OK)
        << said.message;
    pull(ANIMEME_NEED_DATA);
  }
  early = next;
  ASSERT_EQ(animeme_speech_finish(made, nullptr), ANIMEME_OK);
  pull(ANIMEME_END);
  EXPECT_GT(early, 5U);
  EXPECT_EQ(next, animeme_clip_count(want.get()));
  animeme_error error{};
  EXPECT_EQ(animeme_speech_push(made, 9, 10, "AA", &error), ANIMEME_INVALID_ARGUMENT);
}

INSTANTIATE_TEST_SUITE_P(Neutral, CSpeechInMoods, testing::Values(""));
INSTANTIATE_TEST_SUITE_P(Moody, CSpeechInMoods,
                         testing::Values("joy", "anger:0.6", "surprise", "ironic"));

TEST_F(CSpeech, WhatIsWrongIsSaid) {
  animeme_clip* clip = nullptr;
  animeme_error error{};
  const std::string bad = "start_s\tend_s\tphone\n0\t0.1\tAA\n0.1\t0.2\tQQQ\n";
  EXPECT_EQ(animeme_speak(model.get(), bad.data(), bad.size(), nullptr, &clip, &error),
            ANIMEME_NOT_FOUND);
  EXPECT_EQ(error.line, 3);
  animeme_speak_options options;
  animeme_speak_options_init(&options, sizeof options);
  options.style = 7;
  animeme_speech* speech = nullptr;
  EXPECT_EQ(animeme_speech_new(model.get(), &options, &speech, &error), ANIMEME_INVALID_ARGUMENT);
  options.style = 1;
  std::strcpy(options.mood, "jooy");
  EXPECT_EQ(animeme_speech_new(model.get(), &options, &speech, &error), ANIMEME_NOT_FOUND);
  const std::uint8_t noise[] = {'A', 'N', 'I', 'M', 'E', 'D', 'A', 'M', 1, 2, 3};
  animeme_model* other = nullptr;
  EXPECT_LT(animeme_model_read(noise, sizeof noise, &other, &error), 0);
  EXPECT_EQ(other, nullptr);
}

}  // namespace
}  // namespace clip_test
}  // namespace animeme::test
