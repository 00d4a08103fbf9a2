#include "tools/live/serve/head.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "dam/performance/kept_shares.h"
#include "tools/speech/talking/pieces.h"

namespace animeme::serve {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kLinger = 1;  // seconds that a head runs on without viewers

Result<speech::SpeakerOptions> speaker_options(const HeadSettings& settings, int voice_rate,
                                               std::shared_ptr<const dam::Performance> over) {
  speech::SpeakerOptions options;
  const auto keep = dam::parse_kept_shares(settings.keep);
  if (!keep) return keep.error();
  options.face = {settings.motion, settings.idle_motion, settings.idle,
                  settings.mood,   std::move(over),      *keep};
  options.face.synthesis.tongue &= settings.quant > 0;  // else FAP 47 does not fit
  options.fap_quant = settings.quant;
  options.intra_seconds = settings.intra_seconds;
  options.coding_delay = settings.encoder_delay;
  options.voice_rate = voice_rate;
  options.audio.reset();
  if (settings.sound) options.audio = settings.audio;
  options.events = true;
  return options;
}

}  // namespace

Result<std::shared_ptr<Head>> Head::open(const std::string& name, const HeadSettings& settings,
                                         std::shared_ptr<const dam::Model> model,
                                         std::shared_ptr<const dam::Performance> over,
                                         const HeadRoom& room) {
  std::shared_ptr<Head> head(new Head(name, settings, std::move(model), room));
  // Not the head itself: who calls may be the last to know it, in a thread that it waits for.
  const auto wake = [&loop = room.loop, beat = static_cast<const Beat*>(head.get())] {
    loop.wake(beat);
  };
  speech::LineMaker maker = room.voice;
  const int rate = settings.voice_rate > 0 ? settings.voice_rate : maker.sample_rate;
  maker.pieces = std::make_shared<speech::PieceStream>(
      settings.voice, speech::ScriptInput{.language = settings.voice.language}, rate);
  maker.pieces->refuse_files();  // of this machine
  head->lines_ = std::make_shared<HeadLines>(std::move(maker), room.voices, room.clock, wake,
                                             room.most_seconds, room.slow_voice);
  const auto options = speaker_options(settings, rate, std::move(over));
  if (!options) return options.error();
  auto speaker = speech::LiveSpeaker::open(*head->model_, *head->lines_, room.clock, *options);
  if (!speaker) return speaker.error();
  head->speaker_ = std::move(*speaker);
  head->resume_ = std::min(0.0, head->speaker_->next_due().value_or(0));  // priming is before 0
  head->wanted_ = room.clock.now();
  head->sink_ = room.server.make_sink("/heads/" + name, wake, settings.head);
  if (auto ok = head->sink_->start(head->speaker_->info()); !ok) return ok.error();
  return head;
}

Head::~Head() { finish(); }

Result<std::vector<std::string>> Head::say(std::vector<std::string> lines) {
  return lines_->push(std::move(lines));
}

Result<void> Head::say_sound(const std::string& id, media::Pcm sound, bool last) {
  return lines_->push_sound(id, std::move(sound), last);
}

HeadSettings Head::settings() const {
  const std::lock_guard lock(mutex_);
  return settings_;
}

void Head::update(const HeadSettings& settings, speech::LineMaker voice, bool slow_voice) {
  const HeadSettings before = this->settings();
  const tools::Json old = settings_json(before), now = settings_json(settings);
  lines_->speak_with(std::move(voice), slow_voice);
  std::vector<std::string> commands;
  if (old["mood"] != now["mood"]) {
    commands.push_back(tools::Json{{"do", "mood"}, {"mood", now["mood"]}}.dump());
  }
  if (old["look"] != now["look"]) {
    commands.push_back(tools::Json{{"do", "look"}, {"target", now["look"]}}.dump());
  }
  if (!commands.empty()) (void)lines_->push(std::move(commands));
  const std::lock_guard lock(mutex_);
  settings_ = settings;
}

bool Head::silent() const {
  const std::lock_guard lock(mutex_);
  return !speaker_ || (lines_->idle() && speaker_->silent());
}

