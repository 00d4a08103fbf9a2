// How much of a face arrives over RTP when packets get lost: the table of
// tools/formats/media/live/README.md.
//
//     build/release/bin/loss_table             in virtual time, without sockets
//     build/release/bin/loss_table --sockets   in real time, over the sockets of this machine
//     build/release/bin/loss_table --requests  receivers that ask for intra planes
//
// 25 planes a second with an intra plane each second, and AAC beside it. A plane counts as right if
// FaceRecovery gives it out and it decodes to the values that were sent.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <thread>
#include <tuple>

#include "tests/formats/media/live/intra_requests.h"
#include "tests/formats/media/live/rtp_sockets.h"
#include "tests/formats/media/live/rtp_support.h"
#include "tools/formats/media/live/open.h"

namespace {

using namespace animeme;
using namespace animeme::media;

struct Settings {
  int seconds = 60;
  int networks = 20;
  int period = 25;
  bool sockets = false;
  bool requests = false;
};

struct Row {
  std::int64_t sent = 0;
  std::int64_t right = 0;
  std::int64_t freezes = 0;
  double frozen = 0;
  double longest = 0;
  double bytes = 0;  // of the face, with UDP and IP headers
  double seconds = 0;
};

void add(const test::LiveTalk& talk, const std::vector<LiveEvent>& events, Row& row) {
  FaceRecovery recovery;
  const auto units = test::only(test::recovered(events, recovery), LiveTrack::face);
  test::expect_right(talk, units);
  row.sent += std::int64_t(test::only(talk.units, LiveTrack::face).size());
  row.right += std::int64_t(units.size());
  row.freezes += recovery.stats().freezes;
  row.frozen += recovery.stats().frozen_seconds;
  row.longest = std::max(row.longest, recovery.stats().longest_seconds);
  row.seconds += test::seconds_of(talk, talk.units.back());
}

void count_bytes(const test::LiveTalk& talk, const RtpOptions& options, Row& row) {
  constexpr std::size_t kUdpAndIp = 28;
  RtpSender sender(talk.info, options, "192.0.2.1", 5004, 1, 0);
  RtpSender::Datagrams out;
  for (const LiveUnit& unit : talk.units) {
    (void)sender.send(unit, 1 + test::seconds_of(talk, unit), out);
  }
  for (const RtpDatagram& each : out) {
    if (each.track == LiveTrack::face) row.bytes += double(each.bytes.size() + kUdpAndIp);
  }
}

// Real time, real sockets, a relay in between.
std::vector<LiveEvent> over_sockets(const test::LiveTalk& talk, RtpOptions options, int loss,
                                    std::uint64_t seed) {
  const test::TempDir dir;
  const int front = test::free_ports();
  const int back = test::free_ports(front + 4);
  options.sdp_path = dir.file("talk.sdp");
  std::vector<LiveEvent> events;
  auto sink = open_sink("rtp://127.0.0.1:" + std::to_string(front), {options});
  if (!sink || !(*sink)->start(talk.info)) return events;
  test::shift_ports(options.sdp_path, back);
  auto source = open_source(options.sdp_path);
  if (!source) return events;
  test::UdpRelay relay(front, back, seed, loss);
  const auto hear = [&](double patience) {
    relay.pump();
    for (;;) {
      auto event = (*source)->next(patience);
      if (!event || std::holds_alternative<LiveIdle>(*event)) return;
      events.push_back(std::move(*event));
      if (std::holds_alternative<LiveEnd>(events.back())) return;
    }
  };
  const auto begin = std::chrono::steady_clock::now();
  for (const LiveUnit& unit : talk.units) {
    const auto due = begin + std::chrono::duration<double>(0.1 + test::seconds_of(talk, unit));
    std::this_thread::sleep_until(due);
    (void)(*sink)->send(unit);
    hear(0);
  }
  (void)(*sink)->finish();
  hear(3);
  return events;
}

Row measure(const test::LiveTalk& talk, const Settings& settings, const test::Trouble& trouble,
            const RtpOptions& options) {
  Row row;
  count_bytes(talk, options, row);
  row.bytes *= settings.networks;
  for (int network = 1; network <= settings.networks; ++network) {
    const auto seed = std::uint64_t(network);
    add(talk,
        settings.sockets ? over_sockets(talk, options, trouble.loss, seed)
                         : test::transfer(talk, options, trouble, seed),
        row);
  }
  return row;
}

// Intra planes each second, and each ten seconds without and with requests.
void print_requests(const Settings& settings) {
  std::printf(
      "| loss | intra planes | planes right | freezes a minute | mean freeze | longest | face |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const int loss : {0, 1, 2, 5}) {
    for (const auto& [period, requests, name] :
         {std::tuple(1, false, "each second"), std::tuple(10, false, "each 10 s"),
          std::tuple(10, true, "each 10 s and on request")}) {
      const test::LiveTalk talk = test::random_talk(settings.seconds * 25, 25 * period);
      RecoveryStats sum;
      double bytes = 0;
      for (int network = 1; network <= settings.networks; ++network) {
        const test::AskedRun one =
            test::run_asking(talk, requests, {.loss = loss}, std::uint64_t(network));
        bytes += one.bytes;
        sum.usable += one.recovery.usable;
        sum.dropped += one.recovery.dropped;
        sum.lost += one.recovery.lost;
        sum.freezes += one.recovery.freezes;
        sum.frozen_seconds += one.recovery.frozen_seconds;
        sum.longest_seconds = std::max(sum.longest_seconds, one.recovery.longest_seconds);
      }
      const double seconds = double(settings.seconds) * settings.networks;
      std::printf("| %d %% | %s | %.1f %% | %.1f | %.2f s | %.2f s | %.1f kbit/s |\n", loss, name,
                  100 * sum.share(), 60 * double(sum.freezes) / seconds,
                  sum.freezes > 0 ? sum.frozen_seconds / double(sum.freezes) : 0.0,
                  sum.longest_seconds, bytes * 8 / 1000 / seconds);
      std::fflush(stdout);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app("Share of a face that arrives over RTP");
  app.add_option("--seconds", settings.seconds, "length of the talk")->check(CLI::Range(1, 3600));
  app.add_option("--networks", settings.networks, "how many random networks")
      ->check(CLI::Range(1, 1000));
  app.add_option("--period", settings.period, "planes from one intra plane to the next")
      ->check(CLI::Range(1, 1000));
  app.add_flag("--sockets", settings.sockets, "real time over sockets, one network");
  app.add_flag("--requests", settings.requests, "receivers that ask for intra planes");
  CLI11_PARSE(app, argc, argv);
  if (settings.requests) {
    print_requests(settings);
    return ::testing::Test::HasFailure() ? 1 : 0;
  }
  if (settings.sockets) settings.networks = 1;

  test::LiveTalk talk = test::random_talk(settings.seconds * 25, settings.period);
  test::add_sound(talk, test::aac_format());
  const auto print = [](const std::string& name, const Row& row) {
    std::printf("| %s | %.1f %% | %.1f | %.2f s | %.2f s | %.1f kbit/s |\n", name.c_str(),
                100.0 * double(row.right) / double(row.sent),
                60 * double(row.freezes) / row.seconds,
                row.freezes > 0 ? row.frozen / double(row.freezes) : 0.0, row.longest,
                row.bytes * 8 / 1000 / row.seconds);
    std::fflush(stdout);
  };
  const std::string columns = " planes right | freezes a minute | mean freeze | longest | face |\n";
  std::printf("| loss | repeat |%s|---|---|---|---|---|---|---|\n", columns.c_str());
  for (const int loss : {0, 1, 5, 10}) {
    for (const int repeat : {1, 2, 3}) {
      print(std::to_string(loss) + " % | " + std::to_string(repeat),
            measure(talk, settings, {.loss = loss}, {.repeat = repeat}));
    }
  }
  if (settings.sockets) return ::testing::Test::HasFailure() ? 1 : 0;
  std::printf("\n| loss | in bursts of | repeat, after |%s|---|---|---|---|---|---|---|---|\n",
              columns.c_str());
  for (const int loss : {1, 5}) {
    for (const int burst : {6, 20}) {
      for (const auto& [repeat, after] :
           {std::pair(1, 1), std::pair(2, 1), std::pair(2, 2), std::pair(2, 3), std::pair(2, 5),
            std::pair(2, 8), std::pair(3, 3)}) {
        const std::string way = std::to_string(repeat) + ", " + std::to_string(after);
        print(std::to_string(loss) + " % | " + std::to_string(burst) + " | " +
                  (repeat == 1 ? "1" : way),
              measure(talk, settings, {.loss = loss, .burst = burst},
                      {.repeat = repeat, .repeat_after = after}));
      }
    }
  }
  std::printf("\n| jitter | repeat |%s|---|---|---|---|---|---|---|\n", columns.c_str());
  for (const double jitter : {0.05, 0.3, 0.8, 2.0}) {
    for (const int repeat : {1, 2}) {
      print(std::to_string(int(1000 * jitter)) + " ms | " + std::to_string(repeat),
            measure(talk, settings, {.jitter = jitter}, {.repeat = repeat}));
    }
  }
  return ::testing::Test::HasFailure() ? 1 : 0;
}
