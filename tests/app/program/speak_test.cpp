// The main job end to end, through the program: text or voice in, a talking face out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "dam/script/phones.h"
#include "dam/script/script.h"
#include "fap/tables.h"
#include "fap/text.h"
#include "tests/app/program/commands.h"
#include "tests/support/shared.h"
#include "tests/support/wav_bytes.h"
#include "tools/formats/media/audio.h"

namespace animeme {
namespace speak_test {

using test::animeme;
using test::read_clip;
using test::TempDir;
using testing::HasSubstr;

dam::Script read_script_file(const std::string& path) {
  auto script = dam::read_script(test::slurp(path));
  EXPECT_TRUE(script) << script.error().describe();
  return script ? *script : dam::Script();
}

// Opening between the lips in FAP units: upper lip up plus lower lip down.
int inner_gap(const fap::Frame& frame) { return -(frame.value[4] + frame.value[5]); }

struct Range {
  int low = 0;
  int high = 0;
};

// Least and largest gap in the frames that a phone touches, one frame more on each side.
Range gap_during(const fap::Sequence& clip, const dam::Phone& phone) {
  const double fps = clip.rate.frames_per_second();
  Range range{1 << 20, -(1 << 20)};
  for (const fap::Frame& frame : clip.frames) {
    const double time = double(frame.number) / fps;
    if (time < phone.start - 0.04 || time > phone.end + 0.04) continue;
    range.low = std::min(range.low, inner_gap(frame));
    range.high = std::max(range.high, inner_gap(frame));
  }
  return range;
}

constexpr int kClosed = 45;  // FAP units, the threshold of the evaluation

// espeak-ng's sound library would ask PulseAudio, which keeps a cookie there.
TEST(SpeakFiles, TheHomeFolderStaysEmpty) {
  const TempDir home, dir;
  const auto made = test::run_command({"env", "-u", "XDG_CONFIG_HOME", "-u", "XDG_RUNTIME_DIR",
                                       "-u", "PULSE_SERVER", "HOME=" + home.path().string(),
                                       std::string(test::kBinaryFolder) + "/bin/animeme", "speak",
                                       "--text", "Hello world.", "-o", dir / "talk.mp4"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(home.files(), testing::IsEmpty());
}

class SpeakText : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(SpeakText, OpensOnVowelsClosesOnBilabialsAndRestsAtTheEnds) {
  const auto [language, text] = GetParam();
  const TempDir dir;
  const auto made = animeme({"speak", "--text", text, "--lang", language, "-o", dir / "talk.fap",
                             "--save-script", dir / "talk.TextGrid"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const fap::Sequence clip = read_clip(dir / "talk.fap");
  const dam::Script script = read_script_file(dir / "talk.TextGrid");
  ASSERT_FALSE(clip.frames.empty());
  EXPECT_NEAR(clip.duration(), script.duration(), 0.05);

  EXPECT_LT(std::abs(inner_gap(clip.frames.front())), kClosed);
  EXPECT_LT(std::abs(inner_gap(clip.frames.back())), kClosed);

  int vowels = 0;
  int open = 0;
  int bilabials = 0;
  double vowel_gap = 0;
  for (const dam::Phone& phone : script.phones) {
    const dam::PhoneInfo* info = dam::find_phone(phone.label);
    ASSERT_NE(info, nullptr) << phone.label;
    const Range gap = gap_during(clip, phone);
    if (info->bilabial) {
      ++bilabials;
      EXPECT_LT(gap.low, kClosed) << phone.label << " at " << phone.start << " s in " << phone.word;
    } else if (info->vowel) {
      ++vowels;
      open += gap.high > 2 * kClosed ? 1 : 0;
      vowel_gap += gap.high;
    }
  }
  EXPECT_GT(bilabials, 0);
  ASSERT_GT(vowels, 0);
  EXPECT_GE(open * 10, vowels * 8) << "the mouth opens on " << open << " of " << vowels;
  EXPECT_GT(vowel_gap / vowels, 3 * kClosed);
}

INSTANTIATE_TEST_SUITE_P(
    Languages, SpeakText,
    testing::Values(std::pair{"en", "My baby mumbles about a purple apple pie."},
                    std::pair{"de", "Ein guter Abend am Markt bringt Papa eine Ampel."},
                    std::pair{"fr", "Bonjour Madame, voici un beau bateau."},
                    std::pair{"es", "Buenos dias, mi amigo vive en Bilbao."}),
    [](const auto& param_info) { return std::string(param_info.param.first); });

// A name that is typed wrongly is no text to speak.
TEST(Speak, RefusesAMissingFile) {
  const TempDir dir;
  test::spill(dir / "words.TextGrid", "no grid");
  const std::string absent[] = {"nosuch.TextGrid", "talk.wav", dir / "nosuch", "talk.fba"};
  for (const std::string& name : absent) {
    const auto result = animeme({"speak", name, "-o", dir / "a.fba"});
    EXPECT_EQ(result.exit_code, 3) << name;
    EXPECT_THAT(result.err, HasSubstr("there is no file " + name));
    EXPECT_THAT(result.err, HasSubstr("--text"));
    EXPECT_FALSE(std::filesystem::exists(dir / "a.fba"));
  }
  EXPECT_THAT(animeme({"speak", dir / "word.TextGrid", "-o", dir / "a.fba"}).err,
              HasSubstr("did you mean " + (dir / "words.TextGrid") + "?"));
  EXPECT_EQ(animeme({"speak", dir / ".", "-o", dir / "a.fba"}).exit_code, 2);  // a folder
  const auto transcript = animeme(
      {"speak", "--audio", dir / "a.wav", "--transcript", "words.txt", "-o", dir / "a.fba"});
  EXPECT_EQ(transcript.exit_code, 2);
  EXPECT_THAT(transcript.err, HasSubstr("$(cat words.txt)"));
  for (const std::string text : {"Hello", "And/or, she said.", "<speak>either/or</speak>"}) {
    const auto result = animeme({"speak", text, "-o", dir / "a.fba"});
    EXPECT_EQ(result.exit_code, 0) << text << result.err;
  }
  EXPECT_EQ(animeme({"speak", "--text", "talk.wav", "-o", dir / "a.fba"}).exit_code, 0);
}

// What everybody types first.
TEST(Speak, TakesATextOrAFileWithoutAnOption) {
  const TempDir dir;
  test::spill(dir / "words.txt", "Hello world");
  ASSERT_EQ(animeme({"speak", "--text", "Hello world", "-o", dir / "text.fba", "-o",
                     dir / "talk.mp4", "--save-script", dir / "talk.TextGrid"})
                .exit_code,
            0);
  const std::string stream = test::slurp(dir / "text.fba");
  for (const std::string& input : {std::string("Hello world"), dir / "words.txt"}) {
    const auto result = animeme({"speak", input, "-o", dir / "bare.fba"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(test::slurp(dir / "bare.fba"), stream) << input;
  }
  EXPECT_EQ(animeme({"speak", dir / "talk.TextGrid", "-o", dir / "script.fap"}).exit_code, 0);
  const auto heard = animeme(
      {"speak", dir / "talk.mp4", "--transcript", "hello world", "-o", dir / "aligned.fap"});
  EXPECT_EQ(heard.exit_code, 0) << heard.err;
  EXPECT_EQ(read_clip(dir / "script.fap").frames.size(),
            read_clip(dir / "aligned.fap").frames.size());

  test::spill(dir / "data.xyz", "?");
  const std::pair<std::vector<std::string>, const char*> wrong[] = {
      {{"Hello", "--text", "world"}, "give one of them"},
      {{"Hello", "--script", dir / "talk.TextGrid"}, "too many"},
      {{"what she said", "--audio", dir / "talk.mp4"}, "--transcript"},
      {{dir / "data.xyz"}, "--script or --audio"},
      {{"--transcript", "what she said"}, "--transcript requires --audio"}};
  for (const auto& [line, said] : wrong) {
    std::vector<std::string> arguments = {"speak", "-o", dir / "wrong.fap"};
    arguments.insert(arguments.end(), line.begin(), line.end());
    const auto result = animeme(arguments);
    EXPECT_EQ(result.exit_code, 2) << said;
    EXPECT_THAT(result.err, HasSubstr(said));
  }
}

TEST(Speak, Mp4HoldsTheVeryFapsAfterQuantisation) {
  const TempDir dir;
  const std::vector<std::string> what = {"speak", "--text", "Hello world, this is Animeme.", "-o"};
  for (const char* name : {"a.fap", "a.fba", "a.mp4"}) {
    auto arguments = what;
    arguments.push_back(dir / name);
    const auto made = animeme(arguments);
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  for (const char* name : {"a.fba", "a.mp4"}) {
    const std::string decoded = dir / (std::string(name) + ".fap");
    ASSERT_EQ(animeme({"decode", dir / name, "-o", decoded}).exit_code, 0);
    const fap::Sequence want = read_clip(dir / "a.fap");
    const fap::Sequence got = read_clip(decoded);
    ASSERT_EQ(got.frames.size(), want.frames.size());
    for (std::size_t i = 0; i < got.frames.size(); ++i) {
      ASSERT_EQ(got.frames[i].mask, want.frames[i].mask);
      for (int fap = 3; fap <= fap::kFapCount; ++fap) {
        const std::size_t n = std::size_t(fap);
        ASSERT_LE(std::abs(got.frames[i].value[n] - want.frames[i].value[n]),
                  fap::info(fap).quant_step / 2)
            << name << " frame " << i << " FAP " << fap;
      }
    }
  }
  // A lossless stream gives exactly what synthesis made, without tongue, gaze and turns of the
  // head.
  for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{
           {"--quant", "0", "-o", dir / "b.mp4"},
           {"--no-tongue", "--still", "gaze,head", "-o", dir / "b.fap"}}) {
    std::vector<std::string> arguments = {"speak", "--text", "Hello world, this is Animeme."};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ASSERT_EQ(animeme(arguments).exit_code, 0);
  }
  EXPECT_EQ(animeme({"compare", dir / "b.fap", dir / "b.mp4"}).exit_code, 0);
  for (const std::size_t fap : {23, 44, 48}) {
    EXPECT_TRUE(read_clip(dir / "a.fap").frames[0].mask[fap]) << fap;
    EXPECT_FALSE(read_clip(dir / "b.fap").frames[0].mask[fap]) << fap;
  }
}

// Programs that convert leave the face alone, also its first frames.
TEST(Speak, FfmpegConvertsTheSound) {
  if (!test::has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not installed";
  const TempDir dir;
  ASSERT_EQ(animeme({"speak", "--text", "Hello", "-o", dir / "a.mp4"}).exit_code, 0);
  for (const std::vector<std::string>& conversion :
       {std::vector<std::string>{"-b:a", "40k", dir / "out.webm"},
        {"-c", "copy", dir / "out.mkv"}}) {
    std::vector<std::string> command = {"ffmpeg", "-nostdin", "-v", "warning", "-i", dir / "a.mp4"};
    command.insert(command.end(), conversion.begin(), conversion.end());
    const auto converted = test::run_command(command);
    EXPECT_EQ(converted.exit_code, 0) << converted.err;
    EXPECT_EQ(converted.err, "");
  }
}

// As 14496-14 puts it.
TEST(Speak, FfprobeSeesAacAndSimpleFaceAnimation) {
  if (!test::has_program("ffprobe"))
    GTEST_SKIP() << "ffprobe (Debian package ffmpeg) is not installed";
  const TempDir dir;
  ASSERT_EQ(animeme({"speak", "--text", "Hello", "-o", dir / "a.mp4"}).exit_code, 0);
  ASSERT_EQ(animeme({"mux", dir / "a.mp4", dir / "a.mp4", "--audio-codec", "copy", "--video-track",
                     "-o", dir / "b.mp4"})
                .exit_code,
            0);
  const auto probe = test::run_command(
      {"ffprobe", "-v", "quiet", "-print_format", "json", "-show_streams", dir / "b.mp4"});
  ASSERT_EQ(probe.exit_code, 0) << probe.err;
  const auto json = nlohmann::json::parse(probe.out);
  bool aac = false;
  bool face = false;
  for (const auto& stream : json["streams"]) {
    aac = aac || stream["codec_name"] == "aac";
    face = face || (stream["codec_name"] == "mpeg4" &&
                    stream["profile"].get<std::string>().find("Simple Face") == 0);
  }
  EXPECT_TRUE(aac);
  EXPECT_TRUE(face) << probe.out;
}

TEST(Speak, EveryContainerCarriesTheSameFace) {
  const TempDir dir;
  for (const char* name : {"a.mp4", "a.mkv", "a.ts"}) {
    ASSERT_EQ(animeme({"speak", "--text", "Bob and Pam", "-o", dir / name}).exit_code, 0) << name;
  }
  for (const char* name : {"a.mkv", "a.ts"}) {
    EXPECT_EQ(animeme({"compare", dir / "a.mp4", dir / name, "--max-rms", "0"}).exit_code, 0)
        << name;
  }
}

TEST(Speak, CurvesForAnyRig) {
  const TempDir dir;
  const auto sample = test::data_dir() / "grid_s1_sample";
  // A corpus of a rig of its own: the sample's curves under other names.
  std::filesystem::copy(sample, dir.path() / "rig", std::filesystem::copy_options::recursive);
  for (const auto& entry : std::filesystem::directory_iterator(dir.path() / "rig" / "fap")) {
    std::string text = test::slurp(entry.path());
    for (std::size_t at = 0; (at = text.find(",fap", at)) != std::string::npos;) {
      text.replace(at, 4, ",rig");
    }
    test::spill(entry.path(), text);
  }
  ASSERT_EQ(animeme({"train", dir / "rig", "-o", dir / "rig.dam", "--ridge-factor", "1"}).exit_code,
            0);
  const auto made =
      animeme({"speak", "--text", "Hello", "--model", dir / "rig.dam", "-o", dir / "a.csv"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_TRUE(test::slurp(dir / "a.csv").starts_with("time_s,rig3_open_jaw,"));
  const auto refused =
      animeme({"speak", "--text", "Hello", "--model", dir / "rig.dam", "-o", dir / "a.fap"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, HasSubstr(".csv"));
}

TEST(Speak, WithAModelOfAnyMethod) {
  const TempDir dir;
  const std::string sample = (test::data_dir() / "grid_s1_sample").string();
  for (const char* method : {"cohen-massaro", "mmm", "mean", "viseme", "triphone"}) {
    const auto trained = animeme(
        {"train", sample, "--method", method, "--max-iterations", "1", "-o", dir / "m.dam"});
    ASSERT_EQ(trained.exit_code, 0) << trained.err;
    const auto info = animeme({"info", dir / "m.dam", "--json"});
    ASSERT_EQ(info.exit_code, 0) << info.err;
    EXPECT_EQ(nlohmann::json::parse(info.out)["method"], method);
    const auto made =
        animeme({"speak", "--text", "Hello", "--model", dir / "m.dam", "-o", dir / "a.fap"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
  }
  EXPECT_EQ(
      animeme({"train", sample, "--method", "mmm", "--states", "9", "-o", dir / "m.dam"}).exit_code,
      2);
  // An option of another method is said, not swallowed.
  const auto misplaced = animeme({"train", sample, "--plain-sum", "-o", dir / "m.dam"});
  EXPECT_EQ(misplaced.exit_code, 2);
  EXPECT_THAT(misplaced.err, HasSubstr("--plain-sum belongs to --method dam-paper"));
}

TEST(Speak, SameInputGivesTheSameBytes) {
  const TempDir dir;
  for (const char* name : {"a.mp4", "b.mp4"}) {
    ASSERT_EQ(animeme({"speak", "--text", "Twice the same", "-o", dir / name}).exit_code, 0);
  }
  EXPECT_EQ(test::slurp(dir / "a.mp4"), test::slurp(dir / "b.mp4"));
}

TEST(Speak, AnyFrameRate) {
  const TempDir dir;
  for (const char* rate : {"25", "29.97", "60", "12.5", "120"}) {
    ASSERT_EQ(animeme({"speak", "--text", "Hello", "--rate", rate, "-o", dir / "a.fba"}).exit_code,
              0);
    const auto info = animeme({"info", dir / "a.fba", "--json"});
    ASSERT_EQ(info.exit_code, 0);
    const auto json = nlohmann::json::parse(info.out);
    EXPECT_EQ(json["clip"]["rate"], rate);
    EXPECT_NEAR(json["seconds"].get<double>(), 1.1, 0.4);
  }
}

TEST(Speak, RecordedUtteranceGoesTheSameWay) {
  const auto shared = test::shared_dir();
  if (shared.empty()) GTEST_SKIP() << "the recordings do not ship with the project";
  const auto corpus = shared / "data" / "grid_s1";
  const std::string id = "bbal8p";
  const TempDir dir;
  const auto made =
      animeme({"speak", "--script", (corpus / "phonemes" / (id + ".tsv")).string(), "--audio",
               (corpus / "audio" / (id + ".wav")).string(), "-o", dir / "a.mp4", "--json"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NEAR(nlohmann::json::parse(made.out)["seconds"].get<double>(), 3.0, 0.05);
  const auto info = animeme({"info", dir / "a.mp4", "--json"});
  ASSERT_EQ(info.exit_code, 0) << info.err;
  const auto json = nlohmann::json::parse(info.out);
  std::vector<std::string> kinds;
  for (const auto& track : json["tracks"]) kinds.push_back(track["kind"]);
  EXPECT_THAT(kinds, testing::ElementsAre("face", "audio", "text", "text")) << "words, phones";
  EXPECT_EQ(json["face"]["planes"], 75);
  ASSERT_EQ(animeme({"demux", dir / "a.mp4", "--face", dir / "a.fba", "--audio", dir / "a.wav"})
                .exit_code,
            0);
  EXPECT_EQ(animeme({"compare", dir / "a.fba", dir / "a.mp4"}).exit_code, 0);

  const auto aligned = animeme({"speak", "--audio", (corpus / "audio" / (id + ".wav")).string(),
                                "--transcript", "bin blue at l eight please", "-o", dir / "b.mp4"});
  EXPECT_EQ(aligned.exit_code, 0) << aligned.err;
}

// What is listened to is one channel; what is written is the recording, with both and at its level.
TEST(Speak, AStereoRecordingStaysStereo) {
  const TempDir dir;
  std::vector<float> left, right;
  for (std::size_t i = 0; i < 3 * 16000; ++i) {
    left.push_back(0.005f * std::sin(0.2f * float(i)));
    right.push_back(i % 4000 < 80 ? 0.002f : 0.0f);
  }
  test::write_bytes(dir / "voice.wav", test::wav_bytes(16000, {left, right}));
  const auto script = test::data_dir() / "grid_s1_sample" / "phonemes" / "bbbf9a.tsv";
  const auto channels = [](const std::string& path) {
    const test::Json info = test::json_of({"info", path});
    for (const auto& track : info["tracks"]) {
      if (track["kind"] == "audio") return track["channels"].get<int>();
    }
    return 0;
  };
  const auto left_power = [](const std::string& path) {
    auto reader = media::AudioReader::open(path, {.most_channels = 2});
    EXPECT_TRUE(reader) << reader.error().describe();
    double sum = 0;
    while (reader) {
      const auto block = reader->next();
      if (!block || block->empty()) break;
      for (std::size_t i = 0; i < block->size(); i += 2) sum += double((*block)[i] * (*block)[i]);
    }
    return sum;
  };
  const double power = left_power(dir / "voice.wav");
  test::succeeds({"speak", "--script", script.string(), "--audio", dir / "voice.wav", "-o",
                  dir / "a.mp4", "-o", dir / "b.mkv"});
  test::succeeds({"mux", dir / "a.mp4", dir / "voice.wav", "-o", dir / "c.mp4", "--preview",
                  dir / "film.mp4"});
  for (const char* name : {"a.mp4", "b.mkv", "c.mp4", "film.mp4"}) {
    EXPECT_EQ(channels(dir / name), 2) << name;
    EXPECT_NEAR(left_power(dir / name) / power, 1, 0.2) << name;
  }
  test::succeeds({"render", dir / "a.mp4", "--audio", dir / "voice.wav", "--size", "64x64", "-o",
                  dir / "small.mp4"});
  EXPECT_EQ(channels(dir / "small.mp4"), 2);
  // Coded sound can stay as it is.
  test::succeeds({"speak", "--script", script.string(), "--audio", dir / "a.mp4", "--audio-codec",
                  "copy", "-o", dir / "d.mp4"});
  EXPECT_EQ(channels(dir / "d.mp4"), 2);
  test::succeeds({"demux", dir / "a.mp4", "--audio", dir / "a.m4a"});
  test::succeeds({"demux", dir / "d.mp4", "--audio", dir / "d.m4a"});
  EXPECT_EQ(test::slurp(dir / "a.m4a"), test::slurp(dir / "d.m4a"));
  // What is damaged is told once, however often the recording is read.
  std::string damaged = test::slurp(dir / "a.m4a");
  const std::size_t middle = damaged.find("mdat") + 2000;
  for (std::size_t i = middle; i < middle + 500; ++i) damaged[i] = char(damaged[i] ^ 0x5A);
  test::spill(dir / "damaged.m4a", damaged);
  const auto told = animeme({"speak", "--script", script.string(), "--audio", dir / "damaged.m4a",
                             "-o", dir / "f.mp4", "-o", dir / "f.mkv"});
  ASSERT_EQ(told.exit_code, 0) << told.err;
  const std::size_t at = told.err.find("damaged audio packets");
  EXPECT_NE(at, std::string::npos) << told.err;
  EXPECT_EQ(told.err.find("damaged audio packets", at + 1), std::string::npos) << told.err;
  const auto plain = animeme({"speak", "--script", script.string(), "--audio", dir / "voice.wav",
                              "--audio-codec", "copy", "-o", dir / "e.mp4"});
  EXPECT_EQ(plain.exit_code, 3);
  EXPECT_THAT(plain.err, HasSubstr("the sound is pcm_s16le"));
  const auto made = animeme({"speak", "Hello", "--audio-codec", "copy", "-o", dir / "e.mp4"});
  EXPECT_EQ(made.exit_code, 2);
  EXPECT_THAT(made.err, HasSubstr("--audio-codec copy is for a recorded voice"));
}

TEST(Speak, ScriptOfTheSampleCorpusWithoutAudio) {
  const TempDir dir;
  const auto script = test::data_dir() / "grid_s1_sample" / "phonemes" / "bbbf9a.tsv";
  const auto made = animeme({"speak", "--script", script.string(), "-o", dir / "a.fap"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(read_clip(dir / "a.fap").frames.size(), 75u);
  // Standard input works as a script too.
  const auto piped =
      animeme({"speak", "--script", "-", "-o", dir / "b.fap"}, test::slurp(script.string()));
  ASSERT_EQ(piped.exit_code, 0) << piped.err;
  EXPECT_EQ(animeme({"compare", dir / "a.fap", dir / "b.fap"}).exit_code, 0);
}

TEST(Speak, StyleAndLife) {
  const TempDir dir;
  const auto clip_of = [&](std::vector<std::string> more) {
    const std::string path = dir / "clip.fap";
    std::vector<std::string> arguments = {"speak", "--text", "A lovely room.", "-o", path};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = animeme(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_clip(path);
  };
  const auto largest_jaw = [](const fap::Sequence& clip) {
    int most = 0;
    for (const fap::Frame& frame : clip.frames) most = std::max(most, frame.value[3]);
    return most;
  };
  const fap::Sequence plain = clip_of({"--no-idle-motion"});
  EXPECT_GT(largest_jaw(clip_of({"--style", "1.4"})), largest_jaw(plain));
  EXPECT_LT(largest_jaw(clip_of({"--style", "0.5"})), largest_jaw(plain));
  EXPECT_FALSE(plain.frames[0].mask[19]);
  EXPECT_FALSE(plain.frames[0].mask[31]);
  EXPECT_NE(clip_of({"--no-idle-motion", "--articulate", "0"}).frames, plain.frames);
  const fap::Sequence alive = clip_of({});
  EXPECT_TRUE(alive.frames[0].mask[19] && alive.frames[0].mask[48]);
  EXPECT_EQ(largest_jaw(alive), largest_jaw(plain));
  EXPECT_NE(clip_of({"--seed", "5"}).frames, alive.frames);
  EXPECT_EQ(animeme({"speak", "--text", "A", "--style", "2", "-o", dir / "x.fap"}).exit_code, 2);
}

// What the text asks for is shown without idle motion, too.
TEST(Speak, QuestionsWithoutLife) {
  const TempDir dir;
  for (const std::vector<std::string>& off : std::vector<std::vector<std::string>>{
           {"--no-life"}, {"--liveliness", "0"}, {"--no-life", "--still", "brows"}}) {
    const std::string path = dir / "clip.fap";
    std::vector<std::string> arguments = {"speak", "--text", "Is it you?", "-o", path};
    arguments.insert(arguments.end(), off.begin(), off.end());
    const auto result = animeme(arguments);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const fap::Sequence clip = read_clip(path);
    int highest = 0;
    for (const fap::Frame& frame : clip.frames) highest = std::max(highest, frame.value[33]);
    EXPECT_FALSE(clip.frames[0].mask[19] || clip.frames[0].mask[48]);
    if (off.size() == 3) {
      EXPECT_FALSE(clip.frames[0].mask[33]);
    } else {
      EXPECT_GT(highest, 40);
    }
  }
}

TEST(Speak, Moods) {
  const TempDir dir;
  const auto clip_of = [&](const std::string& text, std::vector<std::string> more) {
    const std::string path = dir / "clip.fap";
    std::vector<std::string> arguments = {"speak", "--text", text, "--no-idle-motion", "-o", path};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = animeme(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_clip(path);
  };
  const std::string text = "Bob may move my moon.";
  const fap::Sequence plain = clip_of(text, {});
  EXPECT_EQ(clip_of(text, {"--mood", "neutral"}).frames, plain.frames);
  EXPECT_EQ(clip_of(text + " ", {"--mood", "joy:0"}).frames, plain.frames);
  const fap::Sequence glad = clip_of(text, {"--mood", "joy"});
  ASSERT_EQ(glad.frames.size(), plain.frames.size());
  for (std::size_t i = 0; i < plain.frames.size(); ++i) {
    EXPECT_GT(glad.frames[i].value[21], 150) << i;
    if (inner_gap(plain.frames[i]) <= 0 || inner_gap(plain.frames[i]) > kClosed) continue;
    if (i < 12 || i + 16 > plain.frames.size()) continue;  // silence smiles with open lips
    EXPECT_EQ(inner_gap(glad.frames[i]), inner_gap(plain.frames[i])) << i;
  }
  const fap::Sequence chat = clip_of("It is fine. But this is bad 😢", {});
  EXPECT_EQ(chat.frames[5].value[31], 0);
  EXPECT_GT(chat.frames[chat.frames.size() - 14].value[31], 150) << "sad brows";

  const fap::Sequence coded = clip_of(text, {"--mood", "joy:0.5", "--expressions", "instead"});
  EXPECT_EQ(coded.frames[9].expression, (fap::Expression{1, 32, 0, 0, false, false}));
  EXPECT_FALSE(coded.frames[9].mask[31]);

  const auto fails = [&](std::vector<std::string> more, const std::string& sentence) {
    std::vector<std::string> arguments = {"speak", "--text", "A"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = animeme(arguments);
    EXPECT_EQ(result.exit_code, 2) << sentence;
    EXPECT_THAT(result.err, HasSubstr(sentence));
  };
  fails({"--mood", "joyy", "-o", dir / "x.fap"}, "did you mean joy?");
  fails({"--mood", "joy:3", "-o", dir / "x.fap"}, "between 0 and 1");
  fails({"--expressions", "beside", "-o", dir / "x.csv"}, "--expressions is for FAPs");
}

TEST(Follow, GivesTheCurvesOfTheWholeScript) {
  const TempDir dir;
  const std::string phones =
      "start_s\tend_s\tphone\n0\t0.3\tSIL\n0.3\t0.42\tB\n0.42\t0.6\tay\n0.6\t0.7\tT\n";
  test::spill(dir / "script.tsv", phones);
  ASSERT_EQ(animeme({"speak", "--script", dir / "script.tsv", "-o", dir / "whole.csv"}).exit_code,
            0);
  const auto streamed = animeme({"follow"}, phones);
  EXPECT_EQ(streamed.exit_code, 0) << streamed.err;
  EXPECT_EQ(streamed.out, test::slurp(dir / "whole.csv"));
  const auto early = animeme({"follow", "--look-ahead", "0.1"}, phones);
  EXPECT_EQ(std::count(early.out.begin(), early.out.end(), '\n'),
            std::count(streamed.out.begin(), streamed.out.end(), '\n'));
  const auto bad = animeme({"follow"}, "0 0.1 SIL\n0.1 0.2 QQ\n");
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_THAT(bad.err, HasSubstr("standard input:2"));
  EXPECT_THAT(bad.err, HasSubstr("QQ"));
}

}  // namespace speak_test
}  // namespace animeme
