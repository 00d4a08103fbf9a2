#include "tools/app/check/coded_values.h"

#include <algorithm>
#include <map>
#include <optional>

#include "fap/tables.h"

namespace animeme::tools {
namespace {

constexpr int kParts = 8;

// What two paired frames differ in, beyond wrong values.
struct Extras {
  bool values = false;
  bool numbers = false;
};

std::optional<FirstDifference> compare_frame(const CodedClip& clip, const CodedFrame& expected,
                                             const CodedFrame& got, Extras& extras) {
  std::size_t k = 0;
  for (const auto& [key, value] : expected.values) {
    while (k < got.values.size() && got.values[k].first < key) {
      extras.values = true;
      ++k;
    }
    FirstDifference difference{expected.number, key_name(clip.body, key), value, false, 0};
    if (k == got.values.size() || got.values[k].first != key) {
      difference.missing = true;
      return difference;
    }
    if (got.values[k].second != value) {
      difference.got = got.values[k].second;
      return difference;
    }
    ++k;
  }
  extras.values |= k < got.values.size();
  extras.numbers |= expected.number != got.number;
  return {};
}

Comparison wrong(FirstDifference difference) {
  Comparison result;
  result.text = "frame " + std::to_string(difference.frame) + ", " + difference.parameter +
                ": expected " + std::to_string(difference.expected) + ", got " +
                (difference.missing ? "nothing" : std::to_string(difference.got));
  result.difference = std::move(difference);
  return result;
}

// The frame of `got` for each expected one; an empty list if one has none.
std::vector<const CodedFrame*> pair_up(const CodedClip& expected, const CodedClip& got) {
  std::vector<const CodedFrame*> pairs;
  if (expected.frames.size() == got.frames.size()) {
    for (const CodedFrame& frame : got.frames) pairs.push_back(&frame);
    return pairs;
  }
  std::map<std::int64_t, const CodedFrame*> by_number;
  for (const CodedFrame& frame : got.frames) by_number.emplace(frame.number, &frame);
  for (const CodedFrame& frame : expected.frames) {
    const auto found = by_number.find(frame.number);
    if (found == by_number.end()) return {};
    pairs.push_back(found->second);
  }
  return pairs;
}

// Frames behind the last expected one may only repeat it, as a decoder does that shows skipped
// frames; anything else was never coded.
bool is_odd_end(const CodedClip& expected, const CodedClip& got) {
  if (got.frames.size() <= expected.frames.size()) return false;
  const std::int64_t last = expected.frames.empty() ? -1 : expected.frames.back().number;
  for (std::size_t i = 0; i < got.frames.size(); ++i) {
    if (got.frames[i].number <= last) continue;
    if (i == 0 || got.frames[i].values != got.frames[i - 1].values) return true;
  }
  return false;
}

void add_word(std::string& list, const char* word) {
  list += (list.empty() ? "" : ", ") + std::string(word);
}

}  // namespace

CodedClip coded_values(const fap::Sequence& clip) {
  CodedClip out{false, clip.rate, {}};
  out.frames.reserve(clip.frames.size());
  for (const fap::Frame& frame : clip.frames) {
    CodedFrame& coded = out.frames.emplace_back();
    coded.number = frame.number;
    const auto put = [&](int fap, std::initializer_list<std::int64_t> parts) {
      int part = 0;
      for (const std::int64_t value : parts)
        coded.values.emplace_back(fap * kParts + part++, value);
    };
    const fap::Viseme& v = frame.viseme;
    const fap::Expression& e = frame.expression;
    if (frame.mask[1]) put(1, {v.select1, v.select2, v.blend, v.def});
    if (frame.mask[2]) {
      put(2, {e.select1, e.intensity1, e.select2, e.intensity2, e.init_face, e.def});
    }
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (frame.mask[std::size_t(fap)]) put(fap, {frame.value[std::size_t(fap)]});
    }
  }
  return out;
}

CodedClip coded_values(const fba::BodySequence& clip) {
  CodedClip out{true, clip.rate, {}};
  out.frames.reserve(clip.frames.size());
  for (const fba::BodyFrame& frame : clip.frames) {
    CodedFrame& coded = out.frames.emplace_back();
    coded.number = frame.number;
    for (std::size_t bap = 1; bap <= fba::kBapCount; ++bap) {
      if (frame.mask[bap]) coded.values.emplace_back(int(bap) * kParts, frame.value[bap]);
    }
  }
  return out;
}

std::string key_name(bool body, int key) {
  constexpr const char* kViseme[] = {"viseme_select1", "viseme_select2", "viseme_blend",
                                     "viseme_def"};
  constexpr const char* kExpression[] = {"expression_select1", "expression_intensity1",
                                         "expression_select2", "expression_intensity2",
                                         "init_face",          "expression_def"};
  const int number = key / kParts;
  if (body) return "BAP " + std::to_string(number);
  const std::size_t part = std::size_t(key % kParts);
  const std::string name = number == 1   ? kViseme[part]
                           : number == 2 ? kExpression[part]
                                         : std::string(fap::info(number).name);
  return "FAP " + std::to_string(number) + " " + name;
}

Comparison compare(const CodedClip& expected, const CodedClip& got) {
  const char* frames = expected.body ? " body frames" : " face frames";
  Extras extras;
  const std::vector<const CodedFrame*> pairs = pair_up(expected, got);
  if (pairs.size() != expected.frames.size()) {
    // Values are missing; report a wrong value before them first.
    const std::size_t common = std::min(expected.frames.size(), got.frames.size());
    for (std::size_t i = 0; i < common; ++i) {
      auto difference = compare_frame(expected, expected.frames[i], got.frames[i], extras);
      if (difference) return wrong(std::move(*difference));
    }
    Comparison result;
    result.text = std::to_string(got.frames.size()) + " in place of " +
                  std::to_string(expected.frames.size()) + frames;
    return result;
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    auto difference = compare_frame(expected, expected.frames[i], *pairs[i], extras);
    if (difference) return wrong(std::move(*difference));
  }
  Comparison result;
  if (is_odd_end(expected, got)) {
    result.text = "there are" + std::string(frames) + " behind the last one";
    return result;
  }
  result.right = true;
  if (extras.values) add_word(result.text, "more parameters than were coded");
  if (got.frames.size() != expected.frames.size())
    add_word(result.text, "more frames than were coded");
  if (extras.numbers) add_word(result.text, "other frame numbers");
  if (!expected.frames.empty() && expected.rate != got.rate)
    add_word(result.text, "another frame rate");
  result.exact = result.text.empty();
  return result;
}

bool is_beginning(const CodedClip& expected, const CodedClip& got) {
  if (got.frames.size() > expected.frames.size()) return false;
  Extras extras;
  for (std::size_t i = 0; i < got.frames.size(); ++i) {
    if (compare_frame(expected, expected.frames[i], got.frames[i], extras)) return false;
  }
  return true;
}

}  // namespace animeme::tools
