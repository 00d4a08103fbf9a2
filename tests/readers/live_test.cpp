// Receivers: GStreamer's rtpmp4vdepay and ffprobe take what `animeme stream` sends by RTP or as a
// transport stream, on loopback. Source: tools/formats/media/containers.md, sections 3.2 and 4.1.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <future>
#include <sstream>
#include <thread>

#include "tests/readers/readers_support.h"
#include "tests/readers/talk.h"
#include "tests/support/folders.h"

namespace animeme::test {
namespace live_test {

const std::string kProgram = "'" + std::string(test::kBinaryFolder) + "/bin/animeme'";
constexpr int kRepeat = 2;  // copies of each packet, as the program sends them by itself

bool bind_udp(int port, int& bound) {
  const int handle = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(std::uint16_t(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* plain = reinterpret_cast<sockaddr*>(&address);
  const bool ok = bind(handle, plain, size) == 0 && getsockname(handle, plain, &size) == 0;
  bound = ntohs(address.sin_port);
  close(handle);
  return ok;
}

// An even port with four free ones from it on: face, sound, and the reports of both.
int free_port() {
  for (int attempt = 0; attempt < 100; ++attempt) {
    int port = 0, ignored = 0;
    if (!bind_udp(0, port)) continue;
    port &= ~1;
    bool all = true;
    for (int i = 0; i < 4; ++i) all = all && bind_udp(port + i, ignored);
    if (all) return port;
  }
  return 0;
}

// Waits until somebody listens on a port, by the kernel's table: a trial to bind it would, for a
// moment, keep the receiver from it.
bool listened_to(int port) {
  std::array<char, 8> wanted{};
  std::snprintf(wanted.data(), wanted.size(), ":%04X", unsigned(port));
  for (int i = 0; i < 1000; ++i) {
    for (const char* table : {"/proc/net/udp", "/proc/net/udp6"}) {
      std::ifstream rows(table);
      for (std::string row; std::getline(rows, row);) {
        std::string number, local;  // "12:", "0100007F:1388"
        std::istringstream(row) >> number >> local;
        if (local.ends_with(wanted.data())) return true;
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

class Live : public testing::Test {
 protected:
  // Starts a receiver, sends the talk to it and returns what the receiver prints.
  std::string send_to(const std::string& receiver, int port,
                      const std::string& scheme = "rtp") const {
    auto heard = std::async(std::launch::async, [&] { return run(receiver + " 2>&1"); });
    EXPECT_TRUE(listened_to(port)) << receiver;
    int status = 0;
    const std::string said =
        run(kProgram + " stream '" + path_ + "' --copy --repeat " + std::to_string(kRepeat) +
                " --to " + scheme + "://127.0.0.1:" + std::to_string(port) + " 2>&1",
            &status);
    EXPECT_EQ(status, 0) << said;
    return heard.get();
  }

  // What ffprobe printed has every unit, a plane time apart.
  void expect_units(const std::string& said) const {
    Json report = Json::parse(said, nullptr, false);
    ASSERT_TRUE(report.contains("packets")) << said;
    // It takes a copy right behind its original for a further packet. One comes at the end, and,
    // if the machine holds the sender up, in between.
    Json& packets = report["packets"];
    const auto copies = [](const Json& a, const Json& b) {
      return a["pts"] == b["pts"] && a["data"] == b["data"];
    };
    packets.erase(std::unique(packets.begin(), packets.end(), copies), packets.end());
    const std::vector<Bytes> units = units_of(talk_, true);
    ASSERT_EQ(report["packets"].size(), units.size());
    const std::int64_t first = report["packets"][0]["pts"];
    for (std::size_t i = 0; i < units.size(); ++i) {
      const Json& packet = report["packets"][i];
      EXPECT_EQ(to_hex(from_dump(packet["data"])), to_hex(units[i])) << "unit " << i;
      EXPECT_EQ(packet["pts"].get<std::int64_t>() - first, std::int64_t(i) * 90000 / 25);
    }
  }

  TempDir dir_;
  Talk talk_ = walking_talk();
  std::string path_ = write_talk(dir_, talk_, layout_of("mp4"));
};

TEST_F(Live, RtpToGStreamerGivesTheUnitsByteForByte) {
  NEEDS_PROGRAM("gst-launch-1.0", "gstreamer1.0-tools");
  const int port = free_port();
  ASSERT_NE(port, 0);
  const std::size_t packets = kRepeat * talk_.face.units.size();
  const std::string said = send_to(
      "timeout 30 gst-launch-1.0 udpsrc address=127.0.0.1 port=" + std::to_string(port) +
          " num-buffers=" + std::to_string(packets) +
          " caps=application/x-rtp,media=video,clock-rate=90000,encoding-name=MP4V-ES,payload=96"
          " ! rtpjitterbuffer ! rtpmp4vdepay ! filesink location='" +
          dir_.file("units") + "'",
      port);
  EXPECT_EQ(to_hex(read_bytes(dir_.file("units"))), to_hex(joined(units_of(talk_, true)))) << said;
}

TEST_F(Live, RtpToFfprobeGivesTheUnitsInTime) {
  NEEDS_PROGRAM("ffprobe", "ffmpeg");
  const int port = free_port();
  ASSERT_NE(port, 0);
  // The description of tools/formats/media/containers.md, section 4.1, not the one that the program
  // writes.
  std::ofstream(dir_.file("face.sdp"))
      << "v=0\no=- 0 0 IN IP4 127.0.0.1\ns=-\nc=IN IP4 127.0.0.1\nt=0 0\n"
         "m=video "
      << port
      << " RTP/AVP 96\n"
         "a=rtpmap:96 MP4V-ES/90000\n"
         "a=fmtp:96 profile-level-id=97; config=000001B061000001B58947\n";
  const std::string said = send_to(
      "timeout 30 ffprobe -v fatal -fflags noparse -protocol_whitelist file,udp,rtp -probesize 32 "
      "-analyzeduration 100000 -of json -show_packets -show_data '" +
          dir_.file("face.sdp") + "'",
      port);
  expect_units(said);
}

TEST_F(Live, TransportStreamToFfprobeGivesTheUnitsInTime) {
  NEEDS_PROGRAM("ffprobe", "ffmpeg");
  const int port = free_port();
  ASSERT_NE(port, 0);
  // It ends when nothing has come for four seconds.
  expect_units(
      send_to("timeout 30 ffprobe -v fatal -fflags noparse -probesize 10000 "
              "-analyzeduration 300000 -of json -select_streams v -show_packets "
              "-show_data 'udp://127.0.0.1:" +
                  std::to_string(port) + "?timeout=4000000'",
              port, "udp"));
}

}  // namespace live_test
}  // namespace animeme::test
