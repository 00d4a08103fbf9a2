// The HTTP and WebSocket server: which address gives what, and to whom.
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "fap/result.h"
#include "tools/live/web/detail/address.h"
#include "tools/live/web/detail/broadcast.h"
#include "tools/live/web/detail/chunk_reader.h"
#include "tools/live/web/detail/connection_limiter.h"
#include "tools/live/web/detail/headers.h"
#include "tools/live/web/detail/requests.h"
#include "tools/live/web/detail/service.h"
#include "tools/live/web/web.h"
#include "tools/live/web/web_server.h"

namespace animeme::web {

/// A request that a ServerHandler answers.
struct Exchange {
  lws* wsi = nullptr;  // its connection; null: that has gone
  ServerRequest request;
  bool with_body = true;  // not HEAD
  bool last = false;      // of its connection
  bool socket = false;    // answers are messages
};

/// What was answered, until the server looks. Answers may come when that has gone.
struct Answers {
  std::mutex mutex;
  Service* service = nullptr;  // to be woken
  std::vector<std::pair<std::shared_ptr<Exchange>, ServerReply>> given;
};

/// One connection, from its first request on.
struct Session {
  Resource resource = Resource::none;
  std::shared_ptr<Broadcast> broadcast;  // whose resource it is
  std::shared_ptr<Exchange> exchange;
  std::optional<ServerReply> reply;  // of it
  bool small = false;                // /faps?binary
  bool as_sent = false;              // /face?as-sent
  bool open = false;                 // a WebSocket or /talk.mp4 with a place in the hub
  ClientId client = 0;
  DocumentPtr document;  // that is being sent
  bool packed = false;   // in its form of gzip
  std::size_t at = 0;
  std::function<int()> late;  // answers a request for a head that is still being made
  std::size_t received = 0;
  std::int64_t begin = -1;  // of /talk.mp4: time of its first segment, in samples
  // Of /whep: what was posted, by which number the answer comes, and who else may read it.
  std::string upload, origin;
  std::uint64_t ticket = 0;
  std::optional<PeerAnswer> answer;
  std::string path;  // of its broadcast
  // Of /say: who takes what comes, and what waits for the client alone.
  std::shared_ptr<Intake> intake;
  std::string message;  // that has begun
  std::deque<std::string> told;
  std::optional<ChunkReader> chunks;  // of a body in chunks
  bool whole = false;                 // the body is complete
  bool body_over = false;             // likewise, as libwebsockets said
  bool paused = false;                // nothing is read
  Hub::Clock::time_point heard = Hub::Clock::now();
};

/// What the program around the server is told of a request, without its body.
ServerRequest head_of(const Request& request, bool socket);

class Server {
 public:
  /// Listens. `handler`: for what is no resource of a broadcast; nothing: that is refused. Errors:
  /// io, invalid_argument (more viewers than files may be open).
  static Result<std::unique_ptr<Server>> listen(const WebAddress& address,
                                                const ServerOptions& options,
                                                ServerHandler handler);
  ~Server() { stop(); }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  int port() const { return port_; }
  /// From now on clients are served, in a thread. The first of them is to find everything: who
  /// comes before waits.
  void serve();

  // All of these may be called from any thread.
  /// A broadcast without a path yet. `joined` may be empty.
  std::shared_ptr<Broadcast> make_broadcast(int sample_rate, std::function<void()> joined);
  /// Its resources lie below `path`, "" for all paths. False: there is one already.
  bool open(const std::string& path, const std::shared_ptr<Broadcast>& broadcast);
  /// Removes it; its viewers get the queued messages and the end. `comes_back`: with 1001.
  void close(const std::string& path, bool comes_back = false);
  int viewers() const { return viewers_; }

  /// Lets the clients have what waits for them, for two seconds at most, and says goodbye.
  /// `goes_away`: with 1001, which viewers take for a reason to come back.
  void finish(bool goes_away = false);

