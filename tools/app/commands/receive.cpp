// Recording or printing a face and its sound while they come in.
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "tools/app/commands/common.h"
#include "tools/app/commands/face_text.h"
#include "tools/app/commands/interrupt.h"
#include "tools/app/commands/options.h"
#include "tools/app/commands/report.h"
#include "tools/formats/common/text.h"
#include "tools/formats/media/live/pacer.h"
#include "tools/formats/media/live/recorder.h"
#include "tools/formats/media/live/recording_file.h"
#include "tools/formats/media/rtp/session_clock.h"
#include "tools/live/sessions/address.h"
#include "tools/live/sessions/patient_source.h"
#include "tools/live/sessions/receive_output.h"
#include "tools/live/sessions/receive_report.h"
#include "tools/live/sessions/relay.h"

namespace animeme::tools {

namespace {

// What was said on the command line.
struct ReceiveOptions {
  std::string source;            // address or session description
  std::string output;            // -o; empty: what comes is sent on, and nothing else
  std::vector<std::string> to;   // --to
  std::vector<std::string> sdp;  // --sdp
  live::SourceOptions receive;   // --reorder-seconds ...
  bool any_source = false;       // --any-source
  std::string gap = "hold";      // --gap
  double duration = 0;           // --duration, seconds
  double wait = 60;              // --wait, seconds
  double timeout = 10;           // --timeout, seconds
  live::FapOutputOptions text;   // --coded, --fill, --expand, --exact
  bool stats = false;            // --stats
  bool json = false;             // --json
};

// Adds them.
void add_options(OptionTable& cli, ReceiveOptions& options) {
  cli.add("source", options.source,
          "Session description (.sdp) or address: rtp://host:port, udp://host:port, "
          "srt://host:port, ws://host:port; from phones and engines: livelink://:11111, "
          "vmc://:39539, osc://:9000")
      ->required();
  cli.add("-o,--output", options.output,
          "File to write: .mp4 .mkv .ts (face and sound), .fba (stream), .fap (text), - for "
          "FAP text on standard output as it arrives")
      ->output(".fap .fba .mp4 .mkv .ts", OutputKind::file_or_dash);
  cli.add("--to", options.to,
          "Forward what arrives: addresses as of stream (http://host:port, "
          "livelink://host:port ...); may be repeated")
      ->one_at_a_time();
  cli.add("--sdp", options.sdp, "Write the session description of an rtp address of --to")
      ->output(".sdp")
      ->one_at_a_time();
  cli.add("--duration", options.duration, "End after so many seconds of media")->above_zero();
  cli.add("--wait", options.wait,
          "Seconds to wait for the session description, the server and the first packet; 0: "
          "forever")
      ->at_least_zero()
      ->show_default();
  cli.add("--timeout", options.timeout,
          "End with exit code 1 if nothing arrives for so many seconds; a sender that "
          "restarts earlier is recorded on; 0: never")
      ->at_least_zero()
      ->show_default();
  cli.add("--gap", options.gap,
          "FAP text for missing planes: hold the last values, ease to neutral, or skip the "
          "frames, so that numbers have no gaps (with --exact they have)")
      ->one_of("hold neutral skip")
      ->show_default();
  cli.add("--coded", options.text.coded,
          "FAP text with the coded values only, nothing held or mirrored; with --exact");
  cli.add("--fill", options.text.fill, "FAP text with all FAPs: those that were never sent are 0")
      ->excludes("--coded");
  cli.add("--expand", options.text.expand,
          "FAP text with FAP 1 and 2 (visemes, expressions) expanded to low-level FAPs")
      ->excludes("--coded");
  add_exact_option(cli, options.text.exact);
  cli.add("--reorder-seconds", options.receive.media.rtp.reorder_seconds,
          "rtp: time that a packet waits for an earlier one; grows with jitter and with the "
          "delay of copies")
      ->between(0.0, 10.0)
      ->show_default();
  cli.add("--reorder-most", options.receive.media.rtp.reorder_most_seconds,
          "rtp: upper limit of that time")
      ->between(0.0, 10.0)
      ->show_default();
  cli.add("--any-source", options.any_source,
          "rtp, udp, livelink, vmc, osc: accept datagrams from all addresses; default: one "
          "sender at a time, the next one after a second of silence");
  cli.add("--stats", options.stats, "Print statistics once per second");
  cli.add("--json", options.json,
          "Print a machine-readable report with a row for each intra interval");
}

constexpr double kSlice = 0.1;  // seconds: Ctrl-C and the timers are looked after so often
constexpr std::size_t kMostIntervals = 100'000;

media::GapRule rule_of(const std::string& name) {
  if (name == "neutral") return media::GapRule::neutral;
  return name == "skip" ? media::GapRule::skip : media::GapRule::hold;
}

live::FapOutputOptions text_options(const ReceiveOptions& options) {
  live::FapOutputOptions text = options.text;
  text.gap = rule_of(options.gap);
  text.exact = text.exact || text.coded;
  return text;
}

/// One reception from the first packet to the last.
class Reception {
 public:
  Reception(const ReceiveOptions& options, media::LiveSource& source, live::Relay relay)
      : options_(options),
        source_(source),
        relay_(std::move(relay)),
        recorder_({.duration = options.duration,
                   .keep = !options.output.empty() && !live::is_fap_output(options.output)}),
        text_(options.output, text_options(options)),
        file_(options.output) {}

