/// @file
/// A web server with many presentations on one port, and a handler for other requests.
///
///     auto server = WebServer::open("http://127.0.0.1:8080/", {}, answer_requests);
///     auto sink = (*server)->make_sink("/heads/anna", [] { ... });   // a viewer has joined
///     (*sink)->start(info);            // http://127.0.0.1:8080/heads/anna/ shows the page
///     (*sink)->finish();               // ends it; the others stay
///
/// Each presentation has under its path what make_web_sink() serves at `/`. Other paths, and all
/// methods except GET and HEAD, go to the handler.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "tools/live/web/web.h"

namespace animeme::web {

/// A request for the handler.
struct ServerRequest {
  std::string method;         ///< "GET" (also for HEAD), "POST", "PUT", "DELETE"
  std::string path;           ///< as in the request line, without the query
  std::string authorization;  ///< value of that header, 512 bytes at most; empty: none
  std::string body;           ///< ServerOptions::most_body at most
};

/// A response.
struct ServerReply {
  unsigned status = 200;                  ///< of HTTP
  std::string body;                       ///< not empty; not sent for HEAD
  std::string type = "application/json";  ///< its media type
  int retry_after = 0;  ///< seconds after which to ask again, for 429 and 503; 0: not said
};

/// Sends the response; call once, from any thread. Ignored if the client or the server is gone.
using ServerAnswer = std::function<void(ServerReply)>;

/// Called in the server thread: it must not block, but may answer later.
using ServerHandler = std::function<void(ServerRequest, ServerAnswer)>;

/// All settings of WebServer.
struct ServerOptions {
  /// For all presentations together, except `packets_per_segment`. Up to 10000 viewers.
  /// `per_address` 0 also disables the limit of requests per address.
  WebOptions web;
  std::size_t most_body = 65536;  ///< bytes of a request; longer ones get 413
};

/// A web server with any number of presentations. Thread safe.
class WebServer {
 public:
  /// Starts listening and serving in a separate thread. Errors: as make_web_sink() and
  /// WebSink::start().
  static Result<std::unique_ptr<WebServer>> open(const std::string& url,
                                                 const ServerOptions& options,
                                                 ServerHandler handler);
  /// As finish(), without waiting. Sinks must be destroyed before.
  virtual ~WebServer() = default;

  virtual std::string address() const = 0;  ///< "http://127.0.0.1:8080/" with the real port
  /// A presentation under `path` ("/heads/anna"), from its start() to its finish(). `joined` is
  /// called in the server thread for each new viewer; it must not block. Errors of start(): also
  /// invalid_argument (the path is taken).
  virtual std::unique_ptr<WebSink> make_sink(const std::string& path,
                                             std::function<void()> joined) = 0;
  virtual int viewers() const = 0;  ///< of all presentations
  /// Sends all viewers their queue and the end, within two seconds, and stops serving. Sockets
  /// close with 1001, the server goes away: viewers connect again, to the server that comes after
  /// it.
  virtual void finish() = 0;
};

}  // namespace animeme::web
