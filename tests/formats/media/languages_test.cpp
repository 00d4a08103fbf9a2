// Files with several languages and people: what we read back, and what programs of others see.
#include <gmock/gmock.h>

#include <array>
#include <cstdio>
#include <string>

#include "codec/encode/encode.h"
#include "tests/formats/media/media_support.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/mux.h"
#include "tools/formats/media/stored.h"
#include "tools/formats/media/track_labels.h"

namespace animeme::media {
namespace languages_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TrackLabels labels(const char* language, const char* code, const char* speaker = "") {
  return {language, code, speaker};
}

// One language: its face, its sound, its words.
struct Version {
  TrackLabels labels;
  fba::AccessUnits face;
  Pcm sound;
  std::vector<TextTrack> texts;
};

Version version(const TrackLabels& told, int frames, std::size_t click, const char* word) {
  Version one{told, test::make_face(frames), test::make_clicks(48000, 4 * 48000, {click}), {}};
  one.texts = {{"words", told.code, {{0.2, 0.6, word}}}, {"phones", "zxx", {{0.2, 0.3, "G"}}}};
  return one;
}

MuxInput input_of(const Version& one) {
  MuxInput input;
  input.face = &one.face;
  input.audio = &one.sound;
  input.texts = &one.texts;
  input.labels = one.labels;
  return input;
}

class Languages : public testing::TestWithParam<const char*> {
 protected:
  void write(const std::vector<Version>& versions, const MuxOptions& options = {}) {
    MuxInput all = input_of(versions.front());
    for (std::size_t i = 1; i < versions.size(); ++i) all.more.push_back(input_of(versions[i]));
    if (!has_texts()) {
      all.texts = nullptr;
      for (MuxInput& further : all.more) further.texts = nullptr;
    }
    const auto written = write_container(path_, all, options);
    ASSERT_TRUE(written) << written.error().describe();
  }
  void write_alone(const Version& one, const std::string& path) {
    MuxInput alone = input_of(one);
    alone.labels = {};
    if (!has_texts()) alone.texts = nullptr;
    ASSERT_TRUE(write_container(path, alone));
  }
  static bool has_texts() { return GetParam() != std::string(".mpd"); }

  test::TempDir dir_;
  std::string path_ = dir_.file(std::string("film") + GetParam());
};

TEST_P(Languages, EachComesBackAsItWentIn) {
  const std::vector<Version> versions = {version(labels("en", "eng"), 100, 24000, "hello"),
                                         version(labels("de-AT", "deu"), 90, 48000, "hallo"),
                                         version(labels("pt-BR", "por", "Ann"), 80, 96000, "olá")};
  write(versions);
  for (const Version& one : versions) {
    const std::string alone = dir_.file(std::string("alone") + GetParam());
    write_alone(one, alone);
    const TrackScope scope(one.labels);
    const auto face = read_container(path_);
    ASSERT_TRUE(face) << face.error().describe();
    const TrackScope all({});
    const auto expected = read_container(alone);
    ASSERT_TRUE(expected);
    ASSERT_EQ(face->face.units.size(), one.face.units.size());
    EXPECT_EQ(face->face.config, expected->face.config);
    for (std::size_t i = 0; i < one.face.units.size(); ++i) {
      EXPECT_EQ(face->face.units[i].bytes, one.face.units[i].bytes);
      EXPECT_EQ(face->face.units[i].time, expected->face.units[i].time);
    }
    const auto sound_alone = read_encoded_audio(alone);
    const auto words_alone = has_texts() ? read_text_tracks(alone) : std::vector<TextTrack>();
    const TrackScope again(one.labels);
    const auto sound = read_encoded_audio(path_);
    ASSERT_TRUE(sound) << sound.error().describe();
    ASSERT_EQ(sound->packets.size(), sound_alone->packets.size());
    for (std::size_t i = 0; i < sound->packets.size(); ++i) {
      EXPECT_EQ(sound->packets[i].bytes, sound_alone->packets[i].bytes);
      EXPECT_EQ(sound->packets[i].time, sound_alone->packets[i].time);
    }
    if (!has_texts()) continue;
    const auto words = read_text_tracks(path_);
    ASSERT_TRUE(words);
    ASSERT_EQ(words->size(), words_alone->size());
    for (std::size_t i = 0; i < words->size(); ++i) {
      EXPECT_EQ((*words)[i].name, (*words_alone)[i].name);
      EXPECT_EQ((*words)[i].cues, (*words_alone)[i].cues);
    }
  }
  // Without a wish: the first.
  EXPECT_EQ(read_container(path_)->face.units.size(), 100u);
  if (has_texts()) {
    EXPECT_EQ(read_text_tracks(path_)->front().cues.front().text, "hello");
  }
}

TEST_P(Languages, WishesAreUnderstood) {
  write({version(labels("en", "eng", "Ann"), 100, 24000, "hello"),
         version(labels("en", "eng", "Bob"), 90, 48000, "hi"),
         version(labels("pt-BR", "por", "Ann"), 80, 96000, "olá")});
  const auto frames = [&](const TrackLabels& wanted) -> std::size_t {
    const TrackScope scope(wanted);
    const auto face = read_container(path_);
    return face ? face->face.units.size() : 0;
  };
  EXPECT_EQ(frames({}), 100u);
  EXPECT_EQ(frames(labels("", "", "bob")), 90u);
  EXPECT_EQ(frames(labels("pt", "por")), 80u);
  EXPECT_EQ(frames(labels("PT-br", "por")), 80u);
  EXPECT_EQ(frames(labels("en", "eng", "Bob")), 90u);
  EXPECT_EQ(frames(labels("pt-PT", "por")), 0u);
  EXPECT_EQ(frames(labels("pt", "por", "Bob")), 0u);
  const TrackScope scope(labels("fr", "fra"));
  const auto none = read_container(path_);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Code::not_found);
  EXPECT_THAT(none.error().message, HasSubstr("language fr"));
}

