#include "tools/live/webrtc/detail/gst_peer.h"

#include <arpa/inet.h>
#include <gst/app/gstappsrc.h>
#include <gst/sdp/sdp.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <cstdlib>
#include <cstring>
#include <string_view>
#include <utility>

namespace animeme::webrtc {
namespace {

constexpr int kOwnPayloadType = 111;           // of our offers
constexpr guint64 kMostWaiting = 64 * 1024;    // bytes of a channel
constexpr std::chrono::seconds kPatience{10};  // without a sign of life
constexpr std::chrono::milliseconds kLookForReports{500};

using SdpPtr = std::unique_ptr<GstSDPMessage, decltype(&gst_sdp_message_free)>;

SdpPtr parse(const std::string& text) {
  GstSDPMessage* made = nullptr;
  const bool whole =
      !text.empty() && gst_sdp_message_new_from_text(text.c_str(), &made) == GST_SDP_OK;
  SdpPtr message(made, &gst_sdp_message_free);  // there is one of a broken text, too
  if (!whole) message.reset();
  return message;
}

/// The number that the other end gives Opus; -1: it does not take any.
int payload_type_of(const GstSDPMessage* sdp) {
  for (guint i = 0; i < gst_sdp_message_medias_len(sdp); ++i) {
    const GstSDPMedia* media = gst_sdp_message_get_media(sdp, i);
    if (g_strcmp0(gst_sdp_media_get_media(media), "audio") != 0) continue;
    for (guint k = 0;; ++k) {
      const char* map = gst_sdp_media_get_attribute_val_n(media, "rtpmap", k);
      if (map == nullptr) break;
      const char* name = std::strchr(map, ' ');
      if (name != nullptr && g_ascii_strncasecmp(name + 1, "opus/48000", 10) == 0) {
        return std::atoi(map);
      }
    }
  }
  return -1;
}

/// Addresses of this machine, its own loopback included.
std::vector<std::string> own_addresses() {
  std::vector<std::string> found;
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return found;
  for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || (one->ifa_flags & IFF_UP) == 0) continue;
    char text[INET6_ADDRSTRLEN] = "";
    if (one->ifa_addr->sa_family == AF_INET) {
      const auto* four = reinterpret_cast<const sockaddr_in*>(one->ifa_addr);
      inet_ntop(AF_INET, &four->sin_addr, text, sizeof text);
    } else if (one->ifa_addr->sa_family == AF_INET6) {
      const auto* six = reinterpret_cast<const sockaddr_in6*>(one->ifa_addr);
      if (IN6_IS_ADDR_LINKLOCAL(&six->sin6_addr)) continue;
      inet_ntop(AF_INET6, &six->sin6_addr, text, sizeof text);
    }
    if (*text != '\0') found.emplace_back(text);
  }
  freeifaddrs(all);
  return found;
}

}  // namespace

GstPeer::GstPeer(const PeerSettings& settings, Described described)
    : settings_(settings), described_(std::move(described)) {
  if (!build()) return;
  if (settings_.offer.empty()) {
    if (settings_.sound) add_sound(kOwnPayloadType);
  } else {
    const SdpPtr sdp = parse(settings_.offer);
    if (!sdp || gst_sdp_message_medias_len(sdp.get()) == 0) {
      fail("the offer is not a session description");
      return;
    }
    const int payload_type = settings_.sound ? payload_type_of(sdp.get()) : -1;
    if (payload_type >= 0) add_sound(payload_type);
  }
  if (gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING) == GST_STATE_CHANGE_FAILURE) {
    fail("GStreamer does not start the connection");
    return;
  }
  if (settings_.offer.empty()) {
    GstStructure* options = gst_structure_new("application/data-channel", "ordered", G_TYPE_BOOLEAN,
                                              FALSE, "max-retransmits", G_TYPE_INT, 0, nullptr);
    for (const std::string& label : settings_.channels) {
      GstWebRTCDataChannel* channel = nullptr;
      g_signal_emit_by_name(bin_, "create-data-channel", label.c_str(), options, &channel);
      if (channel != nullptr) add_channel(channel);
    }
    gst_structure_free(options);
    create("create-offer", [](GstPromise* promise, gpointer self) {
      static_cast<GstPeer*>(self)->take_own(promise, "offer");
    });
  } else {
    set_remote(settings_.offer, GST_WEBRTC_SDP_TYPE_OFFER, [](GstPromise* promise, gpointer self) {
      auto* peer = static_cast<GstPeer*>(self);
      const bool good = gst_promise_wait(promise) == GST_PROMISE_RESULT_REPLIED;
      const GstStructure* reply = good ? gst_promise_get_reply(promise) : nullptr;
      const bool refused = reply != nullptr && gst_structure_has_field(reply, "error");
      if (!good || refused) return peer->fail("the offer cannot be answered");
      peer->create("create-answer", [](GstPromise* made, gpointer same) {
        static_cast<GstPeer*>(same)->take_own(made, "answer");
      });
    });
  }
}

