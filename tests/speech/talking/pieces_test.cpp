// Pieces of speech as other programs push them, written as they write them.
#include "tools/speech/talking/pieces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/support/folders.h"
#include "tests/support/program.h"
#include "tools/formats/media/audio.h"

namespace animeme::speech {
namespace pieces_test {

using testing::HasSubstr;
using Json = nlohmann::json;

std::string encoded(const std::string& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      out += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
    }
  }
  return out;
}

// 16-bit samples of a ramp, little-endian.
std::string samples(std::size_t count) {
  std::string bytes;
  for (std::size_t i = 0; i < count; ++i) {
    bytes += char(i & 255);
    bytes += char(i >> 8 & 127);
  }
  return bytes;
}

SpokenLine good(const Json& json) {
  auto line = read_piece(json.dump(), {});
  EXPECT_TRUE(line) << line.error().describe();
  return line ? std::move(*line) : SpokenLine{};
}

std::string labels_of(const dam::Script& script) {
  std::string out;
  for (const dam::Phone& phone : script.phones) out += (out.empty() ? "" : " ") + phone.label;
  return out;
}

constexpr const char* kScript = "0 0.1 SIL\n0.1 0.2 B\n0.2 0.4 AA\n";

TEST(Piece, SamplesAndAScript) {
  const SpokenLine line = good({{"audio", encoded(samples(8000))},
                                {"sample_rate", 16000},
                                {"script", kScript},
                                {"text", "bah"}});
  EXPECT_TRUE(line.joins);
  EXPECT_EQ(line.text, "bah");
  EXPECT_EQ(line.speech.audio.sample_rate, 16000);
  ASSERT_EQ(line.speech.audio.samples.size(), 8000u);
  EXPECT_EQ(line.speech.audio.samples[0x1234], float(0x1234) / 32768);
  EXPECT_EQ(labels_of(line.speech.script), "SIL B AA SIL");
  EXPECT_DOUBLE_EQ(line.speech.script.duration(), 0.5);
  EXPECT_EQ(line.doubt, "");
}

TEST(Piece, AFileInsideOrBesideInAnyOfItsNames) {
  const test::TempDir dir;
  media::Pcm pcm{24000, std::vector<float>(12000, 0.25F)};
  ASSERT_TRUE(media::write_wav(dir / "a.wav", pcm));
  const std::string bytes = test::slurp(dir / "a.wav");
  for (const char* name : {"audio", "audio_base64", "audioContent", "Data"}) {
    // The rate of a file is its own, whatever is said beside it.
    const SpokenLine line =
        good({{name, encoded(bytes)}, {"sampleRate", 16000}, {"script", kScript}});
    EXPECT_EQ(line.speech.audio.sample_rate, 24000) << name;
    EXPECT_EQ(line.speech.audio.samples.size(), 12000u);
  }
  const SpokenLine line = good({{"file", dir / "a.wav"}, {"script", kScript}});
  EXPECT_EQ(line.speech.audio.samples.size(), 12000u);
}

TEST(Piece, FloatsThatAreNoSamplesAreTamed) {
  std::string bytes;
  for (const std::uint32_t bits : {0x3f000000U, 0x7fc00000U, 0xff800000U, 0x41200000U}) {
    for (int i = 0; i < 4; ++i) bytes += char(bits >> (8 * i) & 255);
  }
  const SpokenLine line = good({{"audio", encoded(bytes)},
                                {"sample_rate", 1000},
                                {"encoding", "pcm_f32le"},
                                {"script", "0 0.004 AA"}});
  EXPECT_EQ(line.speech.audio.samples, (std::vector<float>{0.5F, 0, -1, 1}));
}

TEST(Piece, TheRateHasSeveralNames) {
  for (const char* name : {"sample_rate", "sampleRate", "sampleRateHertz", "rate"}) {
    const SpokenLine line =
        good({{"audio", encoded(samples(1000))}, {name, 24000}, {"script", "0 0.04 AA"}});
    EXPECT_EQ(line.speech.audio.sample_rate, 24000) << name;
  }
}

