// animeme_webrtc.so: all of the program that is linked with GStreamer.
#include <gst/gst.h>

#include <chrono>
#include <future>

#include "tools/formats/common/module.h"
#include "tools/live/webrtc/detail/gst_peer.h"
#include "tools/live/webrtc/detail/http.h"

namespace animeme::webrtc {
namespace {

constexpr std::chrono::seconds kFirst{20};

std::string begin() {
  // What GLib and GStreamer tell developers is no talk of the program.
  g_log_set_default_handler([](const gchar*, GLogLevelFlags, const gchar*, gpointer) {}, nullptr);
  GError* error = nullptr;
  if (!gst_init_check(nullptr, nullptr, &error)) {
    const std::string why = error != nullptr ? error->message : "no reason given";
    g_clear_error(&error);
    return "GStreamer does not start: " + why;
  }
  static constexpr struct {
    const char *element, *package;
  } kNeeded[] = {{"webrtcbin", "gstreamer1.0-plugins-bad"}, {"dtlsenc", "gstreamer1.0-plugins-bad"},
                 {"srtpenc", "gstreamer1.0-plugins-bad"},   {"sctpenc", "gstreamer1.0-plugins-bad"},
                 {"rtpbin", "gstreamer1.0-plugins-good"},   {"nicesink", "gstreamer1.0-nice"},
                 {"appsrc", "gstreamer1.0-plugins-base"}};
  for (const auto& [element, package] : kNeeded) {
    GstElementFactory* factory = gst_element_factory_find(element);
    if (factory == nullptr) {
      return std::string("WebRTC needs GStreamer's ") + element +
             "; install it (Debian: " + package + ")";
    }
    gst_object_unref(factory);
  }
  // The first connection takes a third of a second for the key that all share, others 3 ms: it is
  // one that nobody waits for.
  std::promise<std::string> problem;
  PeerSettings settings;
  settings.channels = {"first"};
  const GstPeer first(settings,
                      [&](const std::string&, const std::string& why) { problem.set_value(why); });
  std::future<std::string> known = problem.get_future();
  const bool told = known.wait_for(kFirst) == std::future_status::ready;
  return told ? known.get() : "GStreamer's webrtcbin does not create an offer";
}

std::unique_ptr<Peer> open(const PeerSettings& settings, Described described) {
  return std::make_unique<GstPeer>(settings, std::move(described));
}

constexpr Functions kTable = {begin, open, exchange};

}  // namespace
}  // namespace animeme::webrtc

ANIMEME_MODULE(animeme::webrtc::kTable);
