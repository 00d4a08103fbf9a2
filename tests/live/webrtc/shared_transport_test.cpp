// Offers whose bundled media have ICE credentials of their own, as aiortc makes them.
#include "tools/live/webrtc/detail/shared_transport.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace animeme::webrtc {
namespace shared_transport_test {

using testing::HasSubstr;
using testing::Not;

std::string medium(const std::string& kind, const std::string& mid, const std::string& ufrag) {
  return "m=" + kind + "\r\nc=IN IP4 192.0.2.2\r\na=mid:" + mid +
         "\r\na=candidate:1 1 udp 2130706431 192.0.2.2 4838" + mid +
         " typ host\r\na=end-of-candidates\r\na=ice-ufrag:" + ufrag + "\r\na=ice-pwd:secret-of-" +
         ufrag + "-secret\r\na=fingerprint:sha-256 EB:96\r\na=setup:actpass\r\n";
}

std::string offer(const std::string& second, const std::string& bundle = "a=group:BUNDLE 0 1\r\n") {
  return "v=0\r\no=- 1 1 IN IP4 0.0.0.0\r\ns=-\r\nt=0 0\r\n" + bundle +
         medium("audio 48382 UDP/TLS/RTP/SAVPF 96", "0", "tTLI") +
         medium("application 42609 DTLS/SCTP 5000", "1", second);
}

TEST(SharedTransport, OfTheFirstOfTheBundleCounts) {
  const std::string shared = share_transport(offer("Lw75"));
  EXPECT_EQ(shared, offer("tTLI").replace(offer("tTLI").rfind("48381"), 5, "48380"));
  EXPECT_THAT(shared, Not(HasSubstr("Lw75")));
  EXPECT_EQ(share_transport(shared), shared);
}

TEST(SharedTransport, AllElseStaysAsItIs) {
  for (const std::string& text :
       {offer("tTLI"), offer("Lw75", ""), offer("Lw75", "a=group:BUNDLE 0\r\n"),
        offer("Lw75", "a=group:BUNDLE 7 1\r\n"), std::string(), std::string("m=\nm="),
        std::string("a=group:BUNDLE 0 1"), std::string(1000, '\n')}) {
    EXPECT_EQ(share_transport(text), text);
  }
}

}  // namespace shared_transport_test
}  // namespace animeme::webrtc