GstPeer::~GstPeer() {
  over_ = true;
  if (bin_ != nullptr) g_signal_handlers_disconnect_by_data(bin_, this);
  if (pipeline_) gst_element_set_state(pipeline_.get(), GST_STATE_NULL);
  channels_.clear();
  pipeline_.reset();  // answers the open promises while their callbacks are alive
  describe("", "no description was ready in time");
}

bool GstPeer::build() {
  pipeline_.reset(GST_ELEMENT(gst_object_ref_sink(gst_pipeline_new(nullptr))));
  bin_ = gst_element_factory_make("webrtcbin", nullptr);
  if (bin_ == nullptr) return fail("GStreamer has no webrtcbin"), false;
  gst_bin_add(GST_BIN(pipeline_.get()), bin_);
  g_object_set(bin_, "bundle-policy", GST_WEBRTC_BUNDLE_POLICY_MAX_BUNDLE, nullptr);
  if (!settings_.stun.empty()) {
    g_object_set(bin_, "stun-server", ("stun://" + settings_.stun).c_str(), nullptr);
  }
  if (!settings_.turn.empty()) {
    g_object_set(bin_, "turn-server", ("turn://" + settings_.turn).c_str(), nullptr);
  }
  GstObject *ice = nullptr, *agent = nullptr;
  g_object_get(bin_, "ice-agent", &ice, nullptr);
  for (const std::string& address : own_addresses()) {
    gboolean added = FALSE;
    g_signal_emit_by_name(ice, "add-local-ip-address", address.c_str(), &added);
  }
  // No router is asked for anything. Where UDP does not pass the page has its web sockets.
  g_object_get(ice, "agent", &agent, nullptr);
  g_object_set(agent, "upnp", FALSE, "ice-tcp", FALSE, nullptr);
  g_object_unref(agent);
  gst_object_unref(ice);
  const auto on_channel = +[](GstElement*, GstWebRTCDataChannel* channel, gpointer self) {
    g_object_ref(channel);
    static_cast<GstPeer*>(self)->add_channel(channel);
  };
  g_signal_connect(bin_, "on-data-channel", G_CALLBACK(on_channel), this);
  const auto on_gathering =
      +[](GstElement*, GParamSpec*, gpointer self) { static_cast<GstPeer*>(self)->gathered(); };
  g_signal_connect(bin_, "notify::ice-gathering-state", G_CALLBACK(on_gathering), this);
  // What comes in, of whatever kind, is a sign of life.
  const auto on_element = +[](GstBin*, GstBin*, GstElement* element, gpointer self) {
    GstElementFactory* factory = gst_element_get_factory(element);
    const std::string_view name = factory != nullptr ? GST_OBJECT_NAME(factory) : "";
    if (name != "nicesrc" && name != "nicesink") return;
    GstPad* pad = gst_element_get_static_pad(element, name == "nicesrc" ? "src" : "sink");
    if (name == "nicesink") {
      const auto twice = [](GstPad* sink, GstPadProbeInfo* info, gpointer same) {
        static_cast<GstPeer*>(same)->send_twice(sink, GST_PAD_PROBE_INFO_BUFFER(info));
        return GST_PAD_PROBE_OK;
      };
      gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, twice, self, nullptr);
    }
    if (name == "nicesrc") {
      const auto heard = [](GstPad*, GstPadProbeInfo*, gpointer same) {
        static_cast<GstPeer*>(same)->waiting_since_ = 0;
        return GST_PAD_PROBE_OK;
      };
      constexpr int kAny = GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST;
      gst_pad_add_probe(pad, GstPadProbeType(kAny), heard, self, nullptr);
    }
    gst_object_unref(pad);
  };
  g_signal_connect(bin_, "deep-element-added", G_CALLBACK(on_element), this);
  return true;
}