TEST_P(Languages, AreListed) {
  write({version(labels("en", "eng"), 100, 24000, "hello"),
         version(labels("de-AT", "deu", "Ann"), 90, 48000, "hallo")});
  const TrackScope scope(labels("de", "deu"));  // has no effect on a list
  const auto info = probe(path_);
  ASSERT_TRUE(info);
  std::vector<std::string> list;
  for (const TrackInfo& track : info->tracks) {
    list.push_back(std::string(name_of(track.kind)) + " " + track.name + " " +
                   track.labels.language + " " + track.labels.speaker +
                   (track.is_default ? " default" : ""));
  }
  if (GetParam() == std::string(".m3u8") || !has_texts()) {
    for (std::string& one : list) one = one.substr(0, one.find(" default"));
    if (!has_texts()) {
      EXPECT_THAT(list, testing::UnorderedElementsAre("face  en ", "face  de-AT Ann", "audio  en ",
                                                      "audio  de-AT Ann"));
      return;
    }
    EXPECT_THAT(list, ElementsAre("face  en ", "face  de-AT Ann", "audio  en ", "audio  de-AT Ann",
                                  "text words en ", "text phones en ", "text words de-AT Ann",
                                  "text phones de-AT Ann"));
    return;
  }
  EXPECT_THAT(list, ElementsAre("face  en  default", "face  de-AT Ann", "audio  en  default",
                                "audio  de-AT Ann", "text words en ", "text phones en ",
                                "text words de-AT Ann", "text phones de-AT Ann"));
}

TEST_P(Languages, FragmentsToo) {
  if (GetParam() != std::string(".mp4")) GTEST_SKIP() << "only an mp4 has fragments";
  MuxOptions options;
  options.fragmented = true;
  write({version(labels("en", "eng"), 100, 24000, "hello"),
         version(labels("de", "deu"), 90, 48000, "hallo")},
        options);
  const TrackScope scope(labels("de", "deu"));
  const auto face = read_container(path_);
  ASSERT_TRUE(face) << face.error().describe();
  EXPECT_EQ(face->face.units.size(), 90u);
}

