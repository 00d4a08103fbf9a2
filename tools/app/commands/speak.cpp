#include <cstdio>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "codec/encode/encode.h"
#include "dam/script/script.h"
#include "dam/signal/closure.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/idle_motion.h"
#include "dam/speaking/moods.h"
#include "dam/speaking/synthesise.h"
#include "dam/speaking/tongue.h"
#include "dam/speaking/viseme_track.h"
#include "fap/rate_text.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/face_stream.h"
#include "tools/app/commands/face_text.h"
#include "tools/app/commands/idle_options.h"
#include "tools/app/commands/mood_options.h"
#include "tools/app/commands/motion_options.h"
#include "tools/app/commands/over_options.h"
#include "tools/app/commands/preview.h"
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

struct SpeakOptions {
  std::string input;  // a text, or a file
  speech::SpokenOptions spoken;
  std::vector<std::string> outputs;
  std::string output;  // of those, the one that is written
  std::string preview;
  std::string model;
  std::string rate = "25";
  std::string save_script;
  std::string report;  // file of --report
  StreamSettings stream;
  SoundSettings sound;
  dam::SynthesisOptions motion;
  bool no_closure = false;
  IdleOptions idle;  // neither on nor off: where it can be had
  OverChoice over;
  std::string fit;                                      // range of --fit
  std::shared_ptr<const dam::Performance> performance;  // of --over
  dam::KeptShares keep;
  std::optional<dam::Prosody> prosody;  // of the voice, for it
  bool exact = false;
  std::string visemes, expressions;  // where FAP 1 and 2 go
  std::string mood;
  bool tongue = true;
  bool no_words = false;
  bool subtitles = false;
  bool language_told = false;
  std::optional<double> least;  // confidence
  bool json = false;
  std::shared_ptr<const media::EncodedAudio> coded;  // of --audio-codec copy
};

// A model of another rig can only be written as curves.
Error not_faps(const Error& error) {
  if (error.code != Code::not_found) return error;
  return make_error(Code::not_found,
                    "the controls of this model are neither FAPs nor ARKit blend shapes; write "
                    "them as curves with -o NAME.csv");
}

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

// talk.json, and talk.livelink.csv beside talk.csv, which has the controls of the model.
bool is_arkit_output(const std::string& path) {
  const std::string inner = extension_of(std::filesystem::path(path).stem().string());
  return extension_of(path) == ".json" || (extension_of(path) == ".csv" && inner == ".livelink");
}

