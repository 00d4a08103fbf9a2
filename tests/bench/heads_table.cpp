// The table of tools/live/serve/README.md: many heads that all talk, in one process.
//
//     heads_table [HEADS ...] [--seconds 30] [--watched 4] [--effort 5]
//
// Starts `animeme serve`, makes the heads by requests, keeps each of them talking with sentences of
// its own, and reads the face and the sound of every fourth one by WebSockets. Times are those of
// processors, of the server and its voices, without this program.
#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/folders.h"

namespace animeme::bench {
namespace {

using Json = nlohmann::json;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Options {
  std::vector<int> heads = {1, 10, 100, 200};
  double seconds = 30;
  int watched = 4;
  int effort = 5;
};

int connect_to(int port) {
  const int handle = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(std::uint16_t(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(handle, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) return handle;
  ::close(handle);
  return -1;
}

void send_all(int handle, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::send(handle, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count <= 0) return;
    bytes.remove_prefix(std::size_t(count));
  }
}

/// Body of the answer.
std::string ask(int port, const std::string& method, const std::string& path,
                const std::string& body = {}) {
  const int handle = connect_to(port);
  if (handle < 0) return {};
  send_all(handle, method + " " + path + " HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n" +
                       "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
  std::string text;
  std::array<char, 65536> block{};
  std::size_t end = std::string::npos, length = 0;
  for (;;) {
    const ssize_t count = ::recv(handle, block.data(), block.size(), 0);
    if (count <= 0) break;
    text.append(block.data(), std::size_t(count));
    if (end == std::string::npos) {
      end = text.find("\r\n\r\n");
      const std::size_t at = text.find("content-length: ");
      if (at != std::string::npos) length = std::size_t(std::stoul(text.substr(at + 16)));
    }
    if (end != std::string::npos && text.size() >= end + 4 + length) break;
  }
  ::close(handle);
  return end == std::string::npos ? std::string() : text.substr(end + 4);
}

/// The server as a child.
struct Server {
  pid_t process = -1;
  int port = 0;
  int out = -1;
};

Server start(int most) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return {};
  const std::string heads = std::to_string(most);
  const std::string program = std::string(test::kBinaryFolder) + "/bin/animeme";
  const pid_t process = ::fork();
  if (process == 0) {
    ::dup2(ends[1], STDOUT_FILENO);
    ::execl(program.c_str(), "animeme", "serve", "--listen", "http://127.0.0.1:0", "--json",
            "--quiet", "--max-heads", heads.c_str(), nullptr);
    ::_exit(127);
  }
  ::close(ends[1]);
  std::string line;
  for (char c = 0; ::read(ends[0], &c, 1) == 1 && c != '\n';) line += c;
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return {};
  const std::string url = json["address"];
  return {process, std::stoi(url.substr(url.rfind(':') + 1)), ends[0]};
}

/// Of a process and all below it.
struct Use {
  double cpu = 0;       // seconds
  double resident = 0;  // MB of the process itself
};

Use use_of(pid_t process) {
  std::map<pid_t, std::pair<pid_t, double>> all;  // parent, seconds
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::ifstream file(entry.path() / "stat");
    std::string text;
    std::getline(file, text);
    if (text.rfind(')') == std::string::npos) continue;
    std::istringstream fields(text.substr(text.rfind(')') + 2));
    std::string state, skip;
    pid_t parent = 0;
    fields >> state >> parent;
    for (int i = 0; i < 9; ++i) fields >> skip;
    double sum = 0;
    for (int i = 0; i < 4; ++i) {  // own and of children that have ended, in both modes
      double ticks = 0;
      fields >> ticks;
      sum += ticks;
    }
    all[pid_t(std::stoi(name))] = {parent, sum / double(::sysconf(_SC_CLK_TCK))};
  }
  Use use;
  std::set<pid_t> ours = {process};
  for (bool more = true; more;) {
    more = false;
    for (const auto& [pid, facts] : all) {
      if (ours.contains(facts.first)) more = ours.insert(pid).second || more;
    }
  }
  for (const pid_t pid : ours) use.cpu += all[pid].second;
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmRSS:")) use.resident = std::stod(line.substr(6)) / 1024;
  }
  return use;
}

std::string sentence(std::mt19937& random) {
  static constexpr const char* kWords[] = {
      "the",   "quick",  "brown",  "fox",   "jumps",  "over",  "lazy",   "dog",
      "seven", "wizard", "makes",  "toxic", "potion", "for",   "evil",   "queen",
      "while", "nobody", "sleeps", "and",   "river",  "under", "window", "morning"};
  std::string text;
  for (int i = 0; i < 10; ++i) text += std::string(i > 0 ? " " : "") + kWords[random() % 24];
  return text + ".\n";
}

/// Viewers that read whatever comes.
class Viewers {
 public:
  Viewers(int port, const std::vector<std::string>& paths) {
    for (const std::string& path : paths) {
      const int handle = connect_to(port);
      if (handle < 0) continue;
      send_all(handle, "GET " + path +
                           " HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: "
                           "Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
                           "dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
      handles_.push_back({handle, POLLIN, 0});
    }
    thread_ = std::thread([this] { read(); });
  }
  ~Viewers() {
    stopping_ = true;
    thread_.join();
    for (const pollfd& one : handles_) ::close(one.fd);
  }
  std::int64_t bytes() const { return bytes_; }

 private:
  void read() {
    std::vector<char> block(1 << 16);
    while (!stopping_) {
      ::poll(handles_.data(), handles_.size(), 100);
      for (pollfd& one : handles_) {
        if ((one.revents & POLLIN) == 0) continue;
        const ssize_t count = ::recv(one.fd, block.data(), block.size(), MSG_DONTWAIT);
        if (count > 0) bytes_ += count;
        if (count == 0) one.fd = -1;
      }
      // As little as possible: it shares the processors with the server.
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }
  std::vector<pollfd> handles_;
  std::atomic<std::int64_t> bytes_ = 0;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

/// Lines for whoever has few left.
void feed(int port, std::mt19937& random) {
  const Json all = Json::parse(ask(port, "GET", "/heads"), nullptr, false);
  if (!all.is_object()) return;
  for (const Json& head : all["heads"]) {
    if (head["lines_waiting"].get<int>() >= 4) continue;
    std::string lines;
    for (int i = 0; i < 6; ++i) lines += sentence(random);
    (void)ask(port, "POST", "/heads/" + head["name"].get<std::string>() + "/say", lines);
  }
}

/// How many planes were less late than so many seconds, of the histogram of /metrics.
using Lateness = std::map<double, double>;

Lateness lateness(int port) {
  Lateness late;
  std::istringstream text(ask(port, "GET", "/metrics"));
  const std::string name = "animeme_late_seconds_bucket{le=\"";
  for (std::string line; std::getline(text, line);) {
    if (!line.starts_with(name)) continue;
    const std::string border = line.substr(name.size(), line.find('"', name.size()) - name.size());
    late[border == "+Inf" ? 10 : std::stod(border)] = std::stod(line.substr(line.rfind(' ')));
  }
  return late;
}

/// Milliseconds between two looks, even within a bar of the histogram.
double percentile(const Lateness& before, const Lateness& after, double part) {
  if (after.empty()) return 0;
  const auto count = [&](double border) {
    const auto found = before.find(border);
    return after.at(border) - (found == before.end() ? 0 : found->second);
  };
  const double wanted = part * count(after.rbegin()->first);
  double low = 0, below = 0;
  for (const auto& [border, total] : after) {
    const double here = count(border);
    if (here >= wanted && here > below) {
      return 1000 * (low + (border - low) * (wanted - below) / (here - below));
    }
    low = border;
    below = here;
  }
  return 1000 * low;
}

struct Row {
  Use begin, end;
  Lateness late_before, late;
  Json figures;
  double seconds = 0;
  std::int64_t bytes = 0;
};

Row measure(const Options& options, int heads) {
  Row row;
  const Server server = start(heads);
  if (server.port == 0) {
    std::fprintf(stderr, "the server does not start\n");
    return row;
  }
  std::mt19937 random{1};
  const std::string settings = Json{{"audio_effort", options.effort}}.dump();
  std::vector<std::string> watched;
  for (int i = 0; i < heads; ++i) {
    const std::string path = "/heads/h" + std::to_string(i);
    const std::string made = ask(server.port, "PUT", path, settings);
    if (made.find("name") == std::string::npos) std::fprintf(stderr, "%s", made.c_str());
    if (i % options.watched == 0) watched.insert(watched.end(), {path + "/face", path + "/audio"});
  }
  const Viewers viewers(server.port, watched);
  // Not all at once: as people would. Then what was late in the beginning is left out.
  for (const auto start = Clock::now(); seconds_since(start) < 8;) {
    feed(server.port, random);
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
  row.late_before = lateness(server.port);
  row.begin = use_of(server.process);
  const auto start = Clock::now();
  while (seconds_since(start) < options.seconds) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1000));
    feed(server.port, random);
  }
  row.seconds = seconds_since(start);
  row.end = use_of(server.process);
  row.late = lateness(server.port);
  row.figures = Json::parse(ask(server.port, "GET", "/heads"), nullptr, false);
  row.bytes = viewers.bytes();
  ::kill(server.process, SIGTERM);
  int status = 0;
  ::waitpid(server.process, &status, 0);
  ::close(server.out);
  if (status != 0) std::fprintf(stderr, "the server ended with %d\n", status);
  return row;
}

int run(const Options& options) {
  std::printf(
      "| heads | CPU a head, %% of a core | CPU of all, cores | planes late, ms: 50 %%, 99 %% "
      "| memory, MB | a head, MB |\n|---|---|---|---|---|---|\n");
  double first_memory = 0;
  int first_heads = 0;
  for (const int heads : options.heads) {
    const Row row = measure(options, heads);
    if (!row.figures.is_object()) return 1;
    const double cores = (row.end.cpu - row.begin.cpu) / row.seconds;
    std::printf("| %d | %.2f | %.2f | %.1f, %.1f | %.0f | ", heads, 100 * cores / heads, cores,
                percentile(row.late_before, row.late, 0.5),
                percentile(row.late_before, row.late, 0.99), row.end.resident);
    if (first_heads > 0) {
      std::printf("%.2f |\n", (row.end.resident - first_memory) / (heads - first_heads));
    } else {
      std::printf("|\n");
      first_heads = heads;
      first_memory = row.end.resident;
    }
    std::fflush(stdout);
    std::int64_t spoken = 0, least = 1 << 30;
    for (const Json& head : row.figures["heads"]) {
      spoken += head["lines_spoken"].get<std::int64_t>();
      least = std::min(least, head["lines_spoken"].get<std::int64_t>());
    }
    const double made = row.figures["planes"].get<double>() / heads;
    std::fprintf(stderr,
                 "%.0f planes a head, %lld lines, the head with the fewest %lld; %lld bytes read, "
                 "%d awake\n",
                 made, static_cast<long long>(spoken), static_cast<long long>(least),
                 static_cast<long long>(row.bytes), row.figures["awake"].get<int>());
  }
  return 0;
}

}  // namespace
}  // namespace animeme::bench

int main(int argc, char** argv) {
  animeme::bench::Options options;
  CLI::App app("Prints the table of tools/live/serve/README.md");
  app.add_option("heads", options.heads, "Numbers of heads");
  app.add_option("--seconds", options.seconds, "To measure each of them");
  app.add_option("--watched", options.watched, "Every so many heads have a viewer");
  app.add_option("--effort", options.effort, "Of the encoder of sound, 0..10");
  CLI11_PARSE(app, argc, argv);
  return animeme::bench::run(options);
}
