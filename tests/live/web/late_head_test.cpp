// A head for the page that takes long to make: everything else is served meanwhile.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <thread>

#include "tests/live/web/http.h"
#include "tests/support/live_reference.h"
#include "tools/live/web/web.h"

namespace animeme::test {
namespace late_head_test {

using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

class LateHead : public testing::Test {
 protected:
  // Serves; make_head() gives the head.
  void serve() {
    web::WebOptions options;
    options.head_script = "// a head";
    options.make_head_model = [this] {
      ++made_;
      return wanted_.get_future().get();
    };
    auto sink = web::make_web_sink("http://127.0.0.1:0/", options);
    ASSERT_TRUE(sink) << sink.error().message;
    sink_ = std::move(*sink);
    ASSERT_TRUE(sink_->start(live_presentation(10, 5).info));
    port_ = port_of(sink_->address().substr(0, sink_->address().size() - 1));
  }
  std::future<std::string> ask(const std::string& what) {
    return std::async(std::launch::async, [this, what] {
      Connection connection(port_);
      connection.send(what + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port_) +
                      "\r\nConnection: close\r\n\r\n");
      return connection.read_all(30);
    });
  }

  std::promise<Bytes> wanted_;
  std::atomic<int> made_ = 0;
  std::unique_ptr<web::WebSink> sink_;
  int port_ = 0;
};

TEST_F(LateHead, WhoAsksForItWaitsAndNobodyElse) {
  serve();
  auto one = ask("GET /head.bin"), other = ask("GET /head.bin"), head = ask("HEAD /head.bin");
  {
    Connection gone(port_);  // does not wait
    gone.send("GET /head.bin HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port_) + "\r\n\r\n");
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  EXPECT_EQ(status_of(get(port_, "/info.json")), 200);
  EXPECT_THAT(get(port_, "/"), HasSubstr("head.js"));
  EXPECT_THAT(body_of(get(port_, "/head.js")), HasSubstr("// a head"));
  EXPECT_EQ(one.wait_for(std::chrono::milliseconds(300)), std::future_status::timeout);
  EXPECT_EQ(head.wait_for(std::chrono::milliseconds(0)), std::future_status::timeout);
  wanted_.set_value({'h', 'e', 'a', 'd'});
  for (auto* answer : {&one, &other}) {
    const std::string text = answer->get();
    EXPECT_EQ(status_of(text), 200);
    EXPECT_EQ(body_of(text), "head");
  }
  EXPECT_EQ(status_of(head.get()), 200);
  EXPECT_EQ(body_of(get(port_, "/head.bin")), "head");
  EXPECT_EQ(made_, 1);
  EXPECT_TRUE(sink_->finish());
}

TEST_F(LateHead, ThereMayBeNone) {
  serve();
  auto one = ask("GET /head.bin");
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  wanted_.set_value({});
  EXPECT_EQ(status_of(one.get()), 404);
  EXPECT_EQ(status_of(get(port_, "/head.bin")), 404);
  EXPECT_EQ(status_of(get(port_, "/")), 200);
}

TEST_F(LateHead, AServerMayEndBefore) {
  serve();
  auto one = ask("GET /head.bin");
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  std::thread later([this] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    wanted_.set_value({'x'});
  });
  sink_.reset();
  later.join();
  (void)one.get();  // whatever it was: the connection has ended
}

TEST_F(LateHead, NeedsAScript) {
  web::WebOptions options;
  options.make_head_model = [] { return Bytes{1}; };
  EXPECT_EQ(web::make_web_sink("http://127.0.0.1:0/", options).error().code,
            Code::invalid_argument);
}

}  // namespace late_head_test
}  // namespace animeme::test