/// A datagram of a handshake that is lost costs a second, so the first ones go twice; the other end
/// takes the second for a replay. (By its first byte it is DTLS, RFC 7983.)
void GstPeer::send_twice(GstPad* sink, GstBuffer* datagram) {
  std::uint8_t first = 0;
  gst_buffer_extract(datagram, 0, &first, 1);
  if (copying_ || copies_ == 0 || first < 20 || first > 63) return;
  --copies_;
  copying_ = true;
  gst_pad_chain(sink, gst_buffer_ref(datagram));
  copying_ = false;
}

void GstPeer::add_sound(int payload_type) {
  payload_type_ = payload_type;
  ssrc_ = g_random_int();
  sequence_ = std::uint16_t(g_random_int());
  sound_ = gst_element_factory_make("appsrc", nullptr);
  if (sound_ == nullptr) return fail("GStreamer has no appsrc (gstreamer1.0-plugins-base)");
  GstCaps* caps = gst_caps_new_simple(
      "application/x-rtp", "media", G_TYPE_STRING, "audio", "encoding-name", G_TYPE_STRING, "OPUS",
      "clock-rate", G_TYPE_INT, 48000, "encoding-params", G_TYPE_STRING, "2", "payload", G_TYPE_INT,
      payload_type, "ssrc", G_TYPE_UINT, ssrc_, nullptr);
  g_object_set(sound_, "caps", caps, "is-live", TRUE, "do-timestamp", TRUE, "format",
               GST_FORMAT_TIME, "max-buffers", guint64(50), "leaky-type", 2 /* old ones go */,
               nullptr);
  gst_bin_add(GST_BIN(pipeline_.get()), sound_);
  if (!gst_element_link(sound_, bin_)) {
    gst_caps_unref(caps);
    return fail("webrtcbin does not accept sound");
  }
  GArray* all = nullptr;
  g_signal_emit_by_name(bin_, "get-transceivers", &all);
  for (guint i = 0; all != nullptr && i < all->len; ++i) {
    g_object_set(g_array_index(all, GstWebRTCRTPTransceiver*, i), "direction",
                 GST_WEBRTC_RTP_TRANSCEIVER_DIRECTION_SENDONLY, "codec-preferences", caps, nullptr);
  }
  gst_caps_unref(caps);
  if (all != nullptr) g_array_unref(all);
}

void GstPeer::add_channel(GstWebRTCDataChannel* channel) {
  gchar* label = nullptr;
  g_object_get(channel, "label", &label, nullptr);
  const std::lock_guard lock(mutex_);
  channels_[label != nullptr ? label : ""] = ChannelPtr(channel);
  g_free(label);
}

void GstPeer::set_remote(const std::string& sdp, GstWebRTCSDPType type, GstPromiseChangeFunc then) {
  SdpPtr message = parse(sdp);
  if (!message) return fail("the other end sent no session description");
  GstWebRTCSessionDescription* description =
      gst_webrtc_session_description_new(type, message.release());
  GstPromise* promise =
      then != nullptr ? gst_promise_new_with_change_func(then, this, nullptr) : gst_promise_new();
  g_signal_emit_by_name(bin_, "set-remote-description", description, promise);
  gst_promise_unref(promise);
  gst_webrtc_session_description_free(description);
}

void GstPeer::create(const char* signal, GstPromiseChangeFunc then) {
  GstPromise* promise = gst_promise_new_with_change_func(then, this, nullptr);
  g_signal_emit_by_name(bin_, signal, nullptr, promise);
  gst_promise_unref(promise);
}

