#include "tools/formats/media/rtp/rtcp.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>

#include "tools/formats/media/rtp/wire_internal.h"

namespace animeme::media {
namespace {

enum PacketType : std::uint8_t {
  kSender = 200,
  kReceiver = 201,
  kNames = 202,
  kBye = 203,
  kPayloadFeedback = 206,
};
// Formats of kPayloadFeedback.
constexpr std::size_t kPictureLoss = 1;
constexpr std::size_t kFullIntra = 4;
constexpr std::uint8_t kCname = 1;
constexpr std::size_t kMaxCount = 31;

// Writes the header and, when it goes, the length.
class PacketWriter {
 public:
  PacketWriter(ByteVector& out, PacketType type, std::size_t count)
      : out_(out), begin_(out.size()) {
    put(out, 0x80 | std::min(count, kMaxCount), 1);
    put(out, type, 1);
    put(out, 0, 2);
  }
  ~PacketWriter() {
    while ((out_.size() - begin_) % 4 != 0) out_.push_back(0);
    write_big_endian(out_, begin_ + 2, 2, (out_.size() - begin_) / 4 - 1);
  }
  PacketWriter(const PacketWriter&) = delete;
  PacketWriter& operator=(const PacketWriter&) = delete;

 private:
  ByteVector& out_;
  std::size_t begin_;
};

void write_block(ByteVector& out, const ReportBlock& block) {
  constexpr std::int32_t kLimit = 0x7FFFFF;
  put(out, block.ssrc, 4);
  put(out, block.fraction, 1);
  put(out, std::uint32_t(std::clamp(block.lost, -kLimit - 1, kLimit)), 3);
  put(out, block.highest, 4);
  put(out, block.jitter, 4);
  put(out, block.last_sr, 4);
  put(out, block.since_sr, 4);
}

ReportBlock read_block(WireReader& in) {
  ReportBlock block;
  block.ssrc = in.u32();
  block.fraction = in.u8();
  block.lost = std::int32_t(std::uint32_t(in.get(3)) << 8) >> 8;
  block.highest = in.u32();
  block.jitter = in.u32();
  block.last_sr = in.u32();
  block.since_sr = in.u32();
  return block;
}

void write_report(ByteVector& out, const RtcpReport& report) {
  const PacketWriter packet(out, report.sender ? kSender : kReceiver, report.blocks.size());
  put(out, report.ssrc, 4);
  if (report.sender) {
    put(out, report.sender->ntp, 8);
    put(out, report.sender->rtp, 4);
    put(out, report.sender->packets, 4);
    put(out, report.sender->octets, 4);
  }
  for (std::size_t i = 0; i < std::min(report.blocks.size(), kMaxCount); ++i) {
    write_block(out, report.blocks[i]);
  }
}

bool read_report(WireReader in, PacketType type, std::size_t count, RtcpMessage& message) {
  RtcpReport report;
  report.ssrc = in.u32();
  if (type == kSender) {
    SenderInfo info;
    info.ntp = in.get(8);
    info.rtp = in.u32();
    info.packets = in.u32();
    info.octets = in.u32();
    report.sender = info;
  }
  for (std::size_t i = 0; i < count; ++i) report.blocks.push_back(read_block(in));
  if (in.failed()) return false;
  message.reports.push_back(std::move(report));
  return true;
}

void write_names(ByteVector& out, const std::vector<RtcpName>& names) {
  const PacketWriter packet(out, kNames, names.size());
  for (std::size_t i = 0; i < std::min(names.size(), kMaxCount); ++i) {
    const std::string name = names[i].cname.substr(0, 255);
    put(out, names[i].ssrc, 4);
    put(out, kCname, 1);
    put(out, name.size(), 1);
    out.insert(out.end(), name.begin(), name.end());
    do {  // at least one zero ends the items
      out.push_back(0);
    } while (out.size() % 4 != 0);
  }
}

bool read_names(WireReader in, std::size_t count, RtcpMessage& message) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = in.left();
    const std::uint32_t ssrc = in.u32();
    while (!in.failed()) {
      const std::uint8_t item = in.u8();
      if (item == 0) break;
      const ByteSpan text = in.take(in.u8());
      if (item == kCname) message.names.push_back({ssrc, {text.begin(), text.end()}});
    }
    while (!in.failed() && (begin - in.left()) % 4 != 0) in.u8();
  }
  return !in.failed();
}

