// The HTTP and WebSocket server: which address gives what, and to whom.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "fap/result.h"
#include "tools/web/detail/address.h"
#include "tools/web/detail/hub.h"
#include "tools/web/web.h"

namespace animeme::web {

/// What `/audio` and `/talk.mp4` have; sample_rate 0: there is no sound.
struct SoundFacts {
  int sample_rate = 0;
};

class Server {
 public:
  /// Listens and serves in a thread. Errors: io.
  static Result<std::unique_ptr<Server>> listen(const WebAddress& address,
                                                const WebOptions& options, SoundFacts sound);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  int port() const;

  // All of these may be called from any thread.
  void set_hello(Channel channel, Message hello);
  void set_info(std::string json);
  void publish(Channel channel, Message message);
  void forget_before(Channel channel, double time);
  media::SendStats stats() const;

  /// Lets the clients have what waits for them, for two seconds at most, and says goodbye.
  void finish();

 private:
  struct Impl;
  explicit Server(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::web
