// What moods look like. The six of FAP 2 are its poses, chosen by eye on the heads of fap/head; the
// others are made of them, or of action units (P. Ekman, W. V. Friesen, "Facial Action Coding
// System", 1978) in the units of the same heads: 12 smile, 14 dimple, 4 brows down, 1 and 2 brows
// up, 5 lids up, 6 and 7 lids narrow, 43 lids down, 17 chin up, 24 lips pressed.
#include <algorithm>

#include "dam/speaking/moods.h"
#include "fap/expand.h"
#include "fap/tables.h"

namespace animeme::dam {
namespace {

struct FapValue {
  int fap;    // of the left side, where there are two
  int value;  // of both sides
};

// Single sides of a one-sided mood.
struct SideValue {
  int fap;
  int value;
};

struct ExpressionShare {
  int expression;  // 1..6: joy, sadness, anger, fear, disgust, surprise
  double share;
};

struct MoodRow {
  std::string_view name;
  double style = 1;
  std::span<const ExpressionShare> mixed = {};  // in the pose and in FAP 2
  std::span<const ExpressionShare> coded = {};  // in FAP 2 alone
  std::span<const FapValue> values = {};
  std::span<const SideValue> sides = {};
};

constexpr ExpressionShare kOnly[][1] = {{{1, 1}}, {{2, 1}}, {{3, 1}}, {{4, 1}}, {{5, 1}}, {{6, 1}}};

constexpr ExpressionShare kSmallJoy[] = {{1, 0.35}};
constexpr ExpressionShare kHalfJoy[] = {{1, 0.5}};
constexpr ExpressionShare kJoyAndSurprise[] = {{1, 0.3}, {6, 0.2}};
constexpr ExpressionShare kJoyAndSadness[] = {{1, 0.3}, {2, 0.3}};
constexpr ExpressionShare kSmallSadness[] = {{2, 0.25}};
constexpr ExpressionShare kSmallAnger[] = {{3, 0.3}};
constexpr ExpressionShare kHalfAnger[] = {{3, 0.5}};
constexpr ExpressionShare kSmallDisgust[] = {{5, 0.3}};
constexpr ExpressionShare kSmallSurprise[] = {{6, 0.2}};
constexpr ExpressionShare kExcited[] = {{1, 0.8}, {6, 0.3}};
constexpr ExpressionShare kWorried[] = {{4, 0.4}, {2, 0.5}};
constexpr ExpressionShare kPain[] = {{2, 0.4}, {5, 0.45}};
constexpr ExpressionShare kDisgruntled[] = {{5, 0.4}, {3, 0.4}};
constexpr ExpressionShare kShouting[] = {{3, 0.35}, {6, 0.25}};

constexpr FapValue kFriendly[] = {{12, 150}, {59, 150}, {6, 55},  {53, 55},
                                  {41, 55},  {21, 70},  {31, 25}, {33, 35}};
constexpr FapValue kLoving[] = {{12, 150}, {59, 150}, {6, 50},   {53, 50}, {41, 60},
                                {21, 110}, {19, 110}, {31, 100}, {33, 40}};
constexpr FapValue kHopeful[] = {{12, 100}, {59, 100}, {6, 30},  {53, 30}, {41, 30},
                                 {31, 190}, {33, 110}, {35, 50}, {19, -60}};
constexpr FapValue kProud[] = {{12, 110}, {59, 110}, {6, 40},  {53, 40}, {18, 70},
                               {41, 40},  {19, 190}, {33, 70}, {35, 70}};
constexpr FapValue kCalm[] = {{12, 40}, {59, 40}, {19, 110}};
constexpr FapValue kSerious[] = {{31, -80}, {33, -55}, {37, 45}, {21, 50}, {12, -30}, {59, -30}};
constexpr FapValue kDetermined[] = {{31, -130}, {33, -90}, {37, 75}, {21, 130}, {4, 40},
                                    {5, 50},    {8, 30},   {10, 40}, {18, 70},  {41, 30}};
constexpr FapValue kThinking[] = {{21, 120}, {19, 60},  {37, 50}, {16, 70}, {18, 90},
                                  {12, -50}, {59, -50}, {6, -30}, {53, -30}};
constexpr SideValue kThinkingSides[] = {{31, -70}, {33, -50}, {32, 40}, {34, 150}, {36, 130}};
constexpr FapValue kDoubtful[] = {{18, 80}, {12, -80}, {59, -80}, {21, 60}};
constexpr SideValue kDoubtfulSides[] = {{31, -120}, {33, -90}, {35, -30}, {32, 120},
                                        {34, 280},  {36, 240}, {19, 120}, {20, -60}};
constexpr FapValue kConfused[] = {{37, 50}, {12, -40}, {59, -40}, {16, 40}, {18, 60}};
constexpr SideValue kConfusedSides[] = {{31, -90}, {33, -70}, {32, 220}, {34, 180},
                                        {36, 110}, {19, 60},  {20, -90}};
constexpr FapValue kIronic[] = {{19, 110}, {21, 60}};
constexpr SideValue kIronicSides[] = {{13, 210}, {60, 210}, {7, 90},   {54, 90}, {42, 80},
                                      {31, 60},  {33, 200}, {35, 190}, {32, -40}};
constexpr FapValue kContempt[] = {{19, 150}, {21, 50}, {18, 50}, {31, -30}};
constexpr SideValue kContemptSides[] = {{12, 140}, {59, 140}, {6, 60},
                                        {53, 60},  {41, 70},  {61, 40}};
constexpr FapValue kBored[] = {{19, 320}, {12, -60}, {59, -60}, {31, -20}, {33, 20}, {35, 20}};
constexpr FapValue kSleepy[] = {{19, 520}, {21, 40},  {31, 30}, {33, 60},
                                {35, 40},  {12, -40}, {59, -40}};
constexpr FapValue kEmbarrassed[] = {{12, 110}, {59, 110}, {6, 40},   {53, 40}, {31, 190},
                                     {33, 70},  {37, 30},  {19, 170}, {18, 70}, {41, 40}};
constexpr FapValue kPainMore[] = {{19, 160}, {21, 120}, {37, 40}, {6, 60}, {53, 60}};
constexpr FapValue kWhispering[] = {{31, 70}, {33, 60}, {35, 40}, {19, -30}};

const MoodRow kRows[] = {
    {"neutral"},
    {"joy", 1.05, kOnly[0]},
    {"sadness", 0.85, kOnly[1]},
    {"anger", 1.12, kOnly[2]},
    {"fear", 1, kOnly[3]},
    {"disgust", 1, kOnly[4]},
    {"surprise", 1.05, kOnly[5]},
    {"friendly", 1, {}, kSmallJoy, kFriendly},
    {"excited", 1.15, kExcited},
    {"loving", 0.95, {}, kHalfJoy, kLoving},
    {"hopeful", 1, {}, kJoyAndSurprise, kHopeful},
    {"proud", 1, {}, kSmallJoy, kProud},
    {"calm", 0.9, {}, {}, kCalm},
    {"serious", 1, {}, kSmallAnger, kSerious},
    {"determined", 1.1, {}, kHalfAnger, kDetermined},
    {"thinking", 0.9, {}, {}, kThinking, kThinkingSides},
    {"doubtful", 0.95, {}, kSmallDisgust, kDoubtful, kDoubtfulSides},
    {"confused", 0.95, {}, kSmallSurprise, kConfused, kConfusedSides},
    {"ironic", 1, {}, kSmallJoy, kIronic, kIronicSides},
    {"contempt", 0.95, {}, kSmallDisgust, kContempt, kContemptSides},
    {"bored", 0.8, {}, kSmallSadness, kBored},
    {"sleepy", 0.75, {}, kSmallSadness, kSleepy},
    {"worried", 0.95, kWorried},
    {"embarrassed", 0.85, {}, kJoyAndSadness, kEmbarrassed},
    {"pain", 1, kPain, {}, kPainMore},
    {"disgruntled", 0.95, kDisgruntled},
    {"shouting", 1.35, kShouting},
    {"whispering", 0.75, {}, {}, kWhispering},
};

const MoodRow* find_row(std::string_view name) {
  const auto found = std::find_if(std::begin(kRows), std::end(kRows),
                                  [&](const MoodRow& row) { return row.name == name; });
  return found == std::end(kRows) ? nullptr : found;
}

MoodPose full_pose(const MoodRow& row) {
  MoodPose pose;
  for (const ExpressionShare& one : row.mixed) {
    const fap::Frame shape = fap::expression_pose(one.expression);
    for (std::size_t f = fap::kFirstLowLevel; f < pose.fap.size(); ++f)
      pose.fap[f] += one.share * shape.value[f];
  }
  for (const std::span<const ExpressionShare> list : {row.mixed, row.coded})
    for (const ExpressionShare& one : list)
      pose.expression[std::size_t(one.expression)] += one.share;
  for (const FapValue& one : row.values) {
    pose.fap[std::size_t(one.fap)] += one.value;
    if (const int mirror = fap::info(one.fap).mirror) pose.fap[std::size_t(mirror)] += one.value;
  }
  for (const SideValue& one : row.sides) pose.fap[std::size_t(one.fap)] += one.value;
  pose.style = row.style;
  return pose;
}

}  // namespace

void MoodPose::add(const MoodPose& other, double share) {
  for (std::size_t f = 0; f < fap.size(); ++f) fap[f] += share * other.fap[f];
  for (std::size_t e = 0; e < expression.size(); ++e) expression[e] += share * other.expression[e];
  style += share * (other.style - 1);
}

bool MoodPose::neutral() const {
  const auto rests = [](double value) { return value == 0; };
  return style == 1 && std::all_of(fap.begin(), fap.end(), rests) &&
         std::all_of(expression.begin(), expression.end(), rests);
}

fap::Mask MoodPose::faps() const {
  fap::Mask mask;
  for (int f = fap::kFirstLowLevel; f <= fap::kFapCount; ++f) {
    if (fap[std::size_t(f)] == 0) continue;
    mask.set(std::size_t(f));
    if (const int other = fap::info(f).mirror; other != 0) mask.set(std::size_t(other));
  }
  return mask;
}

MoodPose mood_pose(const Mood& mood) {
  MoodPose pose;
  const MoodRow* row = find_row(mood.name);
  if (row != nullptr && !mood.neutral()) pose.add(full_pose(*row), mood.intensity);
  return pose;
}

const fap::Mask& mood_faps() {
  static const fap::Mask all = [] {
    fap::Mask mask;
    for (const MoodRow& row : kRows) mask |= full_pose(row).faps();
    return mask;
  }();
  return all;
}

}  // namespace animeme::dam