TEST_P(Languages, OthersReadThem) {
  if (GetParam() == std::string(".m3u8") || !has_texts())
    GTEST_SKIP() << "renditions are listed elsewhere";
  if (std::system("ffprobe -version > /dev/null 2>&1") != 0) GTEST_SKIP() << "ffmpeg is not here";
  write({version(labels("en", "eng"), 100, 24000, "hello"),
         version(labels("de", "deu"), 90, 48000, "hallo")});
  const std::string command =
      "ffprobe -v error -select_streams a -show_entries "
      "stream_tags=language:stream_disposition=default -of csv=p=0 " +
      path_ + " 2> /dev/null";
  std::string said;
  std::FILE* out = popen(command.c_str(), "r");
  ASSERT_NE(out, nullptr);
  std::array<char, 256> line{};
  while (std::fgets(line.data(), int(line.size()), out) != nullptr) said += line.data();
  EXPECT_EQ(pclose(out), 0);
  EXPECT_EQ(said, GetParam() == std::string(".mkv") ? "1,eng\n0,ger\n" : "1,eng\n0,deu\n");
}

INSTANTIATE_TEST_SUITE_P(All, Languages, testing::Values(".mp4", ".mkv", ".m3u8", ".mpd"),
                         [](const auto& param) { return std::string(param.param + 1); });

TEST(TrackLabels, PlaylistsTellThem) {
  const test::TempDir dir;
  const Version en = version(labels("en", "eng"), 100, 24000, "hello");
  const Version de = version(labels("de-AT", "deu", "Ann"), 90, 48000, "hallo");
  MuxInput all = input_of(en);
  all.more.push_back(input_of(de));
  ASSERT_TRUE(write_container(dir.file("film.m3u8"), all));
  const std::string hls = test::slurp(dir.file("film.m3u8"));
  EXPECT_THAT(hls, HasSubstr("TYPE=AUDIO,GROUP-ID=\"sound\",NAME=\"English\",LANGUAGE=\"en\","
                             "DEFAULT=YES,AUTOSELECT=YES"));
  EXPECT_THAT(hls, HasSubstr("TYPE=AUDIO,GROUP-ID=\"sound\",NAME=\"Ann, Deutsch (AT)\","
                             "LANGUAGE=\"de-AT\",DEFAULT=NO,AUTOSELECT=YES"));
  EXPECT_THAT(
      hls, HasSubstr("TYPE=VIDEO,GROUP-ID=\"face\",NAME=\"Ann, Deutsch (AT)\",LANGUAGE=\"de-AT\""));
  EXPECT_THAT(hls, HasSubstr("NAME=\"words (Ann, de-AT)\",LANGUAGE=\"de-AT\",DEFAULT=NO,"
                             "AUTOSELECT=NO,CHARACTERISTICS=\"public.accessibility.transcribes-"
                             "spoken-dialog\","));
  EXPECT_THAT(hls, Not(HasSubstr("LANGUAGE=\"zxx-x-en\",DEFAULT=NO,AUTOSELECT=NO,CHAR")));
  EXPECT_THAT(hls, HasSubstr("AUDIO=\"sound\""));
  all.texts = all.more[0].texts = nullptr;
  ASSERT_TRUE(write_container(dir.file("film.mpd"), all));
  const std::string dash = test::slurp(dir.file("film.mpd"));
  EXPECT_THAT(dash, HasSubstr("mimeType=\"audio/mp4\" lang=\"de-AT\""));
  EXPECT_THAT(dash, HasSubstr("value=\"main\""));
  EXPECT_THAT(dash, HasSubstr("value=\"dub\""));
  const TrackScope scope(labels("de", "deu"));
  const auto face = read_container(dir.file("film.mpd"));
  ASSERT_TRUE(face) << face.error().describe();
  EXPECT_EQ(face->face.units.size(), 90u);
}

// A jaw that moves.
fba::AccessUnits spoken_face(std::size_t frames) {
  fap::Sequence clip{{25, 1}, {}, ""};
  for (std::size_t i = 0; i < frames; ++i) {
    fap::Frame frame;
    frame.number = std::int64_t(i);
    frame.set(3, std::int32_t(i * 37 % (frames + 200)));
    clip.frames.push_back(frame);
  }
  const auto stream = fba::encode(clip);
  EXPECT_TRUE(stream);
  auto units = fba::split_access_units(*stream);
  EXPECT_TRUE(units);
  return *units;
}

