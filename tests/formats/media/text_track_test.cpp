// Words and phones beside a face: what we read back, and what programs of others see.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <optional>

#include "tests/formats/media/media_support.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/mux.h"
#include "tools/formats/media/text_track.h"

namespace animeme::media {
namespace text_track_test {

using test::Bytes;
using testing::HasSubstr;

std::vector<TextTrack> spoken() {
  return {{"words",
           "deu",
           {{0.21, 0.6, "Grüße"}, {0.6, 1.25, "an \"alle\" <b & c>"}, {2, 3.5, "日本"}}},
          {"phones", "zxx", {{0.21, 0.25, "G"}, {0.25, 0.6, "R"}, {0.6, 0.65, "AE"}}}};
}

class TextTracks : public testing::TestWithParam<const char*> {
 protected:
  void write(const MuxOptions& options = {}) {
    const MuxInput input{.face = &face_, .audio = &sound_, .texts = &texts_};
    const Result<MuxResult> written = write_container(path_, input, options);
    ASSERT_TRUE(written) << written.error().describe();
  }
  std::vector<TextTrack> read() {
    const auto back = read_text_tracks(path_);
    EXPECT_TRUE(back) << back.error().describe();
    return back ? *back : std::vector<TextTrack>();
  }
  bool is_mkv() const { return std::string(GetParam()) == ".mkv"; }
  double tolerance() const { return is_mkv() ? 0.001 : 1e-6; }

