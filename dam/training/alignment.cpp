#include "dam/training/alignment.h"

#include <algorithm>
#include <cmath>

#include "dam/maths/parallel.h"
#include "dam/maths/random.h"
#include "dam/training/alignment_map_internal.h"

namespace animeme::dam {
namespace {

constexpr std::size_t kMostForMap = 400;  // sentences; more do not improve the map
constexpr std::size_t kOtherScripts = 12;
constexpr double kOtherLags[] = {-0.16, 0, 0.16};  // seconds, around the best
constexpr std::size_t kFewestToCompare = 5;        // sentences
constexpr double kSureOfScripts = 6;               // deviations of the fits with other scripts
constexpr double kBetterThanOthers = 2;            // times their mean
constexpr double kSomeFit = 0.15;                  // where there are too few others
constexpr double kLagNotable = 0.040, kLagSurely = 0.020;          // seconds
constexpr std::size_t kLagPieces = 8;                              // required for a lag
constexpr double kWidestInterval = 0.15, kSpeakersDiffer = 0.010;  // seconds
constexpr std::size_t kLagDraws = 400;
constexpr std::size_t kFewestForDoubt = 5;            // sentences
constexpr double kPoorMatch = 0.6, kGoodMatch = 0.9;  // of the usual correlation
constexpr double kOwnShift = 0.1;                     // seconds
constexpr double kOthersAsGood = 0.25;                // of other scripts

/// The given sentences, each with the script of the sentence `apart` places further.
std::vector<Match> matches_of(const std::vector<SentenceTrack>& tracks, std::size_t apart) {
  std::vector<Match> matches;
  const std::size_t n = tracks.size();
  for (std::size_t s = 0; s < n; s += (n + kMostForMap - 1) / kMostForMap)
    matches.push_back({&tracks[(s + apart) % n], &tracks[s]});
  return matches;
}

/// How far apart the others are that a sentence is compared with: spread over all, so that
/// neighbours, which may be alike, are few.
std::vector<std::size_t> other_places(std::size_t sentences) {
  std::vector<std::size_t> places;
  const std::size_t count = std::min(kOtherScripts, sentences - 1);
  for (std::size_t j = 1; j <= count; ++j) places.push_back(j * (sentences - 1) / count);
  return places;
}

class Aligner {
 public:
  Aligner(const std::vector<SentenceTrack>& tracks, int threads)
      : tracks_(tracks), threads_(threads), others_(other_places(tracks.size())) {}

  Alignment check() {
    out_.sentences = tracks_.size();
    fit();
    compare();
    if (out_.unrelated) return std::move(out_);
    estimate();
    doubt();
    return std::move(out_);
  }

 private:
  void fit() {
    std::vector<ShapeMap> maps(kLags);
    const auto own = matches_of(tracks_, 0);
    parallel_for(kLags, threads_, [&](std::size_t l) { maps[l] = fit_map(own, lag_of(l)); });
    std::size_t best = 0;
    for (std::size_t l = 0; l < kLags; ++l)
      if (maps[l].fit > maps[best].fit) best = l;
    map_ = maps[best];
    lag_ = lag_of(best);
    out_.fit = map_.fit;
  }

  /// Fit of maps for the scripts of other sentences.
  void compare() {
    if (tracks_.size() < kFewestToCompare) return;
    const std::size_t lags = std::size(kOtherLags);
    std::vector<double> fits(others_.size() * lags);
    parallel_for(fits.size(), threads_, [&](std::size_t j) {
      fits[j] = fit_map(matches_of(tracks_, others_[j / lags]), lag_ + kOtherLags[j % lags]).fit;
    });
    const double n = double(fits.size());
    for (const double f : fits) out_.chance += f / n;
    for (const double f : fits) out_.chance_sd += (f - out_.chance) * (f - out_.chance) / n;
    out_.chance_sd = std::sqrt(out_.chance_sd);
    out_.unrelated = out_.fit < out_.chance + kSureOfScripts * out_.chance_sd ||
                     out_.fit < kBetterThanOthers * out_.chance;
  }

