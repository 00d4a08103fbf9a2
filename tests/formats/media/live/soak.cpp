// A sender that speaks a line every three seconds, and two receivers of it, all three killed and
// started again at random:
//
//   soak [--seconds 600] [--restarts 50] [--seed 1] [--keep FOLDER]
//
// `--restarts`: of each. Nothing may crash or grow, and every frame that a receiver wrote must be a
// plane that the sender sent. Exit code 0: so it is; 1: not; 77: there is no voice or no web
// server.
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "tests/formats/media/live/ports.h"
#include "tests/formats/media/live/soak_judge.h"
#include "tests/formats/media/live/soak_player.h"
#include "tests/formats/media/live/soak_truth.h"
#include "tests/support/temp_dir.h"

namespace {

using namespace animeme::test;
using Clock = std::chrono::steady_clock;

constexpr double kLineEvery = 3;                // seconds
constexpr std::size_t kMostGrowth = 24u << 20;  // bytes, from the fifth second of a process on
constexpr std::size_t kMostMemory = 300u << 20;
constexpr int kSkipped = 77;

/// A TCP port that was free just now.
int free_tcp_port() {
  const int handle = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  (void)bind(handle, reinterpret_cast<sockaddr*>(&address), size);
  getsockname(handle, reinterpret_cast<sockaddr*>(&address), &size);
  close(handle);
  return ntohs(address.sin_port);
}

/// The first of four UDP ports in a row that are free just now, even.
int free_udp_ports() {
  for (int port = 20000 + int(getpid() % 1500) * 8; port < 32000; port += 4) {
    try {
      for (int i = 0; i < 4; ++i) (void)UdpSocket(port + i);
      return port;
    } catch (const std::runtime_error&) {  // somebody has it
    }
  }
  return 0;
}

struct Settings {
  double seconds = 600;
  int restarts = 50;
  unsigned seed = 1;
  std::string keep;
};

/// When each of the players is ended, in order.
struct Blow {
  double at = 0;
  std::size_t player = 0;
  int signal = SIGKILL;
};

std::vector<Blow> plan(const Settings& settings, std::mt19937& random) {
  std::vector<Blow> blows;
  // None in the first seconds and in the last ones: there is to be something to look at.
  std::uniform_real_distribution<double> when(4, std::max(5.0, settings.seconds - 5));
  for (std::size_t player = 0; player < 3; ++player) {
    for (int i = 0; i < settings.restarts; ++i) {
      blows.push_back({when(random), player, random() % 2 == 0 ? SIGKILL : SIGTERM});
    }
  }
  std::sort(blows.begin(), blows.end(), [](const Blow& a, const Blow& b) { return a.at < b.at; });
  return blows;
}

std::string line_to_say(std::mt19937& random) {
  static constexpr const char* kWords[] = {"good",  "morning", "people", "believe", "father",
                                           "seven", "over",    "mobile", "window",  "baby"};
  std::string line;
  for (int i = 0; i < 4; ++i) line += std::string(kWords[random() % 10]) + (i < 3 ? " " : ".\n");
  return line;
}

int report(const std::vector<Player*>& players, const Truth& truth, const std::string& folder) {
  bool good = true;
  std::int64_t sent = 0;
  for (const SentPlanes& run : truth.runs()) sent += std::int64_t(run.planes.size());
  std::printf("sender: %zu runs, %lld planes\n", truth.runs().size(), (long long)sent);
  for (const Player* player : players) {
    const char* name = player == players[0] ? "sender" : player == players[1] ? "rtp" : "web";
    std::printf("%s: %d starts, %d ends by a goodbye, at most %.1f MB, growth %.1f MB\n", name,
                player->starts(), player->ends(), double(player->most()) / (1 << 20),
                double(player->growth()) / (1 << 20));
    good = good && player->most() < kMostMemory && player->growth() < kMostGrowth;
    for (const std::string& problem : player->problems()) std::printf("  %s\n", problem.c_str());
    good = good && player->problems().empty();
  }
  for (std::size_t i = 1; i < players.size(); ++i) {
    Verdict verdict;
    Judge judge(truth.runs(), verdict);
    const std::string name = i == 1 ? "rtp" : "web";
    for (int k = 1; k <= players[i]->starts(); ++k) {
      judge.look_at(folder + "/" + name + std::to_string(k) + ".fap");
    }
    std::sort(verdict.late.begin(), verdict.late.end());
    std::printf(
        "%s: %lld frames, %lld right, %lld wrong, %lld at the edge of what is known; "
        "%zu of %zu runs heard",
        name.c_str(), (long long)verdict.frames, (long long)verdict.right, (long long)verdict.wrong,
        (long long)verdict.unknown, verdict.runs.size(), truth.runs().size());
    if (!verdict.late.empty()) {
      std::printf("; %zu restarts survived, gone on at plane %lld (median), %lld (latest)",
                  verdict.late.size(), (long long)verdict.late[verdict.late.size() / 2],
                  (long long)verdict.late.back());
    }
    std::printf("\n");
    for (const std::string& note : verdict.notes) std::printf("  %s\n", note.c_str());
    good = good && verdict.wrong == 0 && verdict.right > sent / 5;
  }
  std::printf(good ? "all is well\n" : "FAILED\n");
  return good ? 0 : 1;
}

int soak(const Settings& settings) {
  const TempDir own;
  const std::string folder = settings.keep.empty() ? own.path().string() : settings.keep;
  std::mt19937 random(settings.seed);
  const int rtp = free_udp_ports(), web = free_tcp_port();
  const std::string http = "127.0.0.1:" + std::to_string(web), sdp = folder + "/talk.sdp";
  const std::vector<std::string> text = {"--gap",  "skip", "--exact",   "--fill",
                                         "--wait", "0",    "--timeout", "0"};
  const auto receiver = [&](const std::string& from, const std::string& name) {
    std::vector<std::string> all = {"receive", from, "-o", folder + "/" + name + "%.fap"};
    all.insert(all.end(), text.begin(), text.end());
    return all;
  };
  Player sender("sender",
                {"stream", "--say", "-", "--idle-motion", "--seed", "%", "--to",
                 "rtp://127.0.0.1:" + std::to_string(rtp), "--sdp", sdp, "--to", "http://" + http},
                folder);
  Player by_rtp("rtp", receiver(sdp, "rtp"), folder),
      by_web("web", receiver("ws://" + http, "web"), folder);
  const std::vector<Player*> players = {&sender, &by_rtp, &by_web};
  Truth truth(web);
  std::vector<Blow> blows = plan(settings, random);
  std::size_t next = 0;
  const auto zero = Clock::now();
  const auto now = [&] { return std::chrono::duration<double>(Clock::now() - zero).count(); };
  double spoken = 0;
  for (double at = 0; at < settings.seconds; at = now()) {
    for (Player* player : players) {
      if (!player->look(at)) continue;
      player->start(at);
      if (player == &sender) truth.begin();
    }
    truth.look();
    if (at > spoken + kLineEvery) {
      spoken = at;
      sender.say(line_to_say(random));
    }
    for (; next < blows.size() && blows[next].at <= at; ++next) {
      players[blows[next].player]->end(blows[next].signal);
    }
    if (at > 3 && truth.runs().size() > 3 && truth.runs()[0].planes.empty() && next == 0) {
      for (const std::string& problem : sender.problems()) std::printf("%s\n", problem.c_str());
      std::printf("the sender does not start here\n");
      return kSkipped;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  for (Player* player : {&by_web, &by_rtp, &sender}) {
    player->end(SIGTERM);
    for (int i = 0; i < 3000 && !player->look(now()); ++i) {
      truth.look();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  return report(players, truth, folder);
}

}  // namespace

int main(int argc, char** argv) {
  signal(SIGPIPE, SIG_IGN);
  Settings settings;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i], value = argv[i + 1];
    if (name == "--seconds") settings.seconds = std::stod(value);
    if (name == "--restarts") settings.restarts = std::stoi(value);
    if (name == "--seed") settings.seed = unsigned(std::stoul(value));
    if (name == "--keep") settings.keep = value;
  }
  return soak(settings);
}