TEST(Piece, TimesOfServicesStandInThePieceItself) {
  const std::string audio = encoded(samples(16000));
  // ElevenLabs.
  const SpokenLine eleven = good({{"audio_base64", audio},
                                  {"encoding", "pcm_s16le"},
                                  {"sample_rate", 16000},
                                  {"alignment",
                                   {{"characters", {"B", "o", "b"}},
                                    {"character_start_times_seconds", {0.1, 0.2, 0.3}},
                                    {"character_end_times_seconds", {0.2, 0.3, 0.4}}}}});
  // Azure.
  const SpokenLine azure = good({{"audio", audio},
                                 {"sample_rate", 16000},
                                 {"visemes",
                                  {{{"AudioOffset", 1000000}, {"VisemeId", 21}},
                                   {{"AudioOffset", 2000000}, {"VisemeId", 2}},
                                   {{"AudioOffset", 4000000}, {"VisemeId", 0}}}}});
  EXPECT_EQ(labels_of(azure.speech.script).substr(0, 3), "SIL");
  EXPECT_EQ(azure.speech.script.phones.size(), 4u);
  EXPECT_DOUBLE_EQ(azure.speech.script.phones[1].start, 0.1);
  if (eleven.speech.script.phones.empty()) return;  // no pronunciations: told by good()
  EXPECT_EQ(labels_of(eleven.speech.script), "SIL B AA B SIL");
}

TEST(Piece, ChannelsAndCodingsOfTelephones) {
  std::string both;
  for (const int value : {1000, 3000, -2000, 2000}) {
    both += char(value & 255);
    both += char(value >> 8 & 255);
  }
  const SpokenLine stereo = good(
      {{"audio", encoded(both)}, {"sample_rate", 8000}, {"channels", 2}, {"script", "0 1 AA"}});
  EXPECT_EQ(stereo.speech.audio.samples, (std::vector<float>{2000.0F / 32768, 0}));
  // ITU-T G.711: the codes of the largest values, of small ones and of 0.
  for (const char* name : {"mulaw", "ulaw_8000", "g711_ulaw", "PCMU", "raw-8khz-8bit-mono-mulaw"}) {
    const SpokenLine line = good({{"audio", encoded(std::string("\x80\x00\xFF\xEF\x7F", 5))},
                                  {"encoding", name},
                                  {"script", "0 1 AA"}});
    EXPECT_EQ(line.speech.audio.sample_rate, 8000) << name;
    EXPECT_EQ(line.speech.audio.samples,
              (std::vector<float>{32124.0F / 32768, -32124.0F / 32768, 0, 132.0F / 32768, 0}))
        << name;
  }
  const SpokenLine alaw =
      good({{"audio", encoded("\xAA\x2A\xD5\x55")}, {"encoding", "alaw"}, {"script", "0 1 AA"}});
  EXPECT_EQ(alaw.speech.audio.samples,
            (std::vector<float>{32256.0F / 32768, -32256.0F / 32768, 8.0F / 32768, -8.0F / 32768}));
}

TEST(Piece, WhatDoesNotFitTheSoundIsToldAndTheSoundIsHeard) {
  const SpokenLine longer =
      good({{"audio", encoded(samples(1000))}, {"sample_rate", 16000}, {"script", kScript}});
  EXPECT_EQ(longer.speech.audio.samples.size(), 1000u);
  EXPECT_DOUBLE_EQ(longer.speech.script.duration(), 1000.0 / 16000);
  EXPECT_THAT(longer.doubt, HasSubstr("338 ms behind its sound"));
  const SpokenLine broken = good(
      {{"audio", encoded(samples(1000))}, {"sample_rate", 16000}, {"script", "no script at all"}});
  EXPECT_EQ(broken.speech.audio.samples.size(), 1000u);
  EXPECT_THAT(broken.doubt, HasSubstr("script cannot be read"));
}

// Made piece by piece: what the lines of a stream become.
std::vector<SpokenLine> all_of(const std::vector<Json>& messages) {
  PieceStream stream({});
  std::vector<std::uint64_t> keys;
  for (const Json& message : messages) {
    const auto taken = stream.add(message.dump());
    EXPECT_TRUE(taken) << taken.error().describe();
    if (taken && taken->key != 0) keys.push_back(taken->key);
  }
  std::vector<SpokenLine> lines;
  for (const std::uint64_t key : keys) {
    auto line = stream.make(key);
    EXPECT_TRUE(line) << line.error().describe();
    if (line) lines.push_back(std::move(*line));
    stream.forget(key);
  }
  return lines;
}

TEST(Piece, APhoneGoesOnInTheNextPiece) {
  const std::string audio = encoded(samples(1600));  // 0.1 s
  const auto lines =
      all_of({{{"audio", audio}, {"sample_rate", 16000}, {"script", "0 0.03 B\n0.03 0.25 AA"}},
              {{"audio", audio}},
              {{"audio", audio}, {"script", "0.04 0.1 M"}}});
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(labels_of(lines[0].speech.script), "B AA");
  EXPECT_EQ(labels_of(lines[1].speech.script), "AA");
  EXPECT_TRUE(lines[1].goes_on);
  EXPECT_EQ(labels_of(lines[2].speech.script), "AA M");
  EXPECT_TRUE(lines[2].goes_on);
  EXPECT_NEAR(lines[2].speech.script.phones[0].end, 0.04, 1e-9);
}

