// C3D files by the manual, independent of the reader: any processor, whole numbers or floating
// point.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace animeme::test {

struct C3dFile {
  enum class Processor : std::uint8_t { intel = 84, dec = 85, mips = 86 };
  Processor processor = Processor::intel;
  double scale = -1;  // negative: floating point
  double rate = 100;
  std::vector<std::string> labels;
  std::string units = "mm";
  /// Frames of labels.size() x 4: x, y, z, residual (negative: not seen).
  std::vector<std::vector<double>> frames;
  std::size_t analogue = 0;  ///< numbers behind each frame

  std::vector<std::uint8_t> bytes() const {
    std::vector<std::uint8_t> parameters = {1, 0x50, 0, std::uint8_t(processor)};
    group(parameters, 1, "POINT");
    words(parameters, 1, "USED", {int(labels.size())});
    real(parameters, 1, "SCALE", scale);
    real(parameters, 1, "RATE", rate);
    words(parameters, 1, "FRAMES", {int(frames.size())});
    text(parameters, 1, "LABELS", labels, 8);
    text(parameters, 1, "UNITS", {units}, 4);
    parameters.push_back(0);
    parameters.resize((parameters.size() + 511) / 512 * 512);
    const std::size_t blocks = parameters.size() / 512;
    parameters[2] = std::uint8_t(blocks);

    std::vector<std::uint8_t> out = {2, 0x50};
    word(out, int(labels.size()));
    word(out, int(analogue));
    word(out, 1);
    word(out, int(frames.size()));
    word(out, 10);
    real(out, scale);
    word(out, int(2 + blocks));
    word(out, analogue > 0 ? 1 : 0);
    real(out, rate);
    out.resize(512);
    out.insert(out.end(), parameters.begin(), parameters.end());
    for (const auto& frame : frames) {
      for (std::size_t k = 0; k < frame.size(); ++k) {
        if (scale < 0) {
          real(out, frame[k]);
        } else {
          word(out, int(std::lround(k % 4 == 3 ? frame[k] : frame[k] / scale)));
        }
      }
      for (std::size_t k = 0; k < analogue; ++k) scale < 0 ? real(out, 0.5) : word(out, 7);
    }
    return out;
  }

 private:
  void word(std::vector<std::uint8_t>& out, int value) const {
    const auto low = std::uint8_t(value & 255), high = std::uint8_t(value >> 8 & 255);
    out.push_back(processor == Processor::mips ? high : low);
    out.push_back(processor == Processor::mips ? low : high);
  }
  void real(std::vector<std::uint8_t>& out, double value) const {
    if (processor == Processor::dec) {
      // Sign, eight bits of an exponent that counts from -128 for 0.5 .. 1, 23 bits behind the
      // first.
      std::uint32_t bits = 0;
      if (value != 0) {
        int exponent = 0;
        const double part = std::frexp(std::abs(value), &exponent);
        bits = std::uint32_t(value < 0) << 31 | std::uint32_t(exponent + 128) << 23 |
               (std::uint32_t(std::lround(part * 16777216)) & 0x7FFFFF);
      }
      word(out, int(bits >> 16));
      word(out, int(bits & 65535));
      return;
    }
    const auto bits = std::bit_cast<std::uint32_t>(float(value));
    const int high = int(bits >> 16), low = int(bits & 65535);
    word(out, processor == Processor::mips ? high : low);
    word(out, processor == Processor::mips ? low : high);
  }
  void head(std::vector<std::uint8_t>& out, int id, const std::string& name,
            std::size_t content) const {
    out.push_back(std::uint8_t(name.size()));
    out.push_back(std::uint8_t(id));
    out.insert(out.end(), name.begin(), name.end());
    word(out, int(content + 2));
  }
  void group(std::vector<std::uint8_t>& out, int id, const std::string& name) const {
    head(out, -id, name, 1);
    out.push_back(0);  // no description
  }
  void words(std::vector<std::uint8_t>& out, int id, const std::string& name,
             const std::vector<int>& values) const {
    head(out, id, name, 3 + 2 * values.size());
    out.push_back(2);
    out.push_back(0);
    for (const int value : values) word(out, value);
    out.push_back(0);
  }
  void real(std::vector<std::uint8_t>& out, int id, const std::string& name, double value) const {
    head(out, id, name, 7);
    out.push_back(4);
    out.push_back(0);
    real(out, value);
    out.push_back(0);
  }
  void text(std::vector<std::uint8_t>& out, int id, const std::string& name,
            const std::vector<std::string>& values, std::size_t size) const {
    head(out, id, name, 5 + size * values.size());
    out.push_back(255);  // -1
    out.push_back(2);
    out.push_back(std::uint8_t(size));
    out.push_back(std::uint8_t(values.size()));
    for (std::string value : values) {
      value.resize(size, ' ');
      out.insert(out.end(), value.begin(), value.end());
    }
    out.push_back(0);
  }
};

}  // namespace animeme::test
