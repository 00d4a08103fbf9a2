#include "tools/speech/voice/hearing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <mutex>

namespace animeme::voice {

namespace {

// Chosen on 42 sentences of GRID talker 1 that are not those of the tables.
constexpr PathOptions kEnglish{0.2, 0.5, 1};
constexpr PathOptions kAnyLanguage{0.2, 0, 0.03};
constexpr float kKin = 0.7f;  // of a vote counts for phones of the same shape of the mouth
constexpr float kBilabials =
    1.6f;  // lips that stay open are seen sooner than lips that close once more
constexpr float kChange = 0.1f;       // of a vote: what another phone has to be better by
constexpr std::size_t kShortest = 3;  // frames
// The trace of noise lies about 47 dB below speech of such peaks, and above what 16 bit cannot
// tell.
constexpr float kTraceOfLoud = 0.002f, kLeastTrace = 0.00025f;

// From the share of paths that agree to how often they are right: paths of one model share its
// mistakes. Between grid_others in noise and the recordings of measured.md.
constexpr double kAgreement = 1.1, kOverconfidence = -0.17;
constexpr double kLoudShare = 0.7;  // of frames that are all alike
constexpr double kMostOfAll = 0.92;
constexpr std::size_t kFewOfSpeech = 30;  // with speech: too few for a mean

// What `count` of the levels reach.
float level_of_loudest(std::vector<float>& levels, double count) {
  const std::size_t last = std::min(std::size_t(count), levels.size() - 1);
  const auto at = levels.begin() + std::ptrdiff_t(last);
  std::nth_element(levels.begin(), at, levels.end(), std::greater<>());
  return *at;
}

Cepstrum mean_above(std::span<const Cepstrum> frames, float level) {
  std::array<double, kCepstra> sums{};
  double count = 0;
  for (const Cepstrum& frame : frames) {
    if (frame[0] < level) continue;
    ++count;
    for (std::size_t i = 0; i < kCepstra; ++i) sums[i] += double(frame[i]);
  }
  Cepstrum mean{};
  for (std::size_t i = 0; i < kCepstra; ++i) mean[i] = float(sums[i] / std::max(count, 1.0));
  return mean;
}

}  // namespace

// A frame begins half way between the middle of its window and that of the frame before. 10 ms are
// taken off, by which the model hears phones late (the bias of the tables in README.md).
double time_of(std::size_t frame) { return frame == 0 ? 0 : double(frame) * 0.01 - 0.0022; }

bool speaks_english(const std::string& language) {
  return language.substr(0, 2) == "en" && (language.size() == 2 || language[2] == '-');
}

Result<HearingModel> load_hearing(const ListenOptions& options) {
  if (options.readings < 1 || options.readings > 200) {
    return make_error(Code::invalid_argument, "the readings must be 1 to 200");
  }
  HearingModel model;
  auto sound = read_sound_model(options.model_path);
  if (!sound) return sound.error();
  model.sound = std::move(*sound);
  auto pairs = read_phone_pairs(options.phones_path, model.sound.phones);
  if (!pairs) return pairs.error();
  model.pairs = std::move(*pairs);
  model.weights = speaks_english(options.language) ? kEnglish : kAnyLanguage;
  for (const std::string& phone : model.sound.phones) {
    const dam::PhoneInfo* info = dam::find_phone(phone);
    model.labels.emplace_back(info != nullptr ? info->label : dam::kSilence);
    model.classes.push_back(info != nullptr ? info->phone_class : dam::PhoneClass::silence);
  }
  return model;
}

Result<std::shared_ptr<const HearingModel>> shared_hearing(const ListenOptions& options) {
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<const HearingModel>> known;
  const std::string key = options.model_path + '\n' + options.phones_path + '\n' +
                          (speaks_english(options.language) ? "en" : "") + '\n' +
                          std::to_string(options.readings);
  const std::lock_guard lock(mutex);
  std::weak_ptr<const HearingModel>& one = known[key];
  if (std::shared_ptr<const HearingModel> model = one.lock()) return model;
  Result<HearingModel> read = load_hearing(options);
  if (!read) return read.error();
  auto model = std::make_shared<const HearingModel>(std::move(*read));
  one = model;
  return model;
}

void to_whole(std::span<const float> samples, Trace& trace, std::vector<std::int16_t>& whole) {
  for (const float sample : samples) {
    std::uint64_t z = ++trace.number * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    const float noise = float((z ^ (z >> 27)) >> 40) / 8388608.0f - 1;  // -1..1
    const float level = std::max(kTraceOfLoud * trace.loud, kLeastTrace);
    whole.push_back(
        std::int16_t(std::clamp(std::lround((sample + level * noise) * 32768), -32768l, 32767l)));
  }
}

// The middle of a window lies in the block behind the one that it begins in.
bool is_speech(std::span<const std::uint8_t> speech, std::size_t frame) {
  return !speech.empty() && speech[std::min(frame + 1, speech.size() - 1)] != 0;
}

Cepstrum mean_of_speech(std::span<const Cepstrum> frames, std::span<const std::uint8_t> speech,
                        double share) {
  std::vector<float> levels;
  std::size_t count = 0;
  for (std::size_t t = 0; t < frames.size(); ++t) {
    levels.push_back(frames[t][0]);
    count += is_speech(speech, t) ? 1 : 0;
  }
  if (count < kFewOfSpeech)
    return mean_above(frames, level_of_loudest(levels, kLoudShare * double(levels.size())));
  return mean_above(frames, level_of_loudest(levels, std::min(share * double(count),
                                                              kMostOfAll * double(levels.size()))));
}

Features features_of(std::span<const Cepstrum> frames, std::size_t at, const Cepstrum& mean) {
  const auto near = [&](int step) -> const Cepstrum& {
    const auto wanted = std::int64_t(at) + step;
    return frames[std::size_t(
        std::clamp<std::int64_t>(wanted, 0, std::int64_t(frames.size()) - 1))];
  };
  Features features;
  for (std::size_t i = 0; i < kCepstra; ++i) {
    features[0][i] = near(0)[i] - mean[i];
    features[1][i] = near(2)[i] - near(-2)[i];
    features[2][i] = (near(3)[i] - near(-1)[i]) - (near(1)[i] - near(-3)[i]);
  }
  return features;
}

Votes count_votes(const std::vector<Path>& paths, std::size_t phones) {
  Votes votes(paths.empty() ? 0 : paths[0].size(), std::vector<float>(phones));
  for (const Path& path : paths) {
    for (std::size_t i = 0; i < path.size(); ++i) votes[i][path[i]] += 1.0f / float(paths.size());
  }
  return votes;
}

namespace {

bool is_closure(const HearingModel& model, std::size_t phone) {
  return model.classes[phone] == dam::PhoneClass::bilabial;
}

// The best path through the votes. Lips do not close in frames that are `open`.
Path best_path(const HearingModel& model, const Votes& votes,
               const std::vector<std::uint8_t>& open) {
  const std::size_t phones = model.labels.size(), states = phones * kShortest;
  std::vector<std::vector<std::uint16_t>> from(votes.size(), std::vector<std::uint16_t>(states));
  std::vector<float> best(states, -1e9f), next(states), gain(phones);
  for (std::size_t frame = 0; frame < votes.size(); ++frame) {
    std::array<float, dam::kPhoneClassCount> kin{};
    for (std::size_t p = 0; p < phones; ++p) kin[std::size_t(model.classes[p])] += votes[frame][p];
    for (std::size_t p = 0; p < phones; ++p) {
      const auto shape = model.classes[p];
      gain[p] = (1 - kKin) * votes[frame][p] + kKin * kin[std::size_t(shape)];
      if (is_closure(model, p)) gain[p] *= open[frame] != 0 ? 0 : kBilabials;
    }
    std::size_t leader = kShortest - 1;  // the best that may end
    for (std::size_t s = leader; s < states; s += kShortest)
      leader = best[s] > best[leader] ? s : leader;
    for (std::size_t s = 0; s < states; ++s) {
      const std::size_t part = s % kShortest;
      std::size_t before = part == 0 ? leader : s - 1;
      float score = part == 0 ? best[leader] - kChange : best[s - 1];
      if (part == 0 && frame == 0) score = 0;
      if (part + 1 == kShortest && best[s] >= score) {
        before = s;
        score = best[s];
      }
      from[frame][s] = std::uint16_t(before);
      next[s] = score + gain[s / kShortest];
    }
    std::swap(best, next);
  }
  Path path(votes.size());
  auto state = std::size_t(std::max_element(best.begin(), best.end()) - best.begin());
  for (std::size_t frame = votes.size(); frame-- > 0;) {
    path[frame] = std::uint8_t(state / kShortest);
    state = from[frame][state];
  }
  return path;
}

// Adds to `open` the frames of closures that have less than `least` of the votes. Returns whether
// there were some.
bool open_doubtful(const HearingModel& model, const Votes& votes, float least, const Path& path,
                   std::vector<std::uint8_t>& open) {
  bool any = false;
  for (std::size_t first = 0, end = 0; first < path.size(); first = end) {
    float share = 0;
    for (end = first; end < path.size() && is_closure(model, path[end]); ++end) {
      for (std::size_t p = 0; p < model.labels.size(); ++p) {
        share += is_closure(model, p) ? votes[end][p] : 0;
      }
    }
    if (end == first) {
      ++end;
    } else if (share < least * float(end - first)) {
      std::fill(open.begin() + std::ptrdiff_t(first), open.begin() + std::ptrdiff_t(end), 1);
      any = true;
    }
  }
  return any;
}

}  // namespace

Path agreed_path(const HearingModel& model, const Votes& votes, float least_closure) {
  if (votes.empty()) return {};
  std::vector<std::uint8_t> open(votes.size());
  Path path = best_path(model, votes, open);
  // What moves into the frames of one may be another.
  constexpr int kMostLooks = 8;
  for (int look = 1; look < kMostLooks && open_doubtful(model, votes, least_closure, path, open);
       ++look) {
    path = best_path(model, votes, open);
  }
  return path;
}

dam::Script script_of_path(const HearingModel& model, const Path& path, std::size_t first,
                           double origin, double end, const Votes* votes,
                           std::vector<double>* confidences) {
  dam::Script script;
  std::vector<double> sums, counts;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const std::string& label = model.labels[path[i]];
    const double start = i == 0 ? 0 : std::max(time_of(first + i) - origin, 0.0);
    if (start >= end) break;
    const bool same = i > 0 && (path[i] == path[i - 1] || label == script.phones.back().label);
    if (!same || script.phones.empty()) {
      if (!script.phones.empty()) script.phones.back().end = start;
      if (!script.phones.empty() && script.phones.back().duration() <= 0) {
        script.phones.pop_back();
        sums.pop_back();
        counts.pop_back();
      }
      script.phones.push_back({script.phones.empty() ? 0 : start, end, label, {}});
      sums.push_back(0);
      counts.push_back(0);
    }
    counts.back() += 1;
    if (votes == nullptr) continue;
    for (std::size_t p = 0; p < model.labels.size(); ++p) {
      if (model.labels[p] == label) sums.back() += double((*votes)[i][p]);
    }
  }
  if (script.phones.empty()) {
    script.phones.push_back({0, end, std::string(dam::kSilence), {}});
    sums.push_back(0);
    counts.push_back(1);
  }
  if (confidences != nullptr) {
    confidences->clear();
    for (std::size_t i = 0; i < sums.size(); ++i)
      confidences->push_back(
          std::clamp(kAgreement * (sums[i] / counts[i]) + kOverconfidence, 0.0, 1.0));
  }
  return script;
}

}  // namespace animeme::voice
