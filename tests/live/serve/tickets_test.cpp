#include "tools/live/serve/tickets.h"

#include <gtest/gtest.h>

#include <string>

namespace animeme::test {
namespace tickets_test {

using serve::Tickets;

// RFC 4231, test cases 1, 2, 6 and 7.
TEST(Tickets, TheSignatureIsHmac) {
  EXPECT_EQ(serve::hmac_sha256(std::string(20, 0x0b), "Hi There"),
            "b0344c61d8db38535ca8afceaf0bf12b881dc200c9833da726e9376c2e32cff7");
  EXPECT_EQ(serve::hmac_sha256("Jefe", "what do ya want for nothing?"),
            "5bdcc146bf60754e6a042426089575c75a003f089d2739839dec58b964ec3843");
  const std::string key(131, char(0xaa));
  EXPECT_EQ(serve::hmac_sha256(key, "Test Using Larger Than Block-Size Key - Hash Key First"),
            "60e431591ee0b67f0d8a26aacbf5b77f8e0bc6213728c5140546040f0ee37f54");
  EXPECT_EQ(serve::hmac_sha256(key,
                               "This is a test using a larger than block-size key and a larger "
                               "than block-size data. The key needs to be hashed before being "
                               "used by the HMAC algorithm."),
            "9b09ffa71b942fcb27635fbcd5b0e944bfdc63644f0713938a7f51535c3a35e2");
}

TEST(Tickets, AreForOneHeadAndSomeTime) {
  const Tickets tickets("secret");
  const std::string ticket = tickets.make("anna", 1000);
  EXPECT_TRUE(tickets.allows("anna", ticket, 999));
  EXPECT_FALSE(tickets.allows("anna", ticket, 1000));
  EXPECT_FALSE(tickets.allows("ann", ticket, 999));
  EXPECT_FALSE(Tickets("secre").allows("anna", ticket, 999));
  EXPECT_FALSE(Tickets("").allows("anna", Tickets("").make("anna", 1000), 999));
  for (std::size_t i = 0; i < ticket.size(); ++i) {
    std::string other = ticket;
    other[i] = other[i] == '1' ? '2' : '1';
    EXPECT_FALSE(tickets.allows("anna", other, 999)) << other;
    EXPECT_FALSE(tickets.allows("anna", ticket.substr(0, i), 999));
  }
  EXPECT_FALSE(tickets.allows("anna", ticket + "0", 999));
}

TEST(Tickets, SecretsAreTheSameOrNot) {
  EXPECT_TRUE(serve::same_secret("abc", "abc"));
  EXPECT_TRUE(serve::same_secret("", ""));
  for (const char* other : {"", "ab", "abd", "abcabc", "Abc"}) {
    EXPECT_FALSE(serve::same_secret("abc", other)) << other;
    EXPECT_FALSE(serve::same_secret(other, "abc")) << other;
  }
}

}  // namespace tickets_test
}  // namespace animeme::test