TEST(Piece, TimesInMessagesOfTheirOwnBeforeAndBehindTheirSound) {
  const std::string audio = encoded(samples(1600));  // 0.1 s
  const auto times = [](const char* script) {
    return Json({{"context_id", 7}, {"script", script}});
  };
  const Json sound = {{"audio", audio}, {"sample_rate", 16000}, {"context_id", 7}};
  for (const auto& messages :
       {std::vector<Json>{times("0 0.08 AA"), sound, times("0.12 0.2 M"), sound},
        std::vector<Json>{sound, sound, times("0 0.08 AA"), times("0.12 0.2 M")}}) {
    const auto lines = all_of(messages);
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_EQ(labels_of(lines[0].speech.script), "AA SIL");
    EXPECT_EQ(labels_of(lines[1].speech.script), "SIL M");
    EXPECT_NEAR(lines[1].speech.script.phones[1].start, 0.02, 1e-9);
  }
  // With their sound they count from where they fit, or as is said.
  for (const char* from : {"piece", "utterance"}) {
    Json second = sound;
    second["script"] = std::string(from) == "piece" ? "0.02 0.1 M" : "0.12 0.2 M";
    for (const bool said : {false, true}) {
      if (said) second["times_from"] = from;
      EXPECT_EQ(labels_of(all_of({sound, second})[1].speech.script), "SIL M") << from;
    }
  }
}

TEST(Piece, ATextOfAnUtteranceWithoutSoundIsSpokenAtItsEnd) {
  PieceStream stream({});
  const auto text = stream.add(R"({"utterance": "a", "text": "Hello"})");
  ASSERT_TRUE(text);
  EXPECT_EQ(text->key, 0u);
  const auto end = stream.add(R"({"utterance": "a", "done": true})");
  ASSERT_TRUE(end);
  EXPECT_NE(end->key, 0u);
  EXPECT_EQ(end->text, "Hello");
  // Messages of services about other things are no errors, and say nothing.
  for (const char* talk : {R"({"type": "flush_done"})", R"({"sample_rate": 24000})",
                           R"({"type": "speech.audio.done", "usage": {"tokens": 3}})"}) {
    const auto taken = stream.add(talk);
    ASSERT_TRUE(taken) << talk;
    EXPECT_EQ(taken->key, 0u) << talk;
  }
  EXPECT_THAT(stream.add(R"({"type": "error", "message": "no credit"})")->warning,
              HasSubstr("no credit"));
}

TEST(Piece, TimesWithoutSoundMoveTheFaceAlone) {
  const SpokenLine line = good({{"script", kScript}});
  EXPECT_TRUE(line.speech.audio.samples.empty());
  EXPECT_DOUBLE_EQ(line.speech.script.duration(), 0.4);
}

TEST(Piece, SaysWhatIsWrong) {
  const std::string audio = encoded(samples(1000));
  const auto said = [](const std::string& json) {
    const auto line = read_piece(json, {});
    EXPECT_FALSE(line) << json;
    return line ? std::string() : line.error().describe();
  };
  EXPECT_THAT(said("{\"text\": \"x\""), HasSubstr("no JSON from its byte"));
  EXPECT_THAT(said("[1, 2]"), HasSubstr("a JSON object"));
  EXPECT_THAT(said("{\"audio\": 5, \"script\": \"0 1 AA\"}"), HasSubstr("\"audio\" has to be"));
  EXPECT_THAT(said("{\"audio\": \"@@\", \"script\": \"0 1 AA\"}"), HasSubstr("no base64"));
  EXPECT_THAT(said("{\"audio\": \"AAAAAAAAAAAAAAAA\"}"), HasSubstr("need \"sample_rate\""));
  EXPECT_THAT(said(Json({{"audio", audio}, {"sample_rate", 10}, {"script", kScript}}).dump()),
              HasSubstr("from 1000 to 384000"));
  EXPECT_THAT(said(Json({{"audio", audio}, {"encoding", "pcm"}, {"script", kScript}}).dump()),
              HasSubstr("sample_rate"));
  EXPECT_THAT(said(Json({{"audio", audio}, {"channels", 17}, {"sample_rate", 16000}}).dump()),
              HasSubstr("from 1 to 16"));
  EXPECT_THAT(said(R"({"script": "0 1 AA", "times_from": "here"})"), HasSubstr("\"here\""));
  EXPECT_THAT(said(R"({"some": "thing"})"), HasSubstr("neither sound nor a text"));
  EXPECT_THAT(said(Json({{"audio", audio}, {"script", kScript}}).dump()), HasSubstr("media"));
  EXPECT_THAT(said("{\"file\": \"no.wav\", \"script\": \"0 1 AA\"}"), HasSubstr("no.wav"));
  EXPECT_THAT(said("{\"script\": \"0 1 AA\\n0.5 2 B\"}"), HasSubstr("overlap"));
  EXPECT_THAT(said("{\"a\":" + std::string(100000, '[')), HasSubstr("no JSON"));
  EXPECT_THAT(said("{\"a\":" + std::string(1000, '[') + std::string(1000, ']') + "}"),
              HasSubstr("too deep"));
}

