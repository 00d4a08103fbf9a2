// Programs of others that receive what the sink sends.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <thread>

#include "tests/formats/media/live/rtp_sockets.h"
#include "tests/formats/media/live/rtp_support.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/shared.h"
#include "tools/formats/media/live/open.h"

namespace animeme::media {
namespace rtp_readers_test {

using test::Bytes;
using test::LiveTalk;

// Somebody listens there, once nobody else can.
bool wait_for_listener(int port) {
  for (int i = 0; i < 1000; ++i) {
    if (!UdpSocket::bind("127.0.0.1", port)) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

// Starts a program, sends a talk in ten times its own speed and waits for the program's end.
void play_to(const std::string& program, const LiveTalk& talk, LiveSink& sink, int port) {
  std::FILE* pipe = popen(program.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  ASSERT_TRUE(wait_for_listener(port)) << program;
  for (const LiveUnit& unit : talk.units) {
    ASSERT_TRUE(sink.send(unit));
    std::this_thread::sleep_for(std::chrono::milliseconds(4));
  }
  // The goodbye comes on a port of its own, and FFmpeg ends with it whatever still lies on the
  // other.
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  ASSERT_TRUE(sink.finish());
  EXPECT_EQ(pclose(pipe), 0) << program;
}

std::string crc32(const Bytes& bytes) {
  std::uint32_t crc = ~0u;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int i = 0; i < 8; ++i) crc = (crc & 1) != 0 ? crc >> 1 ^ 0xEDB88320u : crc >> 1;
  }
  char text[9];
  std::snprintf(text, sizeof text, "%08x", ~crc);
  return text;
}

// "video 0123abcd" for each packet that ffprobe lists.
std::vector<std::string> read_packets(const std::string& path) {
  std::vector<std::string> packets;
  std::ifstream in(path);
  std::string kind;
  for (std::string line; std::getline(in, line);) {
    const std::size_t sign = line.find('=');
    const std::string value = line.substr(std::min(sign + 1, line.size()));
    if (line.starts_with("codec_type=")) kind = value;
    if (line.starts_with("data_hash=CRC32:")) packets.push_back(kind + " " + value.substr(6));
  }
  return packets;
}

// The elementary stream of the planes, with the configuration in front of intra planes.
Bytes face_stream(const LiveTalk& talk) {
  Bytes stream;
  for (const LiveUnit& unit : test::only(talk.units, LiveTrack::face)) {
    if (unit.intra) {
      stream.insert(stream.end(), talk.info.face_config.begin(), talk.info.face_config.end());
    }
    stream.insert(stream.end(), unit.bytes.begin(), unit.bytes.end());
  }
  return stream;
}

// Of the face, copies included.
std::int64_t count_packets(const LiveTalk& talk, const RtpOptions& options) {
  RtpSender sender(talk.info, options, "127.0.0.1", 5004, 1, 0);
  RtpSender::Datagrams packets;
  for (const LiveUnit& unit : talk.units) EXPECT_TRUE(sender.send(unit, 0, packets));
  sender.finish(0, packets);
  return std::count_if(packets.begin(), packets.end(),
                       [](const RtpDatagram& each) { return !each.control; });
}

TEST(RtpReaders, GstreamerGetsTheElementaryStream) {
  if (!test::has_program("gst-launch-1.0")) GTEST_SKIP() << "gst-launch-1.0 is not there";
  const LiveTalk talk = test::random_talk(60, 20);
  const test::TempDir dir;
  const int port = test::free_ports();
  for (const RtpOptions& options :
       {RtpOptions{.repeat = 1}, RtpOptions{.mtu = 256, .repeat = 1}, RtpOptions{.repeat = 2}}) {
    const std::string out = dir.file("face.es");
    auto sink = open_sink("rtp://127.0.0.1:" + std::to_string(port), {.rtp = options});
    ASSERT_TRUE(sink && (*sink)->start(talk.info));
    play_to("timeout 60 gst-launch-1.0 -q udpsrc address=127.0.0.1 port=" + std::to_string(port) +
                " num-buffers=" + std::to_string(count_packets(talk, options)) +
                " caps='application/x-rtp,media=video,clock-rate=90000,encoding-name=MP4V-ES'" +
                (options.repeat > 1 ? " ! rtpjitterbuffer" : "") +
                " ! rtpmp4vdepay ! filesink location=" + out + " 2>&1",
            talk, **sink, port);
    EXPECT_EQ(test::read_bytes(out), face_stream(talk)) << options.mtu << " " << options.repeat;
  }
}

TEST(RtpReaders, FfprobeGetsFaceAndSoundByTheDescription) {
  if (!test::has_program("ffprobe")) GTEST_SKIP() << "ffprobe is not there";
  LiveTalk talk = test::random_talk(60, 20);
  test::add_sound(talk, test::aac_format());
  // Its parser for films glues planes together; sound comes packet by packet.
  std::vector<std::string> expected = {"video " + crc32(face_stream(talk))};
  for (const LiveUnit& unit : test::only(talk.units, LiveTrack::audio)) {
    expected.push_back("audio " + crc32(unit.bytes));
  }
  std::sort(expected.begin(), expected.end());
  const test::TempDir dir;
  const std::string sdp = dir.file("talk.sdp");
  const std::string out = dir.file("packets.txt");
  const int port = test::free_ports();
  for (const int repeat : {1, 2}) {
    std::vector<std::string> packets;
    // It reads from a small buffer: on a busy machine datagrams are lost there.
    for (int attempt = 0; attempt < 5 && packets != expected; ++attempt) {
      auto sink = open_sink("rtp://127.0.0.1:" + std::to_string(port),
                            {.rtp = {.repeat = repeat, .sdp_path = sdp}});
      ASSERT_TRUE(sink && (*sink)->start(talk.info));
      play_to(
          "timeout 60 ffprobe -v quiet -protocol_whitelist file,udp,rtp -show_packets"
          " -show_entries packet=codec_type,data_hash -show_data_hash crc32 " +
              sdp + " > " + out,
          talk, **sink, port + 3);
      packets = read_packets(out);
      std::sort(packets.begin(), packets.end());
    }
    EXPECT_EQ(packets, expected) << repeat;
  }
}

// The planes of the example files: size, intra flag, bytes.
std::vector<Bytes> example_planes() {
  const Bytes all = test::read_bytes((test::data_dir() / "containers" / "fba.aus").string());
  std::vector<Bytes> planes;
  for (std::size_t at = 0; at + 5 <= all.size();) {
    std::size_t size = 0;
    for (std::size_t i = 0; i < 4; ++i) size = size << 8 | all[at + i];
    const auto begin = all.begin() + std::ptrdiff_t(at) + 5;
    planes.emplace_back(begin, begin + std::ptrdiff_t(size));
    at += 5 + size;
  }
  return planes;
}

TEST(RtpReaders, WhatFfmpegSendsIsReceived) {
  if (!test::has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not there";
  const test::TempDir dir;
  const int port = test::free_ports();
  const std::string first = std::to_string(port);
  const std::string second = std::to_string(port + 2);
  const std::string sdp = dir.file("talk.sdp");
  std::ofstream(sdp)
      << "v=0\nc=IN IP4 127.0.0.1\nm=video " + first +
             " RTP/AVP 96\na=rtpmap:96 MP4V-ES/90000\n"
             "a=fmtp:96 profile-level-id=1; config=000001B061000001B58947\nm=audio " +
             second +
             " RTP/AVP 97\na=rtpmap:97 MPEG4-GENERIC/48000/1\n"
             "a=fmtp:97 profile-level-id=1;mode=AAC-hbr;sizelength=13;indexlength=3;"
             "indexdeltalength=3; config=118856E500\n";
  auto source = open_source(sdp);
  ASSERT_TRUE(source) << source.error().describe();
  const std::string file = (test::data_dir() / "containers" / "fba_aac.mkv").string();
  std::FILE* pipe = popen(("timeout 60 ffmpeg -v quiet -readrate 10 -i " + file +
                           " -map 0:v -c copy -f rtp rtp://127.0.0.1:" + first +
                           " -map 0:a -c copy -f rtp rtp://127.0.0.1:" + second)
                              .c_str(),
                          "r");
  ASSERT_NE(pipe, nullptr);
  std::vector<LiveUnit> units;
  LiveInfo info;
  for (bool end = false; !end;) {
    auto event = (*source)->next(units.empty() ? 20 : 2);  // it does not say goodbye
    ASSERT_TRUE(event) << event.error().describe();
    end = std::holds_alternative<LiveEnd>(*event) || std::holds_alternative<LiveIdle>(*event);
    if (const auto* unit = std::get_if<LiveUnit>(&*event)) units.push_back(*unit);
    if (const auto* now = std::get_if<LiveInfo>(&*event)) info = *now;
  }
  pclose(pipe);
  const std::vector<Bytes> planes = example_planes();
  const auto face = test::only(units, LiveTrack::face);
  ASSERT_EQ(face.size(), planes.size());
  for (std::size_t i = 0; i < face.size(); ++i) {
    ASSERT_EQ(face[i].bytes, planes[i]);
    EXPECT_EQ(face[i].intra, i % 125 == 0);
    EXPECT_NEAR(double(face[i].time), double(i) * 3600, 90);  // mkv has times of milliseconds
    EXPECT_EQ(face[i].duration, 3600);
  }
  const auto sound = test::only(units, LiveTrack::audio);
  EXPECT_GT(sound.size(), 460u);
  ASSERT_TRUE(info.audio);
  EXPECT_EQ(info.audio->frame_samples, 1024);
  // Its sender reports tie the tracks, whose RTP times begin at random numbers: the priming of AAC
  // comes 1024 samples before plane 0. FFmpeg takes the time of each track's begin for itself, so a
  // busy machine moves them; on a quiet one it is -1008, which is what mkv's milliseconds leave.
  RecordProperty("first_sound_samples", int(sound[0].time));
  EXPECT_NEAR(double(sound[0].time), -1024, 24000);
}

}  // namespace rtp_readers_test
}  // namespace animeme::media
