#include "tools/formats/inspect/carrier_messages.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "tools/formats/common/json.h"

namespace animeme::inspect {

namespace {

constexpr std::size_t kShapes = fap::kArkitShapeCount;

void put8(Message& out, std::uint32_t value) { out.push_back(std::uint8_t(value)); }
void put16(Message& out, std::uint32_t value) {
  put8(out, value >> 8);
  put8(out, value);
}
void put32(Message& out, std::uint32_t value) {
  put16(out, value >> 16);
  put16(out, value);
}
void put_float(Message& out, double value) {
  put32(out, std::bit_cast<std::uint32_t>(float(value)));
}
void put_text(Message& out, std::string_view text) {
  out.insert(out.end(), text.begin(), text.end());
}

// OSC: a zero and more of them up to a multiple of four.
void put_osc_string(Message& out, std::string_view text) {
  put_text(out, text);
  out.resize(out.size() + 4 - text.size() % 4);
}
void put_osc_element(Message& bundle, const Message& element) {
  put32(bundle, std::uint32_t(element.size()));
  bundle.insert(bundle.end(), element.begin(), element.end());
}

double rounded(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  const double whole = std::round(value * scale) / scale;
  return whole == 0 ? 0 : whole;  // no -0
}

}  // namespace

std::string_view headers_name(Headers headers) {
  switch (headers) {
    case Headers::udp:
      return "IP/UDP";
    case Headers::rtp:
      return "IP/UDP/RTP";
    case Headers::websocket:
      return "IP/TCP/WebSocket";
    case Headers::none:
      break;
  }
  return "-";
}

std::size_t header_bytes(Headers headers, std::size_t size) {
  const auto pieces = [](std::size_t bytes, std::size_t room) { return (bytes + room - 1) / room; };
  switch (headers) {
    case Headers::udp:
      return 8 + 20 * pieces(size + 8, 1480);
    case Headers::rtp:
      return 20 + 20 * pieces(size + 20, 1480);
    case Headers::websocket: {
      const std::size_t frame = size < 126 ? 2 : size < 65536 ? 4 : 10;
      return frame + 40 * pieces(size + frame, 1460);
    }
    case Headers::none:
      break;
  }
  return 0;
}

Message float_weights(const fap::ArkitFrame& weights) {
  Message out;
  for (std::size_t i = 0; i < kShapes; ++i) put_float(out, weights[i]);
  return out;
}

std::uint32_t weight_level(double weight, int bits) {
  const double most = double((1u << bits) - 1);
  return std::uint32_t(std::lround(std::clamp(weight, 0.0, 1.0) * most));
}

Message packed_weights(const fap::ArkitFrame& weights, int bits) {
  Message out;
  std::uint32_t waiting = 0;
  int have = 0;
  for (std::size_t i = 0; i < kShapes; ++i) {
    waiting = waiting << bits | weight_level(weights[i], bits);
    for (have += bits; have >= 8; have -= 8) put8(out, waiting >> (have - 8));
    waiting &= (1u << have) - 1;
  }
  if (have > 0) put8(out, waiting << (8 - have));
  return out;
}

Message live_link_packet(const fap::ArkitFrame& weights, const LiveLinkNames& names) {
  Message out;
  put8(out, 6);  // version
  put32(out, std::uint32_t(names.device.size()));
  put_text(out, names.device);
  put32(out, std::uint32_t(names.subject.size()));
  put_text(out, names.subject);
  put32(out, std::uint32_t(names.frame));
  put_float(out, 0);  // of the frame
  put32(out, std::uint32_t(names.rate));
  put32(out, 1);
  put8(out, fap::kArkitChannelCount);
  for (const double value : weights) put_float(out, value);
  return out;
}

Message vmc_bundle(const fap::ArkitFrame& weights) {
  Message out;
  put_osc_string(out, "#bundle");
  put32(out, 0);
  put32(out, 1);  // at once
  for (std::size_t i = 0; i < kShapes; ++i) {
    std::string name(fap::kArkitNames[i]);
    name[0] = char(name[0] - 'a' + 'A');
    Message value;
    put_osc_string(value, "/VMC/Ext/Blend/Val");
    put_osc_string(value, ",sf");
    put_osc_string(value, name);
    put_float(value, weights[i]);
    put_osc_element(out, value);
  }
  Message apply;
  put_osc_string(apply, "/VMC/Ext/Blend/Apply");
  put_osc_string(apply, ",");
  put_osc_element(out, apply);
  return out;
}

Message arf_unit(const fap::ArkitFrame& weights, std::uint32_t time) {
  Message payload;
  put32(payload, time);
  put16(payload, 0);  // the set of blend shapes
  put8(payload, 0);   // no confidences
  put16(payload, kShapes - 1);
  for (std::size_t i = 0; i < kShapes; ++i) {
    put16(payload, std::uint32_t(i));
    put_float(payload, weights[i]);
  }
  Message out;
  put8(out, 1 << 1);  // blend shapes
  put32(out, std::uint32_t(payload.size()));
  out.insert(out.end(), payload.begin(), payload.end());
  return out;
}

std::string azure_event(std::span<const fap::ArkitFrame> frames, std::size_t first, int decimals) {
  constexpr std::size_t kRolls[] = {54, 57, 60};  // head, left eye, right eye
  tools::Json rows = tools::Json::array();
  for (const fap::ArkitFrame& frame : frames) {
    tools::Json row = tools::Json::array();
    // "0", not "0.0": the shortest that says the same.
    const auto add = [&](double value) {
      value = rounded(value, decimals);
      if (value == std::trunc(value)) {
        row.push_back(std::int64_t(value));
      } else {
        row.push_back(value);
      }
    };
    for (std::size_t i = 0; i < kShapes; ++i) add(frame[i]);
    for (const std::size_t roll : kRolls) add(frame[roll]);
    rows.push_back(std::move(row));
  }
  return tools::Json{{"FrameIndex", first}, {"BlendShapes", std::move(rows)}}.dump();
}

std::string faps_message(const fap::Frame& face, const fap::Mask& faps, const fap::Rate& rate,
                         bool intra, std::size_t unit_bytes) {
  tools::Json json{{"time", rounded(1 + rate.seconds(double(face.number)), 6)},
                   {"duration", rounded(rate.seconds(1), 6)},
                   {"intra", intra},
                   {"bytes", unit_bytes}};
  tools::Json& values = json["values"] = tools::Json::object();
  for (std::size_t fap = 3; fap <= fap::kFapCount; ++fap) {
    if (faps[fap]) values[std::to_string(fap)] = face.value[fap];
  }
  return json.dump();
}

struct Deflater::Stream {
  z_stream z{};
  Stream() {
    deflateInit2(&z, Z_DEFAULT_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  }
  ~Stream() { deflateEnd(&z); }
};

Deflater::Deflater() : stream_(std::make_unique<Stream>()) {}
Deflater::Deflater(Deflater&&) noexcept = default;
Deflater& Deflater::operator=(Deflater&&) noexcept = default;
Deflater::~Deflater() = default;

Message Deflater::pack(std::span<const std::uint8_t> message) {
  z_stream& z = stream_->z;
  Message out(deflateBound(&z, uLong(message.size())) + 64);
  z.next_in = const_cast<Bytef*>(message.data());
  z.avail_in = uInt(message.size());
  z.next_out = out.data();
  z.avail_out = uInt(out.size());
  deflate(&z, Z_SYNC_FLUSH);
  out.resize(out.size() - z.avail_out);
  if (out.size() >= 4) out.resize(out.size() - 4);  // 00 00 FF FF
  return out;
}

}  // namespace animeme::inspect
