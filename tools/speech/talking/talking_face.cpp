#include "tools/speech/talking/talking_face.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "dam/maths/raised_cosine.h"
#include "dam/signal/fap_signal.h"
#include "fap/tables.h"

namespace animeme::speech {

namespace {

constexpr double kFade = 0.25;  // seconds
// A mouth that is cut off: seconds, at most where there is far to go; share of the speed of speech.
constexpr double kClosing = 0.1, kLongestClosing = 0.16, kOfSpeed = 0.75;
constexpr double kLongPhrase = 8;                   // seconds, of speech that is only heard
constexpr double kIdleSeconds = 20;                 // of one piece
constexpr double kMoodSpeech = 5, kMoodSound = 25;  // shares of a mood's mouth, at most, a second
constexpr double kMoodJaw = 6;                      // likewise
constexpr double kHistory = 1;  // seconds of a line that may still bear on what follows

dam::Script silence() {
  dam::Script script;
  script.phones.push_back({0, kIdleSeconds, std::string(dam::kSilence), {}});
  return script;
}

/// A signal whose row `at` follows or replaces `shown`: the difference fades.
void lead_over(const std::vector<double>& shown, dam::Signal& signal, std::size_t at) {
  if (shown.size() < signal.names.size() || at >= signal.frames()) return;
  for (std::size_t c = 0; c < signal.names.size(); ++c) {
    const double offset = shown[c] - signal.at(at, c);
    for (std::size_t i = at; i < signal.frames(); ++i) {
      const double share = dam::raised_bell(signal.rate.seconds(double(i - at + 1)) / kFade);
      if (share <= 0) break;
      signal.at(i, c) += share * offset;
    }
  }
}

/// The same for a mouth that is cut off, evenly, so that no frame moves more than it has to.
/// `speeds`: at which channels move in speech, a second. Gives the seconds that it takes.
double close_mouth(const std::vector<double>& shown, const std::vector<double>& speeds,
                   dam::Signal& signal) {
  double longest = kClosing;
  if (shown.size() < speeds.size()) return longest;
  for (std::size_t c = 0; c < speeds.size(); ++c) {
    const double offset = shown[c] - signal.at(0, c);
    const double wanted = speeds[c] > 0 ? std::abs(offset) / (kOfSpeed * speeds[c]) : kClosing;
    const double seconds = std::clamp(wanted, kClosing, kLongestClosing);
    longest = std::max(longest, seconds);
    for (std::size_t i = 0; i < signal.frames(); ++i) {
      const double share = 1 - signal.rate.seconds(double(i + 1)) / seconds;
      if (share <= 0) break;
      signal.at(i, c) += share * offset;
    }
  }
  return longest;
}

// Each sound of the model between open mouths.
dam::Script example(const dam::Model& model) {
  constexpr double kSeconds = 0.1;
  dam::Script script;
  for (const dam::PhoneModel& phone : model.phones) {
    for (const std::string& label : {std::string("AA"), phone.label}) {
      const double start = script.duration();
      script.phones.push_back({start, start + kSeconds, label, {}});
    }
  }
  return script;
}

std::vector<double> row(const dam::Signal& signal, std::size_t frame) {
  if (frame >= signal.frames()) return {};
  const std::size_t controls = signal.names.size();
  const auto begin = signal.values.begin() + std::ptrdiff_t(frame * controls);
  return {begin, begin + std::ptrdiff_t(controls)};
}

constexpr double kNoGap = 0.001;  // seconds: samples and phones do not end at the same instants

// What is left of a script from `cut` seconds on, and behind it another one that begins at `start`.
dam::Script joint(const dam::Script& before, double cut, const dam::Script& after, double start,
                  bool goes_on = false) {
  dam::Script script;
  for (dam::Phone phone : before.phones) {
    phone.start = std::max(phone.start, cut) - cut;
    phone.end = std::min(phone.end, start) - cut;
    if (phone.end > phone.start) script.phones.push_back(std::move(phone));
  }
  start -= cut;
  if (!script.phones.empty() && start > script.duration() && start - script.duration() < kNoGap) {
    script.phones.back().end = start;
  }
  if (start > script.duration()) {
    script.phones.push_back({script.duration(), start, std::string(dam::kSilence), {}});
  }
  for (dam::Phone phone : after.phones) {
    phone.start += start;
    phone.end += start;
    // Two silences in a row are one, and so are the parts of a phone.
    const bool same = !script.phones.empty() && script.phones.back().label == phone.label;
    if (same && (goes_on || phone.label == dam::kSilence)) {
      script.phones.back().end = phone.end;
    } else {
      script.phones.push_back(std::move(phone));
    }
    goes_on = false;
  }
  return script;
}

double nearer(double shown, double wanted, double most) {
  return shown + std::clamp(wanted - shown, -most, most);
}

double end_of_words(const dam::Script& script) {
  double end = 0;
  for (const dam::Phone& phone : script.phones)
    if (phone.label != dam::kSilence) end = phone.end;
  return end;
}

// The prosody of a line that begins later.
dam::Prosody later(const dam::Prosody& prosody, double seconds) {
  dam::Prosody all;
  all.step = prosody.step;
  const auto before = std::size_t(std::max(0.0, seconds / prosody.step));
  all.pitch.assign(before, 0.0f);
  all.level.assign(before, 0.0f);
  all.pitch.insert(all.pitch.end(), prosody.pitch.begin(), prosody.pitch.end());
  all.level.insert(all.level.end(), prosody.level.begin(), prosody.level.end());
  return all;
}

// The plan of `both` from `start` on: what comes before has been planned.
dam::SpeechPlan plan_from(const dam::Script& both, double start, const dam::Prosody* prosody) {
  std::optional<dam::Prosody> moved;
  if (prosody != nullptr) moved = later(*prosody, start);
  dam::SpeechPlan plan = dam::plan_speech(both, moved ? &*moved : nullptr);
  constexpr double kTolerance = 1e-6;
  std::erase_if(plan.accents, [&](const auto& one) { return one.start < start - kTolerance; });
  std::erase_if(plan.phrases, [&](const auto& one) { return one.end <= start + kTolerance; });
  if (!plan.phrases.empty() && plan.phrases.front().start < start) {
    plan.phrases.front().start = start;
    plan.phrases.front().begins = false;
  }
  return plan;
}

// A value that the codec can carry, as dam::to_sequence() makes them.
int coded_value(double value, int fap) {
  const fap::FapInfo& info = fap::info(fap);
  const double most = double(info.default_i_range) * info.quant_step;
  return int(std::lround(std::clamp(value, -most, most)));
}

// A face whose shapes move lids and brows a little anyway: they close from where they are.
double combined(double own, double moved, int fap, double blink) {
  const bool upper = fap == 19 || fap == 20, lower = fap == 21 || fap == 22;
  return upper || lower ? moved + own * (1 - blink) : own + moved;
}

bool mouth_differs(const fap::Frame& a, const fap::Frame& b, const fap::Mask& mouth) {
  for (std::size_t fap = fap::kFirstLowLevel; fap < mouth.size(); ++fap) {
    if (mouth[fap] && a.value[fap] != b.value[fap]) return true;
  }
  return false;
}

}  // namespace

Result<TalkingFace> TalkingFace::open(const dam::Model& model, const FaceOptions& options) {
  TalkingFace face(model, options);
  const Result<dam::Signal> moving = face.synthesise(example(model));
  if (!moving) return moving.error();
  face.speeds_.assign(moving->names.size(), 0);
  for (std::size_t i = 1; i < moving->frames(); ++i) {
    for (std::size_t c = 0; c < face.speeds_.size(); ++c) {
      const double speed =
          std::abs(moving->at(i, c) - moving->at(i - 1, c)) * moving->rate.frames_per_second();
      face.speeds_[c] = std::max(face.speeds_[c], speed);
    }
  }
  if (auto ok = face.begin(silence(), false); !ok) return ok.error();
  face.mask_ = face.clip_.frames.front().mask;
  const dam::BehaviourOptions wanted{options.synthesis.rate, options.idle.seed,
                                     options.idle_motion ? options.idle.liveliness : 0,
                                     options.idle.still, options.idle.look};
  Result<dam::Behaviour> behaviour = dam::Behaviour::make(wanted);
  if (!behaviour) return behaviour.error();
  face.behaviour_ = std::move(*behaviour);
  face.find_moving(face.mask_, wanted);
  face.questions_only_ = wanted.liveliness <= 0;
  for (const int fap : face.moving_)
    if (!face.questions_only_) face.mask_.set(std::size_t(fap));
  if (options.over) {
    face.over_.emplace(options.over, options.keep, options.synthesis.rate);
    face.mask_ |= face.over_->faps();
  }
  face.mood_ = options.mood;
  face.moods_ = dam::MoodBlend(options.mood);
  return face;
}

// Cheeks and nostrils, which move by half a millimetre, would cost half a kbit/s in streams with an
// intra plane each second; moods move them. What a character has learned stays; shapes of ARKit,
// which move lids and brows besides the mouth, are added to.
void TalkingFace::find_moving(const fap::Mask& known, const dam::BehaviourOptions& wanted) {
  const bool faps =
      std::any_of(model_->controls.begin(), model_->controls.end(),
                  [](const auto& control) { return dam::fap_of_channel(control.name) != 0; });
  for (const int fap : dam::behaviour_faps(wanted)) {
    if (fap == 41 || fap == 42 || fap == 61 || fap == 62) continue;
    const bool turns = (fap >= 23 && fap <= 26) || (fap >= 48 && fap <= 50);
    if (known[std::size_t(fap)] && (faps || turns)) continue;
    moving_.push_back(fap);
  }
}

void TalkingFace::behave(fap::Frame& frame) {
  if (!behaviour_) return;
  const dam::FaceMoment moment = behaviour_->next();
  for (const int fap : moving_) {
    const auto n = std::size_t(fap);
    double value = dam::behaviour_value(moment, fap);
    // Brows become part of the frames with the first question.
    if (questions_only_ && !mask_[n]) {
      if (value == 0) continue;
      mask_.set(n);
    }
    if (frame.mask[n]) value = combined(frame.value[n], value, fap, moment.blink);
    frame.mask.set(n);
    frame.value[n] = coded_value(value, fap);
  }
}

void TalkingFace::set_activity(dam::Activity activity) {
  if (behaviour_) behaviour_->set_activity(activity);
}

void TalkingFace::hear(bool voice) {
  if (behaviour_) behaviour_->hear(voice);
}

void TalkingFace::look(const dam::Look& target) {
  if (behaviour_) behaviour_->look(target);
}

Result<dam::Signal> TalkingFace::synthesise(const dam::Script& script) const {
  dam::SynthesisOptions synthesis = options_.synthesis;
  synthesis.frames = 0;
  synthesis.tail = 0;
  return dam::synthesise(*model_, script, synthesis);
}

// The next frame will be row `at`.
Result<void> TalkingFace::show(dam::Signal signal, std::size_t at) {
  Result<fap::Sequence> clip = dam::to_sequence(signal);
  if (!clip) return clip.error();
  if (clip->frames.size() <= at) {
    return make_error(Code::invalid_argument, "the script has no duration");
  }
  signal_ = std::move(signal);
  clip_ = std::move(*clip);
  at_ = at;
  return {};
}

Result<void> TalkingFace::begin(const dam::Script& script, bool closing) {
  Result<dam::Signal> signal = synthesise(script);
  if (!signal) return signal.error();
  if (closing) {
    const double frames = close_mouth(shown_, speeds_, *signal) * signal->rate.frames_per_second();
    closed_ = number_ + std::int64_t(std::ceil(frames - 1e-9));
  } else {
    lead_over(shown_, *signal, 0);
  }
  if (auto ok = show(std::move(*signal), 0); !ok) return ok;
  script_ = script;
  mouth_ = dam::MoodMouth(script_);
  return {};
}

// Of the clip from its row `first` on.
Line TalkingFace::line_from(std::size_t first, const fap::Frame& before) const {
  fap::Mask mouth;
  for (const dam::Control& control : model_->controls) {
    const int fap = dam::fap_of_channel(control.name);
    if (fap > 0) mouth.set(std::size_t(fap));
  }
  const std::int64_t number = number_ + std::int64_t(first - at_);
  Line line{number, std::int64_t(clip_.frames.size() - first), number};
  for (std::size_t i = first; i < clip_.frames.size(); ++i) {
    if (!mouth_differs(clip_.frames[i], before, mouth)) continue;
    line.first_moved += std::int64_t(i - first);
    break;
  }
  return line;
}

// Moods of a line that begins `start` seconds after the next frame.
void TalkingFace::plan_moods(const dam::Script& script, double start, const LineMoods& moods) {
  const double begin = now() + start;
  const dam::MoodTrack track(moods.mood.value_or(mood_), moods.spans);
  for (const dam::MoodTrack::Part& part : track.parts()) {
    const double at = begin + std::max(part.start, 0.0) - dam::kMoodLead;
    moods_.change(std::max(at, now()), part.mood);
  }
  moods_.change(begin + std::max(end_of_words(script), 0.0), mood_);
}

void TalkingFace::set_mood(const dam::Mood& mood) {
  mood_ = mood;
  moods_.change(now(), mood);
}

// What the sounds leave to the mouth of a mood changes no faster than lips do, also where one piece
// follows another.
void TalkingFace::follow_sounds(const dam::MoodMouth::Shares& wanted) {
  const double seconds = signal_.rate.seconds(1);
  shares_.speech = nearer(shares_.speech, wanted.speech, kMoodSpeech * seconds);
  shares_.round = nearer(shares_.round, wanted.round, kMoodSound * seconds);
  shares_.teeth = nearer(shares_.teeth, wanted.teeth, kMoodSound * seconds);
  shares_.bite = nearer(shares_.bite, wanted.bite, kMoodSound * seconds);
  shares_.shut = nearer(shares_.shut, wanted.shut, kMoodSound * seconds);
  shares_.jaw = nearer(shares_.jaw, wanted.jaw, kMoodJaw * seconds);
}

void TalkingFace::show_mood(fap::Frame& frame) {
  moods_.forget(now());
  const dam::MoodPose pose = moods_.neutral() ? dam::MoodPose() : moods_.at(now());
  // All that it moves at once: each change of the mask costs an intra plane.
  mask_ |= pose.faps();
  frame.mask = mask_;
  if (!pose.neutral()) dam::add_mood(pose, shares_, frame);
}

Result<Line> TalkingFace::say(const dam::Script& script, const LineMoods& moods,
                              const dam::Prosody* prosody) {
  const fap::Frame before = at_ == 0 ? clip_.frames.front() : clip_.frames[at_ - 1];
  const bool interrupts = speaking();
  if (auto ok = begin(script, false); !ok) return ok.error();
  plan_moods(script, 0, moods);
  if (behaviour_) {
    if (interrupts) behaviour_->hush();
    behaviour_->speak(dam::plan_speech(script, prosody));
  }
  speaking_ = true;
  return line_from(0, before);
}

Result<void> TalkingFace::cut() {
  if (!speaking()) return {};
  if (auto ok = begin(silence(), true); !ok) return ok;
  moods_.change(now(), mood_);
  if (behaviour_) behaviour_->hush();
  speaking_ = false;
  return {};
}

dam::Script TalkingFace::rest(double ahead) const {
  if (!speaking()) return {};
  const double from = signal_.rate.seconds(double(at_)) + ahead;
  dam::Script rest;
  for (dam::Phone phone : script_.phones) {
    phone.start = std::max(phone.start - from, 0.0);
    phone.end -= from;
    if (phone.end > phone.start) rest.phones.push_back(std::move(phone));
  }
  return rest;
}

Result<Line> TalkingFace::join(const dam::Script& script, double start, const LineMoods& moods,
                               const dam::Prosody* prosody, bool goes_on) {
  if (!(start >= 0)) return make_error(Code::invalid_argument, "a line begins in the past");
  if (!speaking()) {
    LineMoods shifted = moods;
    for (dam::MoodSpan& span : shifted.spans) span.start += start, span.end += start;
    const dam::Prosody moved = prosody != nullptr ? later(*prosody, start) : dam::Prosody{};
    return say(joint({}, 0, script, start), shifted, prosody != nullptr ? &moved : nullptr);
  }
  const fap::Rate rate = signal_.rate;
  const auto kept = std::size_t(std::ceil(kHistory * rate.frames_per_second()));
  const std::size_t cut = at_ > kept ? at_ - kept : 0;
  const double begin = rate.seconds(double(at_)) + start;  // in the piece that is shown
  const dam::Script both = joint(script_, rate.seconds(double(cut)), script, begin, goes_on);
  Result<dam::Signal> signal = synthesise(both);
  if (!signal) return signal.error();
  const std::size_t at = at_ - cut;
  // From the frame that was to come: its motion goes on.
  lead_over(row(signal_, at_), *signal, at);
  const fap::Frame before = at_ == 0 ? clip_.frames.front() : clip_.frames[at_ - 1];
  if (auto ok = show(std::move(*signal), at); !ok) return ok.error();
  if (behaviour_) {
    const double first_sound = begin - rate.seconds(double(cut));
    behaviour_->speak(plan_from(both, first_sound, prosody), -rate.seconds(double(at)));
  }
  script_ = both;
  mouth_ = dam::MoodMouth(script_);
  plan_moods(script, start, moods);
  const auto first = std::size_t(start * rate.frames_per_second());
  return line_from(std::min(at + first, clip_.frames.size() - 1), before);
}

// Speech whose phrases nobody has told of: it lasts until it ends.
void TalkingFace::behave_as_speaking(bool speaks) {
  if (!behaviour_ || (speaks == accompanies_ && (!speaks || now() < phrase_end_))) return;
  accompanies_ = speaks;
  if (!speaks) return behaviour_->hush();
  dam::SpeechPlan plan;
  plan.phrases.push_back({.start = 0, .end = kLongPhrase, .begins = true});
  behaviour_->speak(plan);
  phrase_end_ = now() + kLongPhrase;
}

fap::Frame TalkingFace::accompany(const fap::Frame& mouth, const dam::MoodMouth::Shares& sounds) {
  fap::Frame frame = mouth;
  behave_as_speaking(sounds.speech > 0);
  behave(frame);
  follow_sounds(sounds);
  if (over_) over_->next(shares_, frame);
  show_mood(frame);
  frame.number = number_++;
  return frame;
}

Result<fap::Frame> TalkingFace::next() {
  if (at_ >= clip_.frames.size()) {
    if (auto ok = begin(silence(), false); !ok) return ok.error();
    speaking_ = false;
  }
  shown_ = row(signal_, at_);
  fap::Frame frame = clip_.frames[at_];
  behave(frame);
  follow_sounds(mouth_.at(signal_.time(at_++)));
  if (over_) over_->next(shares_, frame);
  show_mood(frame);
  frame.number = number_++;
  return frame;
}

}  // namespace animeme::speech
