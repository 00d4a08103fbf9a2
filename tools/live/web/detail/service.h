// A context of libwebsockets and the thread that serves it.
#pragma once

#include <libwebsockets.h>

#include <atomic>
#include <thread>

namespace animeme::web {

class Service {
 public:
  Service() = default;
  ~Service() { stop(); }
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// `info` needs protocols, port and user only. False: libwebsockets refuses.
  bool start(lws_context_creation_info info) {
    lws_set_log_level(0, nullptr);
    info.gid = gid_t(-1);
    info.uid = uid_t(-1);
    info.options |= LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND;
    context_ = lws_create_context(&info);
    return context_ != nullptr;
  }
  /// From now on callbacks come in the thread.
  void run() {
    thread_ = std::thread([this] {
      while (!stopping_ && lws_service(context_, 0) >= 0) {
      }
    });
  }
  /// Makes LWS_CALLBACK_EVENT_WAIT_CANCELLED happen in the thread. Callable from any thread.
  void wake() {
    if (context_ != nullptr) lws_cancel_service(context_);
  }
  void stop() {
    stop([] {});
  }
  /// `before_end` is called between the end of the thread and that of the context.
  template <class BeforeEnd>
  void stop(const BeforeEnd& before_end) {
    if (context_ == nullptr) return;
    stopping_ = true;
    wake();
    if (thread_.joinable()) thread_.join();
    before_end();
    lws_context_destroy(context_);
    context_ = nullptr;
  }
  lws_context* context() const { return context_; }

 private:
  lws_context* context_ = nullptr;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace animeme::web
