// The HTTP and WebSocket server: which address gives what, and to whom.
#pragma once

#include <atomic>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "fap/result.h"
#include "tools/web/detail/address.h"
#include "tools/web/detail/headers.h"
#include "tools/web/detail/hub.h"
#include "tools/web/detail/requests.h"
#include "tools/web/detail/service.h"
#include "tools/web/detail/visitors.h"
#include "tools/web/web.h"

namespace animeme::web {

/// One connection, from its first request on.
struct Session {
  Resource resource = Resource::none;
  bool open = false;  // a WebSocket or /talk.mp4 with a place in the hub
  ClientId client = 0;
  DocumentPtr document;  // that is being sent
  bool packed = false;   // in its form of gzip
  std::size_t at = 0;
  std::size_t received = 0;
  std::int64_t begin = -1;  // of /talk.mp4: time of its first segment, in samples
  // Of /whep: what was posted, by which number the answer comes, and who else may read it.
  std::string upload, origin;
  std::uint64_t ticket = 0;
  std::optional<PeerAnswer> answer;
};

class Server {
 public:
  /// Listens. `sample_rate`: of `/audio` and `/talk.mp4`, 0: there is no sound. Errors: io,
  /// invalid_argument (more viewers than files may be open).
  static Result<std::unique_ptr<Server>> listen(const WebAddress& address,
                                                const WebOptions& options, int sample_rate);
  ~Server() { stop(); }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  int port() const { return port_; }
  /// From now on clients are served, in a thread. The first of them is to find everything: who
  /// comes before waits.
  void serve() { service_.run(); }

  /// Who answers `/whep`; before serve(). nullptr: nobody, there is none.
  void set_peers(std::shared_ptr<Peers> peers) { peers_ = std::move(peers); }

  // All of these may be called from any thread.
  void set_hello(Channel channel, Message hello);
  void set_info(std::string json);
  void publish(Channel channel, Message message);
  void forget_before(Channel channel, double time);
  media::SendStats stats() const;

  /// Lets the clients have what waits for them, for two seconds at most, and says goodbye.
  void finish();

 private:
  Server(const WebAddress& address, const WebOptions& options, int sample_rate);
  void stop();
  static int callback(lws* wsi, lws_callback_reasons reason, void* user, void* in, size_t size);
  int handle(lws* wsi, lws_callback_reasons reason, const char* in, std::size_t size);
  bool exists(Resource resource) const;
  unsigned objection(lws* wsi, const Request& request);
  std::string shared_with(const Request& request) const;
  bool admit(lws* wsi, Session& session);
  int refuse(lws* wsi, const Request& request, unsigned status);
  int request(lws* wsi);
  int serve(lws* wsi, const Request& request, Resource resource);
  int talk(lws* wsi, const Request& request);
  int upgrade(lws* wsi);
  int whep(lws* wsi, const Request& request);
  int whep_body(lws* wsi, const char* bytes, std::size_t size);
  int whep_offer(lws* wsi);
  int whep_answer(lws* wsi, Session& session);
  int whep_reply(lws* wsi, Answer answer, const std::string& text);
  void hand_out_answers();
  int write_body(lws* wsi, Session& session);
  int transaction_over(lws* wsi);
  bool send_message(lws* wsi, Session& session, const Message& message);
  int write_message(lws* wsi, Session& session);
  void look_around();
  void keep_looking();
  void disconnect_overdue();
  void leave(lws* wsi);

  const WebOptions options_;
  const int sample_rate_;  // of the sound, 0: there is none
  const OwnNames names_;
  std::map<Resource, DocumentPtr> documents_;  // but for info.json
  std::shared_ptr<Peers> peers_;
  Service service_;
  int port_ = 0;

  mutable std::mutex mutex_;  // for what follows
  std::condition_variable changed_;
  Hub hub_;
  DocumentPtr info_;
  bool finishing_ = false;
  std::map<std::uint64_t, PeerAnswer> answers_;  // by ticket

  // Of the service thread alone.
  struct Timer {
    lws_sorted_usec_list_t entry{};
    Server* server = nullptr;
  } timer_;
  std::map<lws*, Session> sessions_;
  std::uint64_t tickets_ = 0;
  Visitors visitors_;
  std::string entering_;  // address of the connection that is just being accepted

  std::atomic<int> viewers_ = 0;
};

}  // namespace animeme::web
