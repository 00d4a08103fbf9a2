// Chromium without a window, driven over the pipes of its DevTools protocol: no port, no WebSocket,
// no driver. Linux.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/temp_dir.h"

namespace animeme::test {

class Chromium {
 public:
  using Json = nlohmann::json;

  /// Path of the browser, empty: there is none.
  static std::string find() {
    for (const char* path :
         {"/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"}) {
      if (access(path, X_OK) == 0) return path;
    }
    return {};
  }

  /// `flags`: instead of those that forbid sound without a click.
  explicit Chromium(const std::vector<std::string>& flags = {
                        "--autoplay-policy=user-gesture-required"}) {
    std::array<int, 2> in{}, out{};
    if (pipe2(in.data(), O_CLOEXEC) != 0 || pipe2(out.data(), O_CLOEXEC) != 0) return;
    child_ = fork();
    if (child_ == 0) run(in[0], out[1], flags);
    close(in[0]);
    close(out[1]);
    to_ = in[1];
    from_ = out[0];
    const Json target = call("Target.createTarget", {{"url", "about:blank"}});
    if (!target.contains("targetId")) return;
    const Json attached =
        call("Target.attachToTarget", {{"targetId", target["targetId"]}, {"flatten", true}});
    session_ = attached.value("sessionId", "");
    for (const char* part : {"Page.enable", "Runtime.enable", "Log.enable"}) call(part);
  }
  ~Chromium() {
    if (to_ >= 0) {
      call("Browser.close", {}, 5);
      close(to_);
      close(from_);
    }
    if (child_ > 0) {
      for (int i = 0; i < 100 && waitpid(child_, nullptr, WNOHANG) == 0; ++i) usleep(50000);
      kill(-child_, SIGKILL);  // its own group: helpers that stayed behind
      waitpid(child_, nullptr, WNOHANG);
    }
  }
  Chromium(const Chromium&) = delete;
  Chromium& operator=(const Chromium&) = delete;

  bool is_open() const { return !session_.empty(); }

  /// Result of a command; {"error": ...} if it fails or nothing comes.
  Json call(const std::string& method, const Json& parameters = Json::object(),
            double seconds = 90) {
    Json command{{"id", ++last_id_}, {"method", method}, {"params", parameters}};
    if (!session_.empty() && method.rfind("Browser.", 0) != 0) command["sessionId"] = session_;
    const std::string text = command.dump();
    if (write(to_, text.c_str(), text.size() + 1) != ssize_t(text.size() + 1)) {
      return {{"error", "the browser is gone"}};
    }
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end) {
      const Json message = take(0.5);
      if (message.is_null()) continue;
      if (message.value("id", 0) == last_id_) {
        return message.contains("result") ? message["result"] : Json{{"error", message["error"]}};
      }
      note(message);
    }
    return {{"error", "no answer to " + method}};
  }

  /// Value of an expression, promises awaited; as if somebody had clicked, or only looked.
  Json evaluate(const std::string& expression, bool click = true) {
    const Json result = call("Runtime.evaluate", {{"expression", expression},
                                                  {"awaitPromise", true},
                                                  {"returnByValue", true},
                                                  {"userGesture", click}});
    if (result.contains("exceptionDetails")) {
      complaints_.push_back(result["exceptionDetails"].dump());
    }
    return result.contains("result") && result["result"].contains("value")
               ? result["result"]["value"]
               : Json();
  }

