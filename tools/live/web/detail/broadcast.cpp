#include "tools/live/web/detail/broadcast.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace animeme::web {

void Broadcast::set_hello(Channel channel, Message hello) {
  const std::lock_guard lock(mutex_);
  hub_.set_hello(channel, std::move(hello));
}

void Broadcast::set_info(std::string json) {
  auto document = std::make_shared<Document>();  // small, and another one each second
  document->bytes = std::move(json);
  const std::lock_guard lock(mutex_);
  info_ = std::move(document);
}

void Broadcast::publish(Channel channel, Message message) {
  {
    const std::lock_guard lock(mutex_);
    hub_.publish(channel, std::move(message));
    const int as_sent = channel == Channel::face ? clients_[std::size_t(Channel::sent)] : 0;
    if (clients_[std::size_t(channel)] + as_sent == 0) return;
  }
  touched_(shared_from_this());
}

void Broadcast::forget_before(Channel channel, double time) {
  const std::lock_guard lock(mutex_);
  hub_.forget_before(channel, time);
}

void Broadcast::forget(Channel channel) {
  const std::lock_guard lock(mutex_);
  hub_.forget(channel);
}

bool Broadcast::wanted(Channel channel) const {
  const std::lock_guard lock(mutex_);
  return clients_[std::size_t(channel)] > 0;
}

media::SendStats Broadcast::stats() const {
  const std::lock_guard lock(mutex_);
  media::SendStats stats;
  stats.packets = hub_.messages();
  stats.bytes = hub_.bytes();
  stats.dropped = hub_.dropped();
  const int sound = clients_[std::size_t(Channel::audio)];
  const int owners = clients_[std::size_t(Channel::owner)];
  const int all = std::accumulate(clients_.begin(), clients_.end(), -owners);
  stats.receivers = std::max(all - sound, sound);
  return stats;
}

void Broadcast::end(bool goes_away) {
  {
    const std::lock_guard lock(mutex_);
    goes_away_ = over_ ? goes_away_ : goes_away;
    over_ = true;
  }
  touched_(shared_from_this());
}

bool Broadcast::wait_until_empty(Hub::Clock::time_point instant) {
  std::unique_lock lock(mutex_);
  return changed_.wait_until(lock, instant, [this] { return hub_.clients() == 0; });
}

DocumentPtr Broadcast::info() const {
  const std::lock_guard lock(mutex_);
  return info_;
}

std::optional<ClientId> Broadcast::add(Channel channel) {
  ClientId client = 0;
  {
    const std::lock_guard lock(mutex_);
    if (over_) return std::nullopt;
    ++clients_[std::size_t(channel)];
    client = hub_.add(channel);
  }
  if (joined_ && channel != Channel::owner) joined_();
  return client;
}

void Broadcast::remove(ClientId client, Channel channel) {
  const std::lock_guard lock(mutex_);
  --clients_[std::size_t(channel)];
  hub_.remove(client);
  changed_.notify_all();
}

Broadcast::Turn Broadcast::next(ClientId client) {
  const std::lock_guard lock(mutex_);
  Turn turn{hub_.next(client)};
  turn.more = hub_.waiting(client);
  turn.over = over_ && !turn.more;
  turn.goes_away = goes_away_;
  return turn;
}

Broadcast::Need Broadcast::need_of(ClientId client, Hub::Clock::time_point since) const {
  const std::lock_guard lock(mutex_);
  if (hub_.stalled(client, since)) return Need::to_go;
  return over_ || hub_.waiting(client) ? Need::to_write : Need::nothing;
}

}  // namespace animeme::web