bool read_byes(WireReader in, std::size_t count, RtcpMessage& message) {
  for (std::size_t i = 0; i < count; ++i) message.byes.push_back(in.u32());
  return !in.failed();
}

void write_request(ByteVector& out, const IntraRequest& request) {
  const PacketWriter packet(out, kPayloadFeedback, request.sequence ? kFullIntra : kPictureLoss);
  put(out, request.ssrc, 4);
  put(out, request.sequence ? 0 : request.media, 4);
  if (!request.sequence) return;
  put(out, request.media, 4);
  put(out, *request.sequence, 1);
  put(out, 0, 3);
}

bool read_request(WireReader in, std::size_t format, RtcpMessage& message) {
  const std::uint32_t ssrc = in.u32();
  const std::uint32_t media = in.u32();
  if (in.failed()) return false;
  if (format == kPictureLoss) message.requests.push_back({ssrc, media, std::nullopt});
  while (format == kFullIntra && in.left() >= 8) {
    const std::uint32_t wanted = in.u32();
    message.requests.push_back({ssrc, wanted, in.u8()});
    in.get(3);
  }
  return true;
}

bool read_packet(ByteSpan body, std::uint8_t type, std::size_t count, RtcpMessage& message) {
  const WireReader in(body);
  if (type == kNames) return read_names(in, count, message);
  if (type == kBye) return read_byes(in, count, message);
  if (type == kPayloadFeedback) return read_request(in, count, message);
  if (type != kSender && type != kReceiver) return true;
  return read_report(in, PacketType(type), count, message);
}

}  // namespace

std::vector<std::uint8_t> write_rtcp(const RtcpMessage& message) {
  ByteVector out;
  for (const RtcpReport& report : message.reports) write_report(out, report);
  if (!message.names.empty()) write_names(out, message.names);
  if (!message.byes.empty()) {
    const PacketWriter packet(out, kBye, message.byes.size());
    for (std::size_t i = 0; i < std::min(message.byes.size(), kMaxCount); ++i) {
      put(out, message.byes[i], 4);
    }
  }
  for (const IntraRequest& request : message.requests) write_request(out, request);
  return out;
}

std::optional<RtcpMessage> read_rtcp(std::span<const std::uint8_t> datagram) {
  if (datagram.size() < 4) return std::nullopt;
  RtcpMessage message;
  WireReader in(datagram);
  while (in.left() > 0) {
    const std::uint8_t flags = in.u8();
    const std::uint8_t type = in.u8();
    ByteSpan body = in.take(4 * std::size_t(in.u16()));
    if (in.failed() || flags >> 6 != 2) return std::nullopt;
    if ((flags & 0x20) != 0) {
      if (body.empty() || body.back() > body.size()) return std::nullopt;
      body = body.first(body.size() - body.back());
    }
    if (!read_packet(body, type, flags & 31u, message)) return std::nullopt;
  }
  return message;
}

std::uint64_t ntp_now() {
  using namespace std::chrono;
  constexpr std::uint64_t kFrom1900To1970 = 2208988800;
  const auto since = duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
  const std::uint64_t nanos = std::uint64_t(since);
  return ((nanos / 1000000000 + kFrom1900To1970) << 32) | ((nanos % 1000000000) << 32) / 1000000000;
}

std::uint64_t random_number() {
  std::uint64_t number = 0;
  // Early after the start of the machine there may be none; the time is different enough, too.
  if (::getentropy(&number, sizeof number) != 0) number = ntp_now();
  return number;
}

}  // namespace animeme::media
