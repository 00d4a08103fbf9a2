#include "dam/speaking/conversation.h"

#include <algorithm>
#include <optional>

namespace animeme::dam {
namespace {

constexpr double kSameTurn = 0.4;     // seconds of a pause inside a turn
constexpr double kReaction = 0.2;     // seconds until a listener looks at who begins to speak
constexpr double kNeighbour = 26;     // degrees to who sits beside
constexpr double kFurther = 7;        // degrees for each seat more
constexpr double kMostSideways = 45;  // degrees

// A person speaks.
struct Turn {
  double start = 0, end = 0;
  std::size_t person = 0;
};

std::vector<Turn> turns_of(std::span<const Script> people) {
  std::vector<Turn> turns;
  for (std::size_t person = 0; person < people.size(); ++person) {
    std::optional<Turn> turn;
    for (const Phone& phone : people[person].phones) {
      if (phone.label == kSilence) continue;
      if (turn && phone.start - turn->end < kSameTurn) {
        turn->end = phone.end;
        continue;
      }
      if (turn) turns.push_back(*turn);
      turn = Turn{phone.start, phone.end, person};
    }
    if (turn) turns.push_back(*turn);
  }
  std::stable_sort(turns.begin(), turns.end(),
                   [](const Turn& a, const Turn& b) { return a.start < b.start; });
  return turns;
}

// Who speaks next after turn `at`, but `person`.
std::optional<std::size_t> next_other(const std::vector<Turn>& turns, std::size_t at,
                                      std::size_t person) {
  for (std::size_t i = at; i < turns.size(); ++i)
    if (turns[i].person != person) return turns[i].person;
  return std::nullopt;
}

Attention attention_to(const std::vector<Turn>& turns, std::size_t person, std::size_t count) {
  Attention attention;
  // Whom it looks at while nobody has spoken: the first one, else a neighbour.
  std::size_t target = next_other(turns, 0, person).value_or(person == 0 ? 1 : person - 1);
  target = std::min(target, count - 1);
  attention.looks.push_back({0, look_to(person, target)});
  std::optional<std::size_t> before;  // the other one who spoke last
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const Turn& turn = turns[i];
    double time = turn.start;
    std::size_t wanted = target;
    if (turn.person == person) {
      wanted = before ? *before : next_other(turns, i, person).value_or(target);
    } else {
      before = wanted = turn.person;
      time += kReaction;
      std::vector<HeardSpan>& heard = attention.heard;
      if (!heard.empty() && turn.start <= heard.back().end) {
        heard.back().end = std::max(heard.back().end, turn.end);
      } else {
        heard.push_back({turn.start, turn.end});
      }
    }
    if (wanted == target) continue;
    target = wanted;
    time = std::max(time, attention.looks.back().time);
    attention.looks.push_back({time, look_to(person, target)});
  }
  return attention;
}

}  // namespace

Look look_to(std::size_t from, std::size_t to) {
  const double seats = to > from ? double(to - from) : double(from - to);
  const double yaw = std::min(kMostSideways, kNeighbour + kFurther * (seats - 1));
  // Who sits further right in the picture is to the left of a person that faces the camera.
  return {.kind = Look::Kind::direction, .yaw = to > from ? yaw : -yaw};
}

std::vector<Attention> attention_of(std::span<const Script> people) {
  std::vector<Attention> all(people.size());
  if (people.size() < 2) return all;
  const std::vector<Turn> turns = turns_of(people);
  for (std::size_t person = 0; person < people.size(); ++person)
    all[person] = attention_to(turns, person, people.size());
  return all;
}

}  // namespace animeme::dam
