#include "fap/head/detail/stops.h"

#include <initializer_list>

#include "fap/detail/lips.h"

namespace animeme::head::detail {
namespace {

using Values = ControlValues;

// As far as faces go, one way and the other: from 85 % of the limit on skin gives way, and it is
// never passed.
float ease(float value, float low, float high) {
  const float limit = value < 0 ? -low : high;
  const float soft = 0.15f * limit, over = std::abs(value) - (limit - soft);
  if (!(over > 0)) return value;
  return std::copysign(limit - soft + soft * std::tanh(over / soft), value);
}

// Two FAPs that would make their points pass each other let them meet half way instead. `room` is
// how far they may come together.
void meet(float& a, float& b, float room) {
  const float over = (a + b - room) / 2;
  if (over <= 0) return;
  a -= over;
  b -= over;
}

// Lips that nearly touch are shut: for heads of which no pairs are known, see close_pairs().
void close_nearly(float& a, float& b) {
  const double closing = double(a) + double(b);
  const auto closer = float((fap::internal::soft_closing(closing) - closing) / 2);
  a += closer;
  b += closer;
}

// As meet(), where the meeting place follows from the shares of both.
void share(float& a, float& b, float room) {
  if (a + b <= room) return;
  const float scale = a > 0 && b > 0 ? room / (a + b) : 0;
  if (scale > 0) {
    a *= scale;
    b *= scale;
  } else if (a > b) {
    a = room - b;
  } else {
    b = room - a;
  }
}

// A way in which no reach stops a FAP: what it moves stops at another point (stop_at_rooms()), or
// nowhere. A number, as reaches go to the page as JSON, which has no infinity; beyond all FAPs of
// lengths, and 85 % of it are, too.
constexpr float kNoLimit = 1e7f;

constexpr float kLidRise = -270;    // upper lids rise by this at most
constexpr float kJawBack = -250;    // and the jaw goes back by this
constexpr float kChinUp = 420;      // the chin rises by this at most
constexpr float kCheekIn = 180;     // cheeks are sucked in by this at most
constexpr float kCornerTurn = 300;  // outer corners rise and fall with the inner ones but for this
constexpr float kTongueIn = 190;    // the tongue gets as far behind shut lips,
constexpr float kTongueOut = 3;     // and this times farther than they are open

void at_least(Values& v, std::initializer_list<std::size_t> faps, float least) {
  for (const std::size_t f : faps) v[f] = std::max(v[f], least);
}

// The outer corner of the mouth against the inner one, along one axis.
struct Apart {
  float inner, outer, low, high;
  // Of what there is.
  float share() const {
    const float most = outer < inner ? low : high;
    return most == 0 ? 0 : (outer - inner) / most;
  }
  float at(float part) const { return inner + (outer - inner) * part; }
};

// Points that would come too near to each other, so that the skin between them folds over. `usual`:
// on a face that has the reaches of people.
void stop_at_rooms(const Rooms& rooms, bool usual, Values& v) {
  at_least(v, {19, 20}, kLidRise);
  at_least(v, {14}, kJawBack);
  at_least(v, {18}, -rooms.chin);
  v[45] = std::min(v[45], kTongueIn + kTongueOut * std::max(-v[4] - v[5], 0.0f));
  at_least(v, {31, 32, 33, 34, 35, 36}, -rooms.brow_lid);
  at_least(v, {37, 38}, -0.5f * rooms.brows);
  share(v[37], v[38], rooms.brows);
  // A chin that is up is not pushed aside as well.
  if (usual) at_least(v, {3}, -kChinUp + std::abs(v[15]) + std::max(v[18], 0.0f));
  // An open jaw takes lips and corners along, down and back.
  const float jaw = std::max(v[3], 0.0f);
  at_least(v, {16}, -620 - 0.5f * jaw);
  at_least(v, {12, 13, 59, 60}, -440 - 0.3f * jaw);
  const float chin = v[3] < 0 ? std::min(v[18], 0.0f) - v[3] : std::min(v[18] - jaw, 0.0f);
  at_least(v, {5, 10, 11, 52, 57, 58}, chin - rooms.lip_chin);
  at_least(v, {4, 8, 9, 51, 55, 56}, -rooms.nose_lip);
  for (const std::size_t side : {0u, 1u}) {
    const Apart aside{v[6 + side], v[53 + side], -rooms.corner, 0.2f * rooms.corner};
    const Apart up{v[12 + side], v[59 + side], -kCornerTurn, kCornerTurn};
    const float far = std::hypot(aside.share(), up.share());
    v[53 + side] = aside.at(1 / std::max(far, 1.0f));
    v[59 + side] = up.at(1 / std::max(far, 1.0f));
    // Where the corner or the jaw pulls at the cheek it can be sucked in less.
    const float pull = std::max(
        {v[6 + side], v[53 + side], 0.5f * v[12 + side], 0.5f * v[59 + side], std::abs(v[15])});
    if (usual) at_least(v, {39 + side}, -kCheekIn + 0.5f * pull);
  }
  for (const auto& [outer, inner] : {std::pair(51u, 4u), {55u, 8u}, {56u, 9u}}) {
    v[outer] = std::min(v[outer], v[inner] + rooms.upper_lip);
  }
  for (const auto& [outer, inner] : {std::pair(52u, 5u), {57u, 10u}, {58u, 11u}}) {
    v[outer] = std::min(v[outer], v[inner] + rooms.lower_lip);
  }
}

}  // namespace

void stop_at_contact(const Rig& rig, ControlValues& v) {
  for (const Reach& reach : rig.reaches) {
    float& value = v[std::size_t(reach.fap)];
    value = ease(value, reach.low, reach.high);
  }
  for (const auto& [upper, lower] : fap::internal::kLips) {
    meet(v[std::size_t(upper)], v[std::size_t(lower)], 0);
    if (rig.lips.empty()) close_nearly(v[std::size_t(upper)], v[std::size_t(lower)]);
  }
  share(v[19], v[21], 1024);
  share(v[20], v[22], 1024);
  stop_at_rooms(rig.rooms, !rig.reaches.empty(), v);
}

std::vector<Reach> usual_reaches() {
  // In the units of each FAP, from what people do: the jaw goes 8 mm forward and 11 aside, cheeks
  // 15 mm out, lips 12 mm forward, and back until they lie on the teeth. What has no entry has no
  // limit.
  const struct {
    std::initializer_list<int> faps;
    float low, high;
  } usual_ones[] = {{{3}, -kChinUp, 1500},       {{5, 10, 11, 52, 57, 58}, -kNoLimit, 600},
                    {{6, 7, 53, 54}, -205, 280}, {{12, 13, 59, 60}, -kNoLimit, 640},
                    {{14}, -kNoLimit, 480},      {{15}, -280, 280},
                    {{16}, -kNoLimit, 600},      {{17}, -500, 600},
                    {{18}, -kNoLimit, 470},      {{21, 22}, -175, kNoLimit},
                    {{27, 28}, -200, 20},        {{31, 32, 33, 34}, -kNoLimit, 440},
                    {{35, 36}, -kNoLimit, 350},  {{39, 40}, -kCheekIn, 280},
                    {{41, 42}, -160, 215},       {{61, 62}, -190, 200},
                    {{63}, -180, 240},           {{64}, -240, 240},
                    {{43}, -450, 450},           {{44}, -600, 850},
                    {{45}, -250, 800},           {{46}, -350, 650},
                    {{47}, -80000, 80000}};
  std::vector<Reach> reaches;
  for (const auto& usual : usual_ones) {
    for (const int fap : usual.faps) reaches.push_back({fap, usual.low, usual.high});
  }
  return reaches;
}

}  // namespace animeme::head::detail