  /// The lag of all, with an interval from drawing sentences, or seconds if there are few.
  void estimate() {
    sums_.resize(tracks_.size());
    parallel_for(tracks_.size(), threads_, [&](std::size_t s) {
      const double seconds = tracks_[s].times.back() - tracks_[s].times.front();
      const auto pieces = std::size_t(std::max(1.0, std::round(seconds)));
      sums_[s] =
          match_at_lags({&tracks_[s], &tracks_[s]}, map_, tracks_.size() < kLagPieces ? pieces : 1);
    });
    std::vector<const LagSums*> all;
    for (const auto& sentence : sums_)
      for (const LagSums& piece : sentence) all.push_back(&piece);
    if (all.size() < kLagPieces || (out_.chance_sd == 0 && out_.fit < kSomeFit)) return;
    const LagPeak peak = peak_of(correlations(all));
    Random random(1);
    std::vector<double> lags;
    std::vector<const LagSums*> drawn(all.size());
    for (std::size_t d = 0; d < kLagDraws; ++d) {
      for (const LagSums*& one : drawn) one = all[random.below(all.size())];
      lags.push_back(peak_of(correlations(drawn)).lag);
    }
    std::sort(lags.begin(), lags.end());
    const LagEstimate lag{peak.lag, lags[kLagDraws / 40] - kSpeakersDiffer,
                          lags[kLagDraws - 1 - kLagDraws / 40] + kSpeakersDiffer};
    if (lag.high - lag.low <= kWidestInterval && std::abs(lag.seconds) < lag_of(kLags - 1))
      out_.lag = lag;
  }

  /// Sentences that do not follow their script where it is, but would elsewhere, or would follow
  /// those of others as well.
  void doubt() {
    const std::size_t n = tracks_.size();
    if (n < kFewestForDoubt) return;
    std::vector<LagPeak> peaks;
    std::vector<double> usual;
    for (const auto& sentence : sums_) {
      std::vector<const LagSums*> pieces;
      for (const LagSums& piece : sentence) pieces.push_back(&piece);
      peaks.push_back(peak_of(correlations(pieces)));
      usual.push_back(peaks.back().correlation);
    }
    std::nth_element(usual.begin(), usual.begin() + std::ptrdiff_t(n / 2), usual.end());
    const double middle = usual[n / 2];
    for (std::size_t s = 0; s < n; ++s) {
      const double fit = match_at({&tracks_[s], &tracks_[s]}, map_, lag_);
      if (fit > kPoorMatch * middle) continue;
      const double shift = peaks[s].lag - lag_;
      const bool elsewhere = peaks[s].correlation >= kGoodMatch * middle;
      if (elsewhere ? std::abs(shift) >= kOwnShift : others_as_good(s, fit))
        out_.doubts.push_back(
            {tracks_[s].id, fit, middle, elsewhere ? std::optional(shift) : std::nullopt});
    }
    std::stable_sort(out_.doubts.begin(), out_.doubts.end(),
                     [](const ScriptDoubt& a, const ScriptDoubt& b) { return a.fit < b.fit; });
  }

  bool others_as_good(std::size_t s, double fit) const {
    std::size_t count = 0;
    for (const std::size_t apart : others_)
      if (match_at({&tracks_[(s + apart) % tracks_.size()], &tracks_[s]}, map_, lag_) >= fit)
        ++count;
    return double(count) >= kOthersAsGood * double(others_.size());
  }

  const std::vector<SentenceTrack>& tracks_;
  int threads_;
  std::vector<std::size_t> others_;
  ShapeMap map_;
  double lag_ = 0;
  std::vector<std::vector<LagSums>> sums_;  // by sentence
  Alignment out_;
};

}  // namespace

bool LagEstimate::notable() const {
  const bool sure = seconds > 0 ? low > kLagSurely : high < -kLagSurely;
  return sure && std::abs(seconds) >= kLagNotable;
}

Result<Alignment> check_alignment(std::span<const Utterance* const> utterances, int threads) {
  std::vector<const Utterance*> sentences(utterances.begin(), utterances.end());
  std::stable_sort(sentences.begin(), sentences.end(),
                   [](const Utterance* a, const Utterance* b) { return a->id < b->id; });
  if (sentences.empty()) return Alignment{};
  const auto tracks = make_tracks(sentences, threads);
  if (!tracks) return tracks.error();
  if (tracks->empty()) return Alignment{};
  return Aligner(*tracks, threads).check();
}

Script shifted_script(const Script& script, double seconds) {
  Script out;
  for (Phone phone : script.phones) {
    phone.start += seconds;
    phone.end += seconds;
    if (phone.end <= kTimeTolerance) continue;
    phone.start = std::max(0.0, phone.start);
    if (out.phones.empty() && phone.label == kSilence) phone.start = 0;
    out.phones.push_back(phone);
  }
  return out;
}

}  // namespace animeme::dam
