#include "tools/live/web/detail/hub.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "tools/live/web/detail/messages.h"

namespace animeme::web {
namespace {

// More than that since the last intra plane: the newcomer had better wait for the next one.
constexpr std::size_t kMostRecentBytes = std::size_t(1) << 20;

/// The message with the note that others in front of it were dropped. (Segments of sound need none:
/// their times show it.)
MessagePtr marked(Message message, Channel channel) {
  if (message.text) {
    constexpr std::string_view kNote = "\"missed\":true,";
    message.bytes.insert(message.bytes.begin() + 1, kNote.begin(), kNote.end());  // behind the {
  } else if (channel != Channel::audio) {
    const bool is_unit = channel == Channel::face || channel == Channel::sent;
    message.bytes[is_unit ? kFlagsAt : 0] |= kMissed;
  }
  return std::make_shared<const Message>(std::move(message));
}

bool is_unit(const Message& message) { return !message.text && message.bytes.size() > kUnitHeader; }

// Units as sent are those of the face.
Channel feed_of(Channel channel) { return channel == Channel::sent ? Channel::face : channel; }

}  // namespace

void Hub::set_hello(Channel channel, Message hello) {
  const auto shared = std::make_shared<const Message>(std::move(hello));
  feeds_[std::size_t(channel)].hello = shared;
  if (channel == Channel::face) feeds_[std::size_t(Channel::sent)].hello = shared;
}

void Hub::publish(Channel channel, Message message) {
  const auto shared = std::make_shared<const Message>(std::move(message));
  keep(feeds_[std::size_t(channel)], channel, shared);
  const bool coded = channel == Channel::face && fan_out_ && is_unit(*shared);
  if (coded) follow(shared);
  for (auto& [id, client] : clients_) {
    if (feed_of(client.channel) != channel) continue;
    if (coded && client.channel == Channel::face) {
      push_coded(id, client, shared);
    } else {
      push(client, shared);
    }
  }
}

void Hub::follow(const MessagePtr& message) {
  coded_.clear();
  fan_out_->push(std::span(message->bytes).subspan(kUnitHeader));
}

// `message`: the newest unit, as sent.
void Hub::push_coded(ClientId id, Client& client, const MessagePtr& message) {
  if (!fan_out_->ready()) return push(client, message);
  if (client.waits_for_entry) fan_out_->forget(id);
  const fba::FanOut::Unit unit = fan_out_->unit_for(id);
  MessagePtr& own = coded_[unit.bytes.data()];
  if (own == nullptr) {
    Message made{.entry = unit.intra, .time = message->time};
    made.bytes.assign(message->bytes.begin(), message->bytes.begin() + kUnitHeader);
    std::uint8_t& flags = made.bytes[kFlagsAt];
    flags = std::uint8_t((flags & ~kIntra) | (unit.intra ? kIntra : 0));
    made.bytes.insert(made.bytes.end(), unit.bytes.begin(), unit.bytes.end());
    own = std::make_shared<const Message>(std::move(made));
  }
  push(client, own);
}

// A newcomer sees the face of the newest unit at once. False: nothing is known of it.
bool Hub::add_coded(ClientId id, Client& client) {
  const Feed& feed = feeds_[std::size_t(Channel::face)];
  if (!fan_out_) {
    fan_out_.emplace();
    for (const MessagePtr& message : feed.recent) {
      if (is_unit(*message)) follow(message);
    }
  }
  const auto newest = std::find_if(feed.recent.rbegin(), feed.recent.rend(),
                                   [](const MessagePtr& message) { return is_unit(*message); });
  if (newest == feed.recent.rend() || !fan_out_->ready()) return false;
  push_coded(id, client, *newest);
  for (const MessagePtr& message : feed.recent) {
    if (message->text) push(client, message);
  }
  return true;
}

// Units since the newest intra plane. Segments of sound are all entries: those are kept until
// forget_before().
void Hub::keep(Feed& feed, Channel channel, const MessagePtr& message) {
  if (message->entry && channel != Channel::audio) {
    feed.recent.clear();
    feed.bytes = 0;
  }
  if (!message->entry && feed.recent.empty()) return;
  feed.recent.push_back(message);
  feed.bytes += message->bytes.size();
  while (feed.bytes > kMostRecentBytes && !feed.recent.empty()) {
    feed.bytes -= feed.recent.front()->bytes.size();
    feed.recent.pop_front();
    if (channel == Channel::audio) continue;
    feed.recent.clear();
    feed.bytes = 0;
  }
}

void Hub::forget_before(Channel channel, double time) {
  Feed& feed = feeds_[std::size_t(channel)];
  while (feed.recent.size() > 1 && feed.recent[1]->time <= time) {
    feed.bytes -= feed.recent.front()->bytes.size();
    feed.recent.pop_front();
  }
}

void Hub::forget(Channel channel) {
  Feed& feed = feeds_[std::size_t(channel)];
  feed.recent.clear();
  feed.bytes = 0;
}

void Hub::push(Client& client, const MessagePtr& message) {
  if (client.waits_for_entry && !message->entry) {
    if (client.missed) ++dropped_;
    return;
  }
  const bool full = client.bytes + message->bytes.size() > client_bytes_;
  if (full && !client.queue.empty()) {
    const bool greeted = client.queue.front() != feeds_[std::size_t(client.channel)].hello;
    const std::size_t kept = greeted ? 0 : 1;
    dropped_ += std::int64_t(client.queue.size() - kept) + 1;
    client.queue.resize(kept);
    client.bytes = greeted ? 0 : client.queue.front()->bytes.size();
    client.missed = true;
    client.waits_for_entry = client.channel != Channel::owner;  // which has events alone
    return;
  }
  client.waits_for_entry = false;
  MessagePtr own = message;
  if (client.missed) own = marked(*message, client.channel);
  // Of one that has just lost all that waited for it, nobody can say that it takes anything.
  if (client.queue.empty() && !client.missed) client.taken = Clock::now();
  client.missed = false;
  client.bytes += own->bytes.size();
  client.queue.push_back(std::move(own));
}

ClientId Hub::add(Channel channel) {
  const ClientId id = ++last_id_;
  Client client{
      .channel = channel, .waits_for_entry = channel != Channel::owner, .taken = Clock::now()};
  const Feed& feed = feeds_[std::size_t(feed_of(channel))];
  if (feed.hello) {
    client.queue.push_back(feed.hello);
    client.bytes = feed.hello->bytes.size();
  }
  const bool known = channel == Channel::face && catch_up_ && add_coded(id, client);
  if (catch_up_ && !known) {
    for (const MessagePtr& message : feed.recent) push(client, message);
  }
  if (channel == Channel::face && !fan_out_) fan_out_.emplace();
  clients_.emplace(id, std::move(client));
  return id;
}

void Hub::remove(ClientId client) {
  clients_.erase(client);
  if (!fan_out_) return;
  fan_out_->forget(client);
  const bool others = std::ranges::any_of(
      clients_, [](const auto& each) { return each.second.channel == Channel::face; });
  if (others) return;
  fan_out_.reset();
  coded_.clear();
}

MessagePtr Hub::next(ClientId id) {
  const auto found = clients_.find(id);
  if (found == clients_.end() || found->second.queue.empty()) return nullptr;
  Client& client = found->second;
  MessagePtr message = std::move(client.queue.front());
  client.queue.pop_front();
  client.bytes -= std::min(client.bytes, message->bytes.size());
  client.taken = Clock::now();
  ++messages_;
  bytes_ += std::int64_t(message->bytes.size());
  return message;
}

bool Hub::waiting(ClientId client) const {
  const auto found = clients_.find(client);
  return found != clients_.end() && !found->second.queue.empty();
}

bool Hub::stalled(ClientId client, Clock::time_point since) const {
  return waiting(client) && clients_.at(client).taken < since;
}

}  // namespace animeme::web
