#include <cstdio>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "codec/encode/encode.h"
#include "dam/script/script.h"
#include "dam/speaking/synthesise.h"
#include "fap/rate_text.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/face_stream.h"
#include "tools/app/commands/face_text.h"
#include "tools/app/commands/idle_options.h"
#include "tools/app/commands/mood_options.h"
#include "tools/app/commands/motion_options.h"
#include "tools/app/commands/over_options.h"
#include "tools/app/commands/preview.h"
#include "tools/app/commands/speak_parts.h"
#include "tools/app/commands/speak_people.h"
#include "tools/app/commands/spoken_options.h"
#include "tools/app/commands/text_or_file.h"
#include "tools/formats/common/bit_rate.h"
#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"
#include "tools/formats/exchange/arkit.h"
#include "tools/formats/exchange/curves.h"
#include "tools/formats/files/cost.h"
#include "tools/formats/media/container.h"
#include "tools/speech/talking/marks.h"
#include "tools/speech/voice/pitch.h"

namespace animeme::tools {

namespace {

// The signal as it is, one column a control: for models of other rigs than FAPs.
Result<int> write_curves(const std::string& path, const dam::Signal& signal) {
  std::string text = exchange::write_curve_header(signal.names);
  for (std::size_t frame = 0; frame < signal.frames(); ++frame)
    text += exchange::write_curve_row(signal, frame);
  if (auto done = write_file(path, text); !done) return done.error();
  say(path + ": " + std::to_string(signal.frames()) + " frames of " +
      std::to_string(signal.names.size()) + " controls");
  return kOk;
}

// Curves of ARKit's shapes: those of the model, or fitted to its FAPs.
Result<int> write_arkit(const SpeakOptions& options, const dam::Signal& signal) {
  ProgressLine progress("fitting");
  const auto curves =
      exchange::arkit_of_signal(signal, [&](double done) { progress.update(done); });
  if (!curves) return not_faps(curves.error());
  progress.clear();
  const std::string sound = std::filesystem::path(options.spoken.audio).filename().string();
  const std::string text = extension_of(options.output) == ".json"
                               ? exchange::write_arkit_json(*curves, sound)
                               : exchange::write_live_link(*curves);
  if (auto done = write_file(options.output, text); !done) return done.error();
  say(options.output + ": " + std::to_string(curves->frames.size()) + " frames of 52 shapes, " +
      fap::format_rate(curves->rate) + " frames a second");
  return kOk;
}

Result<std::vector<std::uint8_t>> coded_clip(const fap::Sequence& clip,
                                             const StreamSettings& settings) {
  AtStep step(Step::coding);
  auto stream = encode_face(clip, encode_options(settings));
  if (stream) step.made(stream->size());
  return stream;
}

// A recording is written as it is, with both of its channels; what is listened to is one of them.
void give_sound(const SpeakOptions& options, const speech::Spoken& spoken, media::MuxInput& input) {
  if (options.coded) {
    input.encoded = options.coded.get();
  } else if (!spoken.recording.empty()) {
    input.audio_file = &spoken.recording;
  } else if (spoken.audio) {
    input.audio = &*spoken.audio;
  }
}

// The sound of --audio-codec copy.
Result<void> read_coded(SpeakOptions& options) {
  if (options.sound.codec != "copy") return {};
  Result<media::EncodedAudio> coded = media::read_encoded_audio(options.spoken.audio);
  if (!coded) return coded.error().in_file(options.spoken.audio);
  options.coded = std::make_shared<media::EncodedAudio>(std::move(*coded));
  return {};
}

Result<int> write_result(const SpeakOptions& options, const fap::Sequence& clip,
                         const speech::Spoken& spoken) {
  const std::string extension = extension_of(options.output);
  if (extension == ".fap") {
    FaceText face = face_text(clip);
    face.exact = options.exact;
    OutputFile file(options.output);
    const Result<std::int64_t> frames = write_face_text(file, options.output, face);
    if (!frames) return frames.error();
    if (auto done = file.publish(); !done) return done.error();
    say(options.output + ": " + std::to_string(*frames) + " frames, " +
        seconds_text(clip.duration()));
    return kOk;
  }
  if (extension == ".fba") {
    Result<std::vector<std::uint8_t>> stream = coded_clip(clip, options.stream);
    if (!stream) return stream.error();
    if (auto done = write_file(options.output, *stream); !done) return done.error();
    say(options.output + ": " + std::to_string(clip.frames.size()) + " planes, " +
        std::to_string(stream->size()) + " bytes, " + seconds_text(clip.duration()) +
        format(", %.2f kbit/s", kbit_per_s(stream->size(), clip.duration())));
    return kOk;
  }
  Result<fba::AccessUnits> units = access_units({clip, {}}, options.stream);
  if (!units) return units.error();
  if (!spoken.has_sound()) warn("there is no recorded voice (--audio): the file will be silent");
  media::MuxOptions mux;
  mux.audio = audio_settings(options.sound, options.output);
  mux.text_track = media::TextTrackType::metadata;
  std::vector<media::TextTrack> texts;
  if (!options.no_words && media::takes_text(options.output)) {
    texts = speech::carried_texts(spoken.script, language_of(options, spoken));
    if (shows_captions(options.output, options.subtitles)) speech::add_captions(texts);
  }
  media::MuxInput input{.face = &*units, .texts = &texts};
  give_sound(options, spoken, input);
  Result<int> written = write_media(options.output, input, mux, SoundState::reported);
  if (!written || *written != kOk || options.preview.empty()) return written;
  return write_preview(options.preview, *units, input);
}

speech::Doubts doubts_of(const speech::Spoken& spoken) {
  if (spoken.heard) return speech::doubts_of(spoken.script, spoken.heard->confidences);
  if (!spoken.alignment) return {};
  return speech::doubts_of(spoken.alignment->confidences, spoken.alignment->words);
}

void tell_replaced(const dam::SynthesisReport& synthesis) {
  for (const auto& [label, by] : synthesis.replaced) {
    say_more("the model has no phone " + label + ": it is spoken as " + by);
  }
}

// options.output, of a face that moves by the phones alone.
Result<int> write_output(const SpeakOptions& options, dam::Signal signal,
                         const speech::Spoken& spoken, ShownFace& shown) {
  if (auto added = add_life(options, signal, spoken, shown); !added) return added.error();
  if (is_arkit_output(options.output)) return write_arkit(options, signal);
  if (is_model_curves(options.output)) return write_curves(options.output, signal);
  const Result<fap::Sequence> clip = shown_clip(options, signal, spoken);
  if (!clip) return clip.error();
  return write_result(options, *clip, spoken);
}

// Finds out what the argument without an option is: a text, or a file of a kind that its extension
// tells. Returns a sentence about what is wrong, or an empty string.
std::string place_input(SpeakOptions& options) {
  speech::SpokenOptions& spoken = options.spoken;
  const std::string& input = options.input;
  std::string* place = &spoken.text;
  std::error_code none;
  if (!std::filesystem::exists(input, none)) {
    if (spoken.has_text)
      return "--text is one text too many beside '" + input + "'; give one of them";
    spoken.has_text = true;
  } else if (std::filesystem::is_directory(input, none)) {
    return input + " is a folder; a text of this name comes after --text";
  } else {
    switch (spoken_file(input)) {
      case SpokenFile::text:
        place = &spoken.text_file;
        break;
      case SpokenFile::recording:
        place = &spoken.audio;
        break;
      case SpokenFile::script:
        place = &spoken.script;
        break;
      case SpokenFile::other:
        return input + " is a file; give it after --text-file, --script or --audio";
    }
  }
  const bool was_given = !place->empty();
  *place = input;
  const int words = int(spoken.has_text) + int(!spoken.text_file.empty());
  if (was_given || words + int(!spoken.script.empty()) > 1) {
    return "'" + input + "' is one input too many beside --text-file, --script or --audio";
  }
  if (words > 0 && !spoken.audio.empty()) {
    return "what is said in a recording comes after --transcript: speak --audio voice.wav "
           "--transcript 'what she said'";
  }
  return {};
}

// What --min-confidence asks for: of every word of a transcript, of sound alone as a whole.
Result<void> check_confidence(const SpeakOptions& options, const speech::Spoken& spoken) {
  if (!options.least) return {};
  if (spoken.alignment) return check_words(*spoken.alignment, *options.least);
  if (!spoken.heard || spoken.heard->confidence >= *options.least) return {};
  return make_error(Code::out_of_range,
                    format("recognised with confidence %.2f, below --min-confidence; give a "
                           "transcript, or use a clearer recording",
                           spoken.heard->confidence));
}

}  // namespace

Result<int> run(SpeakOptions& options) {
  if (!options.input.empty()) {
    if (const std::string wrong = place_input(options); !wrong.empty()) return usage_error(wrong);
    if (options.input == options.spoken.text) {
      if (auto text = no_missing_file(options.input, "--text"); !text) return text.error();
    }
  }
  if (const std::string missing = missing_options(options.spoken); !missing.empty()) {
    return usage_error(missing);
  }
  if (options.sound.codec == "copy" && options.spoken.audio.empty()) {
    return usage_error("--audio-codec copy is for a recorded voice (--audio)");
  }
  for (const std::string& output : options.outputs) {
    const std::string extension = extension_of(output);
    const bool curves = extension == ".csv" || extension == ".json";
    if (!options.visemes.empty() && curves)
      return usage_error(
          "--visemes is for FAPs; export writes tables of visemes (talk.visemes.csv)");
    if (!options.expressions.empty() && curves)
      return usage_error("--expressions is for FAPs, which .csv and .json do not hold");
  }
  if (!options.spoken.tts.empty() && !options.spoken.script.empty() && options.fit.empty()) {
    return usage_error("--tts excludes --script, but for subtitles that it speaks with --fit");
  }
  if (!options.fit.empty()) {
    const auto range = speech::parse_fit_range(options.fit);
    if (!range) return range.error();
    options.spoken.fit = *range;
  }
  if (!options.cast.empty()) {
    if (const std::string wrong = problem_with_cast(options); !wrong.empty()) {
      return usage_error(wrong);
    }
  }
  Result<fap::Rate> rate = fap::parse_rate(options.rate);
  if (!rate) return rate.error();
  Result<dam::Model> model = speech::read_model(options.model);
  if (!model) return model.error();
  if (auto done = read_coded(options); !done) return done.error();
  if (!options.cast.empty()) return speak_people(options);
  if (auto done = read_over(options.over, options.performance, options.keep); !done) {
    return done.error();
  }
  ProgressLine progress("listening");
  speech::SpokenOptions source = options.spoken;
  source.sound_in_file = true;
  if (options.least && *options.least == 0) source.least_confidence = 0;
  source.heard = [&](double done) { progress.update(done); };
  Result<speech::Spoken> spoken = speech::get_spoken(source, terminal_log());
  progress.clear();
  if (!spoken) return spoken.error();
  if (auto sure = check_confidence(options, *spoken); !sure) {
    return sure.error().in_file(options.spoken.audio);
  }
  if (spoken->heard) {
    say_more(options.spoken.audio + ": " + std::to_string(spoken->script.phones.size()) +
             format(" phones recognised, confidence %.2f", spoken->heard->confidence));
  }

  dam::SynthesisOptions settings = options.motion;
  settings.rate = *rate;
  settings.closure = !options.no_closure;
  if (spoken->has_sound()) {
    settings.tail = std::max(0.0, spoken->sound_seconds() - spoken->script.duration());
  }
  dam::SynthesisReport synthesis;
  Result<dam::Signal> signal = speech::move_face(*model, *spoken, settings, &synthesis);
  if (!signal) {
    return signal.error().in_file(spoken->heard ? options.spoken.audio : options.spoken.script);
  }
  Result<int> written = kOk;
  ShownFace shown;
  shown.frames = signal->frames();
  shown.seconds = signal->rate.seconds(double(signal->frames()));
  SpeakOptions one = options;
  if (options.idle.on.value_or(true)) {
    one.prosody = std::move(spoken->prosody);
    if (spoken->audio) one.prosody = voice::measure_prosody(*spoken->audio);
  }
  for (const std::string& output : options.outputs) {
    one.output = output;
    const bool last = &output == &options.outputs.back();
    written = write_output(one, last ? std::move(*signal) : *signal, *spoken, shown);
    if (!written || *written != kOk) return written;
  }
  // Last, so that a failure leaves no file behind.
  if (!options.save_script.empty()) {
    const std::string text = speech::write_marked_script(
        spoken->script, spoken->marks, extension_of(options.save_script), doubts_of(*spoken));
    if (auto done = write_file(options.save_script, text); !done) return done.error();
  }
  tell_replaced(synthesis);
  if (options.json || !options.report.empty()) {
    auto done = give_report(options, report_json(options, *spoken, synthesis, shown));
    if (!done) return done.error();
  }
  return written;
}

void add_options(OptionTable& cli, SpeakOptions& options) {
  options.spoken.listen = true;
  cli.add("text", options.input,
          "Text to speak; or a file with a text, a script or a recorded voice, as after "
          "--text-file, --script and --audio")
      ->value("TEXT");
  add_spoken_options(cli, options.spoken);
  cli.get("--transcript")->needed.clear();   // the recording may be `text`
  cli.get("--tts")->excluded = {"--audio"};  // with --fit it speaks a script
  cli.add("-o,--output", options.outputs,
          "File to write; may be repeated: .mp4 .mkv .ts .m3u8 .mpd (face and sound), .fba "
          "(stream), .fap (text), .csv (curves of the model), .livelink.csv (Live Link "
          "Face), .json (ARKit blend shapes)")
      ->output(".mp4 .mkv .ts .m3u8 .mpd .fba .fap .csv .json", OutputKind::file)
      ->required()
      ->one_at_a_time();
  cli.add("--model", options.model, "Model file of a character; default: the built-in model");
  cli.add("--rate", options.rate, "Frames per second: 25, 29.97, 60 ...")
      ->frame_rate()
      ->show_default();
  cli.add("--save-script", options.save_script,
          "Also write the timed phones (.TextGrid, .tsv, .pho) or captions (.vtt, .srt); a "
          "TextGrid of a recording has tiers of confidences and of doubtful parts")
      ->output(joined(dam::script_endings(), " "), OutputKind::file);
  add_motion_options(cli, options.motion);
  cli.add("--no-closure", options.no_closure,
          "Do not force lip closure on p, b, m and lip-teeth contact on f, v");
  add_idle_options(cli, options.idle, "default: on, but not for curves of the model (.csv)");
  add_tongue_option(cli, options.tongue);
  add_mood_option(cli, options.mood);
  add_over_options(cli, options.over, true);
  cli.add("--fit", options.fit,
          "Speak the subtitles of --script with a voice, or put those that --audio says into their "
          "times, at 0.8-1.3 of its usual speed (or another range); what does not fit is reported")
      ->value("SLOWEST-FASTEST")
      ->check(problem_of<speech::parse_fit_range>)
      ->needs("--script");
  add_cast_options(cli, options);
  cli.add(
         "--expressions", options.expressions,
         "Also code moods as FAP 2, for players that support only that: 'instead' of brows, cheeks "
         "and nose, or 'beside' them")
      ->value("PLACE")
      ->one_of("instead beside");
  cli.add("--visemes", options.visemes,
          "Also set FAP 1, for players that only support visemes: 'instead' of jaw, lips and "
          "tongue, or 'beside' them")
      ->value("PLACE")
      ->one_of("instead beside");
  cli.add("--no-words", options.no_words,
          "Leave words and phones out of .mp4, .mkv and .m3u8, where view, plot, export and demux "
          "read them");
  add_subtitles_option(cli, options.subtitles);
  cli.get("--lang")->sets(options.language_told);
  add_exact_option(cli, options.exact);
  add_stream_options(cli, options.stream);
  add_preview_option(cli, options.preview);
  add_sound_options(cli, options.sound, true);
  cli.add("--min-confidence", options.least,
          "Write nothing and fail if a recording is recognised, or a word of its transcript is "
          "found, "
          "with a lower confidence, 0 to 1; 0: accept any transcript")
      ->between(0.0, 1.0);
  cli.add("--json", options.json, "Print a machine-readable summary");
  cli.add("--report", options.report, "Also write what --json prints to a file")
      ->output(".json", OutputKind::file);
  cli.show_in_help_all("Details of coding and alignment",
                       "--rms --kbps --default-ranges --intra-seconds --audio-codec "
                       "--audio-bitrate --exact --min-confidence "
                       "--no-tongue --symmetric --visemes --expressions --look --still --seed "
                       "--keep --bend --fit --turns "
                       "--report --speak-marks --script-format --no-closure --max-seconds");
}

const Command kSpeak{
    "speak", "Animate a face from text, a recorded voice, or timed phones",
    "  animeme speak \"Hello world\" -o hello.mp4\n"
    "  animeme speak --audio voice.wav --transcript \"what she said\" -o talk.mp4\n"
    "  animeme speak --text Hello --tts \"piper -m en.onnx -f {wav}\" -o hello.mp4   # external "
    "TTS\n"
    "  animeme speak --script voice.TextGrid --audio voice.wav --model me.dam -o talk.fba\n"
    "  animeme speak --script two.vtt --fit 0.8-1.3 --cast all -o two.mp4",
    set_up<SpeakOptions>};

}  // namespace animeme::tools