// Of the words. A script may be in any, whatever the default of --lang is.
std::string language_of(const SpeakOptions& options, const speech::Spoken& spoken) {
  if (!spoken.languages.empty()) return spoken.languages.front().language;
  const bool script = !options.spoken.script.empty() && options.spoken.tts.empty();
  return script && !options.language_told ? std::string() : options.spoken.language;
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

// Phones inside words, or all of them, lie where they usually do instead of where they were heard.
bool is_approximate(const speech::Spoken& spoken) {
  return spoken.times == speech::TimesFrom::words ||
         (spoken.alignment && spoken.alignment->approximate);
}

Json confidence_of(const speech::Spoken& spoken) {
  if (spoken.heard) return spoken.heard->confidence;
  return spoken.alignment ? Json(spoken.alignment->confidence) : Json(nullptr);
}

Json doubtful_words(const speech::Spoken& spoken) {
  Json list = Json::array();
  if (!spoken.alignment) return list;
  for (const voice::AlignedWord& word : spoken.alignment->words) {
    if (word.confidence >= voice::kDoubtful) continue;
    list.push_back({{"word", word.text},
                    {"start", word.start},
                    {"end", word.end},
                    {"confidence", word.confidence}});
  }
  return list;
}

speech::Doubts doubts_of(const speech::Spoken& spoken) {
  if (spoken.heard) return speech::doubts_of(spoken.script, spoken.heard->confidences);
  if (!spoken.alignment) return {};
  return speech::doubts_of(spoken.alignment->confidences, spoken.alignment->words);
}

struct RecognisedPhone {
  dam::Phone phone;
  double confidence = 0;
};

std::vector<RecognisedPhone> heard_phones(const speech::Spoken& spoken) {
  std::vector<RecognisedPhone> all;
  for (std::size_t i = 0; i < spoken.script.phones.size(); ++i) {
    all.push_back({spoken.script.phones[i], spoken.heard->confidences[i]});
  }
  return all;
}

Json numbers_of(const fap::Mask& faps) {
  Json list = Json::array();
  for (std::size_t fap = 1; fap < faps.size(); ++fap)
    if (faps[fap]) list.push_back(fap);
  return list;
}

Json language_json(const voice::SpokenLanguage& part) {
  return {{"start", part.start}, {"end", part.end},   {"language", part.language},
          {"voice", part.voice}, {"text", part.text}, {"by_itself", part.by_itself}};
}

// P, B and M of a part of the speech, and how many of them close the lips.
struct ClosedLips {
  std::size_t phones = 0, closed = 0;
};

// Of the face as it is shown, with all that lies over the speech.
struct LipClosures {
  std::vector<std::pair<double, bool>> phones;  // middle in seconds, closed

  ClosedLips between(double start, double end) const {
    ClosedLips count;
    for (const auto& [time, closed] : phones) {
      if (time < start || time >= end) continue;
      ++count.phones;
      count.closed += closed ? 1 : 0;
    }
    return count;
  }
};

// nullopt: the signal has no lips of FAPs.
std::optional<LipClosures> lip_closures_of(const dam::Signal& signal, const dam::Script& script) {
  const auto lips = dam::inner_lip_channels(signal.names);
  if (!lips) return {};
  LipClosures all;
  for (const dam::Phone& phone : script.phones) {
    if (!dam::is_bilabial(phone.label)) continue;
    const dam::FrameSpan span = dam::frames_near(signal, phone, dam::kClosureSearch);
    bool closed = false;
    for (std::size_t frame = span.first; frame < span.last; ++frame)
      closed = closed || dam::inner_gap(signal, frame, *lips) < dam::kClosedGap;
    all.phones.emplace_back((phone.start + phone.end) / 2, closed);
  }
  return all;
}

Json closures_json(const std::optional<LipClosures>& lips, double start, double end) {
  if (!lips) return {};
  const ClosedLips count = lips->between(start, end);
  return {{"phones", count.phones}, {"closed", count.closed}};
}

// What is told of the face that was written first.
struct ShownFace {
  std::size_t frames = 0;
  double seconds = 0;
  std::optional<dam::OverReport> over;
  std::optional<LipClosures> lips;
};

Json cue_json(const speech::FittedCue& one, const ShownFace& shown) {
  return {{"text", one.cue.text},
          {"start", one.cue.start},
          {"end", one.cue.end},
          {"said", one.start},
          {"seconds", one.seconds},
          {"speed", one.speed},
          {"late", one.late},
          {"pauses_cut", one.shortened},
          {"cut_characters", one.cut},
          {"confidence", one.confidence ? Json(*one.confidence) : Json(nullptr)},
          {"closures", closures_json(shown.lips, one.start, one.start + one.seconds)}};
}

Json over_json(const dam::OverReport& over) {
  return {{"end", over.end},
          {"moments", json_list(over.time.moments(),
                                [](const dam::BentMoment& one) -> Json {
                                  return {{"time", one.time}, {"source", one.source}};
                                })},
          {"kept", numbers_of(over.kept)},
          {"filled", numbers_of(over.filled)}};
}

Json report_json(const SpeakOptions& options, const speech::Spoken& spoken,
                 const dam::SynthesisReport& synthesis, const ShownFace& shown) {
  Json replaced = Json::object();
  for (const auto& [label, by] : synthesis.replaced) replaced[label] = by;
  const bool heard = spoken.heard.has_value();
  Json json = {{"output", options.outputs.front()},
               {"voice", spoken.voice},
               {"times", speech::name_of(spoken.times)},
               {"approximate", is_approximate(spoken)},
               {"confidence", confidence_of(spoken)},
               {"doubtful_words", doubtful_words(spoken)},
               {"seconds", shown.seconds},
               {"frames", shown.frames},
               {"phones", synthesis.phones},
               {"replaced_phones", synthesis.replaced_phones},
               {"replaced", replaced},
               {"closures_forced", synthesis.closures},
               {"lip_tooth_forced", synthesis.lip_tooth_contacts},
               {"closures", closures_json(shown.lips, 0, 1e9)},
               {"recognised", heard},
               {"languages", json_list(spoken.languages, language_json)},
               {"marks", json_list(spoken.marks,
                                   [](const voice::SpeechMark& mark) -> Json {
                                     return {{"time", mark.time}, {"name", mark.name}};
                                   })},
               {"warnings", spoken.warnings}};
  if (options.outputs.size() > 1) json["outputs"] = options.outputs;
  if (shown.over) json["over"] = over_json(*shown.over);
  if (!spoken.cues.empty()) {
    json["cues"] = json_list(
        spoken.cues, [&](const speech::FittedCue& one) -> Json { return cue_json(one, shown); });
  }
  if (heard) {
    json["warnings"] = spoken.heard->warnings;
    json["heard"] = json_list(heard_phones(spoken), [](const RecognisedPhone& one) -> Json {
      return {{"start", one.phone.start},
              {"end", one.phone.end},
              {"phone", one.phone.label},
              {"confidence", one.confidence}};
    });
    json["words"] = json_list(spoken.heard->words, [](const voice::RecognisedWord& one) -> Json {
      return {{"word", one.text},
              {"start", one.start},
              {"end", one.end},
              {"confidence", one.confidence}};
    });
  }
  return json;
}

// A file beside an output names it without the folder, which may be moved.
std::string name_beside(const std::string& output, const std::string& file) {
  const std::filesystem::path path(output);
  return path.parent_path() == std::filesystem::path(file).parent_path() ? path.filename().string()
                                                                         : output;
}

Result<void> report(const SpeakOptions& options, const speech::Spoken& spoken,
                    const dam::SynthesisReport& synthesis, const ShownFace& shown) {
  for (const auto& [label, by] : synthesis.replaced) {
    say_more("the model has no phone " + label + ": it is spoken as " + by);
  }
  if (!options.json && options.report.empty()) return {};
  Json json = report_json(options, spoken, synthesis, shown);
  if (options.json) std::printf("%s\n", pretty(json).c_str());
  if (options.report.empty()) return {};
  json["output"] = name_beside(options.outputs.front(), options.report);
  if (json.contains("outputs")) {
    for (Json& one : json["outputs"]) one = name_beside(one.text(), options.report);
  }
  return write_file(options.report, pretty(json) + "\n");
}

// options.output, of a face that moves by the phones alone. `shown` receives what it looks like.
Result<int> write_output(const SpeakOptions& options, dam::Signal signal,
                         const speech::Spoken& spoken, ShownFace& shown) {
  // Curves belong to the model's rig, and players of visemes have no brows.
  const bool curves = extension_of(options.output) == ".csv" && !is_arkit_output(options.output);
  const bool plain = curves || options.visemes == "instead";
  // A lossless stream cannot hold a tongue that curls: FAP 47 goes far beyond 1860 units.
  if (options.tongue && !plain && options.stream.quant > 0) dam::add_tongue(signal, spoken.script);
  const bool lives = options.idle.on.value_or(!plain);
  // Without being asked: where the names of a rig are not known, writing will say what it needs.
  dam::IdleMotionOptions idle = options.idle.motion;
  if (options.prosody) idle.prosody = &*options.prosody;
  // Without quantisation, angles end at one degree.
  if (options.stream.quant == 0) idle.still.gaze = idle.still.head = true;
  if (options.performance) {
    dam::OverOptions settings{options.keep, options.over.bend};
    settings.idle = lives ? std::optional(idle) : std::nullopt;
    auto put = dam::speak_over(signal, spoken.script, *options.performance, settings);
    if (!put) return put.error();
    shown.over = std::move(*put);
  } else if (!plain || lives) {
    if (!lives) idle.liveliness = 0;
    auto added = dam::add_idle_motion(signal, spoken.script, idle);
    if (!added && options.idle.on.value_or(false)) return added.error();
  }
  // The performance has moods of its own.
  const bool own_moods = !options.performance || !options.mood.empty();
  const dam::MoodTrack moods(mood_of(options.mood), own_moods ? std::span(spoken.moods)
                                                              : std::span<const dam::MoodSpan>());
  if (!curves || !options.mood.empty()) {
    auto added = dam::add_moods(signal, spoken.script, moods);
    if (!added && !options.mood.empty()) return added.error();
  }
  if (!shown.lips) shown.lips = lip_closures_of(signal, spoken.script);
  if (is_arkit_output(options.output)) return write_arkit(options, signal);
  if (curves) return write_curves(options.output, signal);
  Result<fap::Sequence> clip = dam::to_sequence(signal);
  if (!clip) return not_faps(clip.error());
  clip->name = std::filesystem::path(options.output).stem().string();
  if (!options.visemes.empty()) {
    const bool instead = options.visemes == "instead";
    dam::show_visemes(spoken.script, *clip,
                      instead ? dam::VisemePlace::instead : dam::VisemePlace::beside);
  }
  if (!options.expressions.empty()) {
    const bool instead = options.expressions == "instead";
    dam::show_expressions(moods, *clip,
                          instead ? dam::ExpressionPlace::instead : dam::ExpressionPlace::beside);
  }
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
  Result<fap::Rate> rate = fap::parse_rate(options.rate);
  if (!rate) return rate.error();
  Result<dam::Model> model = speech::read_model(options.model);
  if (!model) return model.error();
  if (auto done = read_coded(options); !done) return done.error();
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
  if (auto done = report(options, *spoken, synthesis, shown); !done) return done.error();
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
  cli.show_in_help_all(
      "Details of coding and alignment",
      "--rms --kbps --default-ranges --intra-seconds --audio-codec "
      "--audio-bitrate --exact --min-confidence "
      "--no-tongue --visemes --expressions --look --still --seed --keep --bend --fit --report");
}

}  // namespace

const Command kSpeak{
    "speak", "Animate a face from text, a recorded voice, or timed phones",
    "  animeme speak \"Hello world\" -o hello.mp4\n"
    "  animeme speak --audio voice.wav --transcript \"what she said\" -o talk.mp4\n"
    "  animeme speak --text Hello --tts \"piper -m en.onnx -f {wav}\" -o hello.mp4   # external "
    "TTS\n"
    "  animeme speak --script voice.TextGrid --audio voice.wav --model me.dam -o talk.fba",
    set_up<SpeakOptions>};

}  // namespace animeme::tools