  /// Opens an address with a window of this size, in CSS pixels.
  void open(const std::string& url, int width, int height, bool dark) {
    call("Emulation.setDeviceMetricsOverride",
         {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", width < 600}});
    call("Emulation.setEmulatedMedia",
         {{"features",
           Json::array({{{"name", "prefers-color-scheme"}, {"value", dark ? "dark" : "light"}}})}});
    call("Page.navigate", {{"url", url}});
    evaluate(
        "new Promise(done => document.readyState === 'complete' ? done() : "
        "addEventListener('load', done))",
        false);
  }

  /// As of a page that is drawn over something else.
  void make_background_transparent() {
    call("Emulation.setDefaultBackgroundColorOverride",
         {{"color", {{"r", 0}, {"g", 0}, {"b", 0}, {"a", 0}}}});
  }

  /// All of its processes stand still.
  void freeze(bool frozen) { kill(-child_, frozen ? SIGSTOP : SIGCONT); }

  void save_picture(const std::filesystem::path& path) {
    const Json result =
        call("Page.captureScreenshot", {{"format", "png"}, {"captureBeyondViewport", true}});
    std::filesystem::create_directories(path.parent_path());
    std::ofstream file(path, std::ios::binary);
    unsigned bits = 0;
    int count = 0;
    for (const char c : result.value("data", "")) {
      const std::string alphabet =
          "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
      const std::size_t value = alphabet.find(c);
      if (value == std::string::npos) break;
      bits = bits << 6 | unsigned(value);
      count += 6;
      if (count >= 8) file.put(char(bits >> (count -= 8) & 255));
    }
  }

  /// Errors on the console and exceptions so far.
  const std::vector<std::string>& complaints() const { return complaints_; }

 private:
  [[noreturn]] void run(int in, int out, const std::vector<std::string>& flags) {
    setpgid(0, 0);
    const int in_copy = fcntl(in, F_DUPFD, 10), out_copy = fcntl(out, F_DUPFD, 10);
    dup2(in_copy, 3);
    dup2(out_copy, 4);
    const int nothing = ::open("/dev/null", O_RDWR);
    for (const int handle : {0, 1, 2}) dup2(nothing, handle);
    close(in_copy);
    close(out_copy);
    const std::string browser = find(), data = "--user-data-dir=" + folder_.path().string();
    std::vector<const char*> line{browser.c_str(),
                                  "--headless",
                                  "--no-sandbox",
                                  "--disable-quic",
                                  "--no-first-run",
                                  "--disable-background-networking",
                                  "--disable-component-update",
                                  "--disable-sync",
                                  "--disable-dev-shm-usage",
                                  "--disable-extensions",
                                  "--disable-default-apps",
                                  "--remote-debugging-pipe",
                                  "--use-angle=swiftshader",
                                  "--enable-unsafe-swiftshader",
                                  "--ignore-gpu-blocklist",
                                  data.c_str()};
    for (const std::string& flag : flags) line.push_back(flag.c_str());
    line.push_back(nullptr);
    execv(browser.c_str(), const_cast<char* const*>(line.data()));
    _exit(127);
  }

  /// One message; null: none came in time.
  Json take(double seconds) {
    for (;;) {
      const std::size_t end = text_.find('\0');
      if (end != std::string::npos) {
        const Json message = Json::parse(text_.substr(0, end), nullptr, false);
        text_.erase(0, end + 1);
        return message.is_discarded() ? Json() : message;
      }
      pollfd ready{from_, POLLIN, 0};
      std::array<char, 65536> block{};
      if (poll(&ready, 1, int(seconds * 1000)) <= 0) return {};
      const ssize_t count = read(from_, block.data(), block.size());
      if (count <= 0) {
        usleep(100000);
        return {};
      }
      text_.append(block.data(), std::size_t(count));
    }
  }

  void note(const Json& message) {
    const std::string method = message.value("method", "");
    const bool console =
        method == "Runtime.consoleAPICalled" && message["params"].value("type", "") == "error";
    const bool log =
        method == "Log.entryAdded" && message["params"]["entry"].value("level", "") == "error";
    if (console || log || method == "Runtime.exceptionThrown") {
      complaints_.push_back(message["params"].dump());
    }
  }

  const TempDir folder_;  // its profile
  std::string session_, text_;
  pid_t child_ = -1;
  int to_ = -1, from_ = -1, last_id_ = 0;
  std::vector<std::string> complaints_;
};

}  // namespace animeme::test
