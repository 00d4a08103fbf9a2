#include "dam/training/accumulate.h"

#include <algorithm>
#include <cmath>

#include "dam/corpus/statistics_internal.h"
#include "dam/corpus/training_set_internal.h"
#include "dam/kinds/refined/solve.h"
#include "dam/model/bytes_internal.h"
#include "dam/training/training_sums_internal.h"

namespace animeme::dam {
namespace {

/// FNV-1a, 64 bits, its bits well mixed at the end: distinguishes contents, but is not a protection
/// against people who mean harm.
std::uint64_t digest_of(std::span<const std::uint8_t> bytes) {
  std::uint64_t h = 0xCBF29CE484222325u;
  for (const std::uint8_t b : bytes) h = (h ^ b) * 0x100000001B3u;
  h = (h ^ (h >> 33)) * 0xFF51AFD7ED558CCDu;
  h = (h ^ (h >> 33)) * 0xC4CEB9FE1A85EC53u;
  return h ^ (h >> 33);
}

bool same_controls(const SumsState& state, const std::vector<std::string>& names) {
  return std::equal(state.controls.begin(), state.controls.end(), names.begin(), names.end(),
                    [](const ControlSums& c, const std::string& name) { return c.name == name; });
}

/// Sums of a sentence, each added to those of all as one number.
struct SentenceMoments {
  double sum = 0, squares = 0, rest_sum = 0;
};

void add_moments(const Utterance& u, SumsState& state) {
  const auto places = frame_places(u, state.base.pause_edge);
  const std::size_t k = state.controls.size();
  std::vector<SentenceMoments> moments(k);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] == FramePlace::neither) continue;
    const bool speech = places[i] == FramePlace::speech;
    ++(speech ? state.speech_frames : state.rest_frames);
    for (std::size_t c = 0; c < k; ++c) {
      const double value = u.signal.values[i * k + c];
      (speech ? moments[c].sum : moments[c].rest_sum) += value;
      if (!speech) continue;
      moments[c].squares += value * value;
      ControlSums& sums = state.controls[c];
      sums.low = std::min(sums.low, value);
      sums.high = std::max(sums.high, value);
    }
  }
  for (std::size_t c = 0; c < k; ++c) {
    state.controls[c].sum.add(moments[c].sum);
    state.controls[c].squares.add(moments[c].squares);
    state.controls[c].rest_sum.add(moments[c].rest_sum);
  }
}

void add_phones(const std::vector<Occurrence>& timeline, SumsState& state) {
  for (const Occurrence& o : timeline) {
    PhoneSums& sums = state.phones[std::size_t(index_of(state.base.phones, o.label))];
    ++sums.examples;
    sums.log_duration.add(std::log(o.duration));
    sums.longest = std::max(sums.longest, o.duration);
  }
}

void add_contacts(const Utterance& u, SumsState& state) {
  std::vector<double> gaps, lows;
  add_closures(u, gaps);
  add_lip_tooth_contacts(u, lows);
  for (const double gap : gaps) state.closures.add(gap);
  for (const double low : lows) state.lip_tooth.add(low);
  ShutSums shut;
  shut.add(u);
  state.shut.add(shut);
}

/// Whether sums of squares of a sentence stay far below FixedSum::kMost.
bool small_enough(const Utterance& u) {
  double squares = 0;
  for (const double value : u.signal.values) squares += value * value;
  return squares <= FixedSum::kMost && u.script.duration() <= 1e6;
}

/// The normal equations of one sentence. Controls with rest 0 and deviation 1 keep its units.
SentenceSums sums_of(const Utterance& u, const std::vector<Occurrence>& timeline,
                     const SumsBase& base) {
  TrainingSet set;
  for (const std::string& name : u.signal.names) set.controls.push_back({name, 0, 0, 1});
  set.phones = base.phones;
  set.data.controls = set.controls.size();
  set.data.rate = u.signal.rate.frames_per_second();
  add_sentence(u, timeline, base.pause_edge, set);
  const std::size_t k = set.data.controls;
  RefinedData data;
  data.speech = &set.data;
  data.phones = set.phones;
  data.controls = data.prior_controls = k + 1;
  data.around = neighbourhoods(set.data, set.phones);
  data.time_margin = base.refined.time_margin;
  data.duration_exponent = base.refined.duration_exponent;
  data.offset_frames = base.offset_frames;
  data.terms = kSummedTerms;
  data.threads = 1;
  std::vector<double> sum(k, 0.0);
  double frames = 0;
  for (std::size_t i = 0; i < set.data.use.size(); ++i) {
    const double* row = &set.data.target[i * k];
    data.target.insert(data.target.end(), row, row + k);
    data.target.push_back(1);
    if (set.data.use[i] == 0) continue;
    frames += 1;
    for (std::size_t c = 0; c < k; ++c) sum[c] += row[c];
  }
  SentenceSums fit;
  fit.space = term_space(data);
  const std::vector<float> weight(set.data.use.begin(), set.data.use.end());
  fit.curves = sum_curves(data, fit.space, base.refined.dominance, weight);
  for (const double s : sum) fit.level.push_back(s * (1 - frames / (frames + base.offset_frames)));
  return fit;
}

}  // namespace

