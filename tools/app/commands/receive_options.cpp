#include "tools/app/commands/receive_options.h"

#include <CLI/CLI.hpp>

#include "tools/app/commands/bounds.h"
#include "tools/app/commands/face_text.h"
#include "tools/app/commands/outputs.h"

namespace animeme::tools {

void add_options(CLI::App& app, ReceiveOptions& options) {
  app.add_option("source", options.source,
                 "Session description (.sdp) or address: rtp://host:port, udp://host:port, "
                 "srt://host:port, ws://host:port; from phones and engines: livelink://:11111, "
                 "vmc://:39539, osc://:9000")
      ->required();
  add_output(app.add_option("-o,--output", options.output,
                            "What to write: .mp4 .mkv .ts (face and sound), .fba (stream), .fap "
                            "(text), - for FAP text on standard output while it comes"),
             {".fap", ".fba", ".mp4", ".mkv", ".ts"}, OutputKind::file_or_dash);
  app.add_option("--to", options.to,
                 "Send on what comes, while it comes: addresses as of stream (http://host:port, "
                 "livelink://host:port ...); may be repeated")
      ->allow_extra_args(false);
  add_output(app.add_option("--sdp", options.sdp,
                            "Session description to write for an rtp address of --to"),
             {".sdp"})
      ->allow_extra_args(false);
  app.add_option("--duration", options.duration, "End after so many seconds of presentation")
      ->check(above_zero());
  app.add_option("--wait", options.wait,
                 "Seconds to wait for the session description, the server and the first packet; "
                 "0: for ever")
      ->check(at_least_zero())
      ->capture_default_str();
  app.add_option("--timeout", options.timeout,
                 "End, with exit code 1, when nothing came for so many seconds; till then a sender "
                 "that begins again is recorded on; 0: never")
      ->check(at_least_zero())
      ->capture_default_str();
  app.add_option(
         "--gap", options.gap,
         "FAP text where planes are missing: hold the last values, ease to neutral, or skip "
         "the frames (with --exact)")
      ->check(CLI::IsMember({"hold", "neutral", "skip"}))
      ->capture_default_str();
  CLI::Option* coded = app.add_flag(
      "--coded", options.text.coded,
      "FAP text with the values as they are coded, nothing held or mirrored; with --exact");
  app.add_flag("--fill", options.text.fill,
               "FAP text with every FAP: those that were never sent are at rest, 0")
      ->excludes(coded);
  app.add_flag("--expand", options.text.expand,
               "FAP text with FAP 1 and 2 (visemes, expressions) as low-level FAPs")
      ->excludes(coded);
  add_exact_option(app, options.text.exact);
  app.add_option("--reorder-seconds", options.receive.media.rtp.reorder_seconds,
                 "rtp: time that a packet waits for an earlier one; it grows with how late packets "
                 "and copies come")
      ->check(between(0.0, 10.0))
      ->capture_default_str();
  app.add_option("--reorder-most", options.receive.media.rtp.reorder_most_seconds,
                 "rtp: what that time grows to at most")
      ->check(between(0.0, 10.0))
      ->capture_default_str();
  app.add_flag("--any-source", options.any_source,
               "rtp, udp, livelink, vmc, osc: take datagrams from every address; else one sender "
               "is heard, from one "
               "address, and the next one when it is silent for a second");
  app.add_flag("--stats", options.stats, "Tell once a second how it goes");
  app.add_flag("--json", options.json,
               "Machine-readable report on standard output, with a row for every intra interval");
}

}  // namespace animeme::tools
