#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>

#include "codec/decode/fill.h"
#include "fap/rate_text.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/edit_frames.h"
#include "tools/app/commands/edit_options.h"
#include "tools/app/commands/edit_source.h"
#include "tools/app/commands/face_text.h"
#include "tools/app/commands/fap_file.h"
#include "tools/app/commands/plane_file.h"
#include "tools/app/commands/report.h"
#include "tools/app/commands/track_option.h"
#include "tools/formats/common/text.h"

namespace animeme::tools {

namespace {

struct DecodeOptions {
  std::string track;  // of several languages or people
  std::string input;
  std::string output;
  std::string bap;
  std::string rate;
  EditSpan span;
  FaceText face;
};

// What is to be written. A face alone is decoded while it is written, and never in memory.
struct Decoded {
  MotionInput motion;       // what is in memory: text, tables, and streams whose body is wanted
  std::int64_t bodies = 0;  // body frames
  bool face = true;         // there is one
  std::optional<FaceExtent> extent;  // of a stream that is not in memory
};

// The planes of a stream decide what becomes of FAPs that they do not code; a text has no place for
// that, and players would show one side alone. What a text leaves open is held and mirrored.
std::function<Result<void>(const TakeFrame&)> planes_of(
    PlaneFile file, std::function<void(const fba::Plane&)> note = {},
    std::vector<std::string>* warnings = nullptr) {
  return [file = std::move(file), note = std::move(note), warnings](const TakeFrame& take) {
    return file.for_each(
        [&](const fba::Plane& plane) {
          if (note) note(plane);
          if (!fba::has_face(plane.object_mask)) return Result<void>();
          const fba::FaceSettings none;
          return take(plane.face,
                      fba::group_rules(plane.face_settings ? *plane.face_settings : none));
        },
        warnings);
  };
}

// Goes through a stream for the first time: what it has, its rate, its errors. A damaged one is
// repaired.
Result<Decoded> look_at(const PlaneFile& file, DecodeOptions& options) {
  Decoded decoded;
  decoded.motion.kind = FileKind::fba_stream;
  decoded.face = false;
  std::vector<std::string> warnings;
  bool first = true;
  const auto note = [&](const fba::Plane& plane) {
    if (first) options.face.rate = plane.rate;
    first = false;
    decoded.face = decoded.face || fba::has_face(plane.object_mask);
    if (plane.body) ++decoded.bodies;
  };
  FaceText text = options.face;
  text.frames = planes_of(file, note, &warnings);
  Result<FaceExtent> extent = extent_of(text);
  if (!extent || !warnings.empty()) {
    if (const auto repaired = file.repaired(options.input)) {
      options.face.frames = planes_of(*repaired);
      return look_at(*repaired, options);
    }
  }
  if (!extent) return std::move(extent).error().in_file(options.input);
  decoded.extent = *extent;
  for (const std::string& warning : warnings) warn(options.input + ": " + warning);
  return decoded;
}

// --from and --to: frames as they are shown, held where a plane is left out.
Result<Decoded> read_piece(const DecodeOptions& options) {
  const auto piece = options.span.piece();
  if (!piece) return piece.error();
  const auto source = open_edit_source(options.input);
  if (!source) return source.error();
  const std::int64_t first = piece->from.frame(source->rate);
  const std::int64_t end =
      piece->to ? std::min(piece->to->frame(source->rate), source->frames) : source->frames;
  if (end <= first) {
    return make_error(Code::invalid_argument, format("nothing is left: the input lasts %.3f s",
                                                     source->rate.seconds(double(source->frames))))
        .in_file(options.input);
  }
  const EditCut cut{&*source, first, end};
  const auto extent = extent_of(*source);
  if (!extent) return extent.error();
  Decoded decoded;
  decoded.motion.kind = source->motion.kind;
  decoded.motion.face = {source->rate, {}, source->motion.face.name};
  decoded.motion.body.rate = source->rate;
  decoded.motion.body.name = source->motion.body.name;
  const auto keep = [](auto reader, auto& frames) -> Result<void> {
    for (;;) {
      const auto frame = reader.next();
      if (!frame) return frame.error();
      if (*frame == nullptr) return {};
      frames.push_back(**frame);
    }
  };
  if (extent->has_face()) {
    auto done =
        keep(FaceFrames(cut, *extent, source->rate, source->rate), decoded.motion.face.frames);
    if (!done) return done.error();
  }
  if (extent->has_body()) {
    auto done =
        keep(BodyFrames(cut, *extent, source->rate, source->rate), decoded.motion.body.frames);
    if (!done) return done.error();
  }
  decoded.bodies = std::int64_t(decoded.motion.body.frames.size());
  decoded.face = !decoded.motion.face.frames.empty();
  return decoded;
}

// FAP text, to write it in another form.
Result<Decoded> read_fap_file(DecodeOptions& options) {
  const Result<FapFile> file = FapFile::open(options.input);
  if (!file) return file.error();
  options.face.rate = file->survey().rate;
  options.face.name = file->survey().name;
  options.face.frames = [file = *file](const TakeFrame& take) {
    return file.for_each([&](const fap::Frame& frame) { return take(frame, fap::GroupRules{}); });
  };
  Decoded decoded;
  decoded.motion.kind = FileKind::fap_text;
  return decoded;
}

Result<Decoded> read(DecodeOptions& options) {
  if (options.span.given()) return read_piece(options);
  if (options.bap.empty() && PlaneFile::can_read(options.input)) {
    const PlaneFile file(options.input);
    options.face.frames = planes_of(file);
    options.face.name = std::filesystem::path(options.input).stem().string();
    return look_at(file, options);
  }
  if (options.bap.empty() && FapFile::can_read(options.input)) return read_fap_file(options);
  Result<MotionInput> input = read_motion(options.input);
  if (!input) return input.error();
  Decoded decoded;
  decoded.motion = std::move(*input);
  MotionInput& motion = decoded.motion;
  decoded.bodies = std::int64_t(motion.body.frames.size());
  decoded.face = !motion.face.frames.empty() || motion.kind == FileKind::fap_text;
  return decoded;
}

Error no_face(const DecodeOptions& options, const Decoded& decoded) {
  const char* what =
      decoded.motion.kind == FileKind::bap_text ? "this is BAP text: it has a body but no face"
      : decoded.bodies == 0
          ? "the stream codes neither a face nor a body"
          : "the stream codes a body but no face: write it with --bap in place of -o";
  return make_error(Code::not_found, what).in_file(options.input);
}

Result<std::int64_t> write_face(OutputFile& out, const DecodeOptions& options, Decoded& decoded) {
  if (!decoded.face) return no_face(options, decoded);
  FaceText text = options.face;
  if (!text.frames) {
    MotionInput& motion = decoded.motion;
    const FaceText clip = face_text(motion.face);
    text.rate = clip.rate;
    text.name = clip.name;
    text.frames = motion.stream.empty() ? clip.frames : planes_of(PlaneFile(motion.stream));
  }
  const std::string path = name_of_output(options.output);
  Result<std::int64_t> frames = decoded.extent ? write_face_text(out, path, text, *decoded.extent)
                                               : write_face_text(out, path, text);
  if (!frames && frames.error().code != Code::io) {
    return std::move(frames).error().in_file(options.input);
  }
  return frames;
}

// With -o and --bap what there is is written, so that batches run over files with and without
// bodies.
void leave_out_what_is_missing(const Decoded& decoded, DecodeOptions& options) {
  if (options.output.empty() || options.bap.empty()) return;
  const auto leave_out = [&](std::string& path, const char* what) {
    warn(options.input + " has no " + what + ": " + name_of_output(path) + " is not written");
    path.clear();
  };
  if (decoded.bodies == 0) {
    leave_out(options.bap, "body");
  } else if (!decoded.face) {
    leave_out(options.output, "face");
  }
}

Result<std::string> body_text(const Decoded& decoded, const std::string& input) {
  if (decoded.bodies == 0) {
    return make_error(Code::not_found, "there is no body here: name a FAP text with -o")
        .in_file(input);
  }
  return fba::write_bap_text(decoded.motion.body);
}

std::string wrong_use(const DecodeOptions& options) {
  if (options.output.empty() && options.bap.empty()) {
    return "nothing to write: name a FAP text with -o, a BAP text with --bap, or both";
  }
  if (options.output == options.bap) return "-o and --bap name the same file";
  const FaceText& face = options.face;
  if (options.output.empty() &&
      (face.fill || face.coded || face.expand || face.exact || !options.rate.empty())) {
    return "--fill, --coded, --expand, --exact and --rate are for the face: name a FAP text with "
           "-o";
  }
  return {};
}

Result<int> run(DecodeOptions options) {
  const media::TrackScope tracks(wanted_track_of(options.track));
  if (const std::string wrong = wrong_use(options); !wrong.empty()) return usage_error(wrong);
  if (!options.rate.empty()) {
    const Result<fap::Rate> rate = fap::parse_rate(options.rate);
    if (!rate) return rate.error();
    options.face.resampled = *rate;
  }
  Result<Decoded> decoded = read(options);
  if (!decoded) return decoded.error();
  leave_out_what_is_missing(*decoded, options);
  Result<std::string> body = std::string();
  if (!options.bap.empty()) {
    body = body_text(*decoded, options.input);
    if (!body) return body.error();
  }
  OutputFile body_file(options.bap), face_file(options.output);
  // Files before standard output, which cannot be taken back.
  const bool face_first = options.bap == "-";
  Result<std::int64_t> frames = 0;
  for (const bool face : {face_first, !face_first}) {
    if (face && !options.output.empty()) {
      frames = write_face(face_file, options, *decoded);
      if (!frames) return frames.error();
    } else if (!face && !options.bap.empty()) {
      if (auto done = body_file.write(*body); !done) return done.error();
    }
  }
  const auto published = [](OutputFile& file, const std::string& path) {
    return path.empty() ? Result<void>() : file.publish();
  };
  if (auto done = published(body_file, options.bap); !done) return done.error();
  if (auto done = published(face_file, options.output); !done) return done.error();
  const auto told = [](const std::string& path, std::int64_t count, const char* what) {
    if (!path.empty()) report_output(path, std::to_string(count) + what, {{"frames", count}});
  };
  told(options.output, *frames, " frames");
  told(options.bap, decoded->bodies, " body frames");
  if (options.bap.empty() && decoded->bodies > 0) {
    say(options.input + ": there are " + std::to_string(decoded->bodies) +
        " body frames too, --bap writes them");
  }
  return kOk;
}

void add_options(OptionTable& cli, DecodeOptions& options) {
  cli.add("input", options.input, "FBA stream, or an .mp4, .mkv or .ts file with one")->required();
  cli.add("-o,--output", options.output, "FAP text to write, - for standard output")
      ->output(".fap .txt");
  cli.add("--bap", options.bap, "BAP text with the body to write, - for standard output")
      ->output(".bap .txt");
  FaceText& face = options.face;
  face.expand_mixed = true;
  cli.add("--coded", face.coded,
          "Write the coded values only: mirrored sides and skipped frames are missing; with "
          "--exact");
  cli.add("--fill", face.fill, "Write all FAPs: those that the stream never codes are 0");
  cli.add("--expand", face.expand,
          "Expand FAP 1 and 2 (visemes, expressions) to low-level FAPs, for players that do "
          "not support them; the default where others are coded, too, except with --exact");
  add_span_options(cli, options.span);
  cli.add("--rate", options.rate, "Resample to this frame rate, with linear interpolation")
      ->frame_rate();
  add_exact_option(cli, face.exact);
  cli.get("--coded")->excludes("--fill --expand --rate --from --to");
  add_track_option(cli, options.track);
}

}  // namespace

const Command kDecode{
    "decode", "Decode an FBA stream to FAP and BAP text, as a player shows it",
    "  animeme decode talk.mp4 -o talk.fap\n"
    "  animeme decode talk.fba --expand --rate 25 -o talk.fap    # for any player\n"
    "  animeme decode talk.mp4 --from 12 --to 14 -o part.fap\n"
    "  animeme decode dance.fba -o face.fap --bap body.bap\n"
    "  animeme decode talk.fba --coded -o - | head -4    # for tests of decoders",
    set_up<DecodeOptions>};

}  // namespace animeme::tools
