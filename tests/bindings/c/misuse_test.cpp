// NULLs and nonsense are answered, wherever they come.
#include <cmath>

#include "tests/bindings/c/support.h"

namespace animeme::test {
namespace misuse_test {
namespace {

constexpr animeme_status kBad = ANIMEME_INVALID_ARGUMENT;

TEST(CMisuse, FreeingNothing) {
  animeme_decoder_free(nullptr);
  animeme_clip_free(nullptr);
  animeme_encoder_free(nullptr);
  animeme_receiver_free(nullptr);
  animeme_arkit_free(nullptr);
  animeme_model_free(nullptr);
  animeme_speech_free(nullptr);
  animeme_free(nullptr);
  animeme_frame_init(nullptr, 8);
  animeme_body_init(nullptr, 8);
  animeme_encode_options_init(nullptr, 8, 0);
  animeme_speak_options_init(nullptr, 8);
}

TEST(CMisuse, NoPlaceForAHandle) {
  animeme_error error{};
  EXPECT_EQ(animeme_decoder_new(nullptr, &error), kBad);
  EXPECT_EQ(animeme_clip_new(25, 1, nullptr, &error), kBad);
  EXPECT_EQ(animeme_clip_from_text("", 0, nullptr, &error), kBad);
  EXPECT_EQ(animeme_clip_decode(reinterpret_cast<const std::uint8_t*>(""), 0, nullptr, &error),
            kBad);
  EXPECT_EQ(animeme_encoder_new(nullptr, nullptr, &error), kBad);
  EXPECT_EQ(animeme_receiver_new(0, nullptr, &error), kBad);
  EXPECT_EQ(animeme_arkit_new(nullptr, &error), kBad);
  EXPECT_EQ(animeme_model_builtin(nullptr, &error), kBad);
  EXPECT_EQ(animeme_speech_new(nullptr, nullptr, nullptr, &error), kBad);
  EXPECT_EQ(error.status, kBad);
  EXPECT_EQ(animeme_decoder_new(nullptr, nullptr), kBad);  // nor for the error
}

TEST(CMisuse, NoHandle) {
  animeme_frame frame = empty_frame();
  const std::uint8_t* bytes = nullptr;
  std::uint8_t* owned = nullptr;
  char* text = nullptr;
  std::size_t size = 0;
  float weights[ANIMEME_ARKIT_COUNT] = {};
  animeme_clip* clip = nullptr;
  animeme_speech* speech = nullptr;
  animeme_error error{};
  EXPECT_EQ(animeme_decoder_push(nullptr, nullptr, 0, &error), kBad);
  EXPECT_EQ(animeme_decoder_finish(nullptr, &error), kBad);
  EXPECT_EQ(animeme_decoder_reset(nullptr, &error), kBad);
  EXPECT_EQ(animeme_decoder_next(nullptr, &frame, nullptr, &error), kBad);
  EXPECT_EQ(animeme_decoder_warnings(nullptr, &error), 0);
  EXPECT_EQ(animeme_clip_add(nullptr, &frame, &error), kBad);
  EXPECT_EQ(animeme_clip_count(nullptr), 0U);
  EXPECT_EQ(animeme_clip_get(nullptr, 0, &frame, &error), kBad);
  EXPECT_EQ(animeme_clip_rate(nullptr, nullptr, nullptr, &error), kBad);
  EXPECT_EQ(animeme_clip_to_text(nullptr, &text, &size, &error), kBad);
  EXPECT_EQ(animeme_clip_fill(nullptr, 0, &clip, &error), kBad);
  EXPECT_EQ(animeme_clip_encode(nullptr, nullptr, &owned, &size, &error), kBad);
  EXPECT_EQ(animeme_encoder_write(nullptr, &frame, nullptr, 0, &bytes, &size, nullptr, &error),
            kBad);
  EXPECT_EQ(animeme_encoder_finish(nullptr, &bytes, &size, &error), kBad);
  EXPECT_EQ(animeme_encoder_shown(nullptr, &frame, &error), kBad);
  EXPECT_EQ(animeme_receiver_next(nullptr, &frame, &frame, &error), kBad);
  EXPECT_EQ(animeme_arkit_fit(nullptr, &frame, weights, ANIMEME_ARKIT_COUNT, &error), kBad);
  EXPECT_EQ(animeme_model_attribution(nullptr), nullptr);
  EXPECT_EQ(animeme_speak(nullptr, "", 0, nullptr, &clip, &error), kBad);
  EXPECT_EQ(animeme_speech_new(nullptr, nullptr, &speech, &error), kBad);
  EXPECT_EQ(animeme_speech_push(nullptr, 0, 1, "AA", &error), kBad);
  EXPECT_EQ(animeme_speech_finish(nullptr, &error), kBad);
  EXPECT_EQ(animeme_speech_next(nullptr, &frame, &error), kBad);
}

TEST(CMisuse, NoArguments) {
  animeme_error error{};
  animeme_frame frame = empty_frame();
  animeme_frame none{};  // size 0: never initialised
  const std::uint8_t* bytes = nullptr;
  std::size_t size = 0;
  animeme_decoder* made = nullptr;
  ASSERT_EQ(animeme_decoder_new(&made, nullptr), ANIMEME_OK);
  const C<animeme_decoder> decoder(made);
  EXPECT_EQ(animeme_decoder_push(made, nullptr, 1, &error), kBad);
  EXPECT_EQ(animeme_decoder_push(made, nullptr, 0, &error), ANIMEME_OK);
  EXPECT_EQ(animeme_decoder_next(made, nullptr, nullptr, &error), kBad);
  EXPECT_EQ(animeme_decoder_next(made, &none, nullptr, &error), kBad);
  animeme_body body{};
  EXPECT_EQ(animeme_decoder_next(made, &frame, &body, &error), kBad);
  EXPECT_EQ(animeme_decoder_next(made, &frame, nullptr, &error), ANIMEME_NEED_DATA);

  animeme_clip* new_clip = nullptr;
  EXPECT_EQ(animeme_clip_new(0, 1, &new_clip, &error), kBad);
  EXPECT_EQ(animeme_clip_new(25, 0, &new_clip, &error), kBad);
  ASSERT_EQ(animeme_clip_new(25, 1, &new_clip, &error), ANIMEME_OK);
  const C<animeme_clip> clip(new_clip);
  EXPECT_EQ(animeme_clip_add(new_clip, nullptr, &error), kBad);
  EXPECT_EQ(animeme_clip_add(new_clip, &none, &error), kBad);
  frame.group_rule[4] = 3;
  EXPECT_EQ(animeme_clip_add(new_clip, &frame, &error), kBad);
  frame.group_rule[4] = 0;
  EXPECT_EQ(animeme_clip_get(new_clip, 0, nullptr, &error), kBad);
  EXPECT_EQ(animeme_clip_to_text(new_clip, nullptr, &size, &error), kBad);
  animeme_clip* filled = nullptr;
  EXPECT_EQ(animeme_clip_fill(new_clip, 16, &filled, &error), kBad);
  std::uint8_t* owned = nullptr;
  EXPECT_EQ(animeme_clip_encode(new_clip, nullptr, &owned, nullptr, &error), kBad);
  EXPECT_EQ(animeme_clip_encode(new_clip, nullptr, &owned, &size, &error), kBad) << "no frames";
  EXPECT_EQ(animeme_clip_from_text(nullptr, 0, &filled, &error), kBad);
  EXPECT_EQ(animeme_clip_from_text("", 0, &filled, &error), ANIMEME_TRUNCATED);
  EXPECT_EQ(animeme_clip_decode(nullptr, 0, &filled, &error), kBad);

  animeme_encoder* new_encoder = nullptr;
  ASSERT_EQ(animeme_encoder_new(nullptr, &new_encoder, &error), ANIMEME_OK);
  const C<animeme_encoder> encoder(new_encoder);
  EXPECT_EQ(animeme_encoder_write(new_encoder, nullptr, nullptr, 0, &bytes, &size, nullptr, &error),
            kBad);
  EXPECT_EQ(animeme_encoder_write(new_encoder, &frame, &body, 0, &bytes, &size, nullptr, &error),
            kBad);
  EXPECT_EQ(animeme_encoder_write(new_encoder, &frame, nullptr, 0, nullptr, &size, nullptr, &error),
            kBad);
  EXPECT_EQ(animeme_encoder_finish(new_encoder, &bytes, nullptr, &error), kBad);

  animeme_receiver* new_receiver = nullptr;
  EXPECT_EQ(animeme_receiver_new(99, &new_receiver, &error), kBad);
  ASSERT_EQ(animeme_receiver_new(0, &new_receiver, &error), ANIMEME_OK);
  const C<animeme_receiver> receiver(new_receiver);
  EXPECT_EQ(animeme_receiver_next(new_receiver, &frame, nullptr, &error), kBad);
  EXPECT_EQ(animeme_receiver_next(new_receiver, &none, &frame, &error), kBad);
  EXPECT_EQ(animeme_receiver_next(new_receiver, nullptr, &frame, &error), ANIMEME_OK);
  EXPECT_EQ(animeme_expand(nullptr, &frame, &error), kBad);
  EXPECT_EQ(animeme_expand(&frame, nullptr, &error), kBad);
}

TEST(CMisuse, WeightsAndPhones) {
  animeme_error error{};
  animeme_frame frame = empty_frame();
  animeme_arkit* new_arkit = nullptr;
  ASSERT_EQ(animeme_arkit_new(&new_arkit, &error), ANIMEME_OK);
  const C<animeme_arkit> arkit(new_arkit);
  float weights[ANIMEME_ARKIT_COUNT] = {};
  EXPECT_EQ(animeme_arkit_fit(new_arkit, &frame, weights, 51, &error), kBad);
  EXPECT_EQ(animeme_arkit_fit(new_arkit, &frame, nullptr, 61, &error), kBad);
  EXPECT_EQ(animeme_arkit_fit(new_arkit, nullptr, weights, 61, &error), kBad);
  EXPECT_EQ(animeme_arkit_to_frame(nullptr, 3, &frame, &error), kBad);
  for (float& weight : weights) weight = std::nanf("");
  EXPECT_EQ(animeme_arkit_to_frame(weights, 61, &frame, &error), ANIMEME_OK);
  EXPECT_EQ(frame.value[2], 0);

  animeme_model* new_model = nullptr;
  EXPECT_EQ(animeme_model_read(nullptr, 0, &new_model, &error), kBad);
  ASSERT_EQ(animeme_model_builtin(&new_model, &error), ANIMEME_OK);
  const C<animeme_model> model(new_model);
  animeme_clip* clip = nullptr;
  EXPECT_EQ(animeme_speak(new_model, nullptr, 0, nullptr, &clip, &error), kBad);
  EXPECT_LT(animeme_speak(new_model, "", 0, nullptr, &clip, &error), 0);
  animeme_speech* new_speech = nullptr;
  animeme_speak_options options{};
  EXPECT_EQ(animeme_speech_new(new_model, &options, &new_speech, &error), kBad)
      << "never initialised";
  animeme_speak_options_init(&options, sizeof options);
  options.look_ahead = 61;
  EXPECT_EQ(animeme_speech_new(new_model, &options, &new_speech, &error), kBad);
  ASSERT_EQ(animeme_speech_new(new_model, nullptr, &new_speech, &error), ANIMEME_OK);
  const C<animeme_speech> speech(new_speech);
  EXPECT_EQ(animeme_speech_push(new_speech, 0, 1, nullptr, &error), kBad);
  EXPECT_LT(animeme_speech_push(new_speech, 0, 0.1, "QQ", &error), 0);
  EXPECT_LT(animeme_speech_push(new_speech, std::nan(""), 1, "AA", &error), 0);
  EXPECT_LT(animeme_speech_push(new_speech, 1, 0.5, "AA", &error), 0);
  EXPECT_EQ(animeme_speech_next(new_speech, nullptr, &error), kBad);
}

TEST(CLibrary, SaysWhatItIs) {
  const std::uint32_t version = animeme_version();
  const std::string text = std::to_string(version / 10000) + "." +
                           std::to_string(version / 100 % 100) + "." +
                           std::to_string(version % 100);
  EXPECT_EQ(text, animeme_version_text());
  for (const char* feature : {"decode", "encode", "text", "fill", "arkit", "speak"}) {
    EXPECT_EQ(animeme_has(feature), 1) << feature;
  }
  EXPECT_EQ(animeme_has("teleport"), 0);
  EXPECT_EQ(animeme_has(nullptr), 0);
  EXPECT_STREQ(animeme_fap_name(3), "open_jaw");
  EXPECT_EQ(animeme_fap_name(0), nullptr);
  EXPECT_EQ(animeme_fap_name(69), nullptr);
  for (animeme_status status = ANIMEME_NO_MEMORY; status <= ANIMEME_END; ++status) {
    EXPECT_STRNE(animeme_status_text(status), "unknown status");
  }
  EXPECT_STREQ(animeme_status_text(77), "unknown status");
}

}  // namespace
}  // namespace misuse_test
}  // namespace animeme::test