std::uint64_t sentence_digest(const Utterance& u) {
  ByteWriter out;
  out.bytes.reserve(9 * u.signal.values.size() + 64 * u.script.phones.size() + 1024);
  out.put(u.id, u.signal.rate.num, u.signal.rate.den, u.signal.names, u.signal.values);
  for (std::size_t i = 0; i < u.signal.frames(); ++i)
    out.put(std::uint8_t(is_measured(u.signal, i) ? 1 : 0));
  for (const Phone& phone : u.script.phones) out.put(phone.start, phone.end, phone.label);
  return digest_of(out.bytes);
}

TrainingSums::TrainingSums(std::unique_ptr<SumsState> state) : state_(std::move(state)) {}
TrainingSums::TrainingSums(TrainingSums&&) noexcept = default;
TrainingSums& TrainingSums::operator=(TrainingSums&&) noexcept = default;
TrainingSums::~TrainingSums() = default;

std::unique_ptr<SumsState> TrainingSums::release() && { return std::move(state_); }

std::size_t TrainingSums::sentences() const { return state_->sentences.size(); }
std::size_t TrainingSums::frames() const {
  return std::size_t(state_->kept.frames + state_->held.frames);
}
fap::Rate TrainingSums::rate() const { return state_->rate; }

std::vector<std::string> TrainingSums::controls() const {
  std::vector<std::string> names;
  for (const ControlSums& control : state_->controls) names.push_back(control.name);
  return names;
}

Result<TrainingSums> TrainingSums::start(const TrainOptions& options, const Model* base) {
  if (auto ok = validate(options); !ok) return ok.error();
  auto state = std::make_unique<SumsState>();
  SumsBase& own = state->base;
  own = start_base();
  own.pause_edge = options.pause_edge;
  own.offset_frames = options.refined.offset_frames;
  own.refined.time_margin = options.refined.time_margin;
  own.refined.duration_exponent = options.refined.duration_exponent;
  state->phones.resize(own.phones.size());
  if (base == nullptr) return TrainingSums(std::move(state));
  const auto* refined = std::get_if<RefinedParameters>(&base->parameters);
  if (refined == nullptr || base->method != Method::dam)
    return refused("the model for the dominance is of the method " +
                   std::string(method_name(base->method)) + "; take one of the method dam");
  if (auto ok = validate(*base); !ok) return ok.error();
  own.pause_edge = base->pause_edge;
  own.refined.time_margin = refined->time_margin;
  own.refined.duration_exponent = refined->duration_exponent;
  for (std::size_t p = 0; p < own.phones.size(); ++p) {
    const std::int32_t at = base->find_phone(own.phones[p].label);
    if (at < 0) continue;
    own.phones[p].duration = base->phones[std::size_t(at)].duration;
    own.refined.dominance[p] = refined->dominance[std::size_t(at)];
  }
  return TrainingSums(std::move(state));
}

Result<bool> add_to_sums(SumsState& state, const Utterance& u, std::uint64_t digest) {
  const bool first = state.controls.empty();
  const std::string sentence = "sentence '" + u.id + "': ";
  if (!first && !same_controls(state, u.signal.names))
    return refused(sentence + "its controls are not those of the sums (" +
                   std::to_string(state.controls.size()) +
                   " controls); choose the same controls or start other sums");
  if (!first && !(u.signal.rate == state.rate))
    return refused(sentence + "its frame rate is not that of the sums; resample it");
  if (auto ok = check_sentence(u, u.signal.names, u.signal.rate); !ok) return ok.error();
  const auto same_id = state.sentences.lower_bound({u.id, 0});
  if (same_id != state.sentences.end() && same_id->first == u.id) {
    if (state.sentences.contains({u.id, digest})) return false;
    return refused(
        sentence +
        "it has changed since it was added; sums cannot be reduced, so start new ones, or "
        "give the sentence another id if it is another one");
  }
  const auto timeline = make_timeline(u.script, state.base.pause_edge);
  FitSums& set = digest % kHeldOut == 0 ? state.held : state.kept;
  SentenceSums fit;
  if (!timeline.empty()) fit = sums_of(u, timeline, state.base);
  if (!small_enough(u) || !fits(fit, set))
    return refused(sentence +
                   "its values are too large for exact sums (1e6 and less are fine); "
                   "choose a larger unit");
  if (first) set_controls(state, u.signal.names, u.signal.rate);
  if (!timeline.empty()) {
    widen(state, fit.space);
    add_sentence_sums(fit, state, set);
  } else {
    widen(state, {});
  }
  add_moments(u, state);
  add_phones(timeline, state);
  add_contacts(u, state);
  state.sentences.insert({u.id, digest});
  return true;
}

Result<bool> TrainingSums::add(const Utterance& sentence, std::vector<Glitch>* glitches) {
  const Utterance* const one[] = {&sentence};
  const CleanedSentences mended = remove_glitches(one);
  const auto added = add_to_sums(*state_, *mended.sentences[0], sentence_digest(sentence));
  if (added && *added && glitches != nullptr)
    glitches->insert(glitches->end(), mended.glitches.begin(), mended.glitches.end());
  return added;
}

}  // namespace animeme::dam
