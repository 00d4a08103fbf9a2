#include "dam/behaviour/behaviour.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "dam/behaviour/blinks_internal.h"
#include "dam/behaviour/brows_internal.h"
#include "dam/behaviour/curves_internal.h"
#include "dam/behaviour/gaze_internal.h"
#include "dam/behaviour/head_motion_internal.h"

namespace animeme::dam {
namespace {

constexpr double kFadeIn = 0.6, kFadeOut = 0.9;  // seconds, of head and brows
constexpr double kOneUtterance = 0.8;            // seconds of pause inside speech
constexpr double kSamePhrase = 0.2, kPauseToRest = 0.35;
constexpr double kBeforeSpeech = 0.15;
// Seconds for which a face listens after the other one has ended, and of speech that is worth a
// nod.
constexpr double kListensOn = 1.0, kWorthANod = 0.8;
// Lids meet at 1024 IRISD units together; a blink shares them as ARKit's eyeBlink does.
constexpr double kUpperLid = 995, kLowerLid = 29;
// Lids follow the eye, units a radian: as far as ARKit's eyeLook shapes take them along
// (fap/semantics.md, section 10), so that faces with these shapes need no others.
constexpr double kUpperDown = 1092, kUpperUp = 765, kLowerDown = 322, kLowerUp = 381;
constexpr double kMostUpper = 560, kLeastUpper = -330;
// IRISD and ENS units (0.1 mm) of what follows gaze and breath: finer motion is not seen, and codes
// in every frame.
constexpr double kLidStep = 8, kNostrilStep = 3;
constexpr double kNostril = 14;                        // ENS units when breathing in
constexpr double kLidOfBrow = 0.2, kLidOfCheek = 1.2;  // IRISD units for one of ENS

// Share of a blink of open eyes that closes these lids.
double closing(const FaceMoment& m, std::size_t side) {
  return m.blink * (1 - (m.upper_lid[side] + m.lower_lid[side]) / (kUpperLid + kLowerLid));
}

void raise_brows(const behaviour::BrowPose& brow, double amount, FaceMoment& m) {
  for (std::size_t side = 0; side < 2; ++side) {
    m.inner_brow[side] = amount * brow.inner[side];
    m.middle_brow[side] = amount * brow.middle[side];
    m.outer_brow[side] = amount * brow.outer[side];
  }
}

double in_steps(double value, double step) { return step * std::round(value / step); }

struct NamedPart {
  std::string_view name;
  bool StillParts::*still;
};
constexpr NamedPart kParts[] = {{"gaze", &StillParts::gaze},
                                {"head", &StillParts::head},
                                {"brows", &StillParts::brows},
                                {"blinks", &StillParts::blinks}};

/// Of time.
struct SpokenSpan {
  double start = 0, end = 0;
};

}  // namespace

Result<StillParts> parse_still(std::string_view text) {
  StillParts still;
  while (!text.empty()) {
    const std::size_t comma = std::min(text.find(','), text.size());
    const std::string_view word = text.substr(0, comma);
    const auto part = std::find_if(std::begin(kParts), std::end(kParts),
                                   [&](const NamedPart& one) { return one.name == word; });
    if (part == std::end(kParts))
      return make_error(Code::not_found, "\"" + std::string(word.substr(0, 40)) +
                                             "\" is no part that moves by itself; there are gaze, "
                                             "head, brows and blinks");
    still.*(part->still) = true;
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  return still;
}

std::string format_still(const StillParts& still) {
  std::string text;
  for (const NamedPart& part : kParts)
    if (still.*(part.still)) text += (text.empty() ? "" : ",") + std::string(part.name);
  return text;
}

std::vector<int> behaviour_faps(const BehaviourOptions& options) {
  std::vector<int> faps;
  const StillParts& still = options.still;
  const auto add = [&](bool moves, int first, int last) {
    for (int fap = first; moves && fap <= last; ++fap) faps.push_back(fap);
  };
  if (options.liveliness <= 0) {
    add(!still.brows, 31, 36);
    return faps;
  }
  add(!still.gaze || !still.blinks, 19, 22);
  add(!still.gaze, 23, 26);
  add(!still.brows, 31, 38);
  add(!still.brows, 41, 42);
  add(!still.head, 48, 50);
  add(!still.brows, 61, 62);
  return faps;
}

double behaviour_value(const FaceMoment& m, int fap) {
  constexpr double kAngle = 1e5;                  // units a radian
  const std::size_t side = fap % 2 == 0 ? 1 : 0;  // of 19..26 and 31..38, the left ones are odd
  switch (fap) {
    case 19:
    case 20:
      return m.upper_lid[side] + kUpperLid * closing(m, side);
    case 21:
    case 22:
      return m.lower_lid[side] + kLowerLid * closing(m, side);
    case 23:
    case 24:
      return kAngle * m.eye_yaw[side];
    case 25:
    case 26:
      return kAngle * m.eye_pitch[side];
    case 31:
    case 32:
      return m.inner_brow[side];
    case 33:
    case 34:
      return m.middle_brow[side];
    case 35:
    case 36:
      return m.outer_brow[side];
    case 37:
    case 38:
      return m.squeeze[side];
    case 41:
    case 42:
      return m.cheek;
    case 48:
      return kAngle * m.head_pitch;
    case 49:
      return kAngle * m.head_yaw;
    case 50:
      return kAngle * m.head_roll;
    case 61:
    case 62:
      return m.nostril;
    default:
      return 0;
  }
}

struct Behaviour::Impl {
  explicit Impl(const BehaviourOptions& from)
      : options(from),
        frame(from.rate.seconds(1)),
        gaze(from.seed, from.liveliness, from.end, from.look),
        blinks(from.seed, from.liveliness, from.end, frame),
        head(from.seed),
        brows(from.seed, from.liveliness <= 0) {
    head.start_turned(gaze.head_goal());
  }

  double now() const { return options.rate.seconds(double(count)); }

  behaviour::Mode mode(double time) {
    while (!speech.empty() && speech.front().end < time) speech.pop_front();
    if (!speech.empty() && speech.front().start - kBeforeSpeech <= time) {
      if (activity == Activity::thinking) activity = Activity::idle;
      return behaviour::Mode::speaking;
    }
    if (other_speaks || (activity == Activity::idle && time < other_end + kListensOn))
      return behaviour::Mode::listening;
    switch (activity) {
      case Activity::listening:
        return behaviour::Mode::listening;
      case Activity::thinking:
        return behaviour::Mode::thinking;
      case Activity::idle:
        break;
    }
    return behaviour::Mode::idle;
  }

  void speak(const SpeechPlan& plan, double start);
  void hear(bool voice);
  void expect(const std::vector<SpeechPhrase>& phrases, double start, bool goes_on);
  double fade(double time) const {
    const double left = options.end - frame - time;
    return behaviour::smooth_step(time / kFadeIn) * behaviour::smooth_step(left / kFadeOut);
  }
  FaceMoment next();
  void move_eyes(double time, FaceMoment& moment);

  BehaviourOptions options;
  double frame;
  std::int64_t count = 0;  // number of the next moment
  Activity activity = Activity::idle;
  bool other_speaks = false;  // as it was heard last
  double other_end = -10;     // when it was heard to end
  double other_since = 0;     // when it began
  double other_said = 0;      // seconds of it since the last nod
  std::deque<SpokenSpan> speech;
  behaviour::Gaze gaze;
  behaviour::Blinks blinks;
  behaviour::HeadMotion head;
  behaviour::Brows brows;
};

// Looks and blinks about the phrases.
void Behaviour::Impl::expect(const std::vector<SpeechPhrase>& phrases, double start, bool goes_on) {
  double begin = 0;
  bool begins = false;
  for (std::size_t i = 0; i < phrases.size(); ++i) {
    const SpeechPhrase& phrase = phrases[i];
    if (i == 0 || phrase.begins) {
      begin = start + phrase.start;
      begins = phrase.begins && !(i == 0 && goes_on);
    }
    const double end = start + phrase.end;
    blinks.expect_border(end, now());
    if (phrase.ends) {
      gaze.expect_utterance(begin, end, now(), begins);
      begins = false;
      begin = end;
    } else if (i + 1 < phrases.size()) {
      const double next = start + phrases[i + 1].start;
      if (next - end >= kPauseToRest) gaze.expect_pause(end, next, now());
    }
  }
}

void Behaviour::Impl::speak(const SpeechPlan& plan, double start) {
  if (plan.phrases.empty()) return;
  const double first = start + plan.phrases.front().start;
  const bool goes_on = !speech.empty() && first - speech.back().end < kSamePhrase;
  if (goes_on) {
    head.go_on(now());
    brows.go_on(now());
  }
  for (const SpeechPhrase& phrase : plan.phrases) {
    const SpokenSpan span{start + phrase.start, start + phrase.end};
    if (span.end < now()) continue;
    if (!speech.empty() && span.start - speech.back().end < kOneUtterance)
      speech.back().end = std::max(speech.back().end, span.end);
    else
      speech.push_back(span);
  }
  expect(plan.phrases, start, goes_on);
  head.speak(plan, start, now());
  brows.speak(plan, start, now());
}

void Behaviour::Impl::hear(bool voice) {
  const double time = now();
  head.nod_at_pauses_only();
  if (voice == other_speaks) return;
  other_speaks = voice;
  if (voice) {
    other_since = time;
    return;
  }
  other_end = time;
  other_said += time - other_since;
  blinks.expect_border(time, time);
  if (other_said >= kWorthANod && head.pause_of_other(time)) other_said = 0;
}

void Behaviour::Impl::move_eyes(double time, FaceMoment& m) {
  const behaviour::EyeAngles eyes =
      behaviour::eyes_in_head(gaze.at(time), m.head_pitch, m.head_yaw, m.head_roll);
  m.eye_yaw = eyes.yaw;
  m.eye_pitch = eyes.pitch;
  for (std::size_t side = 0; side < 2; ++side) {
    const double down = eyes.pitch[side];
    const double upper = down * (down > 0 ? kUpperDown : kUpperUp);
    m.upper_lid[side] = in_steps(std::clamp(upper, kLeastUpper, kMostUpper), kLidStep);
    m.lower_lid[side] = in_steps(-down * (down > 0 ? kLowerDown : kLowerUp), kLidStep);
  }
}

FaceMoment Behaviour::Impl::next() {
  const double time = now();
  ++count;
  FaceMoment m;
  if (options.liveliness <= 0) {
    if (!options.still.brows) raise_brows(brows.at(time, mode(time)), fade(time), m);
    return m;
  }
  const behaviour::Mode doing = mode(time);
  const auto shift = gaze.advance(time, time + frame, doing);
  if (shift) {
    head.follow_eyes(gaze.head_goal(), shift->time);
    blinks.shift(shift->time, shift->size);
  }
  blinks.advance(time, time + frame, doing);
  const double seconds = count > 1 ? frame : 0;
  const behaviour::HeadPose pose = head.at(time, seconds, doing);
  const behaviour::BrowPose brow = brows.at(time, doing);
  const double shown = fade(time), amount = options.liveliness * shown;
  if (!options.still.head) {
    const behaviour::Aim turned = head.turned();
    m.head_pitch = behaviour::kRadians * (amount * pose.pitch + turned.pitch);
    m.head_yaw = behaviour::kRadians * (amount * pose.yaw + turned.yaw);
    m.head_roll = behaviour::kRadians * amount * pose.roll;
  }
  if (!options.still.gaze) move_eyes(time, m);
  if (!options.still.brows) {
    raise_brows(brow, amount, m);
    for (std::size_t side = 0; side < 2; ++side) m.squeeze[side] = amount * brow.squeeze[side];
    // Lids move together, so that decoders may mirror them.
    const double raised = 0.5 * (m.middle_brow[0] + m.middle_brow[1]);
    for (double& lid : m.upper_lid) lid -= kLidOfBrow * std::max(0.0, raised);
    m.cheek = amount * brow.cheek;
    m.nostril = in_steps(kNostril * amount * head.breath(), kNostrilStep);
    for (double& lid : m.lower_lid) lid += kLidOfCheek * m.cheek;
  }
  if (!options.still.blinks) m.blink = blinks.at(time);
  return m;
}

Result<Behaviour> Behaviour::make(const BehaviourOptions& options) {
  if (!(options.liveliness >= 0 && options.liveliness <= kMostLiveliness))
    return make_error(Code::invalid_argument, "the liveliness must be between 0 and 2");
  const double hertz = options.rate.frames_per_second();
  if (!(hertz > 0 && std::isfinite(hertz)))
    return make_error(Code::invalid_argument, "idle motion needs a frame rate above 0");
  return Behaviour(std::make_unique<Impl>(options));
}

Behaviour::Behaviour(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Behaviour::Behaviour(const Behaviour& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
Behaviour& Behaviour::operator=(const Behaviour& other) {
  if (this != &other) impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}
Behaviour::Behaviour(Behaviour&&) noexcept = default;
Behaviour& Behaviour::operator=(Behaviour&&) noexcept = default;
Behaviour::~Behaviour() = default;

void Behaviour::speak(const SpeechPlan& plan, double delay) {
  impl_->speak(plan, impl_->now() + delay);
}

void Behaviour::hush() {
  const double now = impl_->now();
  while (!impl_->speech.empty() && impl_->speech.back().start > now) impl_->speech.pop_back();
  if (!impl_->speech.empty()) impl_->speech.back().end = std::min(impl_->speech.back().end, now);
  impl_->gaze.hush(now);
  impl_->blinks.hush(now);
  impl_->head.hush(now);
  impl_->brows.hush(now);
}

void Behaviour::hear(bool voice) { impl_->hear(voice); }

void Behaviour::set_activity(Activity activity) { impl_->activity = activity; }

void Behaviour::look(const Look& target) {
  impl_->options.look = target;
  impl_->gaze.look(target, impl_->now());
  impl_->head.follow_eyes(impl_->gaze.head_goal(), impl_->now());
  impl_->blinks.shift(impl_->now(), impl_->gaze.size());
}

FaceMoment Behaviour::next() { return impl_->next(); }
double Behaviour::time() const { return impl_->now(); }

BehaviourCounts Behaviour::counts() const {
  const StillParts& still = impl_->options.still;
  return {still.blinks ? 0 : impl_->blinks.count(), still.head ? 0 : impl_->head.nods(),
          still.brows ? 0 : impl_->brows.raises()};
}

}  // namespace animeme::dam
