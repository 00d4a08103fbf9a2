// Recording or printing a face and its sound while they come in.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "fap/text.h"
#include "tools/commands/common.h"
#include "tools/commands/interrupt.h"
#include "tools/commands/live_address.h"
#include "tools/commands/receive_report.h"
#include "tools/commands/status_line.h"
#include "tools/media/live/live_frames.h"
#include "tools/media/live/pacer.h"
#include "tools/media/live/recorder.h"
#include "tools/media/mux.h"

namespace animeme::tools {

namespace {

constexpr double kSlice = 0.1;  // seconds: Ctrl-C and the timers are looked after so often
constexpr std::size_t kMostIntervals = 100'000;

struct Options {
  std::string source;
  std::string output;
  LiveSourceOptions receive;
  std::string gap = "hold";
  double duration = 0;
  double wait = 60;
  double timeout = 10;
  bool fill = false;
  bool stats = false;
  bool json = false;
};

bool is_container(const std::string& extension) {
  return extension == ".mp4" || extension == ".mkv" || extension == ".ts";
}

bool is_text(const std::string& output) { return output == "-" || extension_of(output) == ".fap"; }

media::GapRule rule_of(const std::string& name) {
  if (name == "neutral") return media::GapRule::neutral;
  return name == "skip" ? media::GapRule::skip : media::GapRule::hold;
}

std::string name_of(const std::string& output) {
  return output == "-" ? "live" : std::filesystem::path(output).stem().string();
}

/// Frames as text: on standard output as they come, else kept for the file.
class TextWriter {
 public:
  explicit TextWriter(const Options& options)
      : options_(options), frames_(rule_of(options.gap), options.fill) {}

  bool wanted() const { return is_text(options_.output); }

  Result<void> push(const media::LiveUnit& unit, std::uint32_t timescale, bool after_gap) {
    if (!wanted() || unit.track != media::LiveTrack::face) return {};
    Result<std::vector<fap::Frame>> frames = frames_.push(unit, timescale, after_gap);
    if (!frames) return frames.error();
    clip_.rate = frames_.rate();
    if (options_.output != "-") {
      clip_.frames.insert(clip_.frames.end(), frames->begin(), frames->end());
      return {};
    }
    return print(*frames);
  }

  Result<void> finish() {
    if (options_.output == "-") return {};
    clip_.name = name_of(options_.output);
    return write_file(options_.output, fap::write_text(clip_));
  }

 private:
  Result<void> print(const std::vector<fap::Frame>& frames) {
    if (frames.empty()) return {};
    std::string text;
    if (!begun_) text = media::fap_header(clip_.rate, name_of(options_.output));
    begun_ = true;
    for (const fap::Frame& frame : frames) text += media::fap_lines(frame, clip_.rate);
    const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
    if (written && std::fflush(stdout) == 0) return {};
    return make_error(Code::io, "the frames cannot be written: nobody reads standard output");
  }

  const Options& options_;
  media::LiveFrames frames_;
  fap::Sequence clip_;
  bool begun_ = false;
};

/// One reception from the first packet to the last.
class Reception {
 public:
  Reception(const Options& options, media::LiveSource& source)
      : options_(options),
        source_(source),
        recorder_({.duration = options.duration, .keep = !is_text(options.output)}),
        text_(options) {}

  bool has_face() const { return recorder_.recovery().usable > 0; }
  bool has_sound() const { return recorder_.sound_seconds() > 0; }
  bool heard() const { return first_.has_value(); }

  /// Until the sender ends, the time is over, or Ctrl-C. Errors: those of the source, of decoding
  /// and of standard output; what came before is kept.
  Result<void> run();
  Result<void> write();
  void report();

 private:
  Result<void> take(media::LiveEvent event);
  void look(double now);

