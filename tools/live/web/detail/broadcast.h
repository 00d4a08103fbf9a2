// One presentation of a server: what waits for its viewers, and what it says of itself.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "tools/formats/media/live/live.h"
#include "tools/live/web/detail/documents.h"
#include "tools/live/web/detail/hub.h"
#include "tools/live/web/peer_connections.h"

struct lws;

namespace animeme::web {

/// Its functions may be called from any thread, but for what is below `of the server`.
class Broadcast : public std::enable_shared_from_this<Broadcast> {
 public:
  using Touched = std::function<void(std::shared_ptr<Broadcast>)>;

  /// `sample_rate`: of `/audio` and `/talk.mp4`, 0: there is no sound. `touched` is called when
  /// something waits for viewers, or it is over; `joined` (or nothing) when there is a new one.
  Broadcast(int sample_rate, std::size_t client_bytes, bool catch_up, Touched touched,
            std::function<void()> joined)
      : sample_rate_(sample_rate),
        touched_(std::move(touched)),
        joined_(std::move(joined)),
        hub_(client_bytes, catch_up) {}

  void set_hello(Channel channel, Message hello);
  void set_info(std::string json);
  void publish(Channel channel, Message message);
  void forget_before(Channel channel, double time);
  void forget(Channel channel);
  /// Does anybody get this channel now?
  bool wanted(Channel channel) const;
  /// Receivers are those of a face or those of a sound, whichever are more; owners are none.
  media::SendStats stats() const;
  /// Viewers get the queued messages and the end; new viewers are refused. `goes_away`: it is the
  /// server that ends.
  void end(bool goes_away = false);
  /// True: all have gone.
  bool wait_until_empty(Hub::Clock::time_point instant);

  /// Who answers offers to `/whep`; null: nobody. Call before the server knows the broadcast.
  void set_peers(std::shared_ptr<PeerConnections> peers) { peers_ = std::move(peers); }
  const std::shared_ptr<PeerConnections>& peers() const { return peers_; }
  /// Somebody is about to watch.
  void expect() const {
    if (joined_) joined_();
  }

  // Of the server.
  int sample_rate() const { return sample_rate_; }
  DocumentPtr info() const;
  std::optional<ClientId> add(Channel channel);  ///< nothing: it is over
  void remove(ClientId client, Channel channel);
  struct Turn {
    MessagePtr message;
    bool more = false, over = false;  ///< behind it
    bool goes_away = false;           ///< over: the server ends
  };
  Turn next(ClientId client);
  enum class Need : std::uint8_t { nothing, to_write, to_go };
  /// Of a client: `to_go` if nothing was taken since `since`.
  Need need_of(ClientId client, Hub::Clock::time_point since) const;
  std::set<lws*> watching;  ///< for the thread of the server alone

 private:
  const int sample_rate_;
  const Touched touched_;
  const std::function<void()> joined_;
  std::shared_ptr<PeerConnections> peers_;
  mutable std::mutex mutex_;  // for what follows
  std::condition_variable changed_;
  Hub hub_;
  std::array<int, kChannels> clients_{};
  DocumentPtr info_ = std::make_shared<const Document>(Document{"{}", {}, {}});
  bool over_ = false, goes_away_ = false;
};

}  // namespace animeme::web
