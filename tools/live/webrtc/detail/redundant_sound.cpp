#include "tools/live/webrtc/detail/redundant_sound.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <utility>

namespace animeme::webrtc {
namespace {

constexpr std::size_t kMostPayload = 1100;         // bytes; what fits in one datagram
constexpr std::uint32_t kMostAge = (1 << 14) - 1;  // 14 bits: 0.34 s
constexpr std::size_t kMostBlock = (1 << 10) - 1;  // 10 bits
// One repetition recovers single losses, the second those of two packets in a row.
constexpr double kSome = 0.003, kMuch = 0.02;
constexpr int kHold = 1500;  // packets: 30 s

std::string_view line_at(const std::string& sdp, std::size_t at) {
  std::string_view line = std::string_view(sdp).substr(at, sdp.find('\n', at) - at);
  while (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::size_t next_line(const std::string& sdp, std::size_t at) {
  const std::size_t end = sdp.find('\n', at);
  return end == std::string::npos ? sdp.size() : end + 1;
}

// [begin, end) of the first sound; empty: there is none.
std::pair<std::size_t, std::size_t> sound_of(const std::string& sdp) {
  std::size_t begin = std::string::npos;
  for (std::size_t at = 0; at < sdp.size(); at = next_line(sdp, at)) {
    const std::string_view line = line_at(sdp, at);
    if (!line.starts_with("m=")) continue;
    if (begin != std::string::npos) return {begin, at};
    if (line.starts_with("m=audio ")) begin = at;
  }
  if (begin == std::string::npos) return {0, 0};
  return {begin, sdp.size()};
}

// The number behind `start`, and what follows the blank after it; -1: the line is another one.
int type_of(std::string_view line, std::string_view start, std::string& rest) {
  if (!line.starts_with(start)) return -1;
  line.remove_prefix(start.size());
  std::size_t digits = 0;
  int type = 0;
  while (digits < line.size() && digits < 3 &&
         std::isdigit(static_cast<unsigned char>(line[digits]))) {
    type = type * 10 + (line[digits++] - '0');
  }
  if (digits == 0 || digits >= line.size() || line[digits] != ' ' || type > 127) return -1;
  rest.clear();
  for (const char c : line.substr(digits + 1)) {
    rest += char(std::tolower(static_cast<unsigned char>(c)));
  }
  return type;
}

// In "minptime=10; useinbandfec=1".
bool has_fec(const std::string& parameters) {
  std::istringstream all(parameters);
  for (std::string one; std::getline(all, one, ';');) {
    std::erase_if(one, [](char c) { return c == ' ' || c == '\t'; });
    if (one == "useinbandfec=1") return true;
  }
  return false;
}

}  // namespace

SoundTypes sound_types(const std::string& sdp) {
  SoundTypes types;
  const auto [begin, end] = sound_of(sdp);
  std::vector<int> redundant;
  std::string rest;
  for (std::size_t at = begin; at < end; at = next_line(sdp, at)) {
    const int type = type_of(line_at(sdp, at), "a=rtpmap:", rest);
    if (type < 0) continue;
    if (types.opus < 0 && rest.starts_with("opus/48000")) types.opus = type;
    if (rest.starts_with("red/48000")) redundant.push_back(type);
  }
  // What is in it are Opus and Opus, as Chromium offers it: a=fmtp:63 111/111.
  const std::string pair = std::to_string(types.opus) + "/" + std::to_string(types.opus);
  for (std::size_t at = begin; at < end; at = next_line(sdp, at)) {
    const int type = type_of(line_at(sdp, at), "a=fmtp:", rest);
    if (type >= 0 && type == types.opus) types.fec = has_fec(rest);
    if (types.opus < 0 || (rest != pair && !rest.starts_with(pair + "/"))) continue;
    if (std::find(redundant.begin(), redundant.end(), type) != redundant.end()) {
      types.redundant = type;
    }
  }
  return types;
}

std::string with_redundant(const std::string& sdp, const SoundTypes& types) {
  const SoundTypes there = sound_types(sdp);
  if (types.redundant < 0 || there.opus != types.opus || there.redundant >= 0) return sdp;
  const std::string type = std::to_string(types.redundant), opus = std::to_string(types.opus);
  const auto [begin, end] = sound_of(sdp);
  std::string text = sdp.substr(0, begin);
  for (std::size_t at = begin; at < end; at = next_line(sdp, at)) {
    const std::string_view line = line_at(sdp, at);
    text += line;
    if (at == begin) text += " " + type;
    text += "\r\n";
    if (line.starts_with("a=rtpmap:" + opus + " ")) {
      text +=
          "a=rtpmap:" + type + " red/48000/2\r\na=fmtp:" + type + " " + opus + "/" + opus + "\r\n";
    }
  }
  return text + sdp.substr(end);
}

std::string without_redundant(const std::string& sdp, const SoundTypes& types) {
  if (types.redundant < 0) return sdp;
  const std::string type = std::to_string(types.redundant);
  const auto [begin, end] = sound_of(sdp);
  std::string text = sdp.substr(0, begin);
  for (std::size_t at = begin; at < end; at = next_line(sdp, at)) {
    const std::string_view line = line_at(sdp, at);
    if (at == begin) {
      // m=audio 9 UDP/TLS/RTP/SAVPF 111 63
      std::istringstream words{std::string(line)};
      std::string kept;
      int number = 0;
      for (std::string word; words >> word; ++number) {
        if (number < 3 || word != type) kept += (number == 0 ? "" : " ") + word;
      }
      text += kept + "\r\n";
      continue;
    }
    bool is_its = false;
    for (const char* start : {"a=rtpmap:", "a=fmtp:", "a=rtcp-fb:"}) {
      is_its |= line.starts_with(start + type + " ");
    }
    if (!is_its) text += std::string(line) + "\r\n";
  }
  return text + sdp.substr(end);
}

void RedundantSound::push(std::span<const std::uint8_t> packet, std::uint32_t time) {
  packets_.push_back({{packet.begin(), packet.end()}, time});
  if (packets_.size() > kMostRepeats + 1) packets_.pop_front();
}

std::vector<std::uint8_t> RedundantSound::payload(int repeats, int type) const {
  std::vector<std::uint8_t> bytes;
  if (packets_.empty()) return bytes;
  const Packet& newest = packets_.back();
  std::size_t first = packets_.size() - 1, size = 1 + newest.bytes.size();
  for (int i = 0; i < repeats && first > 0; ++i) {
    const Packet& one = packets_[first - 1];
    size += 4 + one.bytes.size();
    const std::uint32_t age = newest.time - one.time;
    if (age == 0 || age > kMostAge || one.bytes.size() > kMostBlock || size > kMostPayload) break;
    --first;
  }
  // RFC 2198, section 3: a header of 4 bytes for each that goes again, one byte for the newest.
  for (std::size_t at = first; at + 1 < packets_.size(); ++at) {
    const std::uint32_t age = newest.time - packets_[at].time;
    const auto length = std::uint32_t(packets_[at].bytes.size());
    bytes.insert(bytes.end(), {std::uint8_t(0x80 | type), std::uint8_t(age >> 6),
                               std::uint8_t((age << 2) | (length >> 8)), std::uint8_t(length)});
  }
  bytes.push_back(std::uint8_t(type));
  for (std::size_t at = first; at < packets_.size(); ++at) {
    bytes.insert(bytes.end(), packets_[at].bytes.begin(), packets_[at].bytes.end());
  }
  return bytes;
}

int LossGauge::repeats(double loss) {
  const int wanted = loss >= kMuch ? 2 : loss >= kSome ? 1 : 0;
  if (wanted >= repeats_) {
    repeats_ = wanted;
    since_ = 0;
  } else if (++since_ > kHold) {
    repeats_ = wanted;
    since_ = 0;
  }
  return repeats_;
}

}  // namespace animeme::webrtc
