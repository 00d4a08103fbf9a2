// Viewers that connect by WHEP, and the thread that adds and removes them.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <thread>
#include <utility>

#include "tools/live/webrtc/detail/feed.h"
#include "tools/live/webrtc/detail/load.h"
#include "tools/live/webrtc/detail/shared_transport.h"
#include "tools/live/webrtc/webrtc.h"

namespace animeme::webrtc {
namespace {

using Clock = std::chrono::steady_clock;
using Answer = std::function<void(web::PeerAnswer)>;

constexpr std::chrono::milliseconds kLookEvery{100};
constexpr std::chrono::seconds kToAnswer{4}, kToConnect{15};
constexpr std::chrono::milliseconds kGoodbye{60};  // three times; ends of streams get lost, too

/// A secret: whoever has it may end the connection.
std::string make_id() {
  std::random_device device;
  std::string id;
  for (int i = 0; i < 32; ++i) id += "0123456789abcdef"[device() & 15];
  return id;
}

class PeerHub : public web::PeerConnections {
 public:
  PeerHub(const WebRtcOptions& options, bool now) : options_(options), now_(now) {}
  ~PeerHub() override { finish(true); }

  Result<void> start(const media::LiveInfo& info, int most, int per_address) override;
  void expect() override;
  void offer(std::string sdp, std::string address, Answer answer) override;
  bool end(const std::string& id) override;
  void send(const media::LiveUnit& unit, std::string_view values) override;
  void tell(std::string_view json) override;
  void finish(bool over) override;
  int busy() const override;
  media::SendStats stats() const override;

 private:
  struct Viewer : Receiver {
    std::string address;
    Clock::time_point since = Clock::now();
    bool connected = false;
    std::shared_ptr<std::atomic<bool>> answered;
  };
  struct Offer {
    std::string sdp, address, id;
    Answer answer;
  };
  using Viewers = std::map<std::string, Viewer>;  // by id

  void begin();
  void run();
  void let_in(Offer offer);
  void look_after(std::vector<Viewer>& gone);
  bool has_place(const std::string& address) const;

  const WebRtcOptions options_;
  const bool now_;
  int most_ = 0, per_address_ = 0;
  bool has_sound_ = false;

