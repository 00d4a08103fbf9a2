// The inside of Server: its connections and the callbacks of libwebsockets.
#pragma once

#include <condition_variable>
#include <map>
#include <mutex>
#include <string>

#include "tools/web/detail/hub.h"
#include "tools/web/detail/page.h"
#include "tools/web/detail/requests.h"
#include "tools/web/detail/server.h"
#include "tools/web/detail/service.h"

namespace animeme::web {

/// One connection, from its first request on.
struct Session {
  Resource resource = Resource::none;
  bool open = false;  // a WebSocket or /talk.mp4 with a place in the hub
  ClientId client = 0;
  std::string body;  // of a page, what is left of it
  std::size_t at = 0;
  std::size_t received = 0;
  std::int64_t begin = -1;  // of /talk.mp4: time of its first segment, in samples
};

struct Server::Impl {
  Impl(const WebOptions& web_options, SoundFacts facts)
      : options(web_options),
        sound(facts),
        page(make_page(web_options.head_script)),
        hub(web_options.client_bytes, web_options.catch_up) {}

  const WebOptions options;
  const SoundFacts sound;
  const std::string page;
  Service service;
  int port = 0;

  mutable std::mutex mutex;  // for what follows
  std::condition_variable changed;
  Hub hub;
  std::string info;
  bool finishing = false;

  std::map<lws*, Session> sessions;  // of the service thread alone

  static int callback(lws* wsi, lws_callback_reasons reason, void* user, void* in, size_t size);
  int handle(lws* wsi, lws_callback_reasons reason, const char* in, std::size_t size);
  bool exists(Resource resource) const;
  bool admit(Session& session);
  int refuse(lws* wsi, unsigned status);
  int request(lws* wsi, const std::string& path);
  int upgrade(lws* wsi);
  int write_body(lws* wsi, Session& session);
  int write_talk(lws* wsi, Session& session);
  int write_message(lws* wsi, Session& session);
  void look_around();
  void leave(lws* wsi);
};

}  // namespace animeme::web
