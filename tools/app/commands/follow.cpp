// A face that follows a voice which is still being made.
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "dam/speaking/stream.h"
#include "fap/rate_text.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/motion_options.h"
#include "tools/formats/common/json.h"
#include "tools/formats/exchange/curves.h"
#include "tools/speech/talking/phone_line.h"
#include "tools/speech/talking/sound_bytes.h"
#include "tools/speech/talking/spoken.h"
#include "tools/speech/talking/voice_driven_face.h"

namespace animeme::tools {

namespace {

struct FollowOptions {
  std::string model;
  std::string rate = "25";
  dam::SynthesisOptions motion;
  double look_ahead = -1;
  std::string audio;
  std::string pcm;
  std::string language = "en";
  double delay = speech::VoiceDrivenFaceOptions().delay;
  LengthLimit length;
  bool json = false;
};

Error in_line(std::int64_t line, const std::string& what) {
  return Error{Code::syntax, what, {"standard input", line, 0, -1}};
}

// A line that never ends is none.
Result<bool> next_line(std::istream& in, std::string& line) {
  constexpr std::streamsize kMostOfLine = 4096;
  std::array<char, kMostOfLine> buffer{};
  if (!in.getline(buffer.data(), kMostOfLine)) {
    if (in.eof() || in.gcount() + 1 < kMostOfLine) return false;
    return make_error(Code::syntax, "a line of more than 4 kB is not a phone");
  }
  line = buffer.data();
  return true;
}

// As a table of curves, or as an object per line.
Result<void> print_rows(const dam::Signal& signal, bool json) {
  for (std::size_t frame = 0; frame < signal.frames(); ++frame) {
    if (!json) {
      std::fputs(exchange::write_curve_row(signal, frame).c_str(), stdout);
      continue;
    }
    Json controls = Json::object();
    for (std::size_t c = 0; c < signal.names.size(); ++c) {
      controls[signal.names[c]] = signal.at(frame, c);
    }
    const Json row = {{"time_s", signal.time(frame)}, {"controls", controls}};
    std::printf("%s\n", row.dump().c_str());
  }
  if (std::fflush(stdout) == 0) return {};
  return make_error(Code::io, "the curves cannot be written: nobody reads standard output");
}

void print_header(const dam::Model& model) {
  std::vector<std::string> names;
  for (const dam::Control& control : model.controls) names.push_back(control.name);
  std::fputs(exchange::write_curve_header(names).c_str(), stdout);
  std::fflush(stdout);
}

// A file that is closed, unless it is standard input.
struct Descriptor {
  int number = -1;
  ~Descriptor() {
    if (number > STDIN_FILENO) ::close(number);
  }
};

// The sound as it comes: a pipe gives what there is.
Result<int> follow_sound(const FollowOptions& options, const dam::Model& model,
                         const fap::Rate& rate) {
  std::optional<speech::BareSound> bare;
  if (!options.pcm.empty()) {
    auto parsed = speech::parse_bare_sound(options.pcm);
    if (!parsed) return parsed.error();
    bare = *parsed;
  }
  const std::string name = options.audio == "-" ? "standard input" : options.audio;
  const Descriptor from{options.audio == "-" ? STDIN_FILENO
                                             : ::open(options.audio.c_str(), O_RDONLY | O_CLOEXEC)};
  if (from.number < 0) return make_error(Code::not_found, "it cannot be opened").in_file(name);
  speech::SoundBytes sound(bare);
  std::unique_ptr<speech::VoiceDrivenFace> face;
  const auto open = [&](int sample_rate) -> Result<void> {
    speech::VoiceDrivenFaceOptions settings;
    settings.synthesis = options.motion;
    settings.synthesis.rate = rate;
    settings.language = options.language;
    settings.delay = options.delay;
    auto opened = speech::VoiceDrivenFace::open(model, sample_rate, settings);
    if (!opened) return opened.error();
    face = std::move(*opened);
    return {};
  };
  // Tables are read before there is a voice that waits, where its rate is known.
  if (bare) {
    if (auto ok = open(bare->sample_rate); !ok) return ok.error();
  }
  if (!options.json) print_header(model);
  std::array<std::uint8_t, 8192> bytes;
  std::vector<float> samples;
  std::uint64_t count = 0;
  for (;;) {
    const ssize_t got = ::read(from.number, bytes.data(), bytes.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return make_error(Code::io, "it cannot be read").in_file(name);
    if (got == 0) break;
    samples.clear();
    if (auto ok = sound.push(std::span(bytes).first(std::size_t(got)), samples); !ok) {
      return ok.error().in_file(name);
    }
    if (samples.empty()) continue;
    count += samples.size();
    if (!face) {
      if (auto ok = open(sound.sample_rate()); !ok) return ok.error();
    }
    face->push(samples);
    const auto signal = face->pull();
    if (!signal) return signal.error();
    if (auto ok = print_rows(*signal, options.json); !ok) return ok.error();
  }
  if (count == 0) {
    return make_error(Code::truncated, "it ended before there was any sound").in_file(name);
  }
  const auto signal = face->finish();
  if (!signal) return signal.error();
  if (auto ok = print_rows(*signal, options.json); !ok) return ok.error();
  say_more(name + ": " + std::to_string(count) + " samples");
  return kOk;
}

Result<int> run(const FollowOptions& options) {
  Result<fap::Rate> rate = fap::parse_rate(options.rate);
  if (!rate) return rate.error();
  Result<dam::Model> model = speech::read_model(options.model);
  if (!model) return model.error();
  if (!options.audio.empty()) return follow_sound(options, *model, *rate);
  dam::StreamOptions settings;
  settings.synthesis = options.motion;
  settings.synthesis.rate = *rate;
  if (options.look_ahead >= 0) settings.look_ahead = options.look_ahead;
  dam::SpeechStream stream(*model, settings);
  if (!options.json) print_header(*model);
  std::string text;
  double known = 0;  // seconds
  for (std::int64_t line = 1;; ++line) {
    const Result<bool> more = next_line(std::cin, text);
    if (!more) return in_line(line, more.error().message);
    if (!*more) break;
    const auto phone = speech::parse_phone_line(text);
    if (!phone) return in_line(line, phone.error().message);
    if (!*phone) continue;
    if ((*phone)->end - known > options.length.of_script()) {
      return in_line(line, "the phone ends " + std::to_string(std::llround((*phone)->end - known)) +
                               " s after the last one; correct the times or allow more "
                               "(--max-seconds)");
    }
    known = (*phone)->end;
    if (auto ok = stream.push(**phone); !ok) return in_line(line, ok.error().message);
    Result<dam::Signal> signal = stream.pull();
    if (!signal) return signal.error();
    if (auto ok = print_rows(*signal, options.json); !ok) return ok.error();
  }
  Result<dam::Signal> signal = stream.finish();
  if (!signal) return signal.error();
  if (auto ok = print_rows(*signal, options.json); !ok) return ok.error();
  return kOk;
}

void add_options(OptionTable& cli, FollowOptions& options) {
  cli.add("--model", options.model, "Model file of a character; default: the built-in model");
  cli.add("--rate", options.rate, "Frames per second: 25, 29.97, 60 ...")
      ->frame_rate()
      ->show_default();
  add_motion_options(cli, options.motion);
  cli.add("--max-seconds", options.length.seconds, "Longest phone, or gap before one")
      ->value("SECONDS=3600")
      ->between(1.0, dam::kMaxScriptSeconds);
  cli.add("--look-ahead", options.look_ahead,
          "Seconds of phones to wait for before a frame is printed; default: until it is "
          "final (about half a second)")
      ->between(0.0, 60.0);
  cli.add("--audio", options.audio,
          "Follow a voice instead of phones: WAV from - (standard input), a pipe, a file")
      ->value("FILE")
      ->excludes("--look-ahead --max-seconds");
  cli.add("--pcm", options.pcm,
          "The sound is raw 16-bit little-endian PCM of this rate: 16000, or 48000:2 (two "
          "channels)")
      ->value("RATE[:CHANNELS]")
      ->check(problem_of<speech::parse_bare_sound>)
      ->needs("--audio");
  cli.add("--delay", options.delay, "Seconds of sound to wait for before a frame is printed")
      ->value("0.08..2=0.25")
      ->between(0.08, 2.0)
      ->needs("--audio");
  cli.add("--lang", options.language, "Language of the voice: en, or any other")
      ->value("LANG=en")
      ->needs("--audio");
  cli.add("--json", options.json, "Print a JSON object per frame instead of a table");
}

}  // namespace

const Command kFollow{
    "follow", "Animate a face while phones or sound arrive: prints curves line by line",
    "  animeme follow --audio voice.wav > curves.csv\n"
    "  my_tts --phones | animeme follow --model me.dam | my_player\n"
    "  printf '0 0.3 SIL\\n0.3 0.42 HH\\n0.42 0.6 AY\\n' | animeme follow --look-ahead 0.1\n"
    "  arecord -q -f S16_LE -r 16000 | animeme follow --audio - | my_player\n"
    "  ffmpeg -v error -i voice.mp3 -f wav - | animeme follow --audio - | my_player",
    set_up<FollowOptions>};

}  // namespace animeme::tools
