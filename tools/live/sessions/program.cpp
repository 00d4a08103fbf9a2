#include "tools/live/sessions/program.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "dam/signal/fap_signal.h"
#include "dam/speaking/idle_motion.h"
#include "dam/speaking/moods.h"
#include "tools/speech/talking/pieces.h"
#include "tools/speech/voice/pitch.h"

namespace animeme::live {

namespace {

constexpr double kAhead = 0.02;    // seconds that sound is sent before its time
constexpr double kLiveLead = 0.1;  // silence before a live line, time to open the mouth
constexpr double kLiveTail = 0.3;  // after it, to close it

dam::SynthesisOptions synthesis_of(const ProgramOptions& options, fap::Rate rate) {
  dam::SynthesisOptions settings = options.motion;
  settings.rate = rate;
  settings.tongue = settings.tongue && options.coding.quant > 0;  // else FAP 47 does not fit
  return settings;
}

voice::VoiceOptions voice_of(const speech::SpokenOptions& spoken) {
  voice::VoiceOptions voice;
  voice.language = spoken.language;
  voice.words_per_minute = spoken.words_per_minute;
  voice.pitch = spoken.pitch;
  voice.lead_silence = kLiveLead;
  voice.tail_silence = kLiveTail;
  return voice;
}

Result<speech::LineMaker> maker_of(const ProgramOptions& options) {
  const speech::SpokenOptions& spoken = options.spoken;
  if (!options.say_json.empty()) {
    return speech::piece_lines(voice_of(spoken), {spoken.script_reading, spoken.language});
  }
  if (!spoken.tts.empty()) return speech::command_lines(speech::voice_command(spoken));
  return speech::voice_lines(voice_of(spoken), spoken.script_reading.speak_marks);
}

}  // namespace

Result<Clip> spoken_clip(const ProgramOptions& options, fap::Rate rate, const tools::Log& log) {
  Result<dam::Model> model = speech::read_model(options.model);
  if (!model) return model.error();
  Result<speech::Spoken> spoken = speech::get_spoken(options.spoken, log);
  if (!spoken) return spoken.error();
  dam::SynthesisOptions settings = synthesis_of(options, rate);
  if (spoken->audio) {
    settings.tail = std::max(0.0, spoken->audio->duration() - spoken->script.duration());
  }
  Result<dam::Signal> signal = speech::move_face(*model, *spoken, settings);
  if (!signal) return signal.error();
  const dam::Prosody prosody = options.idle_motion && spoken->audio
                                   ? voice::measure_prosody(*spoken->audio)
                                   : dam::Prosody{};
  dam::IdleMotionOptions idle = options.idle;
  idle.prosody = &prosody;
  // Without quantisation, angles end at one degree.
  if (options.coding.quant == 0) idle.still.gaze = idle.still.head = true;
  if (options.over) {
    dam::OverOptions over;
    over.keep = options.keep;
    over.idle = options.idle_motion ? std::optional(idle) : std::nullopt;
    auto put = dam::speak_over(*signal, spoken->script, *options.over, over);
    if (!put) return put.error();
    if (options.mood.neutral()) spoken->moods.clear();  // the performance has its own
  } else {
    if (!options.idle_motion) idle.liveliness = 0;
    auto added = dam::add_idle_motion(*signal, spoken->script, idle);
    if (!added && options.idle_motion) return added.error();
  }
  auto moody = dam::add_moods(*signal, spoken->script, dam::MoodTrack(options.mood, spoken->moods));
  if (!moody && !options.mood.neutral()) return moody.error();
  Result<fap::Sequence> clip = dam::to_sequence(*signal);
  if (!clip) return clip.error();
  return code_live_clip(*clip, spoken->audio ? &*spoken->audio : nullptr, options.coding);
}

Result<void> open_speaker(const ProgramOptions& options, fap::Rate rate, Program& program) {
  Result<dam::Model> model = speech::read_model(options.model);
  if (!model) return model.error();
  program.model = std::move(*model);
  const std::string& say = options.say.empty() ? options.say_json : options.say;
  if (say != "-" && !say.empty()) {
    program.descriptor = ::open(say.c_str(), O_RDONLY | O_CLOEXEC);
    if (program.descriptor < 0) {
      return make_error(Code::not_found, "cannot open the lines to say").in_file(say);
    }
  }
  const int descriptor = say == "-" ? STDIN_FILENO : program.descriptor;
  Result<speech::LineMaker> maker = maker_of(options);
  if (!maker) return maker.error();
  if (!options.control.empty()) {
    auto control = speech::ControlSocket::open(options.control);
    if (!control) return control.error();
    program.control = std::move(*control);
  }
  auto lines = speech::VoiceLines::open(descriptor, std::move(*maker), media::steady_clock(),
                                        program.control.get());
  if (!lines) return lines.error();
  program.lines = std::move(*lines);

  speech::SpeakerOptions settings;
  settings.face = {synthesis_of(options, rate),
                   options.idle_motion,
                   options.idle,
                   options.mood,
                   options.over,
                   options.keep};
  settings.fap_quant = options.coding.quant;
  settings.intra_seconds = options.coding.intra_seconds;
  settings.coding_delay = options.coding_delay;
  settings.voice_rate = program.lines->sample_rate();
  settings.audio_ahead = kAhead;
  settings.audio.reset();
  if (options.coding.sound) settings.audio = options.coding.audio;
  settings.duration = options.duration;
  settings.events = true;
  auto speaker =
      speech::LiveSpeaker::open(program.model, *program.lines, media::steady_clock(), settings);
  if (!speaker) return speaker.error();
  program.speaker = std::move(*speaker);
  if (options.hear.empty()) return {};
  auto other = speech::OtherVoice::open(options.hear, options.hear_bare);
  if (!other) return other.error();
  program.speaker->hear(std::move(*other));
  return {};
}

Result<void> open_voice(const ProgramOptions& options, fap::Rate rate, Program& program) {
  Result<dam::Model> model = speech::read_model(options.model);
  if (!model) return model.error();
  program.model = std::move(*model);
  const std::string name = options.say_audio == "-" ? "standard input" : options.say_audio;
  if (options.say_audio != "-") {
    program.descriptor = ::open(options.say_audio.c_str(), O_RDONLY | O_CLOEXEC);
    if (program.descriptor < 0) {
      return make_error(Code::not_found, "cannot open the voice").in_file(name);
    }
  }
  speech::LiveVoiceOptions settings;
  settings.synthesis = synthesis_of(options, rate);
  settings.language = options.spoken.language;
  settings.bare = options.bare;
  settings.delay = options.delay;
  settings.fap_quant = options.coding.quant;
  settings.intra_seconds = options.coding.intra_seconds;
  settings.coding_delay = options.coding_delay;
  settings.audio_ahead = kAhead;
  settings.audio.reset();
  if (options.coding.sound) settings.audio = options.coding.audio;
  settings.duration = options.duration;
  settings.idle_motion = options.idle_motion;
  settings.idle = options.idle;
  settings.mood = options.mood;
  settings.over = options.over;
  settings.keep = options.keep;
  if (!options.control.empty()) {
    auto control = speech::ControlSocket::open(options.control);
    if (!control) return control.error();
    program.control = std::move(*control);
    speech::LineMaker none;
    none.make = [](const std::string&, const speech::Wanted&) -> Result<speech::SpokenLine> {
      return make_error(Code::unsupported, "with --say-audio the sound is what is said");
    };
    auto lines =
        speech::VoiceLines::open(-1, std::move(none), media::steady_clock(), program.control.get());
    if (!lines) return lines.error();
    program.lines = std::move(*lines);
    settings.commands = program.lines.get();
  }
  auto voice = speech::LiveVoice::open(
      program.model, options.say_audio == "-" ? STDIN_FILENO : program.descriptor, settings);
  if (!voice) return voice.error().in_file(name);
  program.voice = std::move(*voice);
  return {};
}

Program::~Program() {
  voice.reset();
  speaker.reset();
  lines.reset();
  control.reset();
  if (descriptor >= 0) ::close(descriptor);
}

media::LiveInput& Program::input() const {
  if (voice) return *voice;
  return speaker ? static_cast<media::LiveInput&>(*speaker) : *clip;
}

void play_clip(Clip clip, const ProgramOptions& options, Program& program) {
  media::ClipOptions settings;
  settings.audio_ahead = kAhead;
  settings.loop = options.loop;
  settings.duration = options.duration;
  program.clip =
      std::make_unique<media::ClipInput>(std::move(clip.face), std::move(clip.sound), settings);
}

}  // namespace animeme::live
