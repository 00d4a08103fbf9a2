#include "tools/live/engines/detail/osc.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string_view>

#include "tools/formats/media/rtp/wire_internal.h"

namespace animeme::engines {
namespace {

using media::append;
using media::ByteSpan;
using media::ByteVector;
using media::put;
using media::WireReader;

constexpr std::string_view kBundle = "#bundle";
constexpr std::uint64_t kNow = 1;  // time tag
constexpr int kDeepest = 8;        // bundles in bundles

// With one zero to four of them, so that the length is a multiple of four.
void put_text(ByteVector& out, std::string_view text) {
  out.insert(out.end(), text.begin(), text.end());
  out.insert(out.end(), 4 - text.size() % 4, 0);
}

ByteVector bytes_of(const OscMessage& message) {
  ByteVector out;
  put_text(out, message.address);
  std::string types = ",";
  for (const OscValue& value : message.values) {
    const bool* flag = std::get_if<bool>(&value);
    types += flag != nullptr ? (*flag ? 'T' : 'F') : "ifs"[value.index()];
  }
  put_text(out, types);
  for (const OscValue& value : message.values) {
    if (const auto* text = std::get_if<std::string>(&value)) {
      put_text(out, *text);
    } else if (const auto* number = std::get_if<float>(&value)) {
      put(out, std::bit_cast<std::uint32_t>(*number), 4);
    } else if (const auto* whole = std::get_if<std::int32_t>(&value)) {
      put(out, std::uint32_t(*whole), 4);
    }
  }
  return out;
}

std::optional<std::string> take_text(WireReader& in) {
  const ByteSpan rest = in.rest();
  const auto end = std::find(rest.begin(), rest.end(), 0);
  if (end == rest.end()) return std::nullopt;
  const std::size_t size = std::size_t(end - rest.begin());
  const std::string text(rest.begin(), end);
  in.take(size + 4 - size % 4);
  if (in.failed()) return std::nullopt;
  return text;
}

// false: the values behind this one cannot be found.
bool take_value(char type, WireReader& in, OscMessage& out) {
  switch (type) {
    case 'i':
      out.values.emplace_back(std::int32_t(in.u32()));
      return true;
    case 'f':
      out.values.emplace_back(std::bit_cast<float>(in.u32()));
      return true;
    case 'd':
      out.values.emplace_back(float(std::bit_cast<double>(in.get(8))));
      return true;
    case 'h':
      out.values.emplace_back(float(std::int64_t(in.get(8))));
      return true;
    case 'T':
      out.values.emplace_back(std::int32_t(1));
      return true;
    case 'F':
      out.values.emplace_back(std::int32_t(0));
      return true;
    case 's':
    case 'S':
      if (auto text = take_text(in)) {
        out.values.emplace_back(std::move(*text));
      } else {
        in.take(in.left() + 1);  // damaged
      }
      return true;
    default:
      return false;
  }
}

bool take_message(ByteSpan bytes, std::vector<OscMessage>& out) {
  WireReader in(bytes);
  const auto address = take_text(in);
  if (!address || address->empty() || address->front() != '/') return false;
  OscMessage message{*address, {}};
  if (in.left() > 0) {  // old senders leave the types out where there are no values
    const auto types = take_text(in);
    if (!types || types->empty() || types->front() != ',') return false;
    for (const char type : std::string_view(*types).substr(1)) {
      if (!take_value(type, in, message)) break;
    }
  }
  if (in.failed()) return false;
  out.push_back(std::move(message));
  return true;
}

bool take_packet(ByteSpan bytes, int depth, std::vector<OscMessage>& out) {
  if (bytes.empty() || bytes.size() % 4 != 0) return false;
  if (bytes.front() != '#') return take_message(bytes, out);
  WireReader in(bytes);
  if (depth == 0 || take_text(in) != std::string(kBundle)) return false;
  in.take(8);  // time tag
  while (in.left() > 0) {
    const ByteSpan element = in.take(in.u32());
    if (in.failed() || !take_packet(element, depth - 1, out)) return false;
  }
  return !in.failed();
}

}  // namespace

std::optional<double> OscMessage::number(std::size_t i) const {
  if (i >= values.size()) return std::nullopt;
  double number = 0;
  if (const auto* real = std::get_if<float>(&values[i])) {
    number = double(*real);
  } else if (const auto* whole = std::get_if<std::int32_t>(&values[i])) {
    number = double(*whole);
  } else {
    return std::nullopt;
  }
  if (!std::isfinite(number)) return std::nullopt;
  return number;
}

std::string OscMessage::text(std::size_t i) const {
  const std::string* text = i < values.size() ? std::get_if<std::string>(&values[i]) : nullptr;
  return text != nullptr ? *text : std::string();
}

std::vector<ByteVector> osc_bundles(std::span<const OscMessage> messages, std::size_t most) {
  std::vector<ByteVector> packets;
  for (const OscMessage& message : messages) {
    const ByteVector bytes = bytes_of(message);
    if (packets.empty() || packets.back().size() + 4 + bytes.size() > most) {
      put_text(packets.emplace_back(), kBundle);
      put(packets.back(), kNow, 8);
    }
    put(packets.back(), bytes.size(), 4);
    append(packets.back(), bytes);
  }
  return packets;
}

std::optional<std::vector<OscMessage>> read_osc(std::span<const std::uint8_t> packet) {
  std::vector<OscMessage> messages;
  if (!take_packet(packet, kDeepest, messages)) return std::nullopt;
  return messages;
}

}  // namespace animeme::engines
