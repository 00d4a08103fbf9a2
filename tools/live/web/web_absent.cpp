// What is left without libwebsockets.
#include "tools/live/web/web.h"
#include "tools/live/web/web_server.h"

namespace animeme::web {
namespace {

Error absent() {
  return make_error(Code::unsupported,
                    "this program was built without libwebsockets; install libwebsockets-dev and "
                    "build again");
}

}  // namespace

bool is_open_to_others(const std::string&) { return false; }

Result<std::unique_ptr<WebSink>> make_web_sink(const std::string&, const WebOptions&) {
  return absent();
}

Result<std::unique_ptr<WebServer>> WebServer::open(const std::string&, const ServerOptions&,
                                                   ServerHandler) {
  return absent();
}

Result<std::unique_ptr<media::LiveSource>> make_web_source(const std::string&, const WebOptions&) {
  return absent();
}

}  // namespace animeme::web
