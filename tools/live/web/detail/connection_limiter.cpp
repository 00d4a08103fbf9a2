#include "tools/live/web/detail/connection_limiter.h"

#include <algorithm>
#include <utility>

namespace animeme::web {
namespace {

double seconds_between(ConnectionLimiter::Clock::time_point begin,
                       ConnectionLimiter::Clock::time_point end) {
  return std::chrono::duration<double>(end - begin).count();
}

}  // namespace

std::size_t ConnectionLimiter::passing(const std::string* address) const {
  return std::size_t(std::count_if(connections_.begin(), connections_.end(), [&](const auto& each) {
    const Connection& one = each.second;
    return (one.phase == Phase::asking || one.phase == Phase::taking) &&
           (address == nullptr || one.address == *address);
  }));
}

std::size_t ConnectionLimiter::all_of(const std::string& address) const {
  return std::size_t(std::count_if(connections_.begin(), connections_.end(), [&](const auto& each) {
    return each.second.phase != Phase::leaving && each.second.address == address;
  }));
}

ConnectionLimiter::Connection* ConnectionLimiter::longest_asking(const std::string* address,
                                                                 Key* key) {
  Connection* found = nullptr;
  for (auto& [each, connection] : connections_) {
    if (connection.phase != Phase::asking) continue;
    if (address != nullptr && connection.address != *address) continue;
    if (found != nullptr && found->number < connection.number) continue;
    found = &connection;
    *key = each;
  }
  return found;
}

bool ConnectionLimiter::may_enter(const std::string& address) const {
  const auto asks = [&](const auto& each) {
    return each.second.phase == Phase::asking && each.second.address == address;
  };
  const auto most = std::size_t(limits_.per_address);
  if (most > 0 && all_of(address) >= most) {
    return std::any_of(connections_.begin(), connections_.end(), asks);
  }
  if (passing(nullptr) < kMostPassing) return true;
  return std::any_of(connections_.begin(), connections_.end(),
                     [](const auto& each) { return each.second.phase == Phase::asking; });
}

void ConnectionLimiter::enter(Key key, const std::string& address, Clock::time_point now) {
  connections_[key] = {address, Phase::asking, ++entered_, now};
}

void ConnectionLimiter::leave(Key key) { connections_.erase(key); }

bool ConnectionLimiter::ask(Key key, Clock::time_point now) {
  const auto found = connections_.find(key);
  if (found == connections_.end()) return false;
  found->second.phase = Phase::taking;
  found->second.since = now;
  if (limits_.per_address == 0) return true;
  const auto [budget, first] = budgets_.try_emplace(found->second.address, Budget{kBurst, now});
  double& requests = budget->second.requests;
  requests += kRate * seconds_between(budget->second.filled, now);
  requests = std::min(requests, kBurst);
  budget->second.filled = now;
  if (requests < 1) return false;
  requests -= 1;
  return true;
}

void ConnectionLimiter::progress(Key key, Clock::time_point now) {
  const auto found = connections_.find(key);
  if (found != connections_.end()) found->second.since = now;
}

void ConnectionLimiter::answered(Key key, Clock::time_point now) {
  const auto found = connections_.find(key);
  if (found == connections_.end() || found->second.phase == Phase::leaving) return;
  found->second.phase = Phase::asking;
  found->second.number = ++entered_;
  found->second.since = now;
}

bool ConnectionLimiter::watch(Key key, bool sound) {
  const auto found = connections_.find(key);
  if (found == connections_.end()) return false;
  const Phase before = found->second.phase;
  found->second.phase = sound ? Phase::watching_sound : Phase::watching_face;
  if (viewers() <= limits_.viewers) return true;
  found->second.phase = before;
  return false;
}

std::vector<ConnectionLimiter::Key> ConnectionLimiter::overdue(Clock::time_point now) {
  std::vector<Key> out;
  const auto name = [&](Key key, Connection& connection) {
    connection.phase = Phase::leaving;
    out.push_back(key);
  };
  for (auto& [key, connection] : connections_) {
    const double idle = seconds_between(connection.since, now);
    const bool slow = (connection.phase == Phase::asking && idle > kRequestSeconds) ||
                      (connection.phase == Phase::taking && idle > limits_.patience);
    if (slow) name(key, connection);
  }
  // Too many: those go that have asked for nothing for the longest time.
  Key key = nullptr;
  std::map<std::string, std::size_t> counts;
  for (const auto& [each, connection] : connections_) {
    if (connection.phase != Phase::leaving) ++counts[connection.address];
  }
  for (auto& [address, count] : counts) {
    for (; limits_.per_address > 0 && count > std::size_t(limits_.per_address); --count) {
      Connection* longest = longest_asking(&address, &key);
      if (longest == nullptr) break;
      name(key, *longest);
    }
  }
  for (std::size_t count = passing(nullptr); count > kMostPassing; --count) {
    Connection* longest = longest_asking(nullptr, &key);
    if (longest == nullptr) break;
    name(key, *longest);
  }
  std::erase_if(budgets_, [&](const auto& each) {  // it has been filled up since
    return seconds_between(each.second.filled, now) > kBurst / kRate;
  });
  return out;
}

int ConnectionLimiter::viewers() const {
  std::map<std::string, std::pair<int, int>> watching;
  for (const auto& [key, connection] : connections_) {
    if (connection.phase == Phase::watching_face) ++watching[connection.address].first;
    if (connection.phase == Phase::watching_sound) ++watching[connection.address].second;
  }
  int sum = 0;
  for (const auto& [address, counts] : watching) sum += std::max(counts.first, counts.second);
  return sum;
}

}  // namespace animeme::web