  const Options& options_;
  media::LiveSource& source_;
  media::Recorder recorder_;
  TextWriter text_;
  StatusLine status_;
  std::vector<media::IntraInterval> intervals_;
  std::optional<double> first_;  // instant of the first unit
  double told_ = 0;
};

Result<void> Reception::take(media::LiveEvent event) {
  const std::optional<media::LiveUnit> unit = recorder_.accept(std::move(event));
  for (const media::IntraInterval& interval : recorder_.take_intervals()) {
    if (intervals_.size() < kMostIntervals) intervals_.push_back(interval);
  }
  if (!unit) return {};
  return text_.push(*unit, recorder_.info()->timescale, recorder_.after_gap());
}

void Reception::look(double now) {
  if (!options_.stats || !first_ || now - *first_ < told_ + 1) return;
  told_ = std::floor(now - *first_);
  status_.show(receive_line(told_, recorder_, source_.stats()));
}

Result<void> Reception::run() {
  media::Clock& clock = media::steady_clock();
  double last = clock.now();
  while (!Interrupt::requested() && !recorder_.ended()) {
    Result<media::LiveEvent> event = source_.next(kSlice);
    const double now = clock.now();
    look(now);
    if (!event) return event.error();
    if (std::holds_alternative<media::LiveUnit>(*event)) {
      last = now;
      if (!first_) first_ = now;
    }
    const double patience = first_ ? options_.timeout : options_.wait;
    if (patience > 0 && now - last > patience) {
      if (first_) say("nothing came for " + std::to_string(int(patience)) + " s: the end");
      (void)take(media::LiveEnd{});
      return {};
    }
    if (auto ok = take(std::move(*event)); !ok) return ok;
  }
  return take(media::LiveEnd{});
}

Result<void> Reception::write() {
  if (text_.wanted()) return text_.finish();
  const media::Recording recording = recorder_.recording();
  const bool face = !recording.face.units.empty(), sound = !recording.sound.packets.empty();
  if (extension_of(options_.output) == ".fba") {
    if (recorder_.recovery().frozen_seconds > 0) {
      warn("a raw stream has no place for missing planes: " + options_.output +
           " is shorter than what was sent; mp4 keeps the times");
    }
    return write_file(options_.output, fba::join_access_units(recording.face));
  }
  media::MuxInput input;
  if (face) input.face = &recording.face;
  if (sound) input.encoded = &recording.sound;
  const auto written = media::write_container(options_.output, input);
  if (!written) return written.error().in_file(options_.output);
  return {};
}

void Reception::report() {
  status_.clear();
  say(receive_summary(recorder_, source_.stats(), intervals_));
  if (!options_.json) return;
  std::printf("%s\n", receive_json(recorder_, source_.stats(), intervals_).dump(2).c_str());
}

Error nothing_came(const Options& options, const Reception& reception) {
  if (!reception.heard()) {
    return make_error(Code::not_found,
                      "nothing came: is the sender running, and are address and port the same?")
        .in_file(options.source);
  }
  return make_error(Code::not_found,
                    "no intra plane came, so the face cannot be decoded; let the sender write them "
                    "more often (--intra-seconds)")
      .in_file(options.source);
}

Result<int> run(const Options& options) {
  const std::string extension = extension_of(options.output);
  if (options.output != "-" && !is_container(extension) && extension != ".fap" &&
      extension != ".fba") {
    return usage_error("--output must end in .fap, .fba, .mp4, .mkv or .ts, or be -, not " +
                       options.output);
  }
  if (options.json && options.output == "-") {
    return usage_error("--json and the frames of -o - both go to standard output");
  }
  auto source = open_live_source(options.source, options.receive);
  if (!source && source.error().code == Code::invalid_argument) {
    return usage_error(source.error().message);
  }
  if (!source) return source.error().in_file(options.source);
  const Interrupt interrupt;
  Reception reception(options, **source);
  const auto received = reception.run();
  const bool enough = reception.has_face() || (is_container(extension) && reception.has_sound());
  if (enough) {
    if (auto written = reception.write(); !written) return written.error();
  }
  reception.report();
  if (!received) return received.error().in_file(options.source);
  if (!enough) {
    if (Interrupt::requested() && !reception.heard()) return kInterrupted;
    return nothing_came(options, reception);
  }
  return Interrupt::requested() ? kInterrupted : kOk;
}

Action add(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("source", options->source,
                 "Session description (.sdp) or address: rtp://host:port, udp://host:port, "
                 "srt://host:port, ws://host:port")
      ->required();
  app.add_option("-o,--output", options->output,
                 "What to write: .mp4 .mkv .ts (face and sound), .fba (stream), .fap (text), - for "
                 "FAP text on standard output while it comes")
      ->required();
  app.add_option("--duration", options->duration, "End after so many seconds of presentation")
      ->check(CLI::PositiveNumber);
  app.add_option("--wait", options->wait, "Seconds to wait for the first packet; 0: for ever")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--timeout", options->timeout,
                 "End when nothing came for so many seconds; 0: never")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option(
         "--gap", options->gap,
         "FAP text where planes are missing: hold the last values, ease to neutral, or skip "
         "the frames")
      ->check(CLI::IsMember({"hold", "neutral", "skip"}))
      ->capture_default_str();
  app.add_flag("--fill", options->fill,
               "FAP text with every FAP in every frame, as players want it");
  app.add_option("--reorder-seconds", options->receive.media.rtp.reorder_seconds,
                 "rtp: the longest time that a packet waits for an earlier one")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  app.add_flag("--stats", options->stats, "Tell once a second how it goes");
  app.add_flag("--json", options->json,
               "Machine-readable report on standard output, with a row for every intra interval");
  return [options] { return run(*options); };
}

}  // namespace

const Command kReceive{
    "receive", "Record a live face and its sound, or print its frames as they come",
    "  animeme receive talk.sdp -o talk.mp4\n"
    "  animeme receive udp://239.1.2.3:5004 -o talk.fba --duration 60 --stats\n"
    "  animeme receive talk.sdp -o - --fill | my_avatar\n"
    "Ends when the sender says goodbye, at --duration, after --timeout, or at Ctrl-C (exit code "
    "130);\nwhat was received till then is written whole.",
    add};

}  // namespace animeme::tools