 private:
  Server(const WebAddress& address, const ServerOptions& options, ServerHandler handler);
  void stop();
  void finish_peers(bool over);
  static int callback(lws* wsi, lws_callback_reasons reason, void* user, void* in, size_t size);
  int handle(lws* wsi, lws_callback_reasons reason, const char* in, std::size_t size);
  struct Place {
    std::shared_ptr<Broadcast> broadcast;
    std::string path;  // below it
    Resource resource = Resource::none;
    std::string above = {};  // its own path
  };
  Place place_of(const std::string& path) const;
  bool exists(const Place& place) const;
  unsigned objection(lws* wsi, const Request& request);
  bool may_watch(const Request& request, bool socket) const;
  bool is_open_document(const Request& request) const;
  bool begin_intake(lws* wsi, const Request& request);
  int take_block(lws* wsi, Session& session, const char* bytes, std::size_t size);
  int open_intake(lws* wsi, const Request& request, const Place& place);
  int take_message(lws* wsi, const char* bytes, std::size_t size);
  void look_at_intakes();
  ServerAnswer answer_to(std::shared_ptr<Exchange> exchange) const;
  std::string shared_with(const Request& request) const;
  bool may_deflate(lws* wsi) const;
  bool admit(lws* wsi, Session& session);
  int refuse(lws* wsi, const Request& request, unsigned status);
  int request(lws* wsi);
  int begin_exchange(lws* wsi, const Request& request);
  int take_body(lws* wsi, const char* bytes, std::size_t size);
  int ask_handler(lws* wsi);
  int write_reply(lws* wsi, Session& session);
  int serve(lws* wsi, const Request& request, const Place& place);
  int serve_late(Session& session);
  void take_late_head();
  int talk(lws* wsi, const Request& request, const Place& place);
  int upgrade(lws* wsi);
  bool waits_for_peer_connections(lws* wsi) const;
  int whep(lws* wsi, const Request& request, const Place& place);
  int whep_body(lws* wsi, const char* bytes, std::size_t size);
  int whep_offer(lws* wsi);
  int whep_answer(lws* wsi, Session& session);
  int whep_reply(lws* wsi, Answer answer, const std::string& text);
  void hand_out_answers();
  int write_body(lws* wsi, Session& session);
  int body_over(lws* wsi);
  int transaction_over(lws* wsi);
  bool send_message(lws* wsi, Session& session, const Message& message);
  int write_message(lws* wsi, Session& session);
  void look_at(const Broadcast& broadcast, Hub::Clock::time_point since);
  void look_around();
  void look_at_news();
  void keep_looking();
  void disconnect_overdue();
  void leave(lws* wsi);

  const WebOptions options_;
  const std::size_t most_body_;
  const ServerHandler handler_;
  const IntakeHandler intake_;
  const std::size_t most_message_;
  const std::function<bool(const ServerRequest&)> may_watch_;
  const OwnNames names_;
  const std::string frames_;  // where the page may be in a frame
  // By path, but for info.json. Null: it is still being made.
  std::map<std::string, DocumentPtr> documents_;
  Service service_;
  std::thread head_maker_;
  int port_ = 0;
  const std::shared_ptr<Answers> answers_ = std::make_shared<Answers>();

  mutable std::mutex mutex_;  // for what follows
  std::map<std::string, std::shared_ptr<Broadcast>, std::less<>> broadcasts_;
  std::vector<std::shared_ptr<Broadcast>> touched_;  // since the thread has looked
  bool finishing_ = false;
  std::optional<DocumentPtr> late_head_;  // that has just been made; null: there is none
  std::map<std::uint64_t, PeerAnswer> peer_answers_;  // by ticket

  // Of the service thread alone.
  struct Timer {
    lws_sorted_usec_list_t entry{};
    Server* server = nullptr;
  } timer_;
  std::map<lws*, Session> sessions_;
  std::uint64_t tickets_ = 0;
  ConnectionLimiter limiter_;
  std::string entering_;  // address of the connection that is just being accepted

  std::atomic<int> viewers_ = 0;
};

}  // namespace animeme::web
