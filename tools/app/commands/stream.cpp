// Sending a face and its sound while time passes.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fap/rate_text.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/face_stream.h"
#include "tools/app/commands/interrupt.h"
#include "tools/app/commands/mood_options.h"
#include "tools/app/commands/report.h"
#include "tools/app/commands/stream_options.h"
#include "tools/app/commands/track_option.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/live/expected_loss.h"
#include "tools/live/sessions/address.h"
#include "tools/live/sessions/event_output.h"
#include "tools/live/sessions/program.h"
#include "tools/live/sessions/stream_report.h"

namespace animeme::tools {

namespace {

constexpr double kPollSeconds = 0.05;  // sinks are looked after so often

std::string bad_options(const StreamOptions& options) {
  const live::ProgramOptions& what = options.program;
  const bool voice = !what.say_audio.empty();
  const bool said =
      !what.say.empty() || !what.say_json.empty() || (!what.control.empty() && !voice);
  speech::SpokenOptions source = what.spoken;
  source.listen = options.input.empty() && !said && !voice;  // else it is the sound of that
  const bool spoken = speech::has_source(source);
  const int sources = int(!options.input.empty()) + int(said) + int(voice) + int(spoken);
  if (sources > 1) {
    return "name one thing to stream: a file, --say, --say-audio, or --text and its like";
  }
  if (voice && !what.spoken.audio.empty()) return "--say-audio is the sound, not --audio";
  if (voice && (what.loop || options.fast)) {
    return "--loop and --fast are for clips, --say-audio comes in its own time";
  }
  if (!options.over.path.empty() && !options.input.empty()) {
    return "--over is for speech: --say, --say-audio, or --text and its like";
  }
  if (said && !what.spoken.audio.empty()) {
    return "--audio goes with a face, not with --say, whose voice speaks as the lines come";
  }
  if (sources == 0) {
    return "nothing to stream: name a file with a face, or give --text, --script, --audio or --say "
           "-";
  }
  if (!what.hear.empty() && !said)
    return "--hear is for heads that live: --say, --say-json, --control";
  if (what.hear == "-" && (what.say == "-" || what.say_json == "-")) {
    return "--hear and the lines to say cannot both come from standard input";
  }
  if (!what.hear.empty() && !options.idle.on.value_or(true)) {
    return "--hear needs idle motion: the face listens by it";
  }
  if (said && what.loop) return "--loop repeats clips, --say is none";
  if (said && options.fast) {
    return "--fast does not go with --say, whose lines come in their own time";
  }
  if (!options.events.empty() && !said && !voice) {
    return "--events tells of the lines of --say and --say-json, and of commands";
  }
  if (options.events == "-" && options.json) {
    return "--events - and --json both write to standard output; name a file for the events";
  }
  std::size_t rtp = 0;
  for (const std::string& url : options.to) rtp += live::is_rtp(url);
  if (options.sdp.size() > rtp) return "there are more --sdp files than rtp addresses";
  return {};
}

/// Tells once a second how it goes, and of lines that could not be spoken.
class Watch {
 public:
  Watch(const StreamOptions& options, live::Program& program, live::StreamReport& report,
        live::EventOutput& events)
      : options_(options), program_(program), report_(report), events_(events) {}

  /// What became of the lines meanwhile.
  Result<void> tell_events(live::Sinks& sinks) {
    if (program_.voice) return events_.tell(program_.voice->take_events(), sinks);
    if (!program_.speaker) return {};
    return events_.tell(program_.speaker->take_events(), sinks);
  }
  /// Nothing more is said.
  Result<void> end(live::Sinks& sinks) {
    if (program_.speaker) program_.speaker->end("the stream has ended");
    if (program_.voice) program_.voice->end("the stream has ended");
    return tell_events(sinks);
  }

  void look(const live::Sinks& sinks, const media::Pacer& pacer, double now) {
    if (program_.lines) tell(program_.lines->take_warnings());
    if (program_.voice) tell(program_.voice->take_warnings());
    if (program_.speaker) tell(program_.speaker->take_warnings());
    if (!options_.stats || now < next_) return;
    next_ = std::floor(now) + 1;
    if (now >= 1) status_.show(report_.line(now, sinks, pacer));
  }
  void done() { status_.clear(); }

 private:
  void tell(const std::vector<std::string>& warnings) {
    if (!warnings.empty()) status_.clear();
    for (const std::string& text : warnings) warn(text);
  }