/// What was created is ours from here on; its candidates are still to be found.
void GstPeer::take_own(GstPromise* promise, const char* field) {
  GstWebRTCSessionDescription* own = nullptr;
  if (gst_promise_wait(promise) == GST_PROMISE_RESULT_REPLIED) {
    const GstStructure* reply = gst_promise_get_reply(promise);
    if (reply != nullptr) {
      gst_structure_get(reply, field, GST_TYPE_WEBRTC_SESSION_DESCRIPTION, &own, nullptr);
    }
  }
  if (own == nullptr) return fail("no session description could be made");
  GstPromise* done = gst_promise_new();
  g_signal_emit_by_name(bin_, "set-local-description", own, done);
  gst_promise_unref(done);
  gst_webrtc_session_description_free(own);
}

void GstPeer::gathered() {
  GstWebRTCICEGatheringState state{};
  g_object_get(bin_, "ice-gathering-state", &state, nullptr);
  if (state != GST_WEBRTC_ICE_GATHERING_STATE_COMPLETE) return;
  GstWebRTCSessionDescription* own = nullptr;
  g_object_get(bin_, "local-description", &own, nullptr);
  if (own == nullptr) return;
  gchar* text = gst_sdp_message_as_text(own->sdp);
  describe(text, "");
  g_free(text);
  gst_webrtc_session_description_free(own);
}

void GstPeer::describe(const std::string& sdp, const std::string& problem) {
  Described described;
  {
    const std::lock_guard lock(mutex_);
    described = std::exchange(described_, nullptr);
  }
  if (described) described(sdp, problem);
}

void GstPeer::fail(const std::string& why) {
  {
    const std::lock_guard lock(mutex_);
    if (problem_.empty()) problem_ = why;
  }
  over_ = true;
  describe("", why);
}

void GstPeer::answered(const std::string& sdp) {
  set_remote(sdp, GST_WEBRTC_SDP_TYPE_ANSWER, nullptr);
}

Peer::State GstPeer::state() {
  if (over_) return State::over;
  GstBus* bus = gst_element_get_bus(pipeline_.get());
  if (GstMessage* message = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR)) {
    GError* error = nullptr;
    gst_message_parse_error(message, &error, nullptr);
    fail(error != nullptr ? error->message : "GStreamer failed");
    g_clear_error(&error);
    gst_message_unref(message);
  }
  gst_object_unref(bus);
  const Clock::rep since = waiting_since_;
  if (since != 0 && Clock::now() - Clock::time_point(Clock::duration(since)) > kPatience) {
    fail("the other end does not respond");
  }
  GstWebRTCPeerConnectionState state{};
  g_object_get(bin_, "connection-state", &state, nullptr);
  if (state == GST_WEBRTC_PEER_CONNECTION_STATE_FAILED) fail("the connection failed");
  if (state == GST_WEBRTC_PEER_CONNECTION_STATE_CLOSED) over_ = true;
  if (over_) return State::over;
  return state == GST_WEBRTC_PEER_CONNECTION_STATE_CONNECTED ? State::connected : State::connecting;
}

std::string GstPeer::problem() {
  const std::lock_guard lock(mutex_);
  return problem_;
}

bool GstPeer::has_channel(const std::string& label) {
  const std::lock_guard lock(mutex_);
  const auto at = channels_.find(label);
  if (at == channels_.end()) return false;
  GstWebRTCDataChannelState state{};
  g_object_get(at->second.get(), "ready-state", &state, nullptr);
  return state == GST_WEBRTC_DATA_CHANNEL_STATE_OPEN;
}

bool GstPeer::is_reliable(const std::string& label) {
  const std::lock_guard lock(mutex_);
  const auto at = channels_.find(label);
  if (at == channels_.end()) return false;
  gboolean ordered = FALSE;
  gint lifetime = 0, retransmits = 0;  // -1: no limit
  g_object_get(at->second.get(), "ordered", &ordered, "max-packet-lifetime", &lifetime,
               "max-retransmits", &retransmits, nullptr);
  return ordered != FALSE && lifetime < 0 && retransmits < 0;
}

