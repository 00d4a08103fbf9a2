// What headers of requests say.
#include "tools/live/web/detail/headers.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>

#include "tools/live/web/detail/documents.h"

namespace animeme::test {
namespace headers_test {

using namespace animeme::web;

TEST(Headers, NamesOfHosts) {
  EXPECT_EQ(host_name("Example.org"), "example.org");
  EXPECT_EQ(host_name("example.org:8080"), "example.org");
  EXPECT_EQ(host_name("example.org."), "example.org");
  EXPECT_EQ(host_name("[::1]:80"), "::1");
  EXPECT_EQ(host_name("::1"), "::1") << "as some programs write it";
  for (const char* bad : {"", "[::1", "[::1]80", "a:b", ":80", "a:80x", "a b", "a\t."}) {
    EXPECT_EQ(host_name(bad), "") << bad;
  }
}

TEST(Headers, AServerForThisMachineGoesByNoOtherName) {
  std::array<char, 256> name{};
  ASSERT_EQ(gethostname(name.data(), name.size() - 1), 0);
  const OwnNames closed({"127.0.0.1", 80}, {});
  EXPECT_TRUE(closed.contains("localhost:80"));
  if (std::string(name.data()) != "localhost") {
    EXPECT_FALSE(closed.contains(name.data()));
  }
  const OwnNames open({"0.0.0.0", 80}, {});
  EXPECT_TRUE(open.contains(name.data()));
  EXPECT_TRUE(open.contains("127.0.0.1"));
  EXPECT_FALSE(open.contains("192.0.2.1"));
  EXPECT_FALSE(open.contains(""));
  EXPECT_TRUE(OwnNames({"192.0.2.1", 80}, {}).contains("192.0.2.1:80"));
  EXPECT_TRUE(OwnNames({"2001:db8::1", 80}, {}).contains("[2001:DB8::1]:80"));
}

TEST(Headers, Origins) {
  EXPECT_TRUE(origin_allowed("http://localhost:80", "localhost:80", {}));
  EXPECT_TRUE(origin_allowed("https://Host", "host", {})) << "behind a proxy";
  EXPECT_FALSE(origin_allowed("http://localhost:81", "localhost:80", {}));
  EXPECT_FALSE(origin_allowed("null", "localhost:80", {"https://a.example"}));
  EXPECT_FALSE(origin_allowed("", "localhost:80", {"*"})) << "too long to be read";
  EXPECT_TRUE(origin_allowed("https://a.example", "x", {"https://b.example", "https://a.example"}));
  EXPECT_FALSE(origin_allowed("https://a.example.evil", "x", {"https://a.example"}));
  EXPECT_FALSE(origin_allowed("http://", "", {}));
}

TEST(Headers, Encodings) {
  for (const char* yes : {"gzip", "GZIP", "deflate, gzip;q=0.5", "br,gzip", "*", "gzip ; q=1.0"}) {
    EXPECT_TRUE(takes_gzip(yes)) << yes;
  }
  for (const char* no : {"", "br", "gzip;q=0", "gzip; q=0.000", "identity", "gzipped", "*;q=0"}) {
    EXPECT_FALSE(takes_gzip(no)) << no;
  }
}

TEST(Headers, Versions) {
  EXPECT_TRUE(has_version("\"a\"", "\"a\""));
  EXPECT_TRUE(has_version("W/\"a\"", "\"a\"")) << "compared weakly, as RFC 9110 has it";
  EXPECT_TRUE(has_version("\"b\" , \"a\"", "\"a\""));
  EXPECT_TRUE(has_version("*", "\"a\""));
  EXPECT_FALSE(has_version("\"b\"", "\"a\""));
  EXPECT_FALSE(has_version("", "\"a\""));
}

TEST(Headers, DocumentsThatDoNotShrinkStayAsTheyAre) {
  const DocumentPtr tiny = make_document("abc");
  EXPECT_EQ(tiny->packed, "");
  EXPECT_NE(tiny->etag, make_document("abd")->etag);
  EXPECT_EQ(tiny->etag, make_document("abc")->etag);
  EXPECT_EQ(tiny->etag_of(true).back(), '"');
  EXPECT_EQ(make_document("")->bytes, "");
}

}  // namespace headers_test
}  // namespace animeme::test
