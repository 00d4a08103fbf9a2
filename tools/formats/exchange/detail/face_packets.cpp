#include "tools/formats/exchange/detail/face_packets.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "dam/script/table_text_internal.h"
#include "fap/arkit.h"
#include "tools/formats/exchange/detail/times.h"

namespace animeme::exchange {

namespace {

constexpr std::string_view kPacketEnd = "___iFacialMocap";

// Where a packet's parts are: "jawOpen-12" and "head#1,2,3".
struct PacketField {
  std::string_view name;
  std::string_view value;
  bool angles = false;
};

std::optional<PacketField> packet_field(std::string_view text) {
  text = dam::trimmed(text);
  if (text.starts_with('=')) text.remove_prefix(1);
  if (const std::size_t mark = text.find('#'); mark != std::string_view::npos) {
    return PacketField{text.substr(0, mark), text.substr(mark + 1), true};
  }
  std::size_t mark = text.find('&');
  if (mark == std::string_view::npos) mark = text.find('-', 1);
  if (mark == std::string_view::npos) return std::nullopt;
  return PacketField{dam::trimmed(text.substr(0, mark)), dam::trimmed(text.substr(mark + 1)),
                     false};
}

std::optional<int> packet_shape(const PacketField& field) {
  if (field.angles) return std::nullopt;
  const std::optional<int> channel = fap::find_arkit(field.name);
  return channel && *channel < fap::kArkitShapeCount ? channel : std::nullopt;
}

struct Packet {
  std::string_view text;
  std::int64_t line = 0;
};

// One a line, or several.
std::vector<Packet> packets_of(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::vector<Packet> packets;
  for (std::int64_t line = 1; !text.empty(); ++line) {
    std::string_view row = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(row.size() + 1, text.size()));
    while (!row.empty()) {
      const std::size_t end = row.find(kPacketEnd);
      std::string_view one = dam::trimmed(row.substr(0, end));
      if (one.starts_with("b'") && one.ends_with("'")) one = one.substr(2, one.size() - 3);
      if (!one.empty() && !one.starts_with('#')) packets.push_back({one, line});
      row.remove_prefix(end == std::string_view::npos ? row.size() : end + kPacketEnd.size());
    }
  }
  return packets;
}

// Takes a time off the front of a packet.
std::optional<double> take_time(std::string_view& packet) {
  const std::size_t end = packet.find_first_of("|,;\t ");
  if (end == std::string_view::npos) return std::nullopt;
  const std::optional<RowTime> time = parse_time(packet.substr(0, end), 0);
  if (!time || time->frames) return std::nullopt;
  packet.remove_prefix(end + 1);
  return time->seconds;
}

class PacketReader {
 public:
  Result<ShapeTable> read(std::string_view text) {
    const std::vector<Packet> packets = packets_of(text);
    for (std::size_t i = 0; i < packets.size(); ++i) {
      auto read = read_packet(packets[i]);
      if (read) continue;
      // A recording that was stopped ends within a packet.
      if (i == 0 || i + 1 < packets.size()) return read.error();
      warnings_.emplace_back("the last packet is cut off and was left out");
    }
    if (rows_.empty()) return make_error(Code::truncated, "there is no packet in it");
    if (timed_ > 0 && timed_ < rows_.size()) {
      return make_error(Code::syntax, "some packets have a time in front and others have none");
    }
    return table();
  }

 private:
  struct PacketRow {
    double time = 0;
    fap::ArkitFrame values{};
  };

  Result<void> read_packet(Packet packet) {
    PacketRow row;
    const std::optional<double> time = take_time(packet.text);
    row.time = time.value_or(0);
    bool any = false;
    for (const std::string_view part : dam::split_fields(packet.text, '|')) {
      const std::optional<PacketField> field = packet_field(part);
      if (!field) continue;
      if (field->angles) {
        if (auto read = read_angles(*field, packet.line, row.values); !read) return read;
        continue;
      }
      const std::optional<int> shape = packet_shape(*field);
      if (!shape) {
        ignored_.insert(std::string(field->name.substr(0, 60)));
        continue;
      }
      const std::optional<double> value = dam::parse_number(field->value);
      if (!value) return wrong(*field, packet.line);
      row.values[std::size_t(*shape)] = *value / 100;
      channels_.set(std::size_t(*shape));
      any = true;
    }
    if (!any) {
      return error_at_line(Code::syntax, "this packet has no shape of ARKit, such as jawOpen-12",
                           packet.line);
    }
    timed_ += time ? 1 : 0;
    rows_.push_back(row);
    return {};
  }

  static Error wrong(const PacketField& field, std::int64_t line) {
    return error_at_line(Code::syntax,
                         std::string(field.name.substr(0, 60)) + " is '" +
                             std::string(field.value.substr(0, 60)) + "', which is not a number",
                         line);
  }

  Result<void> read_angles(const PacketField& field, std::int64_t line, fap::ArkitFrame& values) {
    const std::string name(dam::trimmed(field.name));
    const bool head = name == "head";
    if (!head && name != "leftEye" && name != "rightEye") {
      ignored_.insert(name.substr(0, 60));
      return {};
    }
    const std::vector<std::string_view> numbers = dam::split_fields(field.value, ',');
    if (numbers.size() < 3) return wrong(field, line);
    std::array<double, 3> xyz{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::optional<double> value = dam::parse_number(numbers[i]);
      if (!value) return wrong(field, line);
      xyz[i] = *value * std::numbers::pi / 180;
    }
    // ARKit's axes: X and Y point to the person's left and up. Live Link turns the other way.
    const auto put = [&](const std::string& axis, double value) {
      const std::optional<int> channel = fap::find_arkit(name + axis);
      if (!channel) return;
      values[std::size_t(*channel)] = value;
      channels_.set(std::size_t(*channel));
    };
    put("Pitch", xyz[0]);
    put("Yaw", -xyz[1]);
    put("Roll", -xyz[2]);
    return {};
  }

  ShapeTable table() {
    ShapeTableWriter table(timed_ > 0 ? "time_s" : "", channels_);
    for (const PacketRow& row : rows_)
      table.add(cell_of(row.time - rows_.front().time), row.values);
    ShapeTable out{table.take(), {}};
    if (!ignored_.empty()) {
      std::string names;
      for (const std::string& name : ignored_) names += (names.empty() ? "" : ", ") + name;
      warnings_.push_back("left out: " + names);
    }
    out.warnings = std::move(warnings_);
    return out;
  }

  std::vector<PacketRow> rows_;
  std::size_t timed_ = 0;
  fap::ArkitChannels channels_;
  std::set<std::string> ignored_;
  std::vector<std::string> warnings_;
};

}  // namespace

bool is_face_packets(std::string_view text) {
  const std::vector<Packet> packets = packets_of(text.substr(0, 4096));
  if (packets.empty()) return false;
  std::string_view first = packets.front().text;
  take_time(first);
  const std::vector<std::string_view> parts = dam::split_fields(first, '|');
  if (parts.size() < 3) return false;
  return std::count_if(parts.begin(), parts.end(), [](std::string_view part) {
           const std::optional<PacketField> field = packet_field(part);
           return field && packet_shape(*field) && dam::parse_number(field->value);
         }) >= 2;
}

Result<ShapeTable> face_packets_to_shapes(std::string_view text) {
  return PacketReader().read(text);
}

}  // namespace animeme::exchange
