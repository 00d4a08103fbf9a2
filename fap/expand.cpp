#include "fap/expand.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "fap/tables.h"

namespace animeme::fap {
namespace {

// A mouth that is the same on both sides. Outer lips follow the inner ones.
struct Mouth {
  int jaw;          // FAP 3
  int upper_down;   // 4, and less of it at the sides: 8, 9
  int lower_up;     // 5; 10, 11
  int wide;         // 6, 7
  int corners_up;   // 12, 13
  int push_lower;   // 16
  int push_upper;   // 17
  int tongue_up;    // 44
  int tongue_out;   // 45
  int tongue_body;  // 46
};

constexpr std::array<Mouth, 15> kMouths = {{
    {0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {40, 70, 90, -20, 0, -40, -40, 0, 0, 0},              // p b m
    {140, -170, 60, 20, 10, -230, 30, 0, 0, 0},           // f v
    {230, -130, -300, 10, 0, 20, 0, 330, 190, 0},         // T D
    {200, -130, -270, 20, 0, 0, 0, 640, 30, 150},         // t d
    {280, -130, -340, 10, 0, 0, 0, -100, -60, 520},       // k g
    {170, -200, -280, -95, 20, 330, 340, 300, 0, 150},    // tS dZ S
    {80, -150, -210, 70, 20, 0, 0, 200, 10, 100},         // s z
    {240, -130, -320, 10, 0, 0, 0, 680, 20, 100},         // n l
    {190, -150, -240, -65, 10, 190, 210, 350, -40, 120},  // r
    {800, -200, -950, -20, -60, 0, 20, -80, 0, -60},      // A:
    {430, -190, -560, 110, 20, 0, 0, 60, 0, 60},          // e
    {270, -170, -380, 140, 40, 0, 0, 120, 0, 160},        // I
    {620, -170, -700, -120, -30, 230, 240, -60, -20, 0},  // Q
    {240, -70, -190, -175, 0, 440, 430, -40, -30, 60},    // U
}};

// Values that both sides share are written once, for the FAP of the left side.
struct Entry {
  int fap;
  int value;
};

constexpr Entry kJoy[] = {{3, 230},   {4, -130}, {5, -190},  {8, -110},  {10, -190},
                          {12, 300},  {6, 120},  {51, -100}, {52, -150}, {55, -90},
                          {57, -150}, {59, 300}, {53, 120},  {41, 100},  {21, 200},
                          {19, 40},   {31, 40},  {33, 60},   {35, 40}};
constexpr Entry kSadness[] = {{31, 260},  {33, 60},   {35, -70}, {37, 70}, {19, 230}, {21, 40},
                              {12, -190}, {59, -190}, {10, 30},  {57, 30}, {16, 60},  {18, 130}};
constexpr Entry kAnger[] = {{31, -190}, {33, -130}, {35, -10}, {37, 95}, {19, 40}, {21, 190},
                            {4, 70},    {5, 100},   {8, 50},   {10, 70}, {6, -50}, {53, -50},
                            {12, -90},  {59, -90},  {61, 70},  {18, 100}};
constexpr Entry kFear[] = {{31, 340},  {33, 220},  {35, 90},  {37, 70},  {19, -240},
                           {21, 60},   {3, 240},   {4, -90},  {5, -320}, {8, -60},
                           {10, -320}, {6, 90},    {53, 90},  {51, -70}, {52, -280},
                           {55, -50},  {57, -280}, {12, -90}, {59, -90}};
constexpr Entry kDisgust[] = {{31, -120}, {33, -90}, {35, -20},  {37, 60},   {19, 170}, {21, 220},
                              {4, -190},  {8, -230}, {51, -200}, {55, -240}, {12, -60}, {59, -60},
                              {41, 120},  {61, 110}, {63, 70},   {5, -60},   {52, -40}, {16, 60}};
constexpr Entry kSurprise[] = {{31, 420}, {33, 450},  {35, 360}, {19, -270}, {21, -60}, {3, 640},
                               {4, -120}, {5, -620},  {8, -80},  {10, -660}, {6, -90},  {53, -90},
                               {51, -90}, {52, -580}, {55, -60}, {57, -620}, {12, -60}, {59, -60}};

void put(Frame& frame, int fap, int value) {
  if (value == 0) return;
  frame.set(fap, value);
  if (const int mirror = info(fap).mirror) frame.set(mirror, value);
}

Frame from(std::span<const Entry> entries) {
  Frame frame;
  for (const Entry& e : entries) put(frame, e.fap, e.value);
  return frame;
}

using Sums = std::array<double, kFapCount + 1>;

void add(const Frame& shape, double weight, Sums& sum, Mask& mask) {
  mask |= shape.mask;
  for (std::size_t f = kFirstLowLevel; f < sum.size(); ++f) {
    sum[f] += weight * shape.value[f];
  }
}

std::int32_t whole(double value) {
  constexpr double most = std::numeric_limits<std::int32_t>::max();
  return std::int32_t(std::lround(std::clamp(value, -most, most)));
}

// Shapes by their numbers; any other number shows nothing.
const Frame& pick(std::span<const Frame> shapes, std::int32_t number) {
  static const Frame nothing;
  return number >= 0 && std::size_t(number) < shapes.size() ? shapes[std::size_t(number)] : nothing;
}

// The frame with the shapes of its FAP 1 and 2; `own` are the FAPs that win over those.
Frame lower(const Frame& frame, std::span<const Frame> visemes, std::span<const Frame> expressions,
            const Mask& own) {
  Sums sum{};
  Mask mask;
  if (frame.mask[1]) {
    const double blend = frame.viseme.blend / 63.0;
    add(pick(visemes, frame.viseme.select1), blend, sum, mask);
    add(pick(visemes, frame.viseme.select2), 1 - blend, sum, mask);
  }
  if (frame.mask[2]) {
    const Expression& e = frame.expression;
    add(pick(expressions, e.select1), e.intensity1 / 63.0, sum, mask);
    add(pick(expressions, e.select2), e.intensity2 / 63.0, sum, mask);
  }
  Frame result;
  result.number = frame.number;
  for (int f = kFirstLowLevel; f <= kFapCount; ++f) {
    const auto i = std::size_t(f);
    if (frame.mask[i] && (own[i] || !mask[i])) {
      result.set(f, frame.value[i]);
    } else if (mask[i]) {
      result.set(f, whole(sum[i]));
    }
  }
  return result;
}

template <std::size_t count>
std::array<Frame, count> all_of(Frame (*pose)(int)) {
  std::array<Frame, count> poses;
  for (std::size_t i = 0; i < count; ++i) poses[i] = pose(int(i));
  return poses;
}

const auto& all_visemes() {
  static const auto poses = all_of<15>(viseme_pose);
  return poses;
}
const auto& all_expressions() {
  static const auto poses = all_of<7>(expression_pose);
  return poses;
}

// Groups of jaw and lips, tongue, outer lips.
bool is_mouth(int group) { return group == 2 || group == 6 || group == 8; }

// Low-level FAPs of the frame, of the mouth alone or all of them.
Frame shape_in(const Frame& coded, bool mouth, double scale) {
  Frame shape;
  for (int f = kFirstLowLevel; f <= kFapCount; ++f) {
    if (!coded.mask[std::size_t(f)] || (mouth && !is_mouth(info(f).group))) continue;
    shape.set(f, whole(scale * coded.value[std::size_t(f)]));
  }
  return shape;
}

}  // namespace

Frame viseme_pose(int viseme) {
  Frame frame;
  if (viseme < 0 || viseme >= int(kMouths.size())) return frame;
  const Mouth& m = kMouths[std::size_t(viseme)];
  put(frame, 3, m.jaw);
  for (const int fap : {4, 51}) put(frame, fap, m.upper_down);
  for (const int fap : {8, 55}) put(frame, fap, m.upper_down * 7 / 8);
  for (const int fap : {5, 52}) put(frame, fap, m.lower_up);
  // An open mouth is an ellipse: half way to its corners it is 7/8 as high. What presses lips
  // together does so everywhere.
  for (const int fap : {10, 57}) put(frame, fap, m.lower_up < 0 ? m.lower_up * 7 / 8 : m.lower_up);
  for (const int fap : {6, 53}) put(frame, fap, m.wide);
  for (const int fap : {12, 59}) put(frame, fap, m.corners_up);
  put(frame, 16, m.push_lower);
  put(frame, 17, m.push_upper);
  put(frame, 44, m.tongue_up);
  put(frame, 45, m.tongue_out);
  put(frame, 46, m.tongue_body);
  return frame;
}

Frame expression_pose(int expression) {
  switch (expression) {
    case 1:
      return from(kJoy);
    case 2:
      return from(kSadness);
    case 3:
      return from(kAnger);
    case 4:
      return from(kFear);
    case 5:
      return from(kDisgust);
    case 6:
      return from(kSurprise);
    default:
      return {};
  }
}

Frame low_level(const Frame& frame) {
  return lower(frame, all_visemes(), all_expressions(), frame.mask);
}

Expander::Expander() : visemes_(all_visemes()), expressions_(all_expressions()) {}

void Expander::receive(const Frame& coded) {
  if ((coded.mask[1] && coded.viseme.def) || (coded.mask[2] && coded.expression.def)) {
    define(coded);
  } else {
    defining_ &= ~coded.mask;
  }
}

void Expander::define(const Frame& coded) {
  Frame shape;
  if (coded.mask[1] && coded.viseme.def) {
    const Viseme& v = coded.viseme;
    const std::int32_t alone = v.blend >= 63 ? v.select1 : v.blend <= 0 ? v.select2 : -1;
    shape = shape_in(coded, true, 1);
    if (alone > 0 && alone < int(visemes_.size())) visemes_[std::size_t(alone)] = shape;
  }
  if (coded.mask[2] && coded.expression.def) {
    const Expression& e = coded.expression;
    const bool first = e.select2 <= 0 || e.intensity2 <= 0;
    const bool second = e.select1 <= 0 || e.intensity1 <= 0;
    const std::int32_t alone = first ? e.select1 : second ? e.select2 : -1;
    const std::int32_t intensity = first ? e.intensity1 : e.intensity2;
    if (alone > 0 && alone < int(expressions_.size()) && intensity > 0) {
      expressions_[std::size_t(alone)] = shape_in(coded, false, 63.0 / intensity);
    }
    shape = shape_in(coded, false, 1);
  }
  for (const FapInfo& fap : kFaps) {
    if (!shape.mask[std::size_t(fap.number)]) continue;
    for (const int f : {fap.number, fap.mirror, fap.partner}) defining_.set(std::size_t(f));
    if (fap.partner != 0) defining_.set(std::size_t(info(fap.partner).mirror));
  }
}

Frame Expander::expand(const Frame& shown) const {
  Mask own = shown.mask & ~defining_;
  return lower(shown, visemes_, expressions_, own);
}

}  // namespace animeme::fap
