/// @file
/// Many talking heads on one port, controlled by HTTP requests.
///
///     auto server = serve::HeadServer::open({.url = "http://127.0.0.1:8080/"}, {});
///     (*server)->make("anna", {});         // as PUT /heads/anna does
///     while (!stopped) (*server)->look();  // once a second
///     (*server)->finish();
///
/// tools/live/serve/requests.md documents the requests.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tools/live/serve/head.h"
#include "tools/live/serve/settings.h"
#include "tools/live/serve/tickets.h"
#include "tools/live/serve/voices.h"
#include "tools/live/web/web_server.h"

namespace animeme::serve {

/// All settings of HeadServer.
struct ServerOptions {
  std::string url = "http://127.0.0.1:8080/";  ///< where to listen, as make_web_sink() takes it
  web::WebOptions web;                         ///< of all heads together
  /// Token required as "Authorization: Bearer TOKEN" for requests other than viewers'; empty: none.
  std::string token;
  int most_heads = 200;  ///< maximum number of heads, 1..10000
  /// Seconds that a head created by a request sleeps before it is deleted; 0: never.
  double expire = 900;
  double most_seconds = 1800;                     ///< of speech that may wait for a head, 1 or more
  std::size_t most_bytes = std::size_t(4) << 20;  ///< of text that may wait for all of them
  bool make_on_say = false;                       ///< saying something to a missing head creates it
  HeadSettings defaults;                          ///< defaults for heads
  std::map<std::string, std::string> models;      ///< files of models, by name
  std::map<std::string, std::string> tts;         ///< commands as speech::VoiceCommand, by name
  /// Viewers need the token or a ticket (tickets.h); with a token alone.
  bool guard_viewers = false;
  /// Performances that heads may keep under their speech, by name.
  std::map<std::string, std::shared_ptr<const dam::Performance>> performances;
  int threads = 0;  ///< for generating planes and packets; 0: one per core
  MakerOf voices;   ///< empty: speech::voice_lines()
  Log log;          ///< receives requests, heads and lines; empty: nobody
};

/// Thread safe.
class HeadServer {
 public:
  /// Starts serving. `heads` exist from the start and never expire. Errors: those of
  /// WebServer::open() and make(); invalid_argument (options).
  static Result<std::unique_ptr<HeadServer>> open(
      const ServerOptions& options, const std::vector<std::pair<std::string, HeadSettings>>& heads);
  ~HeadServer();
  HeadServer(const HeadServer&) = delete;
  HeadServer& operator=(const HeadServer&) = delete;

  /// Takes other settings for what comes from now on: token, limits (`most_heads`, `expire`,
  /// `most_seconds`, `most_bytes`), `make_on_say`, `defaults`, models (whose files are read anew),
  /// commands of voices, performances. All others stay, and so do the heads that there are, with
  /// their own limits. Errors: as open() (options); then nothing has changed.
  Result<void> change(const ServerOptions& options);
  std::string address() const { return server_->address(); }  ///< with the real port
  /// Changes a head: without an interruption where only with_live_parts() differ, else it is made
  /// anew, its lines are cancelled and its viewers come back. Errors: not_found, those of make().
  Result<void> update(const std::string& name, const HeadSettings& settings);
  /// Creates a head, or returns an existing one with these settings. Errors: invalid_argument (the
  /// name; settings; the name exists with other settings), out_of_range (too many heads), those of
  /// Head::open() and read_model(). `expires`: whether ServerOptions::expire applies.
  Result<std::shared_ptr<Head>> make(const std::string& name, const HeadSettings& settings,
                                     bool expires = true);
  std::shared_ptr<Head> find(const std::string& name) const;  ///< null: not found
  bool remove(const std::string& name);                       ///< false: not found
  /// No new heads and lines from now on: they are refused with 503, as /ready is. What was accepted
  /// is still spoken.
  void drain();
  /// Nothing is said, and nothing waits to be said.
  bool silent() const;
  /// Deletes heads that have slept too long, and looks whether planes are late; call once a second.
  void look();
  /// Cancels what is left to say, with events, tells all viewers to come back (1001), and stops
  /// serving; takes at most two seconds.
  void finish();
  tools::Json figures() const;  ///< GET /heads
  std::string metrics() const;  ///< GET /metrics, in the text format of Prometheus

 private:
  struct Kept {
    std::shared_ptr<Head> head;
    bool expires = true;
  };
  explicit HeadServer(const ServerOptions& options);

  // Requests that wait for a thread of their own: those that make heads wait for voices and models,
  // others for nothing.
  struct Desk {
    std::deque<std::function<void()>> jobs;
    std::condition_variable changed;
    std::thread thread;
  };
  void ask(web::ServerRequest request, web::ServerAnswer answer);
  Result<std::shared_ptr<web::Intake>> open_intake(const web::ServerRequest& request,
                                                   web::ServerAnswer answer);
  bool may_watch(const web::ServerRequest& request) const;
  void post(std::function<void()> job);
  void work(Desk& desk);
  bool makes_a_head(const web::ServerRequest& request) const;
  web::ServerReply health() const;
  web::ServerReply ready() const;
  bool draining() const;
  void look_at_lateness();
  web::ServerReply answer(const web::ServerRequest& request);
  web::ServerReply answer_head(const web::ServerRequest& request, const std::string& name);
  web::ServerReply put(const std::string& name, const std::string& method, const std::string& body);
  web::ServerReply ticket(const std::string& name, const std::string& body) const;
  web::ServerReply make_for_request(const std::string& name, const HeadSettings& settings);
  web::ServerReply say(const std::string& name, const std::string& body);
  bool allowed(const web::ServerRequest& request) const;
  Result<std::shared_ptr<const dam::Model>> model(const std::string& name);
  struct Voice {
    speech::LineMaker maker;
    bool slow = false;
  };
  Result<Voice> voice(const HeadSettings& settings);
  Result<std::shared_ptr<Head>> open_head(const std::string& name, const HeadSettings& settings);
  Result<void> check(const HeadSettings& settings) const;
  void end(const std::shared_ptr<Head>& head, bool comes_back = false);
  Result<std::shared_ptr<const dam::Performance>> performance(const std::string& name) const;
  std::vector<std::pair<std::string, std::shared_ptr<Head>>> all() const;

  std::shared_ptr<const ServerOptions> options() const {  // as of the last change()
    const std::lock_guard lock(options_mutex_);
    return options_;
  }

  mutable std::mutex options_mutex_;
  std::shared_ptr<const ServerOptions> options_;
  Journal journal_;
  const double begun_ = media::steady_clock().now();
  std::map<std::string, std::shared_ptr<const dam::Model>> models_;  // with making_
  std::unique_ptr<Voices> voices_;
  std::unique_ptr<ClockLoop> loop_;
  std::unique_ptr<web::WebServer> server_;

  std::mutex making_;         // one head at a time
  mutable std::mutex mutex_;  // for what follows
  std::map<std::string, Kept> heads_;
  std::size_t most_ = 0;            // heads at the same time
  media::LatenessMeter gone_late_;  // of heads that have gone
  std::int64_t gone_planes_ = 0;
  bool stopping_ = false, draining_ = false;
  bool late_ = false;  // one plane of a hundred comes more than 0.1 s late
  struct Planes {
    std::int64_t all = 0, late = 0;
  };
  std::deque<Planes> seconds_;  // so far, at the end of each of the last seconds
  Desk others_, makers_;
  std::uint64_t sounds_ = 0;                    // that got a name
  std::atomic<std::size_t> sound_waiting_ = 0;  // bytes of all heads, as of the last look()
};

}  // namespace animeme::serve
