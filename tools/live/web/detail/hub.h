// Who gets which message: what waits for each client, what new ones get first, and what is thrown
// away when one is too slow. Knows nothing of sockets. Not thread safe.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "codec/encode/fan_out.h"

namespace animeme::web {

// planes: /faps?binary; sent: /face?as-sent; owner: /say
enum class Channel : std::uint8_t { face, faps, planes, audio, sent, owner };
inline constexpr std::size_t kChannels = 6;

struct Message {
  std::vector<std::uint8_t> bytes;
  bool text = false;
  bool entry = false;  ///< a client can begin, or go on after a loss, with this one
  double time = 0;     ///< seconds on the clock of the segments
};
using MessagePtr = std::shared_ptr<const Message>;

using ClientId = std::uint64_t;

class Hub {
 public:
  using Clock = std::chrono::steady_clock;

  /// `client_bytes`, `catch_up`: as WebOptions.
  Hub(std::size_t client_bytes, bool catch_up) : client_bytes_(client_bytes), catch_up_(catch_up) {}

  /// The first message of each new client of this channel; that of the face is that of the units as
  /// sent, too.
  void set_hello(Channel channel, Message hello);
  /// Binary messages of the face are units (messages.h). Clients of the face get them coded for
  /// themselves: an intra plane first, and no others but those that are needed (fan_out.h); those
  /// of Channel::sent get them as they are. So does everybody where they cannot be decoded.
  void publish(Channel channel, Message message);
  /// Newcomers need nothing that lies in front of this time.
  void forget_before(Channel channel, double time);
  /// Newcomers get nothing that was published so far.
  void forget(Channel channel);

  ClientId add(Channel channel);
  void remove(ClientId client);
  /// Next message for the client, nullptr: nothing waits.
  MessagePtr next(ClientId client);
  bool waiting(ClientId client) const;
  /// Has something been waiting since before `since` without one being taken?
  bool stalled(ClientId client, Clock::time_point since) const;

  std::size_t clients() const { return clients_.size(); }
  std::int64_t dropped() const { return dropped_; }
  std::int64_t messages() const { return messages_; }  ///< handed out
  std::int64_t bytes() const { return bytes_; }        ///< handed out

 private:
  struct Client {
    Channel channel = Channel::face;
    std::deque<MessagePtr> queue;
    std::size_t bytes = 0;
    bool waits_for_entry = false;
    bool missed = false;
    Clock::time_point taken;  // or nothing was waiting
  };
  struct Feed {
    MessagePtr hello;
    std::deque<MessagePtr> recent;  // what newcomers get
    std::size_t bytes = 0;
  };

  void push(Client& client, const MessagePtr& message);
  void push_coded(ClientId id, Client& client, const MessagePtr& message);
  bool add_coded(ClientId id, Client& client);
  void follow(const MessagePtr& message);
  void keep(Feed& feed, Channel channel, const MessagePtr& message);

  std::size_t client_bytes_;
  bool catch_up_;
  std::array<Feed, kChannels> feeds_;
  std::map<ClientId, Client> clients_;
  std::optional<fba::FanOut> fan_out_;  // while there are clients of the face
  // Of its newest unit, by the address of the bytes that FanOut gives: one for all that share them.
  std::map<const std::uint8_t*, MessagePtr> coded_;
  ClientId last_id_ = 0;
  std::int64_t dropped_ = 0, messages_ = 0, bytes_ = 0;
};

}  // namespace animeme::web