  mutable std::mutex mutex_;  // for what follows
  std::condition_variable changed_;
  std::optional<Feed> feed_;
  Viewers viewers_;
  std::vector<Offer> offers_;
  std::vector<Viewer> gone_;  // to be closed by the thread
  int joining_ = 0;           // offers that the thread is answering
  bool expected_ = false, loaded_ = false, over_ = false;
  std::thread thread_;
};

Result<void> PeerHub::start(const media::LiveInfo& info, int most, int per_address) {
  if (now_) {
    if (Result<void> loaded = load(); !loaded) return loaded;
  }
  Result<Feed> feed = Feed::make(info, options_);
  if (!feed) return feed.error();
  if (!now_ && !is_there())
    return make_error(Code::unsupported, "the module for WebRTC is missing");
  feed_.emplace(std::move(*feed));
  most_ = most;
  per_address_ = per_address;
  has_sound_ = info.audio.has_value();
  return {};
}

// The first one that may connect, and those after it, need a thread. With the lock held.
void PeerHub::begin() {
  if (!over_ && !thread_.joinable()) thread_ = std::thread([this] { run(); });
}

int PeerHub::busy() const {
  const std::lock_guard lock(mutex_);
  return int(viewers_.size() + offers_.size()) + joining_;
}

/// With the lock held.
bool PeerHub::has_place(const std::string& address) const {
  int all = int(offers_.size()), there = 0;
  for (const Offer& offer : offers_) there += offer.address == address ? 1 : 0;
  for (const auto& [id, viewer] : viewers_) {
    ++all;
    there += viewer.address == address ? 1 : 0;
  }
  return all < most_ && (per_address_ == 0 || there < per_address_);
}

void PeerHub::expect() {
  const std::lock_guard lock(mutex_);
  if (std::exchange(expected_, true)) return;
  begin();
  changed_.notify_all();
}

void PeerHub::offer(std::string sdp, std::string address, Answer answer) {
  std::unique_lock lock(mutex_);
  if (over_ || !has_place(address)) {
    lock.unlock();
    answer({503, "", "All places are taken (--max-clients).\n"});
    return;
  }
  offers_.push_back({share_transport(sdp), std::move(address), make_id(), std::move(answer)});
  begin();
  changed_.notify_all();
}

bool PeerHub::end(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const auto found = viewers_.find(id);
  if (found == viewers_.end()) return false;
  if (feed_) feed_->forget(found->second);
  gone_.push_back(std::move(found->second));
  viewers_.erase(found);
  changed_.notify_all();
  return true;
}

void PeerHub::send(const media::LiveUnit& unit, std::string_view values) {
  const std::lock_guard lock(mutex_);
  if (over_ || !feed_) return;
  feed_->push(unit, values);
  for (auto& [id, viewer] : viewers_) {
    viewer.connected = viewer.peer->state() == Peer::State::connected;
    if (viewer.connected) feed_->give(viewer);
  }
}

void PeerHub::tell(std::string_view json) {
  const std::lock_guard lock(mutex_);
  if (over_ || !feed_) return;
  for (auto& [id, viewer] : viewers_) {
    if (viewer.connected) feed_->tell(viewer, json);
  }
}

void PeerHub::run() {
  std::unique_lock lock(mutex_);
  while (!over_) {
    const auto news = [this] {
      return over_ || !offers_.empty() || !gone_.empty() || expected_ > loaded_;
    };
    if (viewers_.empty()) {
      changed_.wait(lock, news);
    } else {
      changed_.wait_for(lock, kLookEvery, news);
    }
    std::vector<Offer> offers = std::exchange(offers_, {});
    joining_ = int(offers.size());
    std::vector<Viewer> gone = std::exchange(gone_, {});
    look_after(gone);
    const bool first = expected_ && !std::exchange(loaded_, true);
    if (offers.empty() && gone.empty() && !first) continue;
    lock.unlock();
    if (first) (void)load();  // new viewers get its errors
    gone.clear();             // waits for their threads
    for (Offer& offer : offers) let_in(std::move(offer));
    lock.lock();
    joining_ = 0;
  }
}

/// Those whose connection is over, or was never made. With the lock held.
void PeerHub::look_after(std::vector<Viewer>& gone) {
  for (auto at = viewers_.begin(); at != viewers_.end();) {
    const Peer::State state = at->second.peer->state();
    at->second.connected = state == Peer::State::connected;
    const auto patience = *at->second.answered ? kToConnect : kToAnswer;
    const bool late =
        state == Peer::State::connecting && Clock::now() - at->second.since > patience;
    if (state == Peer::State::over || late) {
      if (feed_) feed_->forget(at->second);
      gone.push_back(std::move(at->second));
      at = viewers_.erase(at);
    } else {
      ++at;
    }
  }
}

/// In the thread, without the lock: connections take a while to be made.
void PeerHub::let_in(Offer offer) {
  const Result<const Functions*> module = functions();
  if (!module) return offer.answer({501, "", module.error().message + "\n"});
  PeerSettings settings;
  settings.offer = std::move(offer.sdp);
  settings.sound = has_sound_;
  settings.stun = options_.stun;
  settings.turn = options_.turn;
  Viewer viewer;
  viewer.address = std::move(offer.address);
  if (has_sound_) viewer.types = sound_types(settings.offer);
  if (options_.audio_repeat == 0) viewer.types.redundant = -1;
  settings.redundant = viewer.types.redundant;
  viewer.answered = std::make_shared<std::atomic<bool>>(false);
  viewer.peer = (*module)->open(
      settings, [id = offer.id, answer = std::move(offer.answer), answered = viewer.answered,
                 types = viewer.types](const std::string& description, const std::string& problem) {
        *answered = true;
        if (problem.empty()) return answer({201, id, with_redundant(description, types)});
        answer({400, "", problem + "\n"});
      });
  const std::lock_guard lock(mutex_);
  viewers_[offer.id] = std::move(viewer);
}

void PeerHub::finish(bool over) {
  {
    std::unique_lock lock(mutex_);
    if (over_) return;
    for (int i = 0; over && i < 3 && !viewers_.empty(); ++i) {
      for (auto& [id, viewer] : viewers_) feed_->end(viewer);
      changed_.wait_for(lock, kGoodbye, [] { return false; });
    }
    for (auto& [id, viewer] : viewers_) viewer.peer->goodbye();
    if (!viewers_.empty()) changed_.wait_for(lock, kGoodbye, [] { return false; });
    over_ = true;
    changed_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
  viewers_.clear();
  gone_.clear();
  offers_.clear();
}

media::SendStats PeerHub::stats() const {
  const std::lock_guard lock(mutex_);
  media::SendStats stats = feed_ ? feed_->stats() : media::SendStats{};
  for (const auto& [id, viewer] : viewers_) {
    if (!viewer.connected) continue;
    ++stats.receivers;
    stats.reported_loss = std::max(stats.reported_loss, viewer.loss);
    stats.sound_loss = std::max(stats.sound_loss, feed_->needs_fec(viewer));
  }
  return stats;
}

}  // namespace

std::unique_ptr<web::PeerConnections> make_peer_connections(const WebRtcOptions& options,
                                                            bool now) {
  return std::make_unique<PeerHub>(options, now);
}

}  // namespace animeme::webrtc
