#include "tests/bench/round_trip_material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <random>
#include <sstream>
#include <utility>

#include "dam/model/builtin.h"
#include "dam/script/phones.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/synthesise.h"

namespace animeme::bench {
namespace {

constexpr double kRates[] = {25, 30, 60};
constexpr double kMadeSeconds = 12;

constexpr std::pair<const char*, const char*> kOpposites[] = {
    {"mouthPucker", "mouthStretchLeft"},
    {"mouthPucker", "mouthStretchRight"},
    {"mouthFunnel", "mouthRollUpper"},
    {"mouthFunnel", "mouthRollLower"},
    {"mouthPressLeft", "mouthUpperUpLeft"},
    {"mouthPressRight", "mouthUpperUpRight"},
    {"mouthSmileLeft", "mouthFrownLeft"},
    {"mouthSmileRight", "mouthFrownRight"},
    {"mouthRollUpper", "mouthUpperUpLeft"},
    {"mouthRollUpper", "mouthUpperUpRight"},
    {"mouthRollLower", "mouthLowerDownLeft"},
    {"mouthRollLower", "mouthLowerDownRight"},
    {"jawLeft", "jawRight"},
    {"mouthLeft", "mouthRight"},
    {"eyeBlinkLeft", "eyeWideLeft"},
    {"eyeBlinkRight", "eyeWideRight"},
    {"eyeLookInLeft", "eyeLookOutLeft"},
    {"eyeLookInRight", "eyeLookOutRight"},
    {"eyeLookUpLeft", "eyeLookDownLeft"},
    {"eyeLookUpRight", "eyeLookDownRight"}};

std::size_t channel(std::string_view name) {
  return std::size_t(fap::find_arkit(name).value_or(0));
}

// A movement there and back, 0 to 1.
double bump(double t, double from, double length) {
  const double share = (t - from) / length;
  return share > 0 && share < 1 ? std::pow(std::sin(M_PI * share), 2) : 0;
}

// The first column is time.
WeightSequence read_take(const std::filesystem::path& path) {
  WeightSequence out{path.stem().string(), 30, {}};
  std::ifstream file(path);
  std::string line, cell;
  std::getline(file, line);
  std::vector<std::optional<int>> channels;
  for (std::istringstream cells(line); std::getline(cells, cell, ',');) {
    channels.push_back(fap::find_arkit(cell));
  }
  while (std::getline(file, line)) {
    out.frames.emplace_back();
    std::size_t i = 0;
    for (std::istringstream cells(line); std::getline(cells, cell, ','); ++i) {
      if (i < channels.size() && channels[i]) {
        out.frames.back()[std::size_t(*channels[i])] = std::atof(cell.c_str());
      }
    }
  }
  return out;
}

WeightSequence at_rate(const WeightSequence& from, double rate) {
  WeightSequence out{from.name, rate, {}};
  const double last = double(from.frames.size()) - 1;
  for (int i = 0;; ++i) {
    const double at = i * from.rate / rate;
    if (at > last) return out;
    const auto before = std::size_t(at);
    const std::size_t after = std::min(before + 1, from.frames.size() - 1);
    out.frames.emplace_back();
    for (std::size_t c = 0; c < out.frames.back().size(); ++c) {
      const double a = from.frames[before][c], b = from.frames[after][c];
      out.frames.back()[c] = a + (at - double(before)) * (b - a);
    }
  }
}

// Any sounds, spoken by the built-in model, as the weights that we export.
WeightSequence speech(double rate) {
  std::mt19937 random(3);
  dam::Script script;
  double at = 0;
  const auto say = [&](std::string_view label, double seconds) {
    script.phones.push_back({at, at + seconds, std::string(label), ""});
    at += seconds;
  };
  say("SIL", 0.3);
  while (at < kMadeSeconds - 0.5) {
    const auto& phone = dam::phones()[random() % dam::kPhoneCount];
    say(phone.label, 0.05 + double(random() % 100) / 1000);
  }
  say("SIL", 0.4);
  dam::SynthesisOptions options;
  options.rate = {std::uint32_t(rate), 1};
  options.articulation = std::nullopt;
  WeightSequence out{"made speech", rate, {}};
  const auto model = dam::builtin_model();
  const auto signal = model ? dam::synthesise(*model, script, options) : model.error();
  const auto clip = signal ? dam::to_sequence(*signal) : signal.error();
  if (!clip) return out;
  fap::ArkitFitter fitter;
  for (const fap::Frame& frame : clip->frames) out.frames.push_back(fitter.fit(frame));
  return out;
}

struct Eyes {
  bool blinks = false, winks = false, squints = false;
};

// Blinks of both eyes, winks of one, squints, wide eyes and a gaze that wanders.
void move_eyes(const Eyes& eyes, double t, fap::ArkitFrame& frame) {
  double both = 0, wink = 0;
  for (int k = 0; k < 10 && eyes.blinks; ++k) both = std::max(both, bump(t, 0.4 + 1.3 * k, 0.25));
  for (int k = 0; k < 6 && eyes.winks; ++k) wink = std::max(wink, bump(t, 0.9 + 2.1 * k, 0.5));
  const bool left = int(t / 2.1) % 2 == 0;
  frame[channel("eyeBlinkLeft")] = std::max(both, left ? wink : 0.1 * wink);
  frame[channel("eyeBlinkRight")] = std::max(0.95 * both, left ? 0.1 * wink : wink);
  if (eyes.squints) {
    const double squint = 0.7 * std::max(0.0, std::sin(1.1 * t));
    frame[channel("eyeSquintLeft")] = squint;
    frame[channel("eyeSquintRight")] = 0.8 * squint;
  }
  if (both == 0 && wink == 0) {
    const double wide = 0.6 * std::max(0.0, std::sin(0.9 * t + 2) - 0.2);
    frame[channel("eyeWideLeft")] = frame[channel("eyeWideRight")] = wide;
  }
  const double across = 0.6 * std::sin(0.7 * t), up = 0.3 * std::sin(0.5 * t + 1);
  frame[channel(across > 0 ? "eyeLookOutLeft" : "eyeLookInLeft")] = std::abs(across);
  frame[channel(across > 0 ? "eyeLookInRight" : "eyeLookOutRight")] = std::abs(across);
  frame[channel(up > 0 ? "eyeLookUpLeft" : "eyeLookDownLeft")] = std::abs(up);
  frame[channel(up > 0 ? "eyeLookUpRight" : "eyeLookDownRight")] = std::abs(up);
}

WeightSequence eyes(const char* name, const Eyes& what, double rate) {
  WeightSequence out{name, rate, {}};
  for (int i = 0; i < int(kMadeSeconds * rate); ++i) {
    move_eyes(what, i / rate, out.frames.emplace_back());
  }
  return out;
}

// With speech, a smile and brows.
WeightSequence all_at_once(double rate) {
  WeightSequence out = speech(rate);
  out.name = "all at once";
  for (std::size_t i = 0; i < out.frames.size(); ++i) {
    const double t = double(i) / rate;
    fap::ArkitFrame& frame = out.frames[i];
    move_eyes({true, true, true}, t, frame);
    const double smile = 0.4 * std::max(0.0, std::sin(0.8 * t));
    for (const char* name : {"mouthSmileLeft", "mouthSmileRight"}) {
      frame[channel(name)] = std::max(frame[channel(name)], smile);
    }
    for (const char* name : {"mouthFrownLeft", "mouthFrownRight"}) {
      if (smile > 0) frame[channel(name)] = 0;
    }
    frame[channel("browInnerUp")] = 0.3 * std::max(0.0, std::sin(1.7 * t));
  }
  return out;
}

}  // namespace

std::vector<WeightSequence> weight_sequences(const std::filesystem::path& shared, double seconds) {
  std::vector<WeightSequence> all;
  for (const char* take : {"alex_rom_3.csv", "alex_rom_4.csv"}) {
    const auto path = shared / "data" / "livelink_rom" / "controls" / take;
    std::error_code none;
    if (shared.empty() || !std::filesystem::exists(path, none)) continue;
    const WeightSequence read = read_take(path);
    for (const double rate : kRates) all.push_back(at_rate(read, rate));
  }
  for (const double rate : kRates) all.push_back(speech(rate));
  for (const double rate : kRates) all.push_back(eyes("blinks", {.blinks = true}, rate));
  for (const double rate : kRates) all.push_back(eyes("winks", {.winks = true}, rate));
  for (const double rate : kRates) all.push_back(eyes("squints", {.squints = true}, rate));
  for (const double rate : {30.0, 60.0}) all.push_back(all_at_once(rate));
  for (WeightSequence& sequence : all) {
    sequence.frames.resize(
        std::min(sequence.frames.size(), std::size_t(std::max(seconds, 0.1) * sequence.rate)));
  }
  return all;
}

Comparison compare_weights(const Rows& given, const Rows& found,
                           const std::vector<std::string>& names) {
  Comparison out;
  const auto place = [&](const char* name) {
    return std::size_t(std::find(names.begin(), names.end(), name) - names.begin());
  };
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& [one, other] : kOpposites) {
    if (std::max(place(one), place(other)) < names.size()) {
      pairs.emplace_back(place(one), place(other));
    }
  }
  const auto moves = [](const Rows& rows, std::size_t i, std::size_t c) {
    return i == 0 || i >= rows.size() ? 0 : std::abs(rows[i][c] - rows[i - 1][c]);
  };
  double frames_off = 0, sum = 0;
  std::vector<int> times_off(names.size(), 0);
  for (std::size_t i = 0; i < given.size(); ++i) {
    bool off = false;
    for (std::size_t c = 0; c < names.size(); ++c) {
      const double difference = std::abs(given[i][c] - found[i][c]);
      sum += difference;
      off = off || difference > 0.2;
      const double before = i > 0 ? moves(given, i - 1, c) : 0;
      const double may = std::max({before, moves(given, i, c), moves(given, i + 1, c)});
      times_off[c] += difference > 0.2 ? 1 : 0;
      if (const double beyond = moves(found, i, c) - may; beyond > out.jump) {
        out.jump = beyond;
        out.jumps_most = names[c] + " " + std::to_string(i);
      }
    }
    for (const auto& [a, b] : pairs) {
      const double was = std::min(given[i][a], given[i][b]);
      if (const double both = std::min(found[i][a], found[i][b]) - was; both > out.opposites) {
        out.opposites = both;
        out.opposite_most = names[a] + " " + names[b] + " " + std::to_string(i);
      }
    }
    frames_off += off ? 1 : 0;
  }
  const auto most = std::max_element(times_off.begin(), times_off.end());
  if (most != times_off.end() && *most > 0) {
    out.off_most = names[std::size_t(most - times_off.begin())];
  }
  const double frames = std::max(double(given.size()), 1.0);
  out.off = frames_off / frames;
  out.mean = sum / frames / std::max(double(names.size()), 1.0);
  return out;
}

fap::Frame complete_face(const fap::ArkitFrame& weights) {
  fap::Frame frame = fap::arkit_to_fap(weights, fap::kAllArkit);
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    if (!frame.mask[std::size_t(fap)]) frame.set(fap, 0);
  }
  return frame;
}

}  // namespace animeme::bench
