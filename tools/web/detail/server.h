// The HTTP and WebSocket server: which address gives what, and to whom.
#pragma once

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "fap/result.h"
#include "tools/web/detail/address.h"
#include "tools/web/detail/hub.h"
#include "tools/web/detail/requests.h"
#include "tools/web/detail/service.h"
#include "tools/web/web.h"

namespace animeme::web {

/// One connection, from its first request on.
struct Session {
  Resource resource = Resource::none;
  bool open = false;  // a WebSocket or /talk.mp4 with a place in the hub
  ClientId client = 0;
  std::string body;  // of a page, what is left of it
  std::size_t at = 0;
  std::size_t received = 0;
  std::int64_t begin = -1;  // of /talk.mp4: time of its first segment, in samples
};

class Server {
 public:
  /// Listens and serves in a thread. `sample_rate`: of `/audio` and `/talk.mp4`, 0: there is no
  /// sound. Errors: io.
  static Result<std::unique_ptr<Server>> listen(const WebAddress& address,
                                                const WebOptions& options, int sample_rate);
  ~Server() { service_.stop(); }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  int port() const { return port_; }

  // All of these may be called from any thread.
  void set_hello(Channel channel, Message hello);
  void set_info(std::string json);
  void publish(Channel channel, Message message);
  void forget_before(Channel channel, double time);
  media::SendStats stats() const;

  /// Lets the clients have what waits for them, for two seconds at most, and says goodbye.
  void finish();

 private:
  Server(const WebOptions& options, int sample_rate);
  static int callback(lws* wsi, lws_callback_reasons reason, void* user, void* in, size_t size);
  int handle(lws* wsi, lws_callback_reasons reason, const char* in, std::size_t size);
  bool exists(Resource resource) const;
  bool admit(Session& session);
  int refuse(lws* wsi, unsigned status);
  int request(lws* wsi, const std::string& path);
  int upgrade(lws* wsi);
  int write_body(lws* wsi, Session& session);
  bool send_message(lws* wsi, Session& session, const Message& message);
  int write_message(lws* wsi, Session& session);
  void look_around();
  void leave(lws* wsi);

  const WebOptions options_;
  const int sample_rate_;  // of the sound, 0: there is none
  const std::string page_;
  Service service_;
  int port_ = 0;

  mutable std::mutex mutex_;  // for what follows
  std::condition_variable changed_;
  Hub hub_;
  std::string info_;
  bool finishing_ = false;

  std::map<lws*, Session> sessions_;  // of the service thread alone
};

}  // namespace animeme::web