  bool has_face() const { return recorder_.recovery().usable > 0; }
  bool has_sound() const { return recorder_.sound_seconds() > 0; }
  bool heard() const { return first_.has_value(); }
  /// Why it ended although the sender did not say so; empty: it did, or it was asked to end.
  const std::string& cut_short() const { return cut_short_; }

  /// Until the sender ends, the time is over, or Ctrl-C. Errors: those of the source, of decoding
  /// and of standard output; what came before is kept.
  Result<void> run();
  /// Completes what was written.
  Result<void> finish();
  void report();

 private:
  Result<void> take(media::LiveEvent event);
  Result<void> keep(const media::LiveUnit& unit);
  Result<void> record(bool idle);
  void look(double now);

  const ReceiveOptions& options_;
  media::LiveSource& source_;
  live::Relay relay_;
  media::Recorder recorder_;
  live::FapOutput text_;
  media::RecordingFile file_;
  bool told_of_recoding_ = false;
  StatusLine status_;
  std::vector<media::IntraInterval> intervals_;
  std::optional<double> first_;  // instant of the first unit
  std::string cut_short_;
  double told_ = 0;
};

Result<void> Reception::take(media::LiveEvent event) {
  const bool idle = std::holds_alternative<media::LiveIdle>(event);
  const std::optional<media::LiveUnit> unit = recorder_.accept(std::move(event));
  for (const media::IntraInterval& interval : recorder_.take_intervals()) {
    if (intervals_.size() < kMostIntervals) intervals_.push_back(interval);
  }
  if (unit) {
    if (auto sent = relay_.send(*recorder_.info(), *unit); !sent) return sent;
  }
  if (auto ok = relay_.poll(); !ok) return ok;
  if (options_.output.empty()) return {};
  if (!text_.wanted()) return record(idle);
  return unit ? keep(*unit) : Result<void>();
}

/// As text.
Result<void> Reception::keep(const media::LiveUnit& unit) {
  const auto text = text_.push(unit, recorder_.info()->timescale, recorder_.after_gap());
  if (!text) return text.error();
  const bool written = std::fwrite(text->data(), 1, text->size(), stdout) == text->size();
  if (written && std::fflush(stdout) == 0) return {};
  return make_error(Code::io, "the frames cannot be written: nobody reads standard output");
}

Result<void> Reception::record(bool idle) {
  auto written = idle ? file_.flush() : file_.write(recorder_);
  if (file_.recodes() && !std::exchange(told_of_recoding_, true)) {
    say("the sound is encoded again as aac, since .ts files do not support opus");
  }
  return written;
}

void Reception::look(double now) {
  if (!options_.stats || !first_ || now - *first_ < told_ + 1) return;
  told_ = std::floor(now - *first_);
  status_.show(live::receive_line(told_, recorder_, source_.stats()));
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
      if (first_) cut_short_ = format("nothing came for %g s (--timeout)", patience);
      return take(media::LiveEnd{});
    }
    const bool described = std::holds_alternative<media::LiveInfo>(*event);
    if (auto ok = take(std::move(*event)); !ok) return ok;
    if (described && recorder_.ended()) {
      cut_short_ = "the sender came back with another sound, which does not fit into the recording";
    }
  }
  return take(media::LiveEnd{});
}

Result<void> Reception::finish() {
  if (auto told = relay_.finish(); !told) return told;
  if (options_.output.empty()) return {};
  if (text_.wanted()) {
    if (!text_options(options_).exact) {
      warn_of_rate(name_of_output(options_.output), text_.rate(),
                   "animeme decode --rate makes another text of it");
    }
    return text_.finish();
  }
  if (extension_of(options_.output) == ".fba" && recorder_.recovery().frozen_seconds > 0) {
    warn("a raw stream cannot represent missing planes: " + options_.output +
         " is shorter than what was sent; mp4 keeps the times");
  }
  return file_.finish();
}

