// Writes the seeds of fuzz_websocket into a folder: make_corpus_websocket FOLDER
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/web_presentation.h"
#include "tools/formats/media/live/audio_segments.h"
#include "tools/live/web/detail/messages.h"

namespace {

using namespace animeme;

std::string g_folder;

void seed(const std::string& name, char kind, const std::string& bytes) {
  std::ofstream out(g_folder + "/" + name, std::ios::binary);
  out << kind << bytes;
}

std::string text_of(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

std::string sized(const std::string& bytes) {
  return std::string{char(bytes.size() >> 8), char(bytes.size() & 255)} + bytes;
}

/// A frame as a client sends it, masked.
std::string frame(int opcode, const std::string& content, bool last = true) {
  std::string out{char((last ? 0x80 : 0) | opcode)};
  if (content.size() < 126) {
    out += char(0x80 | content.size());
  } else {
    out += char(0x80 | 126);
    out += char(content.size() >> 8);
    out += char(content.size() & 255);
  }
  const std::string mask = "\x37\xFA\x21\x3D";
  out += mask;
  for (std::size_t i = 0; i < content.size(); ++i) out += char(content[i] ^ mask[i % 4]);
  return out;
}

std::string close_frame(int code, const std::string& why = "") {
  return frame(8, std::string{char(code >> 8), char(code & 255)} + why);
}

void frames() {
  const std::vector<std::pair<const char*, std::string>> all = {
      {"text", frame(1, "hello")},
      {"binary", frame(2, std::string(100, '\x55'))},
      {"empty", frame(1, "")},
      {"ping", frame(9, "are you there") + frame(9, "")},
      {"pong", frame(10, "yes")},
      {"close", close_frame(1000)},
      {"close_why", close_frame(1001, "going away")},
      {"close_bad", close_frame(5) + close_frame(1005)},
      {"close_short", frame(8, "x")},
      {"parts", frame(1, "he", false) + frame(0, "ll", false) + frame(0, "o")},
      {"ping_between", frame(2, "a", false) + frame(9, "p") + frame(0, "b")},
      {"stray_part", frame(0, "goes on with nothing")},
      {"two_begun", frame(1, "a", false) + frame(1, "b")},
      {"long", frame(2, std::string(3000, 'x'))},
      {"many",
       [] {
         std::string out;
         for (int i = 0; i < 60; ++i) out += frame(1 + i % 2, std::string(std::size_t(i), 'y'));
         return out;
       }()},
      {"long_ping", frame(9, std::string(126, 'p'))},
      {"part_of_ping", frame(9, "p", false)},
      {"reserved_op", frame(3, "?") + frame(11, "?")},
      {"reserved_bits", "\xF1" + frame(1, "compressed?").substr(1)},
      {"huge", std::string("\x82\xFF\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF\1\2\3\4", 14) + "data"},
      {"length_of_64", std::string("\x82\xFF\0\0\0\0\0\0\0\x05\1\2\3\4hello", 19)},
      {"not_masked", std::string("\x81\x05hello", 7)},
      {"bad_utf8", frame(1, "\xC3\x28\xFF")},
      {"half_a_frame", frame(2, std::string(50, 'z')).substr(0, 20)},
  };
  int path = 0;
  for (const auto& [name, bytes] : all) {
    seed(std::string("w_") + name, 'w', std::string(1, char(path++ % 3)) + bytes);
  }
}

void requests() {
  const std::string host = "Host: localhost\r\n";
  const auto get = [&](const std::string& path, const std::string& more = "") {
    return "GET " + path + " HTTP/1.1\r\n" + host + more + "\r\n";
  };
  const std::string socket =
      "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
  const std::vector<std::pair<const char*, std::string>> all = {
      {"page", get("/")},
      {"gzip", get("/live.js", "Accept-Encoding: gzip, deflate;q=0.5\r\n")},
      {"version", get("/live.css", "If-None-Match: \"a\", W/\"b\"\r\n")},
      {"head", "HEAD /info.json HTTP/1.1\r\n" + host + "\r\n"},
      {"two", get("/info.json") + get("/info.json", "Connection: close\r\n")},
      {"old", "GET /info.json HTTP/1.0\r\n\r\n"},
      {"post", "POST / HTTP/1.1\r\n" + host + "Content-Length: 3\r\n\r\nabc"},
      {"chunked",
       "POST / HTTP/1.1\r\n" + host + "Transfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n0\r\n\r\n"},
      {"options", "OPTIONS * HTTP/1.1\r\n" + host + "Origin: http://a.example\r\n\r\n"},
      {"climbing", get("/../%2e%2e/etc/passwd%00?a=b&c#d")},
      {"no_host", "GET / HTTP/1.1\r\n\r\n"},
      {"other_host", "GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n"},
      {"two_hosts", "GET / HTTP/1.1\r\n" + host + "Host: evil.example\r\n\r\n"},
      {"absolute", "GET http://localhost/info.json HTTP/1.1\r\n" + host + "\r\n"},
      {"range", get("/live.js", "Range: bytes=0-5\r\n")},
      {"folded", get("/", "X-A: b\r\n c\r\n")},
      {"talk", get("/talk.mp4")},
      {"origin", get("/face", socket + "Origin: http://evil.example\r\n")},
      {"no_key", get("/face", "Upgrade: websocket\r\nConnection: Upgrade\r\n")},
      {"version_8", get("/face",
                        "Upgrade: websocket\r\nConnection: Upgrade\r\n"
                        "Sec-WebSocket-Version: 8\r\nSec-WebSocket-Key: x\r\n")},
      {"protocol", get("/faps", socket + "Sec-WebSocket-Protocol: animeme, chat\r\n")},
      {"extension", get("/faps", socket + "Sec-WebSocket-Extensions: permessage-deflate\r\n")},
      {"other_upgrade", get("/",
                            "Upgrade: h2c\r\nConnection: Upgrade, HTTP2-Settings\r\n"
                            "HTTP2-Settings: AAMAAABkAARAAAAA\r\n")},
      {"http2", "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + std::string("\0\0\0\4\0\0\0\0\0", 9)},
      {"long_path", get("/" + std::string(3000, 'a'))},
      {"bare_newlines", "GET / HTTP/1.1\nHost: localhost\n\n"},
      {"nonsense", std::string("\x16\x03\x01\x02\0\x01\0\x01\xFC", 9)},
  };
  for (const auto& [name, bytes] : all) seed(std::string("h_") + name, 'h', bytes);
}

void headers() {
  const std::vector<std::string> all = {
      "localhost:80\nhttp://localhost:80\ngzip\n\"x\"",
      "[::1]:8080\nhttps://[::1]:8080\ngzip;q=0, *;q=0.5\nW/\"x\", \"y\"",
      "Talk.Example.\nhttps://a.example\nbr\n*",
      "evil.example\nhttp://evil.example\n\n",
      "127.0.0.1:80:80\nnull\nidentity\n,,\"x",
      "[::1\n\ngzip;x=1;q=1\n\"x",
      ":80\nhttp://:80\n;q=\n",
  };
  for (std::size_t i = 0; i < all.size(); ++i) seed("u_" + std::to_string(i), 'u', all[i]);
}

void messages() {
  const fuzz::WebPresentation show = fuzz::web_presentation();
  const auto message = [](bool sound, const std::string& bytes) {
    return std::string(1, char(sound)) + sized(bytes);
  };
  const std::string hello = text_of(web::write_hello(
      {show.info.visual_profile, true, show.info.timescale, show.info.face_config}));
  const std::string init = text_of(*media::write_audio_init(*show.info.audio));
  std::string face = message(false, hello), sound = message(true, init) + face, units;
  std::vector<media::AudioPacket> packets;
  std::uint32_t segments = 0;
  int planes = 0;
  for (const media::LiveUnit& unit : show.units) {
    if (unit.track == media::LiveTrack::audio) {
      packets.push_back({unit.bytes, unit.time + 16000, unit.duration});
      if (packets.size() < 4 || segments == 3) continue;
      sound += message(true, text_of(*media::write_audio_segment(++segments, packets)));
      packets.clear();
      continue;
    }
    if (++planes > 12) continue;
    const std::uint8_t flags = unit.intra ? (planes > 1 ? 3 : 1) : 0;
    face += message(
        false,
        text_of(web::write_unit({std::uint64_t(unit.time) + 25000, 1000, flags, unit.bytes})));
    units += sized(text_of(unit.bytes));
    seed("v_" + std::to_string(planes), 'v', units);
  }
  seed("m_face", 'm', face);
  seed("m_sound", 'm', sound);
  seed("m_both", 'm', face + sound);
  seed("m_hello", 'm', message(false, hello));
  seed("m_init", 'm', message(true, init));
  seed("m_no_face", 'm',
       message(false, text_of(web::write_hello({0x61, true, 16000, {}}))) + sound);
  seed("m_no_hello", 'm', face.substr(message(false, hello).size()));
  seed("m_other_version", 'm', message(false, "A\x02" + hello.substr(2)));
  seed("m_late", 'm',
       face + message(false, text_of(web::write_unit(
                                 {UINT64_MAX >> 2, UINT32_MAX, 1, {0, 0, 1, 0xBB, 0}}))));
  seed("m_empty", 'm', message(false, "") + message(true, "") + message(false, hello.substr(0, 5)));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "make_corpus_websocket FOLDER\n");
    return 2;
  }
  g_folder = argv[1];
  frames();
  requests();
  headers();
  messages();
  return 0;
}
