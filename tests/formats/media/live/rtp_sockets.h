// Ports, folders and a relay that loses packets, for tests with sockets.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/files.h"
#include "tests/support/random_clip.h"
#include "tests/support/temp_dir.h"
#include "tools/formats/media/rtp/sdp.h"
#include "tools/formats/media/rtp/udp_socket.h"

namespace animeme::test {

/// The first of four ports in a row that are free just now, even, from `least` on. Programs that
/// run at the same time begin at different places, all below those that the system gives to
/// whoever asks for any (from 32768 on).
inline int free_ports(int least = 20000) {
  int port = least > 20000 ? least : 20000 + int(getpid() % 1500) * 8;
  for (; port < 65000; port += 4) {
    bool free = true;
    for (int i = 0; i < 4; ++i) free = free && media::UdpSocket::bind("0.0.0.0", port + i);
    if (free) return port;
  }
  ADD_FAILURE() << "no free ports";
  return 0;
}

/// Rewrites a description to other ports.
inline void shift_ports(const std::string& path, int port) {
  auto session = media::read_sdp(slurp(path));
  ASSERT_TRUE(session) << session.error().describe();
  session->face->port = port;
  session->face->rtcp_port = port + 1;
  if (session->audio) {
    session->audio->port = port + 2;
    session->audio->rtcp_port = port + 3;
  }
  std::ofstream(path, std::ios::binary) << media::write_sdp(*session);
}

/// Takes datagrams at four ports and passes them on to four others, except some.
class UdpRelay {
 public:
  UdpRelay(int from, int to, std::uint64_t seed, int loss)
      : to_(*media::UdpAddress::resolve("127.0.0.1", to)),
        out_(*media::UdpSocket::open_for(to_)),
        random_(seed),
        loss_(loss) {
    for (int i = 0; i < 4; ++i) {
      auto socket = media::UdpSocket::bind("127.0.0.1", from + i);
      EXPECT_TRUE(socket) << socket.error().describe();
      in_.push_back(std::move(*socket));
    }
  }

  /// Passes on what is there. RTCP is never lost.
  void pump() {
    for (std::size_t i = 0; i < in_.size(); ++i) {
      for (;;) {
        const auto got = in_[i].receive();
        if (!got || !*got) break;
        if (i % 2 == 0 && random_.chance(loss_)) continue;
        EXPECT_TRUE(out_.send(**got, to_.with_port(to_.port() + int(i))));
      }
    }
  }

 private:
  media::UdpAddress to_;
  media::UdpSocket out_;
  std::vector<media::UdpSocket> in_;
  Random random_;
  int loss_;
};

}  // namespace animeme::test