  test::TempDir dir_;
  std::string path_ = dir_.file(std::string("talk") + GetParam());
  fba::AccessUnits face_ = test::make_face(100);
  Pcm sound_ = test::make_clicks(48000, 4 * 48000, {24000, 96000});
  std::vector<TextTrack> texts_ = spoken();
};

void expect_equal(const std::vector<TextTrack>& got, const std::vector<TextTrack>& want,
                  double tolerance) {
  ASSERT_EQ(got.size(), want.size());
  for (std::size_t t = 0; t < want.size(); ++t) {
    EXPECT_EQ(got[t].name, want[t].name);
    ASSERT_EQ(got[t].cues.size(), want[t].cues.size());
    for (std::size_t i = 0; i < want[t].cues.size(); ++i) {
      EXPECT_EQ(got[t].cues[i].text, want[t].cues[i].text);
      EXPECT_NEAR(got[t].cues[i].start, want[t].cues[i].start, tolerance);
      EXPECT_NEAR(got[t].cues[i].end, want[t].cues[i].end, tolerance);
    }
  }
}

TEST_P(TextTracks, ComeBackOnTheClockOfTheSound) {
  texts_[0].cues[1].text = "an \"alle\" & c";  // SubRip cannot tell what is no mark
  for (const AudioCodec codec : {AudioCodec::aac, AudioCodec::opus}) {
    write({.audio = {.codec = codec}});
    std::vector<TextTrack> want = texts_;
    // Matroska has no place for the priming of AAC: face, sound and text begin that much later.
    const bool late = is_mkv() && codec == AudioCodec::aac;
    for (TextTrack& track : want) {
      for (TextCue& cue : track.cues) {
        cue.start += late ? 1024.0 / 48000 : 0;
        cue.end += late ? 1024.0 / 48000 : 0;
      }
    }
    expect_equal(read(), want, tolerance());
    EXPECT_EQ(read()[0].language, "deu");
    EXPECT_EQ(read()[1].language, "zxx");
    const auto memory = read_text_tracks(test::read_bytes(path_));
    ASSERT_TRUE(memory);
    EXPECT_EQ(*memory, read());
  }
}

TEST_P(TextTracks, LeaveFaceAndSoundAsTheyAre) {
  write();
  const auto with = read_container(path_);
  const auto sound = read_encoded_audio(path_);
  texts_.clear();
  write();
  const auto without = read_container(path_);
  const auto bare = read_encoded_audio(path_);
  ASSERT_TRUE(with && without && sound && bare);
  EXPECT_EQ(with->face, without->face);
  EXPECT_EQ(with->warnings, without->warnings);
  EXPECT_EQ(with->audio->duration, without->audio->duration);
  EXPECT_EQ(sound->packets.size(), bare->packets.size());
  EXPECT_EQ(sound->length, bare->length);
}

TEST_P(TextTracks, AreTheLastTracksWithNameAndLanguage) {
  write();
  const auto info = probe(path_);
  ASSERT_TRUE(info) << info.error().describe();
  ASSERT_EQ(info->tracks.size(), 4u);
  EXPECT_EQ(info->tracks[0].kind, TrackKind::face);
  EXPECT_EQ(info->tracks[1].kind, TrackKind::audio);
  EXPECT_EQ(info->tracks[2].kind, TrackKind::text);
  EXPECT_EQ(info->tracks[2].name, "words");
  EXPECT_EQ(info->tracks[3].name, "phones");
  EXPECT_NEAR(info->duration, 4.0, 0.05) << "not longer than the sound";
}

TEST_P(TextTracks, AsMetadataTheyAreTheSameToUsAndNothingToFfmpeg) {
  if (is_mkv()) GTEST_SKIP() << "there they are always subtitles";
  write();
  const auto subtitles = read();
  for (const bool fragmented : {false, true}) {
    write({.text_track = TextTrackType::metadata, .fragmented = fragmented});
    expect_equal(read(), subtitles, 1e-6);
    EXPECT_EQ(read()[0].language, "deu");
    const auto info = probe(path_);
    ASSERT_TRUE(info) << info.error().describe();
    ASSERT_EQ(info->tracks.size(), 4u);
    EXPECT_EQ(info->tracks[2].kind, TrackKind::text);
    EXPECT_EQ(info->tracks[2].name, "words");
    EXPECT_EQ(info->tracks[3].language, "zxx");
    const auto back = read_container(path_);
    ASSERT_TRUE(back) << back.error().describe();
    EXPECT_EQ(back->face, face_);
    if (!test::has_program("ffmpeg")) continue;
    int status = -1;
    const std::string copied = dir_.file("copy.mkv");
    EXPECT_EQ(
        test::run("ffmpeg -nostdin -y -v warning -i '" + path_ + "' -c copy '" + copied + "' 2>&1",
                  &status),
        "");
    EXPECT_EQ(status, 0);
  }
}

TEST_P(TextTracks, AreSubtitlesToFfmpeg) {
  if (!test::has_program("ffprobe")) GTEST_SKIP() << "ffprobe is not installed";
  write();
  const std::string streams = test::run(
      "ffprobe -v error -show_entries stream=codec_type,codec_name:stream_disposition=default:"
      "stream_tags=language,handler_name,title -of compact=p=0 '" +
      path_ + "'");
  const std::string codec = is_mkv() ? "subrip" : "mov_text";
  EXPECT_THAT(streams,
              HasSubstr("codec_name=" + codec + "|codec_type=subtitle|disposition:default=0"));
  EXPECT_THAT(streams, HasSubstr(is_mkv() ? "tag:title=words" : "tag:handler_name=words"));
  EXPECT_THAT(streams, HasSubstr(is_mkv() ? "tag:language=ger" : "tag:language=deu"));
  EXPECT_THAT(streams, testing::Not(HasSubstr("codec_type=subtitle|disposition:default=1")));
  const std::string srt = dir_.file("words.srt");
  int status = 0;
  test::run("ffmpeg -y -v error -i '" + path_ + "' -map 0:s:0 '" + srt + "' 2>&1", &status);
  EXPECT_EQ(status, 0);
  const std::string cues = test::slurp(srt);
  // FFmpeg leaves Matroska's times as they are: the sound there begins one priming late.
  if (is_mkv()) {
    EXPECT_THAT(cues, HasSubstr("00:00:00,231 --> 00:00:00,621\nGrüße\n"));
    EXPECT_THAT(cues, HasSubstr("00:00:02,021 --> 00:00:03,521\n日本\n"));
  } else {
    EXPECT_THAT(cues, HasSubstr("00:00:00,210 --> 00:00:00,600\nGrüße\n"));
    EXPECT_THAT(cues, HasSubstr("00:00:02,000 --> 00:00:03,500\n日本\n"));
  }
}

TEST_P(TextTracks, AreSubtitlesToMkvtoolnix) {
  if (!test::has_program("mkvextract")) GTEST_SKIP() << "mkvextract is not installed";
  if (!is_mkv()) GTEST_SKIP() << "of .mkv";
  write();
  const std::string info = test::run("LC_ALL=C mkvinfo '" + path_ + "'");
  EXPECT_THAT(info, HasSubstr("Codec ID: S_TEXT/UTF8"));
  EXPECT_THAT(info, HasSubstr("Name: words"));
  EXPECT_THAT(info, HasSubstr("Name: phones"));
  const std::size_t words = info.find("Track type: subtitles");
  ASSERT_NE(words, std::string::npos);
  EXPECT_THAT(info.substr(words), HasSubstr("\"Default track\" flag: 0"));
  const std::string srt = dir_.file("phones.srt");
  test::run("mkvextract '" + path_ + "' tracks 3:'" + srt + "'");
  EXPECT_THAT(test::slurp(srt), HasSubstr("00:00:00,231 --> 00:00:00,271\nG\n"));
}

TEST_P(TextTracks, GoIntoFragmentsToo) {
  if (is_mkv()) GTEST_SKIP() << "of .mp4";
  texts_[0].cues[1].text = "an";
  write({.fragmented = true, .fragment_seconds = 1});
  expect_equal(read(), texts_, tolerance());
  const auto back = read_container(path_);
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_EQ(back->face, face_);
}

TEST_P(TextTracks, WithoutACueAreThereAllTheSame) {
  texts_ = {{"words", "und", {}}};
  write();
  const auto back = read();
  ASSERT_EQ(back.size(), 1u);
  EXPECT_THAT(back[0].cues, testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Files, TextTracks, testing::Values(".mp4", ".mkv"),
                         [](const auto& file) { return std::string(file.param + 1); });

TEST(TextTracksOfHls, LieBesideTheSegmentsAsWebVtt) {
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(100);
  const Pcm sound = test::make_clicks(48000, 4 * 48000, {24000, 96000});
  const std::vector<TextTrack> texts = spoken();
  const MuxInput input{.face = &face, .audio = &sound, .texts = &texts};
  const std::string path = dir.file("talk.m3u8");
  for (int round = 0; round < 2; ++round) {  // the folder is ours to replace
    const auto written = write_container(path, input);
    ASSERT_TRUE(written) << written.error().describe();
  }
  const std::string master = test::slurp(path);
  EXPECT_THAT(master, HasSubstr("#EXT-X-MEDIA:TYPE=SUBTITLES,GROUP-ID=\"text\",NAME=\"words\","
                                "LANGUAGE=\"deu\",DEFAULT=NO,AUTOSELECT=NO,CHARACTERISTICS="
                                "\"public.accessibility.transcribes-spoken-dialog\","
                                "URI=\"talk_hls/text-1.m3u8\"\n"));
  EXPECT_THAT(master, HasSubstr(",SUBTITLES=\"text\"\ntalk_hls/sound.m3u8\n"));
  EXPECT_THAT(test::slurp(dir.file("talk_hls/text-1.vtt")),
              testing::StartsWith("WEBVTT\n\n00:00:00.210 --> 00:00:00.600\nGrüße\n"));
  const auto back = read_text_tracks(path);
  ASSERT_TRUE(back) << back.error().describe();
  expect_equal(*back, texts, 0.00051);
  EXPECT_EQ((*back)[0].language, "deu");
  const auto info = probe(path);
  ASSERT_TRUE(info) << info.error().describe();
  EXPECT_EQ(info->tracks.size(), 4u);
  EXPECT_EQ(info->tracks[3].name, "phones");
  const auto container = read_container(path);
  ASSERT_TRUE(container) << container.error().describe();
  EXPECT_EQ(container->face, face);
  if (test::has_program("ffmpeg")) {
    const std::string srt = dir.file("words.srt");
    test::run("ffmpeg -y -v error -i '" + dir.file("talk_hls/text-1.vtt") + "' '" + srt + "'");
    EXPECT_THAT(test::slurp(srt),
                HasSubstr("00:00:00,600 --> 00:00:01,250\nan \"alle\" <b & c>\n"));
    // Version 5.1 leaves subtitles of HLS alone; the sound is what it was.
    EXPECT_THAT(
        test::run("ffprobe -v error -show_entries stream=codec_name -of csv=p=0 '" + path + "'"),
        HasSubstr("aac\n"));
  }
  // Face and sound do without.
  std::filesystem::remove(dir.file("talk_hls/text-1.vtt"));
  const auto one = read_text_tracks(path);
  ASSERT_TRUE(one) << one.error().describe();
  EXPECT_EQ(one->size(), 1u);
  EXPECT_TRUE(read_container(path));
}

TEST(TextTrackInput, WrongCuesAreRefused) {
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(10);
  const auto code_of = [&](const char* name, const TextTrack& text) -> std::optional<Code> {
    const std::vector<TextTrack> texts = {text};
    const auto written = write_container(dir.file(name), {.face = &face, .texts = &texts});
    return written ? std::nullopt : std::optional(written.error().code);
  };
  const auto invalid = Code::invalid_argument;
  EXPECT_EQ(code_of("a.mp4", {"words", "eng", {{0, 1, "a"}, {0.5, 2, "b"}}}), invalid);
  EXPECT_EQ(code_of("a.mp4", {"words", "eng", {{1, 1, "a"}}}), invalid);
  EXPECT_EQ(code_of("a.mkv", {"words", "eng", {{-1, 1, "a"}}}), invalid);
  EXPECT_EQ(code_of("a.mkv", {"words", "eng", {{0, HUGE_VAL, "a"}}}), invalid);
  EXPECT_EQ(code_of("a.mp4", {"words", "en", {{0, 1, "a"}}}), invalid);
  EXPECT_EQ(code_of("a.ts", {"words", "eng", {{0, 1, "a"}}}), Code::unsupported);
  EXPECT_EQ(code_of("a.mp4", {"words", "eng", {{0, 1, "a"}}}), std::nullopt);
}

TEST(TextTrackInput, FilesWithoutTextHaveNone) {
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(10);
  ASSERT_TRUE(write_container(dir.file("a.mp4"), {.face = &face}));
  const auto none = read_text_tracks(dir.file("a.mp4"));
  ASSERT_TRUE(none);
  EXPECT_THAT(*none, testing::IsEmpty());
  EXPECT_EQ(read_text_tracks(dir.file("b.mp4")).error().code, Code::not_found);
  EXPECT_FALSE(read_text_tracks(Bytes(40, 'x')));
}

TEST(TextTrackInput, LimitsHold) {
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(10);
  const std::vector<TextTrack> texts = {{"words", "eng", {{0, 1, "abc"}, {1, 2, "ääää"}}},
                                        {"phones", "zxx", {{0, 1, "a"}}}};
  ASSERT_TRUE(write_container(dir.file("a.mp4"), {.face = &face, .texts = &texts}));
  const auto with = [&](const TextLimits& limits) {
    return read_text_tracks(dir.file("a.mp4"), limits);
  };
  EXPECT_EQ(with({.most_tracks = 1})->size(), 1u);
  EXPECT_EQ(with({.most_cues = 2}).error().code, Code::out_of_range);
  EXPECT_EQ(with({.most_bytes = 5}).error().code, Code::out_of_range);
  EXPECT_EQ((*with({.longest_text = 3}))[0].cues[1].text, "ä") << "between characters";
}

TEST(CleanText, IsOneLineOfUtf8) {
  EXPECT_EQ(clean_text("  two \r\n\t lines\0 \x7F"), "two lines");
  EXPECT_EQ(clean_text("Grüße 日本 😀"), "Grüße 日本 😀");
  EXPECT_EQ(clean_text("a\xFF\xC3(b\xC3"), "a\xEF\xBF\xBD\xEF\xBF\xBD(b\xEF\xBF\xBD");
  EXPECT_EQ(clean_text("a\u202Eb\u2066c\uFEFF"), "abc");
  EXPECT_EQ(clean_text("a\u0085b\u2028c"), "a b c");
  EXPECT_EQ(clean_text("\xED\xA0\x80"), "\xEF\xBF\xBD") << "a surrogate";
  EXPECT_EQ(clean_text("aä", 2), "a");
  EXPECT_EQ(clean_text(" \n "), "");
}

// A file of FFmpeg's, with subtitles that overlap, have styles and come without a name.
TEST(ForeignText, IsReadWithoutItsMarks) {
  if (!test::has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not installed";
  const test::TempDir dir;
  test::spill(dir.file("a.srt"),
              "1\n00:00:00,500 --> 00:00:02,000\n<i>First</i>\nline\n\n"
              "2\n00:00:01,000 --> 00:00:03,000\n<font color=\"red\">second</font>\n\n");
  test::spill(dir.file("a.vtt"),
              "WEBVTT\n\n00:00.500 --> 00:02.000\n<v Ann>a &lt;b&gt; <00:01.000>c</v>\n\n");
  for (const char* codec : {"mov_text", "srt", "webvtt"}) {
    const bool vtt = std::string(codec) == "webvtt";
    const std::string out = dir.file(vtt || std::string(codec) == "srt" ? "a.mkv" : "a.mp4");
    test::run("ffmpeg -y -v error -f lavfi -i anullsrc=d=3 -i '" +
              dir.file(vtt ? "a.vtt" : "a.srt") + "' -c:s " + (vtt ? "copy" : codec) + " '" + out +
              "'");
    const auto tracks = read_text_tracks(out);
    ASSERT_TRUE(tracks) << codec << ": " << tracks.error().describe();
    ASSERT_EQ(tracks->size(), 1u) << codec;
    const auto& cues = (*tracks)[0].cues;
    ASSERT_FALSE(cues.empty()) << codec;
    EXPECT_EQ(cues[0].text, vtt ? "a <b> c" : "First line") << codec;
    for (std::size_t i = 1; i < cues.size(); ++i) EXPECT_LE(cues[i - 1].end, cues[i].start);
  }
}

}  // namespace text_track_test
}  // namespace animeme::media
