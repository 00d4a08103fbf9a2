/// @file
/// Many talking heads on one port, made and told what to say by HTTP requests.
///
///     auto server = serve::HeadServer::open({.url = "http://127.0.0.1:8080/"}, {});
///     (*server)->make("anna", {});         // as PUT /heads/anna does
///     while (!stopped) (*server)->look();  // once a second
///     (*server)->finish();
///
/// Which requests there are stands in tools/live/serve/README.md.
#pragma once

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
#include "tools/live/serve/voices.h"
#include "tools/live/web/web_server.h"

namespace animeme::serve {

/// All settings of HeadServer.
struct ServerOptions {
  std::string url = "http://127.0.0.1:8080/";  ///< where to listen, as make_web_sink() takes it
  web::WebOptions web;                         ///< of all heads together
  /// What requests other than viewers' must bring as "Authorization: Bearer TOKEN"; empty: nothing.
  std::string token;
  int most_heads = 200;  ///< 1..10000; more are refused
  /// Seconds that a head made by a request sleeps before it is forgotten; 0: it stays.
  double expire = 900;
  bool make_on_say = false;                   ///< what is said to a head that is not there makes it
  HeadSettings defaults;                      ///< of heads that say nothing else
  std::map<std::string, std::string> models;  ///< files of models, by name
  int threads = 0;                            ///< that make planes and packets; 0: one a core
  MakerOf voices;                             ///< nothing: speech::voice_lines()
};

/// Thread safe.
class HeadServer {
 public:
  /// Serves from now on. `heads`: that are there from the beginning, and never forgotten. Errors:
  /// those of WebServer::open() and make(); invalid_argument (options).
  static Result<std::unique_ptr<HeadServer>> open(
      const ServerOptions& options, const std::vector<std::pair<std::string, HeadSettings>>& heads);
  ~HeadServer();
  HeadServer(const HeadServer&) = delete;
  HeadServer& operator=(const HeadServer&) = delete;

  std::string address() const { return server_->address(); }  ///< with the real port
  /// A head that is not there yet; or is, with these settings. Errors: invalid_argument (the name;
  /// settings; one of this name has others), out_of_range (too many heads), those of Head::open()
  /// and read_model(). `expires`: ServerOptions::expire is for it.
  Result<std::shared_ptr<Head>> make(const std::string& name, const HeadSettings& settings,
                                     bool expires = true);
  std::shared_ptr<Head> find(const std::string& name) const;  ///< null: there is none
  bool remove(const std::string& name);                       ///< false: there is none
  void look();    ///< forgets heads that have slept too long; to be called once a second
  void finish();  ///< all viewers are told, nothing is served any more; two seconds at most
  tools::Json figures() const;  ///< GET /heads
  std::string metrics() const;  ///< GET /metrics, in the text format of Prometheus

 private:
  struct Kept {
    std::shared_ptr<Head> head;
    bool expires = true;
  };
  struct Asked {
    web::ServerRequest request;
    web::ServerAnswer answer;
  };
  explicit HeadServer(const ServerOptions& options);

  void ask(web::ServerRequest request, web::ServerAnswer answer);
  void answer_all();
  web::ServerReply answer(const web::ServerRequest& request);
  web::ServerReply answer_head(const web::ServerRequest& request, const std::string& name);
  web::ServerReply put(const std::string& name, const std::string& body);
  web::ServerReply say(const std::string& name, const std::string& body);
  bool allowed(const web::ServerRequest& request) const;
  Result<std::shared_ptr<const dam::Model>> model(const std::string& name);
  HeadRoom room() { return {*voices_, *server_, *loop_, media::steady_clock()}; }
  void end(const std::shared_ptr<Head>& head);
  std::vector<std::pair<std::string, std::shared_ptr<Head>>> all() const;

  const ServerOptions options_;
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
  std::deque<Asked> asked_;
  bool stopping_ = false;
  std::condition_variable changed_;
  std::thread answering_;
};

}  // namespace animeme::serve
