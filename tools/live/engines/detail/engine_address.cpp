#include "tools/live/engines/detail/engine_address.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "tools/formats/media/rtp/udp_socket.h"
#include "tools/live/engines/engines.h"

namespace animeme::engines {
namespace {

constexpr int kLeastRate = 15, kMostRate = 120;
constexpr std::size_t kMostName = 64;  // characters of a subject or prefix

struct Scheme {
  std::string_view begin;
  Protocol protocol;
  int port;
  std::string_view send, receive;  // members of the query
};

constexpr std::array<Scheme, 3> kSchemes{{
    {"livelink://", Protocol::live_link, 11111, "rate=15..120, subject=NAME, timecode=day|stream",
     "rate=15..120, subject=NAME"},
    {"vmc://", Protocol::vmc, 39539, "rate=15..120, names=arkit|vrm0|vrm1, bones=on|off",
     "rate=15..120"},
    {"osc://", Protocol::unified, 9000, "rate=15..120, prefix=NAME, gaze=on|off, binary=1..8",
     "rate=15..120"},
}};

const Scheme* scheme_of(std::string_view url) {
  const auto found = std::find_if(kSchemes.begin(), kSchemes.end(), [&](const Scheme& scheme) {
    return url.starts_with(scheme.begin);
  });
  return found == kSchemes.end() ? nullptr : &*found;
}

int digit_of(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

// %20 and its like.
std::string unescaped(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escape = text[i] == '%' && i + 2 < text.size();
    const int high = escape ? digit_of(text[i + 1]) : -1;
    const int low = escape ? digit_of(text[i + 2]) : -1;
    if (high < 0 || low < 0) {
      out += text[i];
      continue;
    }
    out += char(16 * high + low);
    i += 2;
  }
  return out;
}

bool is_name(const std::string& text) {
  return !text.empty() && text.size() <= kMostName &&
         std::all_of(text.begin(), text.end(), [](char c) { return std::uint8_t(c) >= 0x20; });
}

// What is wrong with the value; empty: it has been taken.
std::string take_member(const std::string& name, const std::string& value, EngineAddress& out) {
  if (name == "rate") {
    const bool digits = !value.empty() && value.size() <= 3 &&
                        value.find_first_not_of("0123456789") == std::string::npos;
    const int rate = digits ? std::stoi(value) : 0;
    if (rate < kLeastRate || rate > kMostRate) return "rate is a whole number from 15 to 120";
    out.rate = rate;
  } else if (name == "binary") {
    if (value.size() != 1 || value < "1" || value > "8") return "binary is a number from 1 to 8";
    out.binary = value.front() - '0';
  } else if (name == "names") {
    if (value != "arkit" && value != "vrm" && value != "vrm0" && value != "vrm1") {
      return "names are arkit, vrm0 or vrm1";
    }
    out.names = value == "arkit"  ? ShapeNames::arkit
                : value == "vrm1" ? ShapeNames::vrm1
                                  : ShapeNames::vrm0;
  } else if (name == "timecode") {
    if (value != "day" && value != "stream") return "timecode is day or stream";
    out.time_of_day = value == "day";
  } else if (name == "bones" || name == "gaze") {
    if (value != "on" && value != "off") return name + " is on or off";
    (name == "bones" ? out.bones : out.gaze) = value == "on";
  } else {
    if (!is_name(value)) return name + " has 1 to 64 characters";
    (name == "prefix" ? out.prefix : out.subject.emplace()) = value;
  }
  return {};
}

// "rate=15..120, subject=NAME" has it.
bool is_member(std::string_view list, const std::string& name) {
  return (", " + std::string(list)).find(", " + name + "=") != std::string::npos;
}

}  // namespace

bool is_engine(std::string_view url) { return scheme_of(url) != nullptr; }

Result<EngineAddress> parse_engine_address(const std::string& url, bool receiving) {
  const auto wrong = [&](const std::string& what) {
    return make_error(Code::invalid_argument, "'" + url + "': " + what);
  };
  const Scheme* scheme = scheme_of(url);
  if (scheme == nullptr) return wrong("write livelink://, vmc:// or osc://");
  const std::size_t mark = url.find('?');
  const Result<media::HostPort> place = media::read_host_port(url.substr(0, mark), scheme->port);
  if (!place) return place.error();
  EngineAddress out;
  out.protocol = scheme->protocol;
  out.host = place->host;
  out.port = place->port;
  if (!receiving && out.host.empty()) {
    return wrong("name the machine to send to, as in " + std::string(scheme->begin) +
                 "127.0.0.1:" + std::to_string(scheme->port));
  }
  if (!receiving && out.port == 0) return wrong("there is no port 0 to send to");
  const std::string_view members = receiving ? scheme->receive : scheme->send;
  std::string query = mark == std::string::npos ? std::string() : url.substr(mark + 1);
  while (!query.empty()) {
    const std::size_t end = std::min(query.find('&'), query.size());
    const std::string member = query.substr(0, end);
    query.erase(0, end + 1);
    const std::size_t equals = std::min(member.find('='), member.size());
    const std::string name = member.substr(0, equals);
    const std::string value =
        unescaped(std::string_view(member).substr(std::min(equals + 1, member.size())));
    if (!is_member(members, name)) {
      return wrong("there is no '" + name + "' to " + (receiving ? "receive" : "send") + " by " +
                   std::string(scheme->begin) + ", but " + std::string(members));
    }
    if (const std::string bad = take_member(name, value, out); !bad.empty()) return wrong(bad);
  }
  return out;
}

}  // namespace animeme::engines
