#include "tools/app/commands/receive_options.h"

#include "tools/app/commands/face_text.h"
#include "tools/app/commands/options.h"
#include "tools/app/commands/outputs.h"

namespace animeme::tools {

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
          "frames (with --exact)")
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

}  // namespace animeme::tools