TEST(Piece, LinesOfAnyLengthAreLeftOutOrKeptWhole) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  LineMaker maker = piece_lines({});
  maker.most_bytes = 40000;
  auto lines = VoiceLines::open(ends[0], maker, media::steady_clock());
  ASSERT_TRUE(lines) << lines.error().describe();
  const std::string text =
      Json({{"audio", encoded(samples(7000))}, {"sample_rate", 16000}, {"script", kScript}})
          .dump() +
      "\n" + Json({{"audio", encoded(samples(30000))}, {"sample_rate", 16000}}).dump() + "\n" +
      Json({{"script", kScript}}).dump();
  std::thread writer([&] {
    EXPECT_EQ(::write(ends[1], text.data(), text.size()), ssize_t(text.size()));
    ::close(ends[1]);
  });
  std::vector<SpokenLine> all;
  while (!(*lines)->ended()) {
    while (auto line = (*lines)->take(false)) all.push_back(std::move(*line));
    (void)(*lines)->take_news();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  writer.join();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].speech.audio.samples.size(), 21000u);  // at 48000 a second
  EXPECT_TRUE(all[1].speech.audio.samples.empty());
  EXPECT_THAT((*lines)->take_warnings(),
              testing::ElementsAre(testing::AllOf(HasSubstr("line 2"), HasSubstr("40000"))));
  lines->reset();
  ::close(ends[0]);
}

// As ElevenLabs sends it, cut anywhere.
TEST(Piece, PartsOfAnMp3AreOneSound) {
  const test::TempDir dir;
  const std::string voice = std::string(test::kSourceFolder) + "/tools/release/samples/voice.wav";
  const std::string line = "ffmpeg -v quiet -y -i '" + voice +
                           "' -ar 44100 -b:a 128k -write_xing 0 " + "-id3v2_version 0 '" +
                           dir.file("a.mp3") + "' >/dev/null 2>&1";
  if (std::system(line.c_str()) != 0) GTEST_SKIP() << "ffmpeg cannot write MP3 (Debian: ffmpeg)";
  std::ifstream file(dir.file("a.mp3"), std::ios::binary);
  const std::string mp3{std::istreambuf_iterator<char>(file), {}};
  const auto whole = media::read_audio(dir.file("a.mp3"));
  ASSERT_TRUE(whole);
  PieceStream stream({});
  std::vector<float> sound;
  for (std::size_t at = 0; at < mp3.size(); at += 1000) {
    Json message = {{"audio", encoded(mp3.substr(at, 1000))}};
    if (at == 0) message["output_format"] = "mp3_44100_128";
    const auto taken = stream.add(message.dump());
    ASSERT_TRUE(taken) << at << ": " << taken.error().describe();
    if (taken->key == 0) continue;  // no frame is whole yet
    const auto line_of_it = stream.make(taken->key);
    ASSERT_TRUE(line_of_it) << line_of_it.error().describe();
    const media::Pcm& audio = line_of_it->speech.audio;
    EXPECT_EQ(audio.sample_rate, 44100);
    sound.insert(sound.end(), audio.samples.begin(), audio.samples.end());
  }
  ASSERT_EQ(sound.size(), whole->samples.size());
  double worst = 0;
  for (std::size_t i = 0; i < sound.size(); ++i) {
    worst = std::max(worst, double(std::abs(sound[i] - whole->samples[i])));
  }
  EXPECT_LT(worst, 1e-4);
}

}  // namespace pieces_test
}  // namespace animeme::speech
