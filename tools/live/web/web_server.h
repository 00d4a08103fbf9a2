/// @file
/// Many presentations on one port, and what a program answers to other requests there.
///
///     auto server = WebServer::open("http://127.0.0.1:8080/", {}, answer_requests);
///     auto sink = (*server)->make_sink("/heads/anna", [] { ... });   // a viewer has come
///     (*sink)->start(info);            // http://127.0.0.1:8080/heads/anna/ shows the page
///     (*sink)->finish();               // and is gone; the others stay
///
/// Each has below its path what make_web_sink() offers at `/`. What lies below no such path, and
/// all methods but GET and HEAD, go to the function that the server was opened with.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "tools/live/web/web.h"

namespace animeme::web {

/// A request that is no viewer's.
struct ServerRequest {
  std::string method;         ///< "GET" (also for HEAD), "POST", "PUT", "DELETE"
  std::string path;           ///< as in the request line, without the query
  std::string authorization;  ///< value of that header, 512 bytes at most; empty: none
  std::string body;           ///< ServerOptions::most_body at most
};

/// What is answered.
struct ServerReply {
  unsigned status = 200;                  ///< of HTTP
  std::string body;                       ///< never empty, but see HEAD
  std::string type = "application/json";  ///< its media type
};

/// Gives the answer, from any thread, once. If nobody waits for it any more, it is dropped; after
/// the end of the server, too.
using ServerAnswer = std::function<void(ServerReply)>;

/// Called in the thread that serves all viewers: it must not wait, but may answer later.
using ServerHandler = std::function<void(ServerRequest, ServerAnswer)>;

/// All settings of WebServer.
struct ServerOptions {
  /// Of all presentations together, but for `packets_per_segment`, which each has. Up to 10000
  /// viewers. `per_address` 0 also lifts the limit of requests that an address may make.
  WebOptions web;
  std::size_t most_body = 65536;  ///< bytes of a request; longer ones get 413
};

/// A web server with any number of presentations. Thread safe.
class WebServer {
 public:
  /// Listens and serves from now on, in a thread of its own. Errors: as make_web_sink() and
  /// WebSink::start().
  static Result<std::unique_ptr<WebServer>> open(const std::string& url,
                                                 const ServerOptions& options,
                                                 ServerHandler handler);
  /// As finish(), without its patience. Sinks must be gone before.
  virtual ~WebServer() = default;

  virtual std::string address() const = 0;  ///< "http://127.0.0.1:8080/" with the real port
  /// A presentation below `path` ("/heads/anna"), from its start() to its finish(). `joined` is
  /// called, in the thread of the server, when it has one more viewer; it must not wait. Errors of
  /// start(): also invalid_argument (the path is taken).
  virtual std::unique_ptr<WebSink> make_sink(const std::string& path,
                                             std::function<void()> joined) = 0;
  virtual int viewers() const = 0;  ///< of all presentations
  /// All viewers get what waits for them and are told that it is over, for two seconds at most.
  /// Nobody is served after it.
  virtual void finish() = 0;
};

}  // namespace animeme::web
