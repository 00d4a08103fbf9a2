// Playlists of HLS and DASH: what is written, what is read, what is refused.
#include "tools/formats/media/detail/segments/playlist_text.h"

#include <gmock/gmock.h>

#include "tools/formats/media/detail/segments/presentation.h"

namespace animeme::media {
namespace playlist_text_test {

using testing::ElementsAre;
using testing::HasSubstr;

SegmentedTrack track(bool face) {
  SegmentedTrack out;
  out.face = face;
  out.name = face ? "face" : "sound";
  out.codecs = face ? "mp4v.20.61" : "mp4a.40.2";
  out.timescale = face ? 25000 : 48000;
  out.sample_rate = 48000;
  out.channels = 1;
  out.init = out.name + "-init.mp4";
  const std::int64_t scale = out.timescale;
  out.segments = {{out.name + "-00001.m4s", 0, 2 * scale, 1000},
                  {out.name + "-00002.m4s", 2 * scale, 2 * scale, 3000},
                  {out.name + "-00003.m4s", 4 * scale, scale / 2, 200}};
  return out;
}

TEST(Playlists, TheSoundIsTheVariant) {
  EXPECT_EQ(hls_master({track(true), track(false)}, "talk_hls"),
            "#EXTM3U\n#EXT-X-VERSION:7\n#EXT-X-INDEPENDENT-SEGMENTS\n"
            "#EXT-X-MEDIA:TYPE=VIDEO,GROUP-ID=\"face\",NAME=\"face\",DEFAULT=NO,AUTOSELECT=NO,"
            "URI=\"talk_hls/face.m3u8\"\n"
            "#EXT-X-STREAM-INF:BANDWIDTH=12000,AVERAGE-BANDWIDTH=7467,CODECS=\"mp4a.40.2\"\n"
            "talk_hls/sound.m3u8\n");
  EXPECT_THAT(hls_master({track(true)}, "f"), HasSubstr("CODECS=\"mp4v.20.61\"\nf/face.m3u8\n"));
}

TEST(Playlists, HlsComesBack) {
  const Result<HlsPlaylist> master = read_hls(hls_master({track(true), track(false)}, "talk_hls"));
  ASSERT_TRUE(master) << master.error().describe();
  EXPECT_THAT(master->playlists, ElementsAre("talk_hls/face.m3u8", "talk_hls/sound.m3u8"));
  const std::string text = hls_media(track(true));
  EXPECT_THAT(text, HasSubstr("#EXT-X-TARGETDURATION:2\n"));
  EXPECT_THAT(text, HasSubstr("#EXTINF:0.500000,\nface-00003.m4s\n"));
  const Result<HlsPlaylist> media = read_hls(text);
  ASSERT_TRUE(media) << media.error().describe();
  EXPECT_EQ(media->rendition.init, "face-init.mp4");
  EXPECT_THAT(media->rendition.segments,
              ElementsAre("face-00001.m4s", "face-00002.m4s", "face-00003.m4s"));
}

TEST(Playlists, DashComesBack) {
  const std::string text = dash_description({track(true), track(false)}, "talk_dash");
  EXPECT_THAT(text, HasSubstr("codecs=\"mp4v.20.61\""));
  EXPECT_THAT(text, HasSubstr("<S t=\"0\" d=\"50000\" r=\"1\"/>"));
  EXPECT_THAT(text, HasSubstr("mediaPresentationDuration=\"PT4.500000S\""));
  const auto renditions = read_dash(text);
  ASSERT_TRUE(renditions) << renditions.error().describe();
  ASSERT_EQ(renditions->size(), 2u);
  EXPECT_EQ((*renditions)[0].init, "talk_dash/sound-init.mp4") << "the sound is the first";
  EXPECT_THAT((*renditions)[1].segments,
              ElementsAre("talk_dash/face-00001.m4s", "talk_dash/face-00002.m4s",
                          "talk_dash/face-00003.m4s"));
}

TEST(Playlists, HlsOfOtherWriters) {
  const Result<HlsPlaylist> read = read_hls(
      "\xEF\xBB\xBF#EXTM3U\r\n# a comment\r\n#EXT-X-MAP:URI=\"a,b.mp4\",OTHER=1\r\n\r\n"
      "#EXT-X-KEY:METHOD=NONE\r\n#EXTINF:1,title\r\n1.m4s\r\n#EXTINF:1\r\n2.m4s  ");
  ASSERT_TRUE(read) << read.error().describe();
  EXPECT_EQ(read->rendition.init, "a,b.mp4");
  EXPECT_THAT(read->rendition.segments, ElementsAre("1.m4s", "2.m4s"));
}

TEST(Playlists, DashOfOtherWriters) {
  const auto numbers = read_dash(
      "<MPD mediaPresentationDuration='PT0H0M5.5S'><!-- c --><Period><AdaptationSet>"
      "<SegmentTemplate timescale='1000' duration='2000' startNumber='0'"
      " media='$RepresentationID$/$$$Number%03d$.m4s' initialization='$RepresentationID$.mp4'/>"
      "<Representation id='a'/><Representation id='b'/></AdaptationSet></Period></MPD>");
  ASSERT_TRUE(numbers) << numbers.error().describe();
  ASSERT_EQ(numbers->size(), 1u) << "of several representations the first";
  EXPECT_EQ((*numbers)[0].init, "a.mp4");
  EXPECT_THAT((*numbers)[0].segments, ElementsAre("a/$000.m4s", "a/$001.m4s", "a/$002.m4s"));
  const auto times = read_dash(
      "<d:MPD xmlns:d='x'><d:BaseURL>one/</d:BaseURL><d:Period><d:AdaptationSet><d:Representation>"
      "<d:SegmentTemplate media='t$Time$.m4s'><d:SegmentTimeline><d:S t='7' d='3' r='1'/>"
      "<d:S d='2'/></d:SegmentTimeline></d:SegmentTemplate></d:Representation>"
      "</d:AdaptationSet></d:Period></d:MPD>");
  ASSERT_TRUE(times) << times.error().describe();
  EXPECT_THAT((*times)[0].segments, ElementsAre("one/t7.m4s", "one/t10.m4s", "one/t13.m4s"));
  const auto list = read_dash(
      "<MPD><Period><AdaptationSet><Representation><SegmentList>"
      "<Initialization sourceURL='i.mp4'/><SegmentURL media='x&amp;y.m4s'/></SegmentList>"
      "</Representation></AdaptationSet></Period></MPD>");
  ASSERT_TRUE(list) << list.error().describe();
  EXPECT_EQ((*list)[0].init, "i.mp4");
  EXPECT_THAT((*list)[0].segments, ElementsAre("x&y.m4s"));
}

void expect_hls_refused(const std::string& text, Code code, const std::string& words) {
  const Result<HlsPlaylist> read = read_hls(text);
  ASSERT_FALSE(read) << text;
  EXPECT_EQ(read.error().code, code) << text;
  EXPECT_THAT(read.error().message, HasSubstr(words)) << text;
}

TEST(Playlists, HlsRefusals) {
  const std::string begin = "#EXTM3U\n";
  expect_hls_refused("", Code::truncated, "empty");
  expect_hls_refused("no playlist\n", Code::syntax, "begins with #EXTM3U");
  expect_hls_refused(begin, Code::truncated, "no segments");
  expect_hls_refused(begin + "#EXT-X-BYTERANGE:1@2\na.mp4\n", Code::unsupported, "byte ranges");
  expect_hls_refused(begin + "#EXT-X-MAP:URI=\"a\",BYTERANGE=\"1@2\"\n", Code::unsupported, "byte");
  expect_hls_refused(begin + "#EXT-X-MAP:URI=\"a\"\n#EXT-X-MAP:URI=\"b\"\nc\n", Code::unsupported,
                     "second");
  expect_hls_refused(begin + "#EXT-X-MAP:X=1\n", Code::syntax, "no URI");
  expect_hls_refused(begin + "#EXT-X-KEY:METHOD=AES-128,URI=\"k\"\na\n", Code::unsupported,
                     "encrypted");
  expect_hls_refused(begin + "#EXT-X-STREAM-INF:BANDWIDTH=1\na.m3u8\nb.m4s\n", Code::syntax,
                     "mixes");
  std::string many = begin;
  for (std::size_t i = 0; i <= kMostSegments; ++i) many += "a\n";
  expect_hls_refused(many, Code::out_of_range, "too long");
}

void expect_dash_refused(const std::string& inside, Code code, const std::string& words) {
  const auto read = read_dash("<MPD type='static'><Period><AdaptationSet>" + inside +
                              "</AdaptationSet></Period></MPD>");
  ASSERT_FALSE(read) << inside;
  EXPECT_EQ(read.error().code, code) << inside;
  EXPECT_THAT(read.error().message, HasSubstr(words)) << inside;
}

TEST(Playlists, DashRefusals) {
  const std::string one = "<Representation/>";
  expect_dash_refused("", Code::truncated, "no segments");
  expect_dash_refused(one, Code::unsupported, "not in segments");
  expect_dash_refused("<SegmentTemplate media='a$Number$'/>" + one, Code::truncated, "no segments");
  expect_dash_refused("<SegmentTemplate media='a$Number$' duration='1'/>" + one, Code::unsupported,
                      "number of segments");
  expect_dash_refused(
      "<SegmentTemplate media='a$Bandwidth$'><SegmentTimeline><S d='1'/>"
      "</SegmentTimeline></SegmentTemplate>" +
          one,
      Code::unsupported, "template");
  const auto expect_times_refused = [&](const std::string& entry, Code code,
                                        const std::string& words) {
    expect_dash_refused("<SegmentTemplate media='a$Time$'><SegmentTimeline>" + entry +
                            "</SegmentTimeline></SegmentTemplate>" + one,
                        code, words);
  };
  expect_times_refused("<S d='1' r='-1'/>", Code::unsupported, "count");
  expect_times_refused("<S d='1' r='99999999'/>", Code::out_of_range, "too long");
  expect_times_refused("<S d='9007199254740992' r='1'/>", Code::out_of_range, "too long");
  expect_times_refused("<S d='x'/>", Code::syntax, "not a number");
  expect_times_refused("<S/>", Code::syntax, "duration");
  expect_dash_refused("<SegmentTemplate timescale='0'/>", Code::syntax, "time scale");
  expect_dash_refused("<SegmentList><SegmentURL media='a' mediaRange='0-1'/></SegmentList>",
                      Code::unsupported, "byte");
  EXPECT_EQ(read_dash("<MPD type='dynamic'/>").error().code, Code::unsupported);
  EXPECT_EQ(read_dash("<MPD><Period/><Period/></MPD>").error().code, Code::unsupported);
  EXPECT_EQ(read_dash("<!DOCTYPE a [<!ENTITY b 'c'>]><MPD/>").error().code, Code::unsupported);
  EXPECT_EQ(read_dash("<SomethingElse/>").error().code, Code::syntax);
  EXPECT_EQ(read_dash("<MPD><Period></MPD>").error().code, Code::syntax);
  EXPECT_EQ(read_dash("<MPD").error().code, Code::syntax);
  EXPECT_EQ(read_dash("<MPD>").error().code, Code::syntax);
  EXPECT_EQ(read_dash("<MPD/>").error().code, Code::truncated);
  EXPECT_EQ(read_dash("").error().code, Code::syntax);
  std::string deep = "<MPD>";
  for (int i = 0; i < 10000; ++i) deep += "<a>";
  EXPECT_EQ(read_dash(deep).error().code, Code::out_of_range);
}

TEST(Playlists, XmlTags) {
  const auto read = [](const std::string& media, const std::string& rest = "") {
    return read_dash(
        "<?xml version='1.0'?>\n<MPD xmlns:b='b'><Period><AdaptationSet>"
        "<Representation><SegmentList><SegmentURL b:x='1' media=" +
        media + "/></SegmentList></Representation></AdaptationSet></Period></MPD>" + rest);
  };
  const auto tags = read("\"&lt;&quot;&#65;&amp;#38;&#38;\"", "<!-- c --><?x?>");
  ASSERT_TRUE(tags) << tags.error().describe();
  EXPECT_THAT(tags->front().segments, ElementsAre("<\"A&#38;&"));
  for (const char* bad : {"", "1", "'1", "'&b;'", "'1' media='2'", "'1'><a>&b;</a>"}) {
    const auto refused = read(bad);
    ASSERT_FALSE(refused) << bad;
    EXPECT_EQ(refused.error().code, Code::syntax) << bad;
    EXPECT_EQ(refused.error().where.line, 2) << bad;
  }
  for (const char* bad : {"<", "<a", "<!--", "<?x", "<a/>"}) EXPECT_FALSE(read("'1'", bad)) << bad;
}

TEST(Playlists, References) {
  EXPECT_EQ(to_reference("a b/c-1_2.m4s"), "a%20b/c-1_2.m4s");
  EXPECT_EQ(to_reference("$x&\"<\xC3\xA4"), "%24x%26%22%3C%C3%A4");
  for (const char* name : {"a b/c.m4s", "100%", "\xC3\xA4$&<\"'?#:\\"}) {
    const Result<std::string> back = from_reference(to_reference(name));
    ASSERT_TRUE(back) << back.error().describe();
    EXPECT_EQ(*back, name);
  }
  for (const char* bad : {"", "/etc/passwd", "../a", "a/../../b", "http://x/y", "file:a", "a?b",
                          "a#b", "a\\b", "%2e%2e/a", "%2Fetc/passwd", "a/..", ".."}) {
    const Result<std::string> read = from_reference(bad);
    ASSERT_FALSE(read) << bad;
    EXPECT_EQ(read.error().code, Code::unsupported) << bad;
  }
  for (const char* bad : {"%", "%4", "%4g", "%00", "a%"}) {
    EXPECT_EQ(from_reference(bad).error().code, Code::syntax) << bad;
  }
}

}  // namespace playlist_text_test
}  // namespace animeme::media
