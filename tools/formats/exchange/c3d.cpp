#include "tools/formats/exchange/c3d.h"

#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "fap/rate_text.h"

namespace animeme::exchange {
namespace {

constexpr std::size_t kBlock = 512;
constexpr std::uint8_t kMagic = 0x50;

enum class Processor : std::uint8_t { intel = 84, dec = 85, mips = 86 };

// Numbers of a processor, by their place in the file. Whoever asks has looked that they are there.
struct Numbers {
  std::span<const std::uint8_t> bytes;
  Processor processor = Processor::intel;

  std::uint16_t word(std::size_t at) const {
    const int first = bytes[at], second = bytes[at + 1];
    return std::uint16_t(processor == Processor::mips ? first << 8 | second : second << 8 | first);
  }
  std::int16_t integer(std::size_t at) const { return std::int16_t(word(at)); }
  double real(std::size_t at) const {
    const std::uint32_t a = word(at), b = word(at + 2);
    switch (processor) {
      case Processor::intel:
        return std::bit_cast<float>(b << 16 | a);
      case Processor::mips:
        return std::bit_cast<float>(a << 16 | b);
      case Processor::dec:
        // The word with the sign comes first; the exponent counts two more, and 0 is zero.
        if ((a & 0x7F80) == 0) return 0;
        return double(std::bit_cast<float>(a << 16 | b)) / 4;
    }
    return 0;
  }
};

struct Parameter {
  int type = 0;  // -1 text, 1 byte, 2 integer, 4 real
  std::vector<std::size_t> dimensions;
  std::size_t at = 0, count = 0;  // first value, values
};

// By "GROUP:NAME".
using Parameters = std::map<std::string, Parameter>;

Error broken(std::size_t at, const char* what) {
  return error_at_bit(Code::syntax, what, std::int64_t(at) * 8);
}

std::string upper_case(std::span<const std::uint8_t> bytes) {
  std::string out;
  for (const std::uint8_t c : bytes) out += char(c >= 'a' && c <= 'z' ? c - 32 : c);
  return out;
}

Result<Parameter> read_parameter(const Numbers& in, std::size_t at, std::size_t end) {
  if (at + 2 > end) return broken(at, "a parameter of the C3D file ends before its values");
  Parameter out;
  out.type = std::int8_t(in.bytes[at]);
  const std::size_t dimensions = in.bytes[at + 1];
  if (dimensions > 7 || at + 2 + dimensions > end) {
    return broken(at, "a parameter of the C3D file has too many dimensions");
  }
  out.count = 1;
  for (std::size_t d = 0; d < dimensions; ++d) {
    out.dimensions.push_back(in.bytes[at + 2 + d]);
    out.count *= out.dimensions.back();  // 255^7 at most
  }
  out.at = at + 2 + dimensions;
  const std::size_t size = std::size_t(std::abs(out.type));
  if ((size != 1 && size != 2 && size != 4) || out.count > (end - out.at) / size) {
    return broken(at, "a parameter of the C3D file is longer than the file says");
  }
  return out;
}

// Records: length of the name, number of the group (negative: it is the group), name, way to the
// next, content.
Result<Parameters> read_parameters(const Numbers& in, std::size_t begin, std::size_t end) {
  std::map<int, std::string> groups;
  std::vector<std::pair<int, std::pair<std::string, Parameter>>> found;
  std::size_t at = begin + 4;
  while (at + 2 <= end) {
    const auto length = std::size_t(std::abs(int(std::int8_t(in.bytes[at]))));
    const int group = std::int8_t(in.bytes[at + 1]);
    if (length == 0 || group == 0) break;
    const std::size_t name = at + 2, step = name + length;
    if (step + 2 > end) return broken(at, "a name in the C3D file is longer than its parameters");
    const std::string text = upper_case(in.bytes.subspan(name, length));
    const std::size_t way = in.word(step);
    const std::size_t next = way == 0 ? end : step + way;
    if (group < 0) {
      groups[-group] = text;
    } else {
      auto parameter = read_parameter(in, step + 2, end);
      if (!parameter) return parameter.error();
      found.push_back({group, {text, std::move(*parameter)}});
    }
    if (way == 0) break;
    if (next <= at || next > end)
      return broken(step, "a parameter of the C3D file has an invalid link");
    at = next;
  }
  Parameters out;
  for (auto& [group, parameter] : found) {
    out.emplace(groups[group] + ":" + parameter.first, std::move(parameter.second));
  }
  return out;
}

std::optional<double> number(const Numbers& in, const Parameters& parameters, const char* name) {
  const auto found = parameters.find(name);
  if (found == parameters.end() || found->second.count == 0) return std::nullopt;
  const Parameter& p = found->second;
  if (p.type == 2) return in.word(p.at);  // counts beyond 32767 are meant as they stand
  if (p.type == 4) return in.real(p.at);
  if (p.type == 1) return in.bytes[p.at];
  return std::nullopt;
}

std::string trimmed_text(const Numbers& in, std::size_t at, std::size_t size) {
  std::string text(reinterpret_cast<const char*>(&in.bytes[at]), size);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
  text.erase(0, std::min(text.find_first_not_of(' '), text.size()));
  return text;
}

std::vector<std::string> texts(const Numbers& in, const Parameters& parameters,
                               const std::string& name) {
  const auto found = parameters.find(name);
  std::vector<std::string> out;
  if (found == parameters.end() || found->second.type != -1 || found->second.count == 0) return out;
  const Parameter& p = found->second;
  const std::size_t size = p.dimensions.empty() ? 1 : p.dimensions[0];
  for (std::size_t i = 0; i < p.count / size; ++i) {
    out.push_back(trimmed_text(in, p.at + i * size, size));
  }
  return out;
}

std::vector<std::string> names_of(const Numbers& in, const Parameters& parameters,
                                  std::size_t points) {
  std::vector<std::string> names = texts(in, parameters, "POINT:LABELS");
  for (int more = 2; names.size() < points; ++more) {
    const auto next = texts(in, parameters, "POINT:LABELS" + std::to_string(more));
    if (next.empty()) break;
    names.insert(names.end(), next.begin(), next.end());
  }
  names.resize(points);
  std::set<std::string> taken;
  for (std::size_t i = 0; i < points; ++i) {
    std::string name = names[i].empty() ? "M" + std::to_string(i + 1) : names[i];
    for (int copy = 2; !taken.insert(name).second; ++copy) {
      name =
          (names[i].empty() ? "M" + std::to_string(i + 1) : names[i]) + "_" + std::to_string(copy);
    }
    names[i] = name;
  }
  return names;
}

// Where the frames are and what they look like.
struct Layout3d {
  std::size_t points = 0, analogue = 0, frames = 0, data = 0;
  double scale = 0;  // of whole numbers; negative: floating point
  double rate = 0;
  std::size_t number_size() const { return scale < 0 ? 4 : 2; }
  std::size_t frame_size() const { return (points * 4 + analogue) * number_size(); }
};

Result<Layout3d> read_layout(const Numbers& in, const Parameters& parameters) {
  Layout3d out;
  out.points = std::size_t(number(in, parameters, "POINT:USED").value_or(in.word(2)));
  out.analogue = in.word(4);
  out.scale = number(in, parameters, "POINT:SCALE").value_or(in.real(12));
  out.rate = number(in, parameters, "POINT:RATE").value_or(in.real(20));
  const std::size_t data = in.word(16);
  const auto data_start = number(in, parameters, "POINT:DATA_START");
  out.data = (data > 0 ? data : std::size_t(std::max(0.0, data_start.value_or(0))));
  if (out.points == 0) return make_error(Code::not_found, "the C3D file has no markers");
  if (out.data < 2) return broken(16, "the C3D file does not say where its frames are");
  out.data = (out.data - 1) * kBlock;
  // The header counts to 65535; longer recordings say it in parameters.
  const std::size_t first = in.word(6), last = in.word(8);
  double frames = last >= first ? double(last - first) + 1 : 0;
  if (const auto told = number(in, parameters, "POINT:FRAMES"); told && *told > frames) {
    frames = *told;
  }
  const auto from = parameters.find("TRIAL:ACTUAL_START_FIELD");
  const auto to = parameters.find("TRIAL:ACTUAL_END_FIELD");
  if (from != parameters.end() && to != parameters.end() && from->second.type == 2 &&
      to->second.type == 2 && from->second.count >= 2 && to->second.count >= 2) {
    const auto whole = [&](const Parameter& p) {
      return double(in.word(p.at)) + 65536.0 * in.word(p.at + 2);
    };
    const double told = whole(to->second) - whole(from->second) + 1;
    if (told > frames) frames = told;
  }
  if (!(frames >= 1 && frames <= 1e9) || !std::isfinite(out.scale) || out.scale == 0) {
    return broken(6, "the C3D file does not say how many frames it has, or in which unit");
  }
  out.frames = std::size_t(frames);
  return out;
}

void read_frame(const Numbers& in, const Layout3d& layout, std::size_t at,
                std::vector<double>& values) {
  for (std::size_t p = 0; p < layout.points; ++p) {
    double place[4];
    for (double& value : place) {
      value = layout.scale < 0 ? in.real(at) : in.integer(at);
      at += layout.number_size();
    }
    bool seen = place[3] >= 0;
    for (int k = 0; k < 3; ++k) {
      place[k] *= layout.scale < 0 ? 1 : layout.scale;
      seen = seen && std::isfinite(place[k]);
    }
    for (int k = 0; k < 3; ++k) {
      values.push_back(seen ? place[k] : std::numeric_limits<double>::quiet_NaN());
    }
  }
}

}  // namespace

bool is_c3d(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= kBlock && bytes[1] == kMagic && bytes[0] >= 2 && bytes[0] < 0x20;
}

Result<PointRecording> read_c3d(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kBlock) {
    return make_error(Code::truncated, "a C3D file has a header of 512 bytes");
  }
  if (bytes[1] != kMagic || bytes[0] < 2) return broken(0, "this is not a C3D file");
  const std::size_t begin = (bytes[0] - std::size_t(1)) * kBlock;
  if (begin + 4 > bytes.size()) {
    return error_at_bit(Code::truncated, "the C3D file ends before its parameters",
                        std::int64_t(bytes.size()) * 8);
  }
  const std::size_t blocks = bytes[begin + 2];
  const int processor = bytes[begin + 3];
  if (processor < 84 || processor > 86) {
    return broken(begin + 3, "the C3D file is not in Intel, DEC or MIPS format");
  }
  const std::size_t end = begin + blocks * kBlock;
  if (end > bytes.size()) {
    return error_at_bit(Code::truncated, "the C3D file ends in its parameters",
                        std::int64_t(bytes.size()) * 8);
  }
  const Numbers in{bytes, Processor(processor)};
  const Result<Parameters> parameters = read_parameters(in, begin, end);
  if (!parameters) return parameters.error();
  const Result<Layout3d> layout = read_layout(in, *parameters);
  if (!layout) return layout.error();
  const std::size_t there =
      layout->data < bytes.size() ? (bytes.size() - layout->data) / layout->frame_size() : 0;
  if (there == 0) {
    return error_at_bit(Code::truncated, "the C3D file ends before its first frame",
                        std::int64_t(bytes.size()) * 8);
  }
  PointRecording out;
  if (there < layout->frames) {
    out.warnings.push_back("the file ends after " + std::to_string(there) + " of " +
                           std::to_string(layout->frames) + " frames");
  }
  const std::size_t frames = std::min(there, layout->frames);
  if (frames > kMostCoordinates / (3 * layout->points)) {
    return make_error(Code::out_of_range, "the C3D file has too many frames; split it");
  }
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", layout->rate);
  const Result<fap::Rate> rate = fap::parse_rate(text);
  if (!rate || !rate->valid()) return broken(20, "the frame rate of the C3D file is invalid");
  out.track.rate = *rate;
  out.track.dimensions = 3;
  out.track.names = names_of(in, *parameters, layout->points);
  const auto units = texts(in, *parameters, "POINT:UNITS");
  if (!units.empty()) out.unit = units[0];
  out.track.values.reserve(frames * out.track.size());
  for (std::size_t i = 0; i < frames; ++i) {
    read_frame(in, *layout, layout->data + i * layout->frame_size(), out.track.values);
  }
  return out;
}

}  // namespace animeme::exchange
