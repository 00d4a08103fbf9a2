#include "tools/app/commands/stream_options.h"

#include <CLI/CLI.hpp>

#include "tools/app/commands/bounds.h"
#include "tools/app/commands/brief_help.h"
#include "tools/app/commands/head_options.h"
#include "tools/app/commands/motion_options.h"
#include "tools/app/commands/outputs.h"
#include "tools/app/commands/spoken_options.h"

namespace animeme::tools {

namespace {

void add_source_options(CLI::App& app, StreamOptions& options) {
  app.add_option("input", options.input,
                 "File with a face: mp4, mkv, ts (with its sound), .fba, .fap");
  options.program.spoken.listen = true;
  add_spoken_options(app, options.program.spoken);
  app.add_option("--say", options.program.say,
                 "Lines of text to speak as they come, - for standard input; between them the face "
                 "idles");
  app.add_option("--say-json", options.program.say_json,
                 "Pieces of sound with text, words or visemes and their times, one JSON a line, "
                 "as speech services give them")
      ->option_text("FILE")
      ->excludes("--say")
      ->excludes("--tts");
  app.add_option("--say-audio", options.program.say_audio,
                 "A voice as it comes, which the face follows: WAV, - for standard input")
      ->option_text("FILE");
  app.add_option("--pcm", options.pcm, "--say-audio is bare samples of 16 bit: 16000, 48000:2 ...")
      ->option_text("RATE[:CHANNELS]")
      ->check(read_by(speech::parse_bare_sound))
      ->needs("--say-audio");
  app.add_option("--delay", options.program.delay,
                 "Seconds from sound that comes to its face and its being heard")
      ->option_text("0.25..2=0.3")
      ->check(between(0.25, 2.0))
      ->needs("--say-audio");
  app.add_option(
         "--control", options.program.control,
         "Path of a socket (Unix domain, mode 0600) for more lines and commands; events come "
         "back on it")
      ->option_text("FILE")
      ->excludes("--say-audio");
  add_output(
      app.add_option("--events", options.events,
                     "What becomes of each line, word and phone and when, one JSON a line; - "
                     "for standard output"),
      {});
  app.add_flag("--loop", options.program.loop, "Begin the clip again at its end; times go on");
  app.add_option("--duration", options.program.duration, "End after so many seconds")
      ->check(above_zero());
  app.add_flag("--no-sound", options.no_sound, "Send the face alone");
  app.add_option("--model", options.program.model,
                 "Model file of a character; default: the built-in one");
  app.add_option("--rate", options.rate, "Frames a second of a face made from text or script")
      ->type_name("RATE")
      ->check(frame_rate())
      ->capture_default_str();
  add_motion_options(app, options.program.motion);
  app.add_flag("--idle-motion,--life", options.program.idle_motion,
               "Add blinks, and brows and head that move a little");
  app.add_option("--seed", options.program.seed,
                 "Other times of blinks and another sway of the head")
      ->needs("--idle-motion")
      ->check(between(0, 1e9));
}

void add_coding_options(CLI::App& app, StreamOptions& options) {
  app.add_option("--intra-seconds", options.program.coding.intra_seconds,
                 "Seconds between points where receivers can join; streams and containers whose "
                 "own lie farther apart are coded again, all others are sent as they are")
      ->check(between(0.04, 60.0))
      ->capture_default_str();
  app.add_flag(
      "--copy", options.program.coding.copy,
      "Send streams and containers as they are, however far their joining points are apart");
  app.add_option("--quant", options.program.coding.quant,
                 "Quantiser fap_quant of faces that are coded")
      ->check(between(0, 31))
      ->capture_default_str();
  app.add_option("--audio-codec", options.codec,
                 "aac or opus; default: what a file has, opus for --say, else aac")
      ->check(CLI::IsMember({"aac", "opus"}));
  app.add_option("--audio-bitrate", options.program.coding.audio.bit_rate,
                 "Bits a second of sound that is coded; default: aac 64000, opus 40000")
      ->check(between(6000, 320000));
}

void add_web_options(CLI::App& app, web::WebOptions& options) {
  app.add_option("--max-clients", options.max_clients,
                 "http: viewers at the same time, each with a face, a sound or both")
      ->check(between(1, 1000))
      ->capture_default_str();
  app.add_option("--max-per-address", options.per_address,
                 "http: connections of one address at the same time, about two a viewer; 0: any "
                 "number, behind a proxy")
      ->check(between(0, 10000))
      ->capture_default_str();
  add_guard_options(app, options);
}

}  // namespace

void add_guard_options(CLI::App& app, web::WebOptions& options) {
  app.add_option("--allow-origin", options.allow_origins,
                 "Pages elsewhere that may use the web server, as https://example.org; may be "
                 "repeated; *: all")
      ->allow_extra_args(false);
  app.add_option("--host-name", options.host_names,
                 "A name by which browsers call the web server, besides the names and addresses of "
                 "its machine; may be repeated; *: any")
      ->allow_extra_args(false);
}

void add_options(CLI::App& app, StreamOptions& options) {
  add_source_options(app, options);
  app.add_option(
         "--to", options.to,
         "Address: rtp://host:port, udp://host:port, srt://host:port; http://host:port to serve "
         "browsers, webrtc://host:port the same by WebRTC; whip://host:port/path to a WebRTC "
         "server; for engines livelink://host:port, vmc://host:port, osc://host:port; may be "
         "repeated")
      ->required()
      ->allow_extra_args(false);
  add_output(app.add_option("--sdp", options.sdp,
                            "Session description to write for an rtp address; receivers need it"),
             {".sdp"})
      ->allow_extra_args(false);
  app.add_option("--mtu", options.sink.media.rtp.mtu, "Largest datagram, bytes")
      ->check(between(256, 65000))
      ->capture_default_str();
  app.add_option("--repeat", options.sink.media.rtp.repeat,
                 "rtp: how often each packet of the face is sent, against loss")
      ->check(between(1, 8))
      ->capture_default_str();
  app.add_option("--repeat-after", options.sink.media.rtp.repeat_after,
                 "rtp: a copy follows its original by so many packets of the face; more survive "
                 "longer bursts of loss and cost that much delay where one is needed")
      ->check(between(1, 50))
      ->capture_default_str();
  app.add_option("--bundle", options.sink.media.rtp.bundle,
                 "rtp: planes a packet; more save headers and cost delay")
      ->check(between(1, 16))
      ->capture_default_str();
  add_web_options(app, options.sink.web);
  add_heads_options(app, options.heads.heads, options.heads.rest);
  add_coding_options(app, options);
  app.add_flag("--fast", options.fast, "Do not wait for the clock, send as fast as it goes");
  app.add_flag("--stats", options.stats, "Tell once a second how it goes");
  app.add_flag("--json", options.json, "Machine-readable summary on standard output at the end");
  show_in_help_all(app, "Details of voices, coding and transport",
                   {"--tier",         "--script-format", "--max-seconds", "--speed",
                    "--pitch",        "--seed",          "--mtu",         "--repeat",
                    "--repeat-after", "--bundle",        "--max-clients", "--max-per-address",
                    "--allow-origin", "--host-name",     "--delay",       "--intra-seconds",
                    "--points",       "--gain",          "--copy",        "--quant",
                    "--sharpness",    "--articulate",    "--audio-codec", "--audio-bitrate"});
}

}  // namespace animeme::tools