void Reception::report() {
  status_.clear();
  if (!heard()) return;
  const std::string summary = live::receive_summary(recorder_, source_.stats(), intervals_);
  if (!summary.empty()) say(summary);
  if (!options_.json) return;
  std::printf("%s\n", live::receive_json(recorder_, source_.stats(), intervals_).c_str());
  report_printed();
}

// "waiting up to 60 s (--wait) for the first packet".
std::string waiting_text(double wait, const live::PatientSource& source) {
  std::string text = "waiting ";
  text += wait > 0 ? format("up to %g s (--wait)", wait) : "until the sender comes (--wait 0)";
  if (source.waiting_for()) return text + ": " + source.waiting_for()->describe();
  return wait > 0 ? text + " for the first packet" : text;
}

Error nothing_came(const ReceiveOptions& options, const Reception& reception,
                   const live::PatientSource& source) {
  if (!reception.heard()) {
    if (source.waiting_for()) return *source.waiting_for();
    const std::int64_t foreign = source.stats().foreign;
    const std::string others =
        foreign > 0 ? " (" + std::to_string(foreign) + " datagrams came that are of no sender)"
                    : "";
    return make_error(Code::not_found, "nothing came" + others +
                                           ": is the sender running, and are address and port the "
                                           "same?")
        .in_file(options.source);
  }
  return make_error(Code::not_found,
                    "no intra plane came, so the face cannot be decoded; let the sender write them "
                    "more often (--intra-seconds)")
      .in_file(options.source);
}

Result<int> run(ReceiveOptions& options) {
  if (options.json && options.output == "-") {
    return usage_error("--json and -o - both write to standard output");
  }
  if (options.output.empty() && options.to.empty()) {
    return usage_error("give an output: -o FILE to record, --to ADDRESS to forward");
  }
  if (!options.output.empty()) {
    if (auto ok = live::check_place(options.output); !ok) return ok.error();
  }
  auto relay = live::Relay::open(options.to, options.sdp, terminal_log());
  if (!relay && relay.error().code == Code::invalid_argument) {
    return usage_error(relay.error().message);
  }
  if (!relay) return relay.error();
  live::SourceOptions receive = options.receive;
  receive.media.rtp.any_source = receive.media.ts.any_source = options.any_source;
  receive.engines.any_source = options.any_source;
  auto opened = live::open_patiently(options.source, receive);
  if (!opened && opened.error().code == Code::invalid_argument) {
    return usage_error(opened.error().message);
  }
  if (!opened) return opened.error().in_file(options.source);
  const live::PatientSource& patient = **opened;
  say(waiting_text(options.wait, patient));
  const std::unique_ptr<media::LiveSource> source = media::make_steady(std::move(*opened));
  const Interrupt interrupt;
  Reception reception(options, *source, std::move(*relay));
  const auto received = reception.run();
  const bool enough =
      reception.has_face() || (live::is_container_output(options.output) && reception.has_sound());
  if (enough) {
    if (auto written = reception.finish(); !written) return written.error();
  }
  reception.report();
  if (!received) return received.error().in_file(options.source);
  if (!enough) {
    if (Interrupt::requested() && !reception.heard()) return kInterrupted;
    return nothing_came(options, reception, patient);
  }
  if (Interrupt::requested()) return kInterrupted;
  if (reception.cut_short().empty()) return kOk;
  std::string why = reception.cut_short();
  if (patient.waiting_for()) why += "; " + patient.waiting_for()->describe();
  warn("the recording ended early: " + why + "; what came before is kept");
  return kCheckFailed;
}

}  // namespace

const Command kReceive{
    "receive", "Record a live face and its sound, or print its frames as they arrive",
    "  animeme receive talk.sdp -o talk.mp4\n"
    "  animeme receive udp://239.1.2.3:5004 -o talk.fba --duration 60 --stats\n"
    "  animeme receive talk.sdp -o - --fill | my_avatar\n"
    "  animeme receive livelink://:11111 -o phone.mp4 --to http://127.0.0.1:8080\n"
    "Ends when the sender says goodbye, at --duration, after --timeout, or at Ctrl-C (exit code "
    "130). What arrives is on the disk within a second, under its name, and can be played however "
    "the program ends; an existing file of that name is replaced after the first second. An .mp4 "
    "is fragmented.",
    set_up<ReceiveOptions>};

}  // namespace animeme::tools
