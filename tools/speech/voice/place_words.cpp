#include "tools/speech/voice/place_words.h"

#include <algorithm>

#include "tools/speech/voice/review_words.h"

namespace animeme::voice {

namespace {

constexpr std::size_t kWhole = 6000, kPiece = 4000;      // frames
constexpr double kPhonesPerFrame = 0.25;                 // a frame: more nobody says
constexpr double kEarliestCut = 0.4, kLatestCut = 0.95;  // of a piece
constexpr double kWordCut = 0.8;                         // where there is no pause
// A piece that has less of it in words may have lost its place: the text is looked at further on.
constexpr double kLost = 0.3;
constexpr std::size_t kFurther = 4;

// Chosen on 40 sentences of grid_s1 with words too many and missing
// (tools/speech/voice/measured.md): in quiet, and how much more is asked for where the voice stands
// out less.
constexpr PathCosts kQuietCosts{46, 20, 20, 30, 2.5f, 2};
constexpr float kQuietRange = 42, kNoisyRange = 27;  // dB
constexpr float kForeignWords = 1;  // words of other languages fit as those of English in noise
constexpr float kNoisySkip = 2.5f, kNoisyForeign = 1.5f, kNoisyFrame = 0.5f;

constexpr std::size_t kReviews = 3;  // a word that is taken out gives its neighbours room

// Foreign sound is speech if it is no shorter, and no nearer to the room than to the voice.
constexpr std::size_t kLeastForeign = 15;  // frames
constexpr float kLoudEnough = 0.6f;

PathCosts costs_of(const FrameScores& scores, bool foreign) {
  PathCosts costs = kQuietCosts;
  const float noisy =
      foreign ? kForeignWords
              : std::clamp((kQuietRange - scores.range) / (kQuietRange - kNoisyRange), 0.0f, 1.0f);
  costs.skip *= 1 + (kNoisySkip - 1) * noisy;
  costs.foreign *= 1 + (kNoisyForeign - 1) * noisy;
  costs.foreign_frame += kNoisyFrame * noisy;
  return costs;
}

double costs_to_skip(std::span<const WordModel> words, const PathCosts& costs) {
  double known = 0;
  for (const WordModel& word : words) {
    if (!word.variants.empty()) known += double(word.words);
  }
  return known == 0 ? 0 : double(costs.skip) + known * double(costs.skip_word);
}

PlacedPart placed(const FrameScores& scores, const PathPart& part) {
  PlacedPart out{part, {}};
  if (part.kind != PartKind::foreign) return out;
  float level = 0;
  for (std::size_t t = part.first; t < part.first + part.frames; ++t) {
    level += scores.levels[t];
    out.heard.push_back(scores.free[t]);
  }
  const bool quiet = level < kLoudEnough * scores.range * float(part.frames);
  if (part.word == kNone && (part.frames < kLeastForeign || quiet)) {
    out.part.kind = PartKind::pause;
    out.heard.clear();
  }
  return out;
}

// As many words as can be said in so many frames.
std::size_t words_within(std::span<const WordModel> words, double frames) {
  double phones = 0;
  std::size_t count = 0;
  while (count < words.size() && phones < frames * kPhonesPerFrame) {
    const auto& variants = words[count++].variants;
    phones += variants.empty() ? 1 : double(variants[0].size());
  }
  return count;
}

double share_of_words(const std::vector<PathPart>& parts, std::size_t frames) {
  std::size_t words = 0;
  for (const PathPart& part : parts) words += part.kind == PartKind::phone ? part.frames : 0;
  return double(words) / double(frames);
}

// The frame to stop before: the middle of the longest pause, or stretch of foreign sound, that is
// neither early nor at the very end, where the path still leans on words that were not heard whole;
// without one a word that begins there.
std::size_t cut_of(const std::vector<PathPart>& parts, std::size_t frames) {
  const auto early = std::size_t(kEarliestCut * double(frames));
  const auto late = std::size_t(kLatestCut * double(frames));
  const auto usual = std::size_t(kWordCut * double(frames));
  std::size_t best = 0, longest = 0, word = usual, distance = frames;
  for (const PathPart& part : parts) {
    const std::size_t first = std::max(part.first, early);
    const std::size_t last = std::min(part.first + part.frames, late);
    if (part.word == kNone && last > first && last - first > longest) {
      longest = last - first;
      best = first + longest / 2;
    }
    const bool begins = part.kind == PartKind::phone && part.index == 0;
    const std::size_t off = part.first > usual ? part.first - usual : usual - part.first;
    if (begins && off < distance) {
      distance = off;
      word = part.first;
    }
  }
  return std::clamp<std::size_t>(best > 0 ? best : word, 1, frames);
}

// The path, without words that are squeezed in.
FoundPath find_words(const SoundModel& model, const FrameScores& scores,
                     std::span<const WordModel> words, const PathCosts& costs, bool open_end) {
  FoundPath path = find_path(model, scores, words, costs, open_end);
  std::vector<WordModel> rest;
  for (std::size_t round = 0; round < kReviews; ++round) {
    const auto squeezed = squeezed_words(model, scores, words, path.parts, costs);
    if (squeezed.empty()) break;
    if (rest.empty()) rest.assign(words.begin(), words.end());
    for (const std::size_t word : squeezed) rest[word].left_out = true;
    path = find_path(model, scores, rest, costs, open_end);
  }
  return path;
}

}  // namespace

Placement place_words(const SoundModel& model, const MeasuredSound& sound,
                      std::span<const WordModel> words, bool foreign) {
  Placement all;
  double saved = 0, without = 0;
  for (std::size_t at = 0, word = 0; at < sound.cepstra.size();) {
    const std::size_t left = sound.cepstra.size() - at;
    const bool last = left <= kWhole;
    const std::size_t frames = last ? left : kPiece;
    const FrameScores scores = score_frames(model, sound, at, frames);
    const PathCosts costs = costs_of(scores, foreign);
    const auto rest = words.subspan(word);
    // What is behind the end of the sound is left out, and never more than that searched.
    const double reach = double(last ? kWhole : kPiece);
    std::size_t some = words_within(rest, last ? double(kFurther) * reach : reach);
    const auto find = [&] {
      return find_words(model, scores, rest.first(some), costs, !last || some < rest.size());
    };
    FoundPath path = find();
    const auto& parts = path.parts;
    if (!last && some < rest.size() && share_of_words(parts, frames) < kLost) {
      some = words_within(rest, double(kFurther) * reach);
      path = find();
    }
    const double nothing = double(find_path(model, scores, {}, costs, false).total) -
                           (last ? costs_to_skip(words.subspan(word), costs) : 0);
    saved += double(path.total) - nothing;
    without -= nothing;
    const std::size_t cut = last ? frames : cut_of(parts, frames);
    std::size_t next = word;
    for (PathPart part : parts) {
      if (part.first >= cut) break;
      part.frames = std::min(part.frames, cut - part.first);
      PlacedPart one = placed(scores, part);
      one.part.first += at;
      if (part.word != kNone) {
        one.part.word += word;
        next = one.part.word + 1;
      }
      all.parts.push_back(std::move(one));
    }
    at += cut;
    word = next;
  }
  all.explained = without > 0 ? saved / without : 0;
  return all;
}

}  // namespace animeme::voice