// ISO_639_language_descriptors of sounds, by libavformat, and of faces, by us.
TEST(TrackLabels, TransportStreamsTellLanguages) {
  const test::TempDir dir;
  std::vector<Version> versions = {version(labels("en", "eng"), 100, 24000, "hello"),
                                   version(labels("de", "deu"), 90, 48000, "hallo"),
                                   version(labels("fr", "fra"), 80, 96000, "salut")};
  // Real streams: the start codes in those that are made up look like a program stream.
  for (Version& one : versions) one.face = spoken_face(one.face.units.size());
  const auto write = [&](const std::vector<Version>& list, const std::string& name) {
    MuxInput all = input_of(list.front());
    for (std::size_t i = 1; i < list.size(); ++i) all.more.push_back(input_of(list[i]));
    all.texts = nullptr;
    for (MuxInput& further : all.more) further.texts = nullptr;
    return write_container(dir.file(name), all);
  };
  const auto written = write(versions, "film.ts");
  ASSERT_TRUE(written) << written.error().describe();
  const auto info = probe(dir.file("film.ts"));
  ASSERT_TRUE(info);
  std::vector<std::string> list;
  for (const TrackInfo& track : info->tracks)
    list.push_back(std::string(name_of(track.kind)) + " " + track.labels.code);
  EXPECT_THAT(
      list, ElementsAre("face eng", "face deu", "face fra", "audio eng", "audio deu", "audio fra"));
  for (const Version& one : versions) {
    ASSERT_TRUE(write({one}, "alone.ts"));
    const auto alone = read_container(dir.file("alone.ts"));
    const auto sound_alone = read_encoded_audio(dir.file("alone.ts"));
    const TrackScope scope(one.labels);
    const auto face = read_container(dir.file("film.ts"));
    ASSERT_TRUE(face) << face.error().describe();
    ASSERT_EQ(face->face.units.size(), one.face.units.size());
    for (std::size_t i = 0; i < one.face.units.size(); ++i)
      EXPECT_EQ(face->face.units[i].bytes, one.face.units[i].bytes);
    const auto sound = read_encoded_audio(dir.file("film.ts"));
    ASSERT_TRUE(sound) << sound.error().describe();
    ASSERT_TRUE(sound_alone);
    ASSERT_EQ(sound->packets.size(), sound_alone->packets.size());
    for (std::size_t i = 0; i < sound->packets.size(); ++i)
      EXPECT_EQ(sound->packets[i].bytes, sound_alone->packets[i].bytes);
  }
  // Six fit in the program map.
  std::vector<Version> many;
  for (const char* code : {"eng", "deu", "fra", "spa", "ita", "nld"})
    many.push_back(version(labels(code, code), 10, 24000, ""));
  for (Version& one : many) one.face = spoken_face(50);
  const auto six = write(many, "six.ts");
  ASSERT_TRUE(six) << six.error().describe();
  const auto told = probe(dir.file("six.ts"));
  ASSERT_TRUE(told);
  ASSERT_EQ(told->tracks.size(), 12u);
  EXPECT_EQ(told->tracks[5].labels.code, "nld");
  EXPECT_EQ(told->tracks[11].labels.code, "nld");
  many.push_back(version(labels("pl", "pol"), 10, 24000, ""));
  EXPECT_EQ(write(many, "seven.ts").error().code, Code::unsupported);
  EXPECT_EQ(write({version(labels("pl", "pol", "Ann"), 10, 24000, "")}, "ann.ts").error().code,
            Code::unsupported);
}