void Head::hush(const std::string& why) {
  const std::lock_guard lock(mutex_);
  if (!speaker_ || !sink_) return;
  speaker_->end(why);
  (void)tell_events();
}

void Head::finish(bool comes_back) {
  hush("the head has gone");
  if (lines_) lines_->stop();
  const std::lock_guard lock(mutex_);
  if (sink_) (void)(comes_back ? sink_->leave() : sink_->finish());
  speaker_.reset();
}

bool Head::wanted(const media::SendStats& sent) const {
  return sent.receivers > 0 || !lines_->idle() || !speaker_->silent();
}

Result<void> Head::tell_events() {
  bool ended = false;
  for (const speech::LineEvent& event : speaker_->take_events()) {
    journal_.line(name_, event);
    ended |= event.what == speech::LineEvent::What::done;
    if (auto ok = sink_->tell_owner(speech::to_json(event)); !ok) return ok;
    // What is not spoken yet is not for viewers.
    speech::LineEvent told = event;
    if (told.what == speech::LineEvent::What::queued) told.text.clear();
    if (auto ok = sink_->tell(speech::to_json(told)); !ok) return ok;
  }
  if (ended) note_latencies();
  return {};
}

// Of lines that were shown and heard since the last time.
void Head::note_latencies() {
  double last = noted_;
  for (auto trace = speaker_->traces().rbegin(); trace != speaker_->traces().rend(); ++trace) {
    if (trace->begun <= noted_) break;
    if (trace->face_sent <= 0) continue;
    journal_.latency(*trace);
    last = std::max(last, trace->begun);
  }
  noted_ = last;
}

Result<void> Head::send_due(const media::SendStats& sent) {
  const std::optional<double> due = speaker_->next_due();
  if (!due || pacer_.now() < *due) return {};
  expected_.follow(sent, clock_.now(), *speaker_);
  Result<std::vector<media::LiveUnit>> units = speaker_->take(pacer_.now());
  if (!units) return units.error();
  for (const media::LiveUnit& unit : *units) {
    if (auto ok = sink_->send(unit); !ok) return ok;
    speaker_->sent(unit, clock_.now());
    if (auto ok = tell_events(); !ok) return ok;
    if (unit.track == media::LiveTrack::face) {
      late_.add(pacer_.now() - media::due_of(*speaker_, unit));
    }
  }
  return {};
}

double Head::step() {
  const std::lock_guard lock(mutex_);
  if (!speaker_) return kNever;
  const double now = clock_.now();
  const media::SendStats sent = sink_->stats();
  if (wanted(sent)) {
    wanted_ = now;
    if (std::exchange(asleep_, false)) pacer_.restart(-resume_);
  }
  if (asleep_) return kNever;
  if (auto ok = send_due(sent); !ok) {
    failure_ = ok.error().describe();
    asleep_ = true;  // for good, until it is forgotten
    (void)sink_->finish();
    speaker_.reset();
    return kNever;
  }
  const std::optional<double> due = speaker_->next_due();
  if (!due) return kNever;
  if (clock_.now() - wanted_ > kLinger) {
    asleep_ = true;
    resume_ = *due;
    return kNever;
  }
  return clock_.now() + *due - pacer_.now();
}

HeadFigures Head::figures() const {
  HeadFigures figures;
  const std::lock_guard lock(mutex_);
  const media::SendStats stats = sink_->stats();
  figures.planes = stats.face_units;
  figures.packets = stats.audio_units;
  figures.viewers = stats.receivers;
  figures.dropped = stats.dropped;
  figures.late_50 = late_.percentile(0.5);
  figures.late_99 = late_.percentile(0.99);
  figures.lines = lines_->waiting();
  figures.spoken = lines_->given();
  figures.asleep = asleep_;
  figures.idle = asleep_ ? clock_.now() - wanted_ : 0;
  figures.warning = failure_.empty() ? lines_->last_warning() : failure_;
  return figures;
}

void Head::add_lateness(media::LatenessMeter& meter) const {
  const std::lock_guard lock(mutex_);
  meter.add(late_);
}

}  // namespace animeme::serve