bool GstPeer::send(const std::string& label, std::span<const std::uint8_t> message, bool text) {
  if (over_ || !has_channel(label)) return false;
  const std::lock_guard lock(mutex_);
  GstWebRTCDataChannel* channel = channels_.at(label).get();
  guint64 waiting = 0;
  g_object_get(channel, "buffered-amount", &waiting, nullptr);
  if (waiting > kMostWaiting) return false;
  Clock::rep none = 0;
  waiting_since_.compare_exchange_strong(none, Clock::now().time_since_epoch().count());
  GError* error = nullptr;
  if (text) {
    const std::string copy(message.begin(), message.end());
    gst_webrtc_data_channel_send_string_full(channel, copy.c_str(), &error);
  } else {
    GBytes* bytes = g_bytes_new(message.data(), message.size());
    gst_webrtc_data_channel_send_data_full(channel, bytes, &error);
    g_bytes_unref(bytes);
  }
  const bool sent = error == nullptr;
  g_clear_error(&error);
  return sent;
}

void GstPeer::goodbye() {
  const std::lock_guard lock(mutex_);
  for (const auto& [label, channel] : channels_) gst_webrtc_data_channel_close(channel.get());
}

/// What the sources of RTCP say of ours; reports come every few seconds.
double GstPeer::reported_loss() {
  if (over_ || sound_ == nullptr || Clock::now() - asked_ < kLookForReports) return loss_;
  asked_ = Clock::now();
  GstElement* rtp = gst_bin_get_by_name(GST_BIN(bin_), "rtpbin");
  if (rtp == nullptr) return loss_;
  GObject* session = nullptr;
  g_signal_emit_by_name(rtp, "get-internal-session", 0, &session);
  gst_object_unref(rtp);
  if (session == nullptr) return loss_;
  GstStructure* stats = nullptr;
  g_object_get(session, "stats", &stats, nullptr);
  g_object_unref(session);
  if (stats == nullptr) return loss_;
  const GValue* sources = gst_structure_get_value(stats, "source-stats");
  const auto* all =
      sources != nullptr && std::string_view(G_VALUE_TYPE_NAME(sources)) == "GValueArray"
          ? static_cast<const GValueArray*>(g_value_get_boxed(sources))
          : nullptr;
  for (guint i = 0; all != nullptr && i < all->n_values; ++i) {
    const GstStructure* source = gst_value_get_structure(&all->values[i]);
    gboolean reports = FALSE;
    guint about = 0, lost = 0;
    if (gst_structure_get(source, "have-rb", G_TYPE_BOOLEAN, &reports, "rb-fractionlost",
                          G_TYPE_UINT, &lost, nullptr) == FALSE ||
        reports == FALSE) {
      continue;
    }
    if (gst_structure_get_uint(source, "rb-ssrc", &about) != FALSE && about != ssrc_) continue;
    loss_ = double(lost) / 256;
  }
  gst_structure_free(stats);
  return loss_;
}

void GstPeer::send_sound(std::span<const std::uint8_t> packet, std::uint32_t time, bool redundant) {
  if (over_ || sound_ == nullptr) return;
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, 12 + packet.size(), nullptr);
  const std::uint8_t header[12] = {0x80,
                                   std::uint8_t(redundant ? settings_.redundant : payload_type_),
                                   std::uint8_t(sequence_ >> 8),
                                   std::uint8_t(sequence_),
                                   std::uint8_t(time >> 24),
                                   std::uint8_t(time >> 16),
                                   std::uint8_t(time >> 8),
                                   std::uint8_t(time),
                                   std::uint8_t(ssrc_ >> 24),
                                   std::uint8_t(ssrc_ >> 16),
                                   std::uint8_t(ssrc_ >> 8),
                                   std::uint8_t(ssrc_)};
  ++sequence_;
  gst_buffer_fill(buffer, 0, header, sizeof header);
  gst_buffer_fill(buffer, sizeof header, packet.data(), packet.size());
  Clock::rep none = 0;
  waiting_since_.compare_exchange_strong(none, Clock::now().time_since_epoch().count());
  gst_app_src_push_buffer(GST_APP_SRC(sound_), buffer);
}

}  // namespace animeme::webrtc
