#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "tools/formats/common/text.h"
#include "tools/formats/inspect/carriers_internal.h"

namespace animeme::inspect {

namespace {

constexpr int kMostBits = 16, kMostDecimals = 6, kAzureDecimals = 3;

double levels_error(Carried& m, int bits) {
  const double most = double((1u << bits) - 1);
  return m.error_of_changed([&](double weight) { return weight_level(weight, bits) / most; });
}

void add_floats(Carried& m) {
  const double error = m.error_of_changed([](double weight) { return double(float(weight)); });
  const auto row = [&](const char* name, Headers headers) {
    return row_of(name, "", false, headers, error);
  };
  Carrier plain = row("52 x float32", Headers::udp);
  Carrier packed = row("52 x float32, deflate, one join", Headers::websocket);
  Carrier arf = row("ARF, AAU of 52 float32", Headers::rtp);
  Carrier link = row("Live Link Face, 61 float32", Headers::udp);
  Carrier vmc = row("VMC, OSC bundle", Headers::udp);
  Deflater deflater;
  LiveLinkNames names;
  names.rate = std::int32_t(m.second());
  for (const fap::ArkitFrame& frame : m.weights) {
    const Message floats = float_weights(frame);
    send(plain, floats.size());
    send(packed, deflater.pack(floats).size());
    send(arf, arf_unit(frame, std::uint32_t(names.frame)).size());
    send(link, live_link_packet(frame, names).size());
    send(vmc, vmc_bundle(frame).size());
    ++names.frame;
  }
  m.rows.insert(m.rows.end(), {std::move(plain), std::move(packed), std::move(arf), std::move(link),
                               std::move(vmc)});
}

void add_packed(Carried& m, int bits, bool fitted) {
  Carrier row = row_of("52 weights, packed", tools::format("%d bit", bits), fitted, Headers::udp,
                       levels_error(m, bits));
  for (const fap::ArkitFrame& frame : m.weights) send(row, packed_weights(frame, bits).size());
  m.rows.push_back(std::move(row));
}

// Levels as bytes, as they are or as differences from those before.
class LevelBytes {
 public:
  LevelBytes(int bits, bool differences) : bits_(bits), differences_(differences) {}
  Message next(const fap::ArkitFrame& frame) {
    Message out;
    for (std::size_t i = 0; i < before_.size(); ++i) {
      std::uint32_t level = weight_level(frame[i], bits_);
      const auto change = std::int32_t(level - before_[i]);
      before_[i] = level;
      // Small changes of either sign become small numbers.
      if (differences_) level = std::uint32_t(change < 0 ? -2 * change - 1 : 2 * change);
      if (bits_ + int(differences_) > 8) out.push_back(std::uint8_t(level >> 8));
      out.push_back(std::uint8_t(level));
    }
    return out;
  }

 private:
  int bits_;
  bool differences_;
  std::array<std::uint32_t, fap::kArkitShapeCount> before_{};
};

void add_deflated(Carried& m, int bits) {
  const double error = levels_error(m, bits);
  const auto row = [&](const char* name, Headers headers) {
    return row_of(name, tools::format("%d bit", bits), true, headers, error);
  };
  Carrier joins = row("52 weights, differences, deflate, joins", Headers::udp);
  Carrier once = row("52 weights, deflate, one join", Headers::websocket);
  Carrier changes = row("52 weights, differences, deflate, one join", Headers::websocket);
  Carrier file = row("52 weights, differences, deflate, file", Headers::none);
  LevelBytes of_second(bits, true), levels(bits, false), differences(bits, true);
  Deflater second_deflater, levels_deflater, changes_deflater;
  Message whole;
  for (std::size_t i = 0; i < m.weights.size(); ++i) {
    if (i % m.second() == 0) {
      of_second = LevelBytes(bits, true);
      second_deflater = Deflater();
    }
    send(joins, second_deflater.pack(of_second.next(m.weights[i])).size());
    send(once, levels_deflater.pack(levels.next(m.weights[i])).size());
    const Message changed = differences.next(m.weights[i]);
    send(changes, changes_deflater.pack(changed).size());
    whole.insert(whole.end(), changed.begin(), changed.end());
  }
  send(file, Deflater().pack(whole).size());
  m.rows.insert(m.rows.end(),
                {std::move(joins), std::move(once), std::move(changes), std::move(file)});
}

double decimals_error(Carried& m, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return m.error_of_changed([&](double weight) { return std::round(weight * scale) / scale; });
}

// An event has the frames of a second.
void add_azure(Carried& m, int decimals, bool fitted) {
  Carrier json = row_of("Azure's JSON", tools::format("%d decimals", decimals), fitted,
                        Headers::websocket, decimals_error(m, decimals));
  const std::span all(m.weights);
  for (std::size_t i = 0; i < all.size(); i += m.second()) {
    const auto some = all.subspan(i, std::min(m.second(), all.size() - i));
    send(json, azure_event(some, i, decimals).size());
  }
  m.rows.push_back(std::move(json));
}

}  // namespace

void add_weights(Carried& m) {
  add_floats(m);
  add_packed(m, 16, false);
  add_packed(m, 8, false);
  const double limit = m.options->error;
  const int bits =
      *coarsest(kMostBits, 1, limit, [&](int n) -> Result<double> { return levels_error(m, n); });
  add_packed(m, bits, true);
  add_deflated(m, bits);
  add_azure(m, kAzureDecimals, false);
  const int decimals = *coarsest(kMostDecimals, 1, limit,
                                 [&](int n) -> Result<double> { return decimals_error(m, n); });
  add_azure(m, decimals, true);
}

}  // namespace animeme::inspect