  const StreamOptions& options_;
  live::Program& program_;
  live::StreamReport& report_;
  live::EventOutput& events_;
  StatusLine status_;
  double next_ = 1;
};

/// Sends all of it, unit by unit. Ends early at Ctrl-C.
Result<void> send_all(media::LiveInput& input, live::Sinks& sinks, media::Clock& clock,
                      media::Pacer& pacer, live::StreamReport& report, Watch& watch, double begin) {
  double polled = clock.now();
  media::ExpectedLoss expected;
  const auto look = [&]() -> Result<void> {
    if (clock.now() - polled < kPollSeconds) return {};
    polled = clock.now();
    watch.look(sinks, pacer, pacer.now() - begin);
    expected.follow(sinks.stats(), polled, input);
    return sinks.poll();
  };
  while (!Interrupt::requested()) {
    const std::optional<double> due = input.next_due();
    if (!due) return {};
    const bool reached = pacer.wait_until(*due);
    if (auto ok = look(); !ok) return ok;
    if (!reached) continue;
    // What is due is taken even if the difference of two instants is a bit below it.
    Result<std::vector<media::LiveUnit>> units = input.take(std::max(pacer.now(), *due));
    if (!units) return units.error();
    for (const media::LiveUnit& unit : *units) {
      if (auto ok = sinks.send(unit); !ok) return ok;
      input.sent(unit, clock.now());
      pacer.sent(media::due_of(input, unit));
      report.add(unit);
      if (auto ok = watch.tell_events(sinks); !ok) return ok;
    }
  }
  return {};
}

// A file with a face, and with sound if it is a container or `audio` names one. Coded streams and
// coded sound keep their bytes, but for what `coding` says.
Result<live::Clip> load_clip(const std::string& path, const std::string& audio,
                             const live::Coding& coding) {
  Result<std::vector<std::uint8_t>> bytes = read_input(path);
  if (!bytes) return bytes.error();
  live::Clip clip;
  const bool media = kind_of(*bytes) == FileKind::media;
  if (media) {
    // Its units with their own times.
    Result<media::Container> container = open_container(*bytes, path);
    if (!container) return container.error().in_file(path);
    clip.face = std::move(container->face);
    const bool own_sound = audio.empty() && coding.sound && container->audio.has_value();
    if (own_sound) {
      Result<media::EncodedAudio> sound = live::live_sound(path, coding, terminal_log());
      if (!sound) return sound.error();
      clip.sound = std::move(*sound);
    }
  }
  Result<MotionInput> motion = parse_motion(std::move(*bytes), path);
  if (!motion) return motion.error();
  if (motion->stream.empty()) {
    if (auto ok = require_face(*motion, path); !ok) return ok.error();
    Result<fba::AccessUnits> face = live::live_units(motion->face, coding);
    if (!face) return face.error().in_file(path);
    clip.face = std::move(*face);
  } else {
    if (!media) {
      Result<fba::AccessUnits> units = fba::split_access_units(motion->stream);
      if (!units) return units.error().in_file(path);
      clip.face = std::move(*units);
    }
    auto face =
        live::for_live_use(std::move(clip.face), motion->decoded, path, coding, terminal_log());
    if (!face) return face.error();
    clip.face = std::move(*face);
  }
  if (!audio.empty() && coding.sound) {
    Result<media::EncodedAudio> sound = live::live_sound(audio, coding, terminal_log());
    if (!sound) return sound.error();
    clip.sound = std::move(*sound);
  }
  return clip;
}

Result<void> open_program(const StreamOptions& options, fap::Rate rate, live::Program& program) {
  const live::ProgramOptions& what = options.program;
  if (!what.say_audio.empty()) return live::open_voice(what, rate, program);
  if (!what.say.empty() || !what.say_json.empty() || !what.control.empty()) {
    return live::open_speaker(what, rate, program);
  }
  Result<live::Clip> clip = options.input.empty()
                                ? live::spoken_clip(what, rate, terminal_log())
                                : load_clip(options.input, what.spoken.audio, what.coding);
  if (!clip) return clip.error();
  live::play_clip(std::move(*clip), what, program);
  return {};
}

void print_result(const StreamOptions& options, const live::StreamReport& report, double seconds,
                  const live::Sinks& sinks, const media::Pacer& pacer,
                  const live::Program& program) {
  const auto traces = program.speaker ? program.speaker->traces() : std::deque<speech::LineTrace>{};
  say(report.summary(seconds, sinks, pacer, traces));
  if (options.json) {
    std::printf("%s\n", report.json(seconds, sinks, pacer, traces).c_str());
    report_printed();
  }
}

Result<int> send(const StreamOptions& options, live::Program& program, live::Sinks& sinks,
                 live::EventOutput& events) {
  media::LiveInput& input = program.input();
  media::JumpingClock jumping;
  media::Clock& clock = options.fast ? static_cast<media::Clock&>(jumping) : media::steady_clock();
  const Interrupt interrupt(kLiveGrace);
  if (auto ok = sinks.start(input.info()); !ok) return ok.error();
  for (const live::Address& address : sinks.addresses()) say("sending to " + address.url);
  // Priming is due before time 0.
  const double begin = std::min(0.0, input.next_due().value_or(0));
  media::Pacer pacer(clock, kPollSeconds);
  pacer.restart(-begin);
  live::StreamReport report(input.info());
  Watch watch(options, program, report, events);
  auto sent = send_all(input, sinks, clock, pacer, report, watch, begin);
  if (auto told = watch.end(sinks); sent && !told) sent = told.error();
  watch.done();
  const auto finished = sinks.finish();
  if (!sent) return sent.error();
  print_result(options, report, pacer.now() - begin, sinks, pacer, program);
  if (!finished) return finished.error();
  return Interrupt::requested() ? kInterrupted : kOk;
}

}  // namespace

Result<int> run(StreamOptions& options) {
  const media::TrackScope tracks(wanted_track_of(options.track));
  if (const std::string bad = bad_options(options); !bad.empty()) return usage_error(bad);
  Result<fap::Rate> rate = fap::parse_rate(options.rate);
  if (!rate) return rate.error();
  options.program.mood = mood_of(options.mood);
  options.program.idle_motion = options.idle.on.value_or(true);
  options.program.idle = options.idle.motion;
  if (auto done = read_over(options.over, options.program.over, options.program.keep); !done) {
    return done.error();
  }
  if (!options.pcm.empty()) {
    const auto bare = speech::parse_bare_sound(options.pcm);
    if (!bare) return bare.error();
    options.program.bare = *bare;
  }
  if (!options.hear_pcm.empty()) {
    const auto bare = speech::parse_bare_sound(options.hear_pcm);
    if (!bare) return bare.error();
    options.program.hear_bare = *bare;
  }
  const bool rtc = std::any_of(options.to.begin(), options.to.end(), live::takes_opus_alone);
  options.program.coding.codec_given = rtc || !options.codec.empty();
  options.program.coding.sound = !options.no_sound;
  options.sink.engines.fast = options.fast;
  // Opus packets are shorter, which is what counts when sound is made while it is sent.
  const live::ProgramOptions& what = options.program;
  const bool live = !what.say.empty() || !what.say_json.empty() || !what.control.empty() ||
                    !what.say_audio.empty();
  const live::Coding& coding = options.program.coding;
  give_limits(options.limits, options.program.coding);
  if (live && (coding.max_rms > 0 || coding.max_bits_per_second > 0)) {
    return usage_error(
        "--rms, --kbps and --small need a clip that is known: a file or --text; for speech that "
        "is made while it is sent there is --quant");
  }
  if (!live && what.coding_delay > 0) {
    return usage_error("--encoder-delay is for speech that is made while it is sent");
  }
  if (coding.default_ranges) {
    if (live) return usage_error("--default-ranges needs a clip that is known: a file or --text");
    warn_of_default_ranges(true);
  }
  const bool opus = options.codec.empty() ? live || rtc : options.codec == "opus";
  options.program.coding.audio.codec = opus ? media::AudioCodec::opus : media::AudioCodec::aac;
  if (!options.heads.heads.empty()) {
    if (const std::string bad = problem_of(options.heads); !bad.empty()) return usage_error(bad);
    const auto serves = [](const std::string& url) { return url.starts_with("http://"); };
    if (std::none_of(options.to.begin(), options.to.end(), serves)) {
      warn("--head is for the page of an http:// address, but there is none");
    } else if (auto ok = give_heads(options.heads, options.sink.web); !ok) {
      return ok.error();
    }
  }
  const auto loss = media::parse_expected_loss(options.audio_fec);
  if (!loss) return usage_error("--audio-fec: " + loss.error().message);
  options.program.coding.audio.expected_loss = *loss;
  if (auto ok = use_rtc_options(options.ice, options.audio_repeat, options.sink.web); !ok) {
    return usage_error(ok.error().message);
  }
  auto sinks = live::Sinks::open(options.to, options.sdp, options.sink, terminal_log());
  if (!sinks && sinks.error().code == Code::invalid_argument) {
    return usage_error(sinks.error().message);
  }
  if (!sinks) return sinks.error();
  if (options.sdp.empty() && std::any_of(options.to.begin(), options.to.end(), live::is_rtp)) {
    warn("receivers of rtp need a session description: write one with --sdp talk.sdp");
  }
  live::Program program;
  if (auto ok = open_program(options, *rate, program); !ok) return ok.error();
  auto events = live::EventOutput::open(options.events, program.control.get());
  if (!events) return events.error();
  return send(options, program, *sinks, *events);
}

const Command kStream{
    "stream", "Stream a face and its sound live: a clip, a text, or lines as they are typed",
    "  animeme stream talk.mp4 --to rtp://192.0.2.7:5004 --sdp talk.sdp --loop\n"
    "  animeme stream talk.fba --audio talk.wav --to udp://239.1.2.3:5004 --intra-seconds 1\n"
    "  animeme stream --text \"Hello\" --to srt://192.0.2.7:5005 --to http://127.0.0.1:8080\n"
    "  my_chat_bot | animeme stream --say - --to rtp://192.0.2.7:5004 --sdp bot.sdp "
    "--stats\n"
    "  arecord -q -f S16_LE -r 16000 | animeme stream --say-audio - --to http://127.0.0.1:8080\n"
    "  my_chat_bot | animeme stream --say - --control bot.sock --to http://127.0.0.1:8080 --events "
    "-\n"
    "A line {\"do\": \"stop\"} among those of --say ends what is spoken; more commands: "
    "tools/speech/talking/interrupting.md.\n"
    "Ctrl-C ends it in good order: receivers are told, the summary is printed; exit code 130.",
    set_up<StreamOptions>};

}  // namespace animeme::tools
