#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "codec/decode/access_unit.h"
#include "fap/detail/text_scanner.h"
#include "tools/app/commands/common.h"
#include "tools/formats/common/json.h"
#include "tools/formats/media/container.h"

namespace animeme::tools {

namespace {

struct DemuxOptions {
  std::string input;
  std::string face;
  std::string audio;
  std::string script;
  std::vector<std::string> outputs;
  bool headers = false;
  bool json = false;
};

Result<Json> write_face(const DemuxOptions& options) {
  Result<media::Container> container = media::read_container(options.input);
  if (!container) return container.error().in_file(options.input);
  for (const std::string& text : container->warnings) warn(options.input + ": " + text);
  const fba::AccessUnits& face = container->face;
  const auto stream = fba::join_access_units(face, options.headers);
  if (auto written = write_file(options.face, stream); !written) return written.error();
  say(name_of_output(options.face) + ": " + std::to_string(face.units.size()) + " planes");
  const fba::AccessUnit& last = face.units.back();
  return Json{{"file", options.face},
              {"format", container->format},
              {"planes", face.units.size()},
              {"bytes", stream.size()},
              {"start", double(face.units.front().time) / face.timescale},
              {"end", double(last.time + last.duration) / face.timescale},
              {"timescale", face.timescale},
              {"profile", container->visual_profile},
              {"warnings", container->warnings}};
}

bool ends_as(const std::string& ending, const std::vector<std::string>& endings) {
  return std::any_of(endings.begin(), endings.end(), [&](const std::string& one) {
    return fap::detail::lower_case(one) == ending;
  });
}

// Which of the three each -o is, by its ending; a sentence if that cannot be.
std::string sort_outputs(DemuxOptions& options) {
  for (const std::string& output : options.outputs) {
    const std::string ending = extension_of(output);
    if (ending == ".fap" || ending == ".bap") {
      return "-o " + output + ": animeme decode writes text; demux writes the stream, .fba";
    }
    const bool face = output == "-" || ending.empty() || ends_as(ending, stream_endings());
    std::string& place = face                                     ? options.face
                         : ends_as(ending, dam::script_endings()) ? options.script
                                                                  : options.audio;
    if (!place.empty()) return "-o " + output + " and " + place + " are the same; give one of them";
    place = output;
  }
  return {};
}

Result<int> run(DemuxOptions options) {
  if (const std::string wrong = sort_outputs(options); !wrong.empty()) return usage_error(wrong);
  if (options.face.empty() && options.audio.empty() && options.script.empty()) {
    return usage_error("nothing to do: name what to write, -o face.fba, .wav or .TextGrid");
  }
  if (options.json && options.face == "-") {
    return usage_error("--json and the face on - both want the standard output");
  }
  Json json = Json::object();
  if (!options.face.empty()) {
    Result<Json> face = write_face(options);
    if (!face) return face.error();
    json["face"] = std::move(*face);
  }
  if (!options.audio.empty()) {
    if (auto written = media::extract_audio(options.input, options.audio); !written) {
      return written.error().in_file(options.input);
    }
    say(options.audio + ": sound of " + options.input);
    json["audio"] = {{"file", options.audio}};
  }
  if (!options.script.empty()) {
    const auto script = speech::carried_script(options.input, {}, terminal_log());
    if (!script) {
      return make_error(Code::not_found,
                        "carries no words and phones, as speak puts into .mp4, .mkv and .m3u8")
          .in_file(options.input);
    }
    const std::string text = dam::write_script(*script, extension_of(options.script));
    if (auto written = write_file(options.script, text); !written) return written.error();
    say(options.script + ": " + std::to_string(script->phones.size()) + " phones of " +
        options.input);
    json["script"] = {{"file", options.script}, {"phones", script->phones.size()}};
  }
  if (options.json) {
    std::printf("%s\n", pretty(json).c_str());
  }
  return kOk;
}

void add_options(CLI::App& app, DemuxOptions& options) {
  app.add_option("input", options.input, "mp4, mkv, ts, m3u8 or mpd file with a face")->required();
  add_output(app.add_option("-o,--output", options.outputs,
                            "What to write, once or more: .fba (the face's stream; - is standard "
                            "output), .wav .m4a (sound), .TextGrid .tsv .pho .vtt (words)"),
             {})
      ->allow_extra_args(false);
  add_output(app.add_option("--face", options.face,
                            "As -o, whatever the name: raw FBA stream, - for standard output"),
             stream_endings());
  add_output(app.add_option("--audio", options.audio,
                            "Likewise: sound, .wav, or .m4a and others as it is"),
             {});
  add_output(
      app.add_option("--script", options.script,
                     "Likewise: words and phones, of .mp4, .mkv, .m3u8: .TextGrid, .tsv, .pho, "
                     "or .vtt (words)"),
      dam::script_endings(), OutputKind::file);
  app.add_flag("--es-headers", options.headers,
               "Begin the stream with its visual object headers (old decoders want none)");
  app.add_flag("--json", options.json, "Machine-readable summary on standard output");
}

}  // namespace

const Command kDemux{"demux", "Take face, voice and words out of a file",
                     "  animeme demux talk.mp4 -o talk.fba -o voice.m4a\n"
                     "  animeme demux talk.mp4 -o talk.TextGrid    # or .vtt: its words\n"
                     "  animeme demux talk.m3u8 --audio voice.wav\n"
                     "  animeme demux talk.mkv -o - | animeme decode - -o talk.fap",
                     set_up<DemuxOptions>};

}  // namespace animeme::tools
