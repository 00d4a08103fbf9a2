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
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "tools/live/web/web.h"

namespace animeme::web {

/// A request for the handler.
struct ServerRequest {
  std::string method;         ///< "GET" (also for HEAD), "POST", "PUT", "PATCH", "DELETE"
  std::string path;           ///< as in the request line, without the query
  std::string query;          ///< behind the "?", 512 bytes at most
  std::string authorization;  ///< value of that header, 512 bytes at most; empty: none
  std::string type;           ///< media type of the body, with its parameters; empty: not said
  std::int64_t length = 0;    ///< of the body, bytes; -1: not known
  std::string body;           ///< ServerOptions::most_body at most
  bool socket = false;        ///< it opens a WebSocket
};

/// A response.
struct ServerReply {
  unsigned status = 200;                  ///< of HTTP
  std::string body;                       ///< not empty; not sent for HEAD
  std::string type = "application/json";  ///< its media type
  std::string allow = {};                 ///< 405: methods that there are
  bool frames = false;                    ///< a page that shows others of this server in frames
  int retry_after = 0;  ///< seconds after which to ask again, for 429 and 503; 0: not said
};

/// Sends the response; call once, from any thread. Ignored if the client or the server is gone.
using ServerAnswer = std::function<void(ServerReply)>;

/// Called in the server thread: it must not block, but may answer later.
using ServerHandler = std::function<void(ServerRequest, ServerAnswer)>;

/// Takes what a client sends bit by bit: messages of a WebSocket, or a body of any length. Called
/// in the server thread; must not block.
class Intake {
 public:
  virtual ~Intake() = default;
  /// A whole message (`text`: of text) of a socket, or the next bytes of a body.
  virtual void take(std::string bytes, bool text) = 0;
  /// Whether no more is to be read from the client for now; asked again every 0.25 s.
  virtual bool full() const = 0;
  /// The body is complete (true: an answer is expected now), or the client has gone.
  virtual void end(bool whole) = 0;
};

/// Who takes what comes by a request; null: it is a request for the handler. Errors refuse a
/// socket: not_found with 404, others with 401; requests go to the handler. Of a socket each answer
/// is a message of text with its body, and there may be any number of them; its client also gets
/// what WebSink::tell_owner() says at the path of the request without its last part. Called in the
/// server thread; must not block.
using IntakeHandler =
    std::function<Result<std::shared_ptr<Intake>>(const ServerRequest&, ServerAnswer)>;

/// All settings of WebServer.
struct ServerOptions {
  /// For all presentations together, except `packets_per_segment`. Up to 10000 viewers.
  /// `per_address` 0 also disables the limit of requests per address.
  WebOptions web;
  std::size_t most_body = 65536;  ///< bytes of a request; longer ones get 413
  /// For requests and sockets at paths that end with "/say"; empty: there are none.
  IntakeHandler intake = nullptr;
  std::size_t most_message = std::size_t(1) << 20;  ///< bytes of a message of its sockets
  /// Whether a request for a face, a sound or what is told of them is granted; called in the server
  /// thread. If it is given, all such requests without a right get the same answer (403), whether
  /// the presentation exists or not, and the files of the page, which are the same for all, are
  /// served at all paths that could be those of a presentation. Empty: everybody may watch.
  std::function<bool(const ServerRequest&)> may_watch = nullptr;
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
  /// called in the server thread for each new viewer; it must not block. `head`: the name of that
  /// of the heads of WebOptions which its page shows first; empty: the first one. Errors of
  /// start(): also invalid_argument (the path is taken).
  virtual std::unique_ptr<WebSink> make_sink(const std::string& path, std::function<void()> joined,
                                             const std::string& head = {}) = 0;
  virtual int viewers() const = 0;  ///< of all presentations
  /// Sends all viewers their queue and the end, within two seconds, and stops serving. Sockets
  /// close with 1001, the server goes away: viewers connect again, to the server that comes after
  /// it.
  virtual void finish() = 0;
};

}  // namespace animeme::web
