#include <cstdio>
#include <optional>
#include <span>

#include "codec/decode/access_unit.h"
#include "fap/detail/text_scanner.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/damage.h"
#include "tools/app/commands/outputs.h"
#include "tools/app/commands/track_option.h"
#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"
#include "tools/formats/media/container.h"

namespace animeme::tools {

namespace {

struct DemuxOptions {
  std::string track;  // of several languages or people
  std::string input;
  std::string face;
  std::string audio;
  std::string script;
  std::vector<std::string> outputs;
  bool headers = false;
  bool json = false;
};

// An intact face is written while it is read. nullopt: something is wrong with it, or it cannot be
// read again, or written again.
Result<std::optional<Json>> stream_face(const DemuxOptions& options) {
  if (is_strict() || !is_on_disk(options.input) || options.face == "-") return {std::nullopt};
  OutputFile out(options.face);
  std::size_t bytes = 0;
  const auto write = [&](std::span<const std::uint8_t> piece) {
    bytes += piece.size();
    return out.write(piece);
  };
  bool begun = false;
  const auto summary = media::stream_face(
      options.input,
      [&](const fba::AccessUnit& unit, std::span<const std::uint8_t> config) -> Result<void> {
        if (!begun && options.headers) {
          if (auto done = write(config); !done) return done;
        }
        begun = true;
        return write(unit.bytes);
      });
  if (!summary) return summary.error();
  if (!*summary) return {std::nullopt};
  if (auto done = write(fba::end_code()); !done) return done.error();
  if (auto done = out.publish(); !done) return done.error();
  const media::FaceSummary& face = **summary;
  say(name_of_output(options.face) + ": " + std::to_string(face.units) + " planes");
  return {Json{{"file", options.face},
               {"format", face.format},
               {"planes", face.units},
               {"bytes", bytes},
               {"start", double(face.start) / face.timescale},
               {"end", double(face.end) / face.timescale},
               {"timescale", face.timescale},
               {"profile", face.visual_profile},
               {"warnings", Json::array()}}};
}

Result<Json> write_face(const DemuxOptions& options) {
  Result<std::optional<Json>> streamed = stream_face(options);
  if (!streamed) return std::move(streamed).error().in_file(options.input);
  if (*streamed) return **streamed;
  Result<media::Container> container = open_container({}, options.input);
  if (!container) return container.error().in_file(options.input);
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

// Whether `endings`, separated by blanks, have this one.
bool ends_as(const std::string& ending, const std::string& endings) {
  const std::string all = " " + fap::detail::lower_case(endings) + " ";
  return all.find(" " + ending + " ") != std::string::npos;
}

// Which of the three each -o is, by its ending; a sentence if that cannot be.
std::string sort_outputs(DemuxOptions& options) {
  for (const std::string& output : options.outputs) {
    const std::string ending = extension_of(output);
    if (ending == ".fap" || ending == ".bap") {
      return "-o " + output + ": animeme decode writes text; demux writes the stream, .fba";
    }
    const bool face = output == "-" || ending.empty() || ends_as(ending, kStreamEndings);
    std::string& place = face                                                  ? options.face
                         : ends_as(ending, joined(dam::script_endings(), " ")) ? options.script
                                                                               : options.audio;
    if (!place.empty()) return "-o " + output + " and " + place + " are the same; give one of them";
    place = output;
  }
  return {};
}

Result<int> run(DemuxOptions options) {
  const media::TrackScope tracks(wanted_track_of(options.track));
  if (const std::string wrong = sort_outputs(options); !wrong.empty()) return usage_error(wrong);
  if (options.face.empty() && options.audio.empty() && options.script.empty()) {
    return usage_error("nothing to do: name what to write, -o face.fba, .wav or .TextGrid");
  }
  if (options.json && options.face == "-") {
    return usage_error("--json and the face both write to standard output");
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
      return make_error(
                 Code::not_found,
                 "there are no words and phones, which speak writes into .mp4, .mkv and .m3u8")
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

void add_options(OptionTable& cli, DemuxOptions& options) {
  cli.add("input", options.input, ".mp4, .mkv, .ts, .m3u8 or .mpd file with a face")->required();
  cli.add("-o,--output", options.outputs,
          "File to write; may be repeated: .fba (the stream of the face; - is standard "
          "output), .wav .m4a (sound), .TextGrid .tsv .pho .vtt (words)")
      ->output("")
      ->one_at_a_time();
  cli.add("--face", options.face,
          "Raw FBA stream to write, whatever its name; - for standard output")
      ->output(kStreamEndings);
  cli.add("--audio", options.audio, "Sound to write: .wav, or .m4a and others without re-encoding")
      ->output("");
  cli.add("--script", options.script,
          "Words and phones to write, from .mp4, .mkv, .m3u8: .TextGrid, .tsv, .pho, or .vtt "
          "(words)")
      ->output(joined(dam::script_endings(), " "), OutputKind::file);
  cli.add("--es-headers", options.headers,
          "Start the stream with its visual object headers (old decoders need none)");
  cli.add("--json", options.json, "Print a machine-readable summary");
  add_track_option(cli, options.track);
}

}  // namespace

const Command kDemux{"demux", "Extract face, sound and words from a file",
                     "  animeme demux talk.mp4 -o talk.fba -o voice.m4a\n"
                     "  animeme demux talk.mp4 -o talk.TextGrid    # or .vtt: its words\n"
                     "  animeme demux talk.m3u8 --audio voice.wav\n"
                     "  animeme demux talk.mkv -o - | animeme decode - -o talk.fap",
                     set_up<DemuxOptions>};

}  // namespace animeme::tools
