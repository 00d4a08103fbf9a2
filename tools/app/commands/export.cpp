// Motion for other programs: what they know are ARKit's shapes, visemes, mouth shapes or glTF.
#include <filesystem>

#include "fap/rate_text.h"
#include "fap/turns.h"
#include "tools/app/commands/avatar_export.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/export_options.h"
#include "tools/app/commands/head_options.h"
#include "tools/app/commands/report.h"
#include "tools/app/commands/said_visemes.h"
#include "tools/app/commands/script_options.h"
#include "tools/app/commands/track_option.h"
#include "tools/formats/exchange/arkit.h"
#include "tools/formats/exchange/visemes.h"
#include "tools/formats/media/container.h"
#include "tools/speech/talking/spoken.h"
#include "tools/view/gltf/glb.h"

namespace animeme::tools {

namespace {

// Options that were given for nothing, in a sentence; empty: there are none.
std::string idle_options(const ExportOptions& options, const std::string& what, bool from_script) {
  const auto given = [](const std::vector<const Option*>& list) {
    for (const Option* option : list) {
      if (option->given()) return option->name();
    }
    return std::string();
  };
  if (const std::string name = given(options.of_heads); what != "head" && !name.empty()) {
    return name + " is for a head (.glb)";
  }
  if (const std::string name = given(options.of_scripts); !from_script && !name.empty()) {
    return name + " is for visemes of a phoneme script; a face has its own times";
  }
  return {};
}

// What a name like talk.visemes.json asks for.
std::string what_of(const ExportOptions& options, bool from_script) {
  if (!options.what.empty()) return options.what;
  if (!options.format.empty()) return "rhubarb";
  const std::string extension = extension_of(options.output);
  const std::string inner = extension_of(std::filesystem::path(options.output).stem().string());
  if (inner == ".talkinghead") return "talkinghead";
  if (inner == ".rhubarb" || extension == ".tsv" || extension == ".xml" || extension == ".dat") {
    return "rhubarb";
  }
  if (is_head_output(options.output)) return "head";
  if (inner == ".visemes" || from_script) return "visemes";
  return "arkit";
}

// Empty if `what` can be written with this extension.
std::string wrong_extension(const std::string& what, const std::string& path) {
  const std::string extension = extension_of(path);
  if (what == "head") {
    if (is_head_output(path)) return {};
    return "--output must end in .glb (.gltf, .vrm, .vrma) for a head, not " + path;
  }
  if (what == "talkinghead") {
    return extension == ".json" ? "" : "--output must end in .json for talkinghead, not " + path;
  }
  const bool of_rhubarb = extension == ".tsv" || extension == ".xml" || extension == ".dat";
  if (extension == ".json" || (what == "rhubarb" ? of_rhubarb : extension == ".csv")) return {};
  const char* wanted = what == "rhubarb"   ? ".tsv, .xml, .json or .dat"
                       : what == "visemes" ? ".csv or .json"
                                           : ".csv (Live Link Face), .json or .glb";
  return "--output must end in " + std::string(wanted) + " for " + what + ", not " + path;
}

exchange::ArkitCurves to_arkit(const fap::Sequence& clip) {
  ProgressLine progress("fitting");
  return exchange::fit_arkit(clip, [&](double done) { progress.update(done); });
}

Result<fap::Sequence> read_filled(const ExportOptions& options, std::vector<std::uint8_t> bytes,
                                  bool keep_high_level) {
  Result<FaceInput> input = parse_face(std::move(bytes), options.input);
  if (!input) return input.error();
  fap::FillOptions filling;
  filling.interpolate = filling.complete = true;
  filling.keep_high_level = keep_high_level;
  return shown_face(*input, options.input, filling, options.length);
}

Result<int> write_arkit(const ExportOptions& options, std::vector<std::uint8_t> bytes) {
  const Result<fap::Sequence> clip = read_filled(options, std::move(bytes), false);
  if (!clip) return clip.error();
  const exchange::ArkitCurves curves = to_arkit(*clip);
  const std::string sound = std::filesystem::path(options.audio).filename().string();
  const bool csv = extension_of(options.output) == ".csv";
  const std::string text =
      csv ? exchange::write_live_link(curves) : exchange::write_arkit_json(curves, sound);
  if (auto written = write_file(options.output, text); !written) return written.error();
  const std::string rate = fap::format_rate(curves.rate);
  report_output(
      options.output,
      std::to_string(curves.frames.size()) + " frames of 52 shapes, " + rate + " frames per second",
      {{"frames", curves.frames.size()}, {"rate", rate}});
  return kOk;
}

speech::ScriptInput input_of(const ExportOptions& options) {
  speech::ScriptInput input = options.reading;
  input.most_seconds = options.length.of_script();
  return input;
}

// For animations, turns are eased between the steps of the coder.
Result<fap::Sequence> eased_face(const FaceInput& input, const std::string& path,
                                 const fap::FillOptions& filling, const LengthLimit& length) {
  Result<fap::Sequence> clip = shown_face(input, path, filling, length);
  if (clip) fap::smooth_turns(*clip);
  return clip;
}

// A head of the user's own: its file, with the clips in it.
Result<int> write_avatar(const ExportOptions& options, std::vector<std::uint8_t> bytes) {
  AvatarExport job{options.head, options.output, options.audio, options.sounds, {}};
  ExportOptions each = options;
  for (std::size_t i = 0; i <= options.more.size(); ++i) {
    if (i > 0) {
      each.input = options.more[i - 1];
      auto next = read_input(each.input);
      if (!next) return next.error();
      bytes = std::move(*next);
    }
    auto input = parse_face(std::move(bytes), each.input);
    if (!input) return input.error();
    fap::FillOptions filling;
    filling.interpolate = filling.complete = filling.keep_expressions = true;
    auto clip = eased_face(*input, each.input, filling, options.length);
    if (!clip) return clip.error();
    const auto script = script_for(options.script, {each.input}, input_of(options));
    if (!script) return script.error();
    auto visemes = said_visemes(*input, *clip, *script, options.mouth);
    job.clips.push_back({each.input, input->start, std::move(*clip), std::move(visemes)});
  }
  return export_avatar(job);
}

Result<int> write_head(const ExportOptions& options, std::vector<std::uint8_t> bytes) {
  if (moves_by_itself(options.head)) return write_avatar(options, std::move(bytes));
  if (!options.sounds.empty()) {
    return usage_error("--sound is for your own head (.glb, .vrm); --audio names a sound");
  }
  if (const std::string wrong = problem_of_built_head(options.output, options.head);
      !wrong.empty()) {
    return usage_error(wrong);
  }
  Result<FaceInput> input = parse_face(std::move(bytes), options.input);
  if (!input) return input.error();
  fap::FillOptions filling;
  filling.interpolate = filling.complete = true;
  const Result<fap::Sequence> clip = eased_face(*input, options.input, filling, options.length);
  if (!clip) return clip.error();
  const auto script = script_for(options.script, {options.input}, input_of(options));
  if (!script) return script.error();
  studio::HeadChoice choice = options.head;
  choice.colours_at_vertices = true;
  const Result<head::Head> head = studio::load_head(choice, terminal_log());
  if (!head) return head.error();
  ProgressLine progress("exporting");
  gltf::GlbOptions settings;
  settings.morphs = options.morphs == "fap" ? gltf::MorphNames::fap : gltf::MorphNames::arkit;
  settings.audio = std::filesystem::path(options.audio).filename().string();
  settings.normals = options.normals;
  settings.visemes = said_visemes(*input, *clip, *script, options.mouth);
  settings.name = std::filesystem::path(options.output).stem().string();
  settings.progress = [&](double done) { progress.update(done); };
  const auto file = gltf::make_glb(*head, head::make_rig(*head), *clip, settings);
  if (!file) return file.error();
  if (auto written = write_file(options.output, *file); !written) return written.error();
  progress.clear();
  const std::string rate = fap::format_rate(clip->rate);
  report_output(options.output,
                "head \"" + head->name + "\", " + std::to_string(clip->frames.size()) + " keys, " +
                    rate + " per second, " + std::to_string(file->size() / 1000) + " kB",
                {{"head", head->name},
                 {"frames", clip->frames.size()},
                 {"rate", rate},
                 {"bytes", file->size()}});
  return kOk;
}

// Visemes, and the script that their events are from; empty: they are of the face.
struct ShownVisemes {
  exchange::VisemeTrack track;
  dam::Script script;
};

bool is_of_visemes(const std::string& what) {
  return what == "visemes" || what == "rhubarb" || what == "talkinghead";
}

Result<ShownVisemes> visemes_of(dam::Script script, const fap::Rate& rate, double crossfade) {
  auto track = exchange::track_of_events(exchange::script_events(script), rate, crossfade);
  if (!track) return track.error();
  return ShownVisemes{std::move(*track), std::move(script)};
}

// A recorded voice: its text, if there is one, else what is heard.
Result<ShownVisemes> visemes_of_voice(const ExportOptions& options, const fap::Rate& rate) {
  speech::SpokenOptions source;
  source.audio = options.input;
  source.language = options.reading.language;
  source.listen = true;
  ProgressLine progress("listening");
  source.heard = [&](double done) { progress.update(done); };
  if (!options.dialog_file.empty()) {
    auto text = read_text_file(options.dialog_file, kMostWritten);
    if (!text) return text.error();
    source.transcript = std::move(*text);
    source.has_transcript = true;
  }
  const auto spoken = speech::get_spoken(source, terminal_log());
  progress.clear();
  if (!spoken) return spoken.error();
  return visemes_of(spoken->script, rate, options.crossfade);
}

// Media without a face.
bool is_voice(const ExportOptions& options, std::span<const std::uint8_t> bytes) {
  if (kind_of(bytes) != FileKind::media || options.input == "-") return false;
  return !open_container({bytes.begin(), bytes.end()}, options.input);
}

Result<ShownVisemes> visemes_of(const ExportOptions& options, std::vector<std::uint8_t> bytes,
                                bool from_script, const fap::Rate& rate) {
  if (from_script) {
    auto script = speech::parse_script({bytes.begin(), bytes.end()}, options.input,
                                       input_of(options), terminal_log());
    if (!script) return script.error();
    auto shown = visemes_of(std::move(*script), rate, options.crossfade);
    if (!shown) return std::move(shown).error().in_file(options.input);
    return shown;
  }
  const Result<fap::Sequence> clip = read_filled(options, std::move(bytes), true);
  if (!clip) return clip.error();
  Result<dam::Script> script = script_for(options.script, {options.input}, input_of(options));
  if (!script) return script.error();
  ShownVisemes shown{exchange::track_of_face(*clip), std::move(*script)};
  if (!shown.script.phones.empty()) shown.track.events = exchange::script_events(shown.script);
  return shown;
}

Result<int> write_visemes(const ExportOptions& options, const std::string& what,
                          const ShownVisemes& shown) {
  const exchange::VisemeTrack& track = shown.track;
  const std::string sound = std::filesystem::path(options.audio).filename().string();
  const std::string format =
      options.format.empty() ? extension_of(options.output) : "." + options.format;
  const bool json = format == ".json";
  std::string text;
  if (what == "rhubarb") {
    text = json               ? exchange::write_rhubarb_json(track, sound, options.rhubarb)
           : format == ".xml" ? exchange::write_rhubarb_xml(track, sound, options.rhubarb)
           : format == ".dat" ? exchange::write_rhubarb_dat(track, options.rhubarb)
                              : exchange::write_rhubarb_tsv(track, options.rhubarb);
  } else if (what == "talkinghead") {
    text = exchange::write_talking_head(track, shown.script, sound);
  } else {
    text = json ? exchange::write_visemes_json(track, sound) : exchange::write_visemes_csv(track);
  }
  if (auto written = write_file(options.output, text); !written) return written.error();
  if (what != "visemes") {
    report_output(options.output,
                  "mouth shapes of " + std::to_string(track.events.size()) + " visemes",
                  {{"visemes", track.events.size()}});
  } else {
    const std::string rate = fap::format_rate(track.rate);
    report_output(
        options.output,
        std::to_string(track.events.size()) + " events, " + std::to_string(track.frames.size()) +
            " frames of 15 visemes, " + rate + " frames per second",
        {{"visemes", track.events.size()}, {"frames", track.frames.size()}, {"rate", rate}});
  }
  return kOk;
}

}  // namespace

Result<int> run(const ExportOptions& given) {
  const media::TrackScope tracks(wanted_track_of(given.track));
  ExportOptions options = given;
  if (options.output.empty() && !options.format.empty()) options.output = "-";
  if (options.output.empty()) return usage_error("name what to write: -o talk.csv");
  if (options.output == "-" && options.format.empty()) {
    return usage_error("for standard output name a format: -f tsv, xml, json or dat");
  }
  if (const std::string wrong = problem_with_report(); options.output == "-" && !wrong.empty()) {
    return usage_error(wrong);
  }
  const Result<fap::Rate> rate = fap::parse_rate(options.rate);
  if (!rate) return rate.error();
  // Before the input is read, so that a wrong name fails at once.
  const std::string named = what_of(options, false);
  if (!options.format.empty() && named != "rhubarb") {
    return usage_error("-f is for Rhubarb mouth shapes (--what rhubarb)");
  }
  if (const std::string wrong = wrong_extension(named, options.output);
      options.format.empty() && !wrong.empty()) {
    return usage_error(wrong);
  }
  Result<std::vector<std::uint8_t>> bytes = read_input(options.input);
  if (!bytes) return bytes.error();
  if (is_of_visemes(named) && is_voice(options, *bytes)) {
    if (options.audio.empty()) options.audio = options.input;
    auto shown = visemes_of_voice(options, *rate);
    if (!shown) return shown.error();
    return write_visemes(options, named, *shown);
  }
  if (!options.dialog_file.empty()) {
    return usage_error("--dialog-file is for a recorded voice, whose mouth shapes are written");
  }
  const bool from_script = kind_of(*bytes) == FileKind::script;
  const std::string what = what_of(options, from_script);
  if (const std::string idle = idle_options(options, what, from_script); !idle.empty()) {
    return usage_error(idle);
  }
  if (!options.more.empty() && !(what == "head" && moves_by_itself(options.head))) {
    return usage_error("several clips need your own head: --head me.glb -o talk.glb");
  }
  if (what == "arkit" || what == "head") {
    if (!options.script.empty() && what == "arkit") {
      return usage_error("--script is for visemes; add --what visemes");
    }
    if (from_script) {
      return make_error(Code::not_found,
                        "a script has no face; make one with animeme speak --script, or export "
                        "its visemes")
          .in_file(options.input);
    }
    if (const std::string problem = studio::problem_of(options.head);
        what == "head" && !problem.empty()) {
      return usage_error(problem);
    }
    return what == "head" ? write_head(options, std::move(*bytes))
                          : write_arkit(options, std::move(*bytes));
  }
  if (what != "visemes" && options.audio.empty() && kind_of(*bytes) == FileKind::media) {
    const Result<media::ContainerInfo> file = media::probe(*bytes);
    const bool sounds = file && file->first(media::TrackKind::audio) != nullptr;
    if (sounds && options.input != "-") options.audio = options.input;
  }
  const auto shown = visemes_of(options, std::move(*bytes), from_script, *rate);
  if (!shown) return shown.error();
  return write_visemes(options, what, *shown);
}

const Command kExport{
    "export", "Convert a face to curves for Unreal, Blender, Unity, web avatars or scripts",
    "  animeme export talk.mp4 -o talk.csv\n"
    "  animeme export talk.fap --audio voice.wav -o talk.json\n"
    "  animeme export talk.fba --head man -o talk.glb\n"
    "  animeme export hello.mp4 bye.fba --head me.glb -o me_talks.glb    # your file with both "
    "animations\n"
    "  animeme export talk.fap -o talk.visemes.json\n"
    "  animeme export talk.fap --script words.tsv --audio voice.wav -o talk.visemes.json\n"
    "  animeme export words.tsv --rate 60 -o words.visemes.csv\n"
    "  animeme export words.tsv -o words.rhubarb.json\n"
    "  animeme export talk.mp4 -o talk.talkinghead.json   # visemes, vtimes, vdurations, words\n"
    "  animeme export voice.wav -f xml -o voice.xml       # as rhubarb -f xml voice.wav\n"
    "\n"
    "Visemes are viseme_sil, PP, FF, TH, DD, kk, CH, SS, nn, RR, aa, E, I, O, U: the morph targets "
    "of Ready Player Me and Oculus avatars. In three.js, with the .visemes.json as `track`:\n"
    "  const frame = track.frames[Math.min(Math.floor(t * track.fps), track.frames.length - 1)];\n"
    "  track.names.forEach((name, i) =>\n"
    "    mesh.morphTargetInfluences[mesh.morphTargetDictionary[name]] = frame[i]);",
    set_up<ExportOptions>};

}  // namespace animeme::tools
