// A connection by GStreamer's webrtcbin. Part of the module.
#pragma once

#define GST_USE_UNSTABLE_API
#include <gst/gst.h>
#include <gst/webrtc/webrtc.h>

#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "tools/live/webrtc/detail/peer.h"

namespace animeme::webrtc {

struct Unref {
  void operator()(void* object) const { gst_object_unref(object); }
};
struct UnrefObject {
  void operator()(void* object) const { g_object_unref(object); }
};
using ElementPtr = std::unique_ptr<GstElement, Unref>;
using ChannelPtr = std::unique_ptr<GstWebRTCDataChannel, UnrefObject>;

class GstPeer : public Peer {
 public:
  GstPeer(const PeerSettings& settings, Described described);
  ~GstPeer() override;
  GstPeer(const GstPeer&) = delete;
  GstPeer& operator=(const GstPeer&) = delete;

  void answered(const std::string& sdp) override;
  State state() override;
  std::string problem() override;
  bool has_channel(const std::string& label) override;
  bool is_reliable(const std::string& label) override;
  bool send(const std::string& label, std::span<const std::uint8_t> message, bool text) override;
  void send_sound(std::span<const std::uint8_t> packet, std::uint32_t time,
                  bool redundant) override;
  double reported_loss() override;
  void goodbye() override;

 private:
  using Clock = std::chrono::steady_clock;

  bool build();
  void send_twice(GstPad* sink, GstBuffer* datagram);
  void add_sound(int payload_type);
  void add_channel(GstWebRTCDataChannel* channel);  // takes it
  void set_remote(const std::string& sdp, GstWebRTCSDPType type, GstPromiseChangeFunc then);
  void create(const char* signal, GstPromiseChangeFunc then);
  void take_own(GstPromise* promise, const char* field);
  void gathered();
  void describe(const std::string& sdp, const std::string& problem);
  void fail(const std::string& why);

  const PeerSettings settings_;
  ElementPtr pipeline_;
  GstElement* bin_ = nullptr;    // the pipeline's
  GstElement* sound_ = nullptr;  // the pipeline's; nullptr: there is none
  int payload_type_ = 0;
  double loss_ = 0;            // by the newest report
  Clock::time_point asked_{};  // when it was looked at
  std::uint32_t ssrc_ = 0;
  std::uint16_t sequence_ = 0;
  int copies_ = 60;       // of datagrams, that still go twice
  bool copying_ = false;  // both of the thread that sends
  std::atomic<bool> over_ = false;
  /// When something was sent that nothing has been heard since; 0: everything was heard of.
  std::atomic<Clock::rep> waiting_since_ = 0;

  std::mutex mutex_;  // for what follows
  Described described_;
  std::string problem_;
  std::map<std::string, ChannelPtr> channels_;
};

}  // namespace animeme::webrtc