// An hour, made of a second of coded sound: times of faces and sounds are exact to the last one.
TEST(TrackLabels, LanguagesAreInStepAfterAnHour) {
  const test::TempDir dir;
  const std::string path = dir.file("hour.mp4"), copy = dir.file("copy.mp4");
  const auto second = encode_audio(test::make_clicks(8000, 8000, {4000}));
  ASSERT_TRUE(second);
  EncodedAudio sound{second->format, {}, std::int64_t(3600) * 8000};
  for (std::int64_t time = -sound.format.priming; time < sound.length;) {
    sound.packets.push_back(second->packets[sound.packets.size() % second->packets.size()]);
    sound.packets.back().time = time;
    time += sound.packets.back().duration = sound.format.frame_samples;
  }
  // Ten frames of 29.97 a second each.
  const fba::AccessUnits faces[] = {test::make_face(10789, 30000, 10010),
                                    test::make_face(10700, 30000, 10010)};
  const TrackLabels told[] = {labels("en", "eng"), labels("de", "deu")};
  MuxInput input{.face = &faces[0], .encoded = &sound, .labels = told[0]};
  input.more.push_back({.face = &faces[1], .encoded = &sound, .labels = told[1]});
  ASSERT_TRUE(write_container(path, input));
  for (int i = 0; i < 2; ++i) {
    const TrackScope scope(told[i]);
    const auto face = read_container(path);
    ASSERT_TRUE(face) << face.error().describe();
    ASSERT_EQ(face->face.units.size(), faces[i].units.size());
    for (std::size_t k = 0; k < faces[i].units.size(); ++k) {
      ASSERT_EQ(face->face.units[k].time, faces[i].units[k].time) << k;
    }
    auto back = StoredAudio::read(path);
    ASSERT_TRUE(back) << back.error().describe();
    EXPECT_EQ(back->length(), sound.length);
    EXPECT_EQ(back->format(), sound.format);
    for (const AudioPacket& packet : sound.packets) {
      const auto next = back->next();
      ASSERT_TRUE(next && *next != nullptr);
      ASSERT_EQ((*next)->time, packet.time);
      ASSERT_EQ((*next)->bytes, packet.bytes);
    }
    EXPECT_EQ(*back->next(), nullptr);
  }
  // Sound that is read while it is written gives the same file.
  auto stored = StoredAudio::read(path);
  ASSERT_TRUE(stored);
  ASSERT_TRUE(write_container(copy, {.face = &faces[0], .stored = &*stored}));
  ASSERT_TRUE(write_container(path, {.face = &faces[0], .encoded = &sound}));
  EXPECT_TRUE(test::slurp(copy) == test::slurp(path));
}

TEST(TrackLabels, AreParsed) {
  EXPECT_EQ(parse_track_labels("lang=de").value(), labels("de", ""));
  EXPECT_EQ(parse_track_labels("lang=pt_BR").value(), labels("pt-BR", ""));
  EXPECT_EQ(parse_track_labels("speaker=Ann Lee,lang=pt-BR").value(),
            labels("pt-BR", "", "Ann Lee"));
  EXPECT_EQ(parse_track_labels("speaker=Lee\\, Ann\\\\x\\y,lang=fr").value(),
            labels("fr", "", "Lee, Ann\\x\\y"));
  for (const char* wrong : {"", "de", "lang=", "lang=d", "lang=de-", "lang=de_", "language=de",
                            "lang=de,,speaker=A", "speaker=", "lang=de,", ",", ",lang=de", ",,"}) {
    EXPECT_EQ(parse_track_labels(wrong).error().code, Code::invalid_argument) << wrong;
  }
}

TEST(TrackLabels, OfThreeLettersAreThoseOfTwo) {
  const TrackLabels german = labels("de-AT", "deu"), untagged = labels("", "deu");
  for (const TrackLabels& wanted : {labels("de", "deu"), labels("deu", "deu")}) {
    EXPECT_TRUE(is_wanted(wanted, german)) << wanted.language;
    EXPECT_TRUE(is_wanted(wanted, untagged)) << wanted.language;
    EXPECT_FALSE(is_wanted(wanted, labels("fr", "fra"))) << wanted.language;
  }
}

TEST(TrackLabels, MistakesInWriting) {
  const test::TempDir dir;
  Version one = version(labels("en", "eng"), 50, 24000, "hello");
  const auto code_of = [&](const MuxInput& input, const char* name) {
    const auto written = write_container(dir.file(name), input);
    return written ? Code::internal : written.error().code;
  };
  MuxInput all = input_of(one);
  all.more.push_back(input_of(one));
  EXPECT_EQ(code_of(all, "a.ts"), Code::unsupported);
  all.more[0].labels.language = "no tag";
  EXPECT_EQ(code_of(all, "a.mp4"), Code::invalid_argument);
  all.more[0].labels = labels("en", "ENG");
  EXPECT_EQ(code_of(all, "a.mp4"), Code::invalid_argument);
  all.more[0].labels = labels("en", "eng", "two\nlines");
  EXPECT_EQ(code_of(all, "a.mp4"), Code::invalid_argument);
  all.more[0] = MuxInput();
  EXPECT_EQ(code_of(all, "a.mp4"), Code::invalid_argument);
}

}  // namespace languages_test
}  // namespace animeme::media
