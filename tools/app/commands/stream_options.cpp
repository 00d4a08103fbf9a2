#include "tools/app/commands/stream_options.h"

#include "tools/app/commands/head_options.h"
#include "tools/app/commands/idle_options.h"
#include "tools/app/commands/mood_options.h"
#include "tools/app/commands/motion_options.h"
#include "tools/app/commands/options.h"
#include "tools/app/commands/spoken_options.h"
#include "tools/app/commands/track_option.h"
#include "tools/formats/media/live/expected_loss.h"
#include "tools/live/webrtc/webrtc.h"

namespace animeme::tools {

namespace {

void add_source_options(OptionTable& cli, StreamOptions& options) {
  cli.add("input", options.input, "File with a face: .mp4, .mkv, .ts (with its sound), .fba, .fap");
  options.program.spoken.listen = true;
  add_spoken_options(cli, options.program.spoken);
  cli.add("--say", options.program.say,
          "Lines of text to speak as they arrive, - for standard input; the face idles "
          "between them");
  cli.add("--say-json", options.program.say_json,
          "Audio chunks with text, words or visemes and their times as JSON lines, as speech "
          "services deliver them")
      ->value("FILE")
      ->excludes("--say --tts");
  cli.add("--say-audio", options.program.say_audio,
          "A voice as it arrives, which the face follows: WAV, - for standard input")
      ->value("FILE");
  cli.add("--pcm", options.pcm,
          "--say-audio is raw 16-bit PCM: 16000, 48000:2 ...; mulaw or alaw: a telephone, 8000 Hz")
      ->value("RATE[:CHANNELS]")
      ->check(problem_of<speech::parse_bare_sound>)
      ->needs("--say-audio");
  cli.add("--delay", options.program.delay,
          "Latency in seconds from the arrival of sound to its playback with the face")
      ->value("0.25..2=0.3")
      ->between(0.25, 2.0)
      ->needs("--say-audio");
  cli.add("--control", options.program.control,
          "Path of a Unix domain socket (mode 0600) for further lines and commands; events "
          "are sent back on it; with --say-audio for commands alone")
      ->value("FILE");
  cli.add("--events", options.events,
          "Write the progress of each line, word and phone as JSON lines; - for standard "
          "output")
      ->output("");
  cli.add("--hear", options.program.hear,
          "Sound of the other party, as it arrives: the face listens while it speaks and nods at "
          "its "
          "pauses; WAV file or pipe, - for standard input; for --say, --say-json and --control")
      ->value("FILE")
      ->excludes("--say-audio");
  cli.add("--hear-pcm", options.hear_pcm, "--hear is raw 16-bit PCM: 16000, 48000:2 ...")
      ->value("RATE[:CHANNELS]")
      ->check(problem_of<speech::parse_bare_sound>)
      ->needs("--hear");
  cli.add("--loop", options.program.loop, "Repeat the clip; time stamps continue");
  cli.add("--duration", options.program.duration, "End after so many seconds")->above_zero();
  cli.add("--no-sound", options.no_sound, "Send the face only");
  cli.add("--model", options.program.model,
          "Model file of a character; default: the built-in model");
  cli.add("--rate", options.rate, "Frames per second of a face that is synthesised")
      ->frame_rate()
      ->show_default();
  add_motion_options(cli, options.program.motion);
  options.program.motion.tongue = true;
  add_tongue_option(cli, options.program.motion.tongue);
  add_mood_option(cli, options.mood);
  add_idle_options(cli, options.idle, "default: on");
  add_over_options(cli, options.over, false);
}

void add_coding_options(OptionTable& cli, StreamOptions& options) {
  cli.add("--intra-seconds", options.program.coding.intra_seconds,
          "Seconds between random access points; streams and containers with longer "
          "intervals are encoded again, all others are sent unchanged")
      ->between(0.04, 60.0)
      ->show_default();
  cli.add("--copy", options.program.coding.copy,
          "Send streams and containers unchanged, however long their intra intervals are");
  cli.add("--quant", options.program.coding.quant,
          "Quantiser (fap_quant) of faces that are encoded")
      ->between(0, 31)
      ->show_default();
  add_limit_options(cli, options.limits, "--quant --copy");
  for (const char* name : {"--rms", "--kbps", "--small"}) {
    cli.get(name)->help += "; for clips that are known";
  }
  cli.add("--encoder-delay", options.program.coding_delay,
          "--say, --say-audio: send face and sound so many seconds later; intra planes then know "
          "what follows, and get the tightest ranges if that reaches to the next of them")
      ->between(0.0, 10.0);
  add_default_ranges_option(cli, options.program.coding.default_ranges);
  cli.get("--default-ranges")->help += "; for clips that are known";
  cli.add("--audio-codec", options.codec,
          "aac or opus; default: that of the file, opus for --say, else aac")
      ->one_of("aac opus");
  cli.add("--audio-bitrate", options.program.coding.audio.bit_rate,
          "Bits per second of sound that is encoded; default: aac 64000, opus 40000")
      ->between(6000, 320000);
  cli.add("--audio-fec", options.audio_fec,
          "opus: percent of packets that receivers lose, 0..50; each has the one before it again, "
          "coarsely; auto: by their reports, for speech that is made while it is sent; not for "
          "sound that is Opus already")
      ->value("auto|PERCENT")
      ->check(problem_of<media::parse_expected_loss>)
      ->show_default();
}

void add_web_options(OptionTable& cli, web::WebOptions& options) {
  cli.add("--max-clients", options.max_clients,
          "http: most viewers at the same time, each with a face, sound or both")
      ->between(1, 1000)
      ->show_default();
  cli.add("--max-per-address", options.per_address,
          "http: most connections per client address, about two per viewer; 0: no limit, "
          "behind a proxy")
      ->between(0, 10000)
      ->show_default();
  add_guard_options(cli, options);
}

}  // namespace

void add_guard_options(OptionTable& cli, web::WebOptions& options) {
  cli.add("--allow-origin", options.allow_origins,
          "Origin of other web pages that may use the server, such as https://example.org; "
          "may be repeated; *: all")
      ->one_at_a_time();
  cli.add("--host-name", options.host_names,
          "Host name of the web server besides the names and addresses of the machine; may "
          "be repeated; *: any")
      ->one_at_a_time();
}

void add_rtc_options(OptionTable& cli, std::vector<std::string>& servers,
                     std::string& audio_repeat) {
  cli.add("--ice-server", servers,
          "Server that helps WebRTC through NAT: stun:HOST:PORT tells the public address of this "
          "machine, turn:USER:PASSWORD@HOST:PORT relays; one of each; a webrtc address has its own")
      ->value("URL")
      ->check([](const std::string& text) {
        webrtc::WebRtcOptions options;
        const auto added = webrtc::add_ice_server(text, options);
        return added ? std::string() : added.error().message;
      })
      ->one_at_a_time();
  cli.add("--audio-repeat", audio_repeat,
          "WebRTC: how many packets of sound go again with each, against loss (RFC 2198): auto, by "
          "what a browser reports; a webrtc address has its own")
      ->one_of("auto 0 1 2 3")
      ->show_default();
}

Result<void> use_rtc_options(const std::vector<std::string>& servers,
                             const std::string& audio_repeat, web::WebOptions& options) {
  if (servers.empty() && audio_repeat == "auto") return {};
  webrtc::WebRtcOptions settings;
  if (audio_repeat != "auto") settings.audio_repeat = audio_repeat.front() - '0';
  for (const std::string& server : servers) {
    if (auto ok = webrtc::add_ice_server(server, settings); !ok) return ok;
  }
  options.make_peer_connections = [settings] { return webrtc::make_peer_connections(settings); };
  return {};
}

void add_options(OptionTable& cli, StreamOptions& options) {
  add_source_options(cli, options);
  cli.add("--to", options.to,
          "Address: rtp://host:port, udp://host:port, srt://host:port; http://host:port to "
          "serve browsers, webrtc://host:port likewise by WebRTC; whip://host:port/path to a "
          "WebRTC server; for engines livelink://host:port, vmc://host:port, "
          "osc://host:port; may be repeated")
      ->required()
      ->one_at_a_time();
  cli.add("--sdp", options.sdp,
          "Write the session description of an rtp address, which receivers need")
      ->output(".sdp")
      ->one_at_a_time();
  cli.add("--mtu", options.sink.media.rtp.mtu, "Largest datagram in bytes")
      ->between(256, 65000)
      ->show_default();
  cli.add("--repeat", options.sink.media.rtp.repeat,
          "rtp: how many times each packet of the face is sent, against loss")
      ->between(1, 8)
      ->show_default();
  cli.add("--repeat-after", options.sink.media.rtp.repeat_after,
          "rtp: send a copy so many packets of the face after its original; larger values "
          "survive longer bursts of loss and add delay when a copy is needed")
      ->between(1, 50)
      ->show_default();
  cli.add("--bundle", options.sink.media.rtp.bundle,
          "rtp: planes per packet; larger values save headers and add delay")
      ->between(1, 16)
      ->show_default();
  add_web_options(cli, options.sink.web);
  add_rtc_options(cli, options.ice, options.audio_repeat);
  add_heads_options(cli, options.heads.heads, options.heads.rest);
  add_coding_options(cli, options);
  cli.add("--fast", options.fast, "Send as fast as possible instead of in real time");
  cli.add("--stats", options.stats, "Print statistics once per second");
  cli.add("--json", options.json, "Print a machine-readable summary at the end");
  add_track_option(cli, options.track);
  cli.show_in_help_all(
      "Voices, coding and transport",
      "--sdp --duration --tier --speaker --speak-marks --script-format --max-seconds --speed "
      "--pitch --liveliness "
      "--look --still --seed --no-tongue --hear-pcm --mtu --repeat --repeat-after "
      "--bundle --ice-server --audio-repeat --audio-fec --max-clients --max-per-address "
      "--allow-origin --host-name --delay "
      "--intra-seconds "
      "--points --shape-name --shape-names --gain --copy --quant --rms --kbps --small "
      "--default-ranges --encoder-delay --stats --keep --track --pcm --style --fast "
      "--sharpness "
      "--articulate --symmetric "
      "--audio-codec --audio-bitrate");
}

}  // namespace animeme::tools
