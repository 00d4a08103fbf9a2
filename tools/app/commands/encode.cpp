#include "codec/encode/encode.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "codec/text/epf.h"
#include "fap/rate_text.h"
#include "tools/app/commands/clip_file.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/face_stream.h"
#include "tools/app/commands/outputs.h"
#include "tools/formats/common/bit_rate.h"
#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"
#include "tools/formats/files/cost.h"

namespace animeme::tools {

namespace {

enum class Preset : std::uint8_t { plain, file, live, exact };

struct EncodeOptions {
  std::string input;
  std::string bap;
  std::string output;
  std::string epf;
  std::optional<Preset> preset;
  std::optional<int> quant;
  std::optional<double> intra_seconds;
  std::optional<int> intra_period;
  std::optional<fba::PlaneStartCodes> start_codes;
  bool old_codes = false;
  double rms = 0;
  double kbps = 0;
  double still_below = 0;
  bool skip_still = false;
  bool kept_ranges = false;
  bool default_ranges = false;
  bool json = false;

  // Who joins a live stream looks for a start code; what is read from its begin needs none.
  fba::StreamOptions stream() const {
    return {start_codes.value_or(preset == Preset::live ? fba::PlaneStartCodes::intra
                                                        : fba::PlaneStartCodes::none),
            old_codes};
  }
};

using Bytes = std::vector<std::uint8_t>;

// What an EPF codes planes of, in memory. Frames keep their numbers: an EPF names them in FFR and
// BFR, and those of face and body belong together.
struct Material {
  fap::Sequence face;
  std::vector<fba::BodyFrame> body;
};

Result<Material> read_material(const EncodeOptions& options) {
  const Result<ClipFile> clip = ClipFile::open(options.input, options.bap, ClipRates::any);
  if (!clip) return clip.error();
  Material material;
  material.face.rate = clip->rate();
  auto done = clip->source().each([&](const fap::Frame* face, const fba::BodyFrame* body) {
    if (face != nullptr) material.face.frames.push_back(*face);
    if (body != nullptr) material.body.push_back(*body);
    return Result<void>();
  });
  if (!done) return done.error();
  return material;
}

Result<void> check_material(const Material& material, const std::vector<fba::EpfPlane>& planes) {
  for (const fba::EpfPlane& plane : planes) {
    if (fba::has_face(plane.object_mask) && material.face.frames.empty()) {
      return make_error(Code::not_found, "the EPF codes a face: name a FAP text to take it from");
    }
    if (fba::has_body(plane.object_mask) && material.body.empty()) {
      return make_error(Code::not_found, "the EPF codes a body: name a BAP text with --bap");
    }
  }
  return {};
}

Result<Bytes> encode_by_epf(const EncodeOptions& options) {
  Result<std::string> text = read_text_file(options.epf);
  if (!text) return text.error();
  Result<std::vector<fba::EpfPlane>> planes = fba::read_epf(*text);
  if (!planes) return planes.error().in_file(options.epf);
  Result<Material> material = read_material(options);
  if (!material) return material.error();
  if (auto ok = check_material(*material, *planes); !ok) return ok.error().in_file(options.epf);
  Result<Bytes> bytes = fba::encode_epf(material->face, material->body, *planes, options.stream());
  if (!bytes) return bytes.error().in_file(options.epf);
  return bytes;
}

// What was written.
struct Outcome {
  std::size_t planes = 0;
  std::size_t intra_planes = 0;
  std::size_t bytes = 0;
  double kbps = 0;
};

// Clips of several windows are written window by window.
Result<Outcome> encode_clip(const EncodeOptions& options, fba::EncodeReport& report) {
  const Result<ClipFile> clip = ClipFile::open(options.input, options.bap, ClipRates::equal);
  if (!clip) return clip.error();
  fba::EncodeOptions settings;
  if (options.preset == Preset::file) settings = fba::file_options();
  if (options.preset == Preset::live) settings = fba::live_options();
  settings.leave_out = settings.leave_out || options.rms > 0 || options.kbps > 0;
  settings.fap_quant = settings.bap_quant = options.quant.value_or(1);
  if (options.intra_seconds) settings.intra_seconds = *options.intra_seconds;
  if (options.intra_period) settings.intra_seconds = clip->rate().seconds(*options.intra_period);
  settings.stream = options.stream();
  settings.kept_ranges = options.kept_ranges;
  settings.default_ranges = options.default_ranges;
  settings.max_rms = options.rms;
  settings.max_bits_per_second = options.kbps * 1000;
  settings.still_below = options.still_below;
  settings.skip_still = options.skip_still;
  ProgressLine progress("searching for the smallest stream");
  settings.progress = [&progress](double done) { progress.update(done); };
  AtStep step(Step::coding);
  OutputFile out(options.output);
  Outcome outcome;
  const auto written = fba::encode_long(clip->source(), settings,
                                        [&](std::span<const std::uint8_t> bytes) -> Result<void> {
                                          outcome.bytes += bytes.size();
                                          return out.write(bytes);
                                        });
  if (!written) return written.error();
  if (auto published = out.publish(); !published) return published.error();
  step.made(outcome.bytes);
  report = *written;
  outcome.planes = report.planes;
  outcome.intra_planes = report.intra_planes;
  outcome.kbps = kbit_per_s(outcome.bytes, clip->rate().seconds(double(clip->frames())));
  return outcome;
}

Result<Outcome> encode_exactly(const EncodeOptions& options) {
  const Result<Bytes> bytes = encode_by_epf(options);
  if (!bytes) return bytes.error();
  if (auto written = write_file(options.output, *bytes); !written) return written.error();
  Outcome outcome;
  outcome.bytes = bytes->size();
  const Result<fba::DecodedStream> decoded = fba::decode(*bytes);
  if (!decoded) return outcome;
  outcome.planes = decoded->planes.size();
  for (const fba::Plane& plane : decoded->planes) outcome.intra_planes += plane.intra ? 1 : 0;
  const double seconds = decoded->rate.seconds(double(decoded->planes.back().number + 1));
  outcome.kbps = kbit_per_s(bytes->size(), seconds);
  return outcome;
}

void tell(const EncodeOptions& options, const Outcome& outcome, const fba::EncodeReport& report) {
  std::string line =
      name_of_output(options.output) +
      format(": %zu planes, %zu bytes, %.2f kbit/s", outcome.planes, outcome.bytes, outcome.kbps);
  if (report.planes > 0) {
    line += format("; fap_quant %d, error %.2f FAP units RMS, %zu coded", report.fap_quant,
                   report.rms, report.coded);
    const auto add = [&line](std::size_t number, const char* what) {
      if (number > 0) line += ", " + std::to_string(number) + what;
    };
    add(report.mirrored, " right sides left to the decoder");
    add(report.left_out, " at rest left out");
    add(report.stilled, " stilled");
    add(report.skipped, " still frames skipped");
    if (report.kept_ranges) line += ", ranges kept from a coarse first plane";
  }
  say(line);
  if (options.default_ranges) warn_of_default_ranges(report.default_ranges);
  if (report.limited > 0) {
    warn(
        format("%zu values are out of the range of a plane, +-1860 quantiser steps, and were "
               "clipped to it",
               report.limited));
  }
  if (options.kbps > 0 && outcome.kbps > options.kbps * 1.001) {
    warn(format("%.2f kbit/s is the least that this clip needs, %.2f asked", outcome.kbps,
                options.kbps));
  }
  if (!options.json) return;
  Json json = {{"planes", outcome.planes},
               {"intra_planes", outcome.intra_planes},
               {"bytes", outcome.bytes},
               {"kbit_per_s", outcome.kbps}};
  if (report.planes > 0) {
    json.update(Json{{"fap_quant", report.fap_quant},
                     {"bap_quant", report.bap_quant},
                     {"rms", report.rms},
                     {"rms_other", report.rms_other},
                     {"coded", report.coded},
                     {"mirrored", report.mirrored},
                     {"left_out", report.left_out},
                     {"stilled", report.stilled},
                     {"skipped", report.skipped},
                     {"limited", report.limited},
                     {"kept_ranges", report.kept_ranges},
                     {"default_ranges", report.default_ranges}});
  }
  std::printf("%s\n", pretty(json).c_str());
}

// Options that the preset has no use for.
const char* contradiction(const EncodeOptions& options, Preset preset) {
  if (options.input.empty() && options.bap.empty()) {
    return "nothing to code: name a FAP text, or a BAP text with --bap";
  }
  if ((preset == Preset::exact) != !options.epf.empty()) {
    return preset == Preset::exact ? "--preset exact needs an encoder parameter file, --epf"
                                   : "--epf decides everything: only --preset exact goes with it";
  }
  for (const double limit : {options.rms, options.kbps, options.still_below}) {
    if (!std::isfinite(limit)) return "--rms, --kbps and --still-below want a number";
  }
  const bool chooses = options.rms > 0 || options.kbps > 0;
  const bool shapes = chooses || options.still_below > 0 || options.skip_still;
  if (shapes && preset != Preset::file && preset != Preset::live) {
    return "--rms, --kbps, --still-below and --skip-still need --preset file or live";
  }
  if (options.kept_ranges && preset != Preset::file) return "--kept-ranges needs --preset file";
  if (options.default_ranges && preset != Preset::file && preset != Preset::live) {
    return "--default-ranges needs --preset file or live";
  }
  if (options.default_ranges && options.kept_ranges) {
    return "--default-ranges and --kept-ranges exclude each other: leave one out";
  }
  if (options.intra_seconds && options.intra_period) {
    return "--intra-seconds and --intra-period say the same: leave one out";
  }
  if (options.kept_ranges && (options.intra_seconds || options.intra_period)) {
    return "with --kept-ranges receivers can join at the begin only: leave the intra period out";
  }
  if (options.quant && chooses) return "--quant is chosen by --rms and --kbps: leave it out";
  if (preset == Preset::exact && (options.quant || options.intra_seconds || options.intra_period)) {
    return "--quant and --intra-seconds come from the encoder parameter file: leave them out";
  }
  if (options.json && options.output == "-") return "--json and -o - both want standard output";
  return nullptr;
}

Result<int> run(const EncodeOptions& given) {
  EncodeOptions options = given;
  if (!options.preset) options.preset = options.epf.empty() ? Preset::plain : Preset::exact;
  if (const char* text = contradiction(options, *options.preset)) return usage_error(text);
  fba::EncodeReport report;
  const Result<Outcome> outcome =
      *options.preset == Preset::exact ? encode_exactly(options) : encode_clip(options, report);
  if (!outcome) {
    if (!outcome.error().where.file.empty()) return outcome.error();
    return outcome.error().in_file(options.input.empty() ? options.bap : options.input);
  }
  tell(options, *outcome, report);
  return kOk;
}

std::string parse_preset(const std::string& text, std::optional<Preset>& preset) {
  preset = text == "file"    ? Preset::file
           : text == "live"  ? Preset::live
           : text == "exact" ? Preset::exact
                             : Preset::plain;
  return {};
}

std::string parse_start_codes(const std::string& text, std::optional<fba::PlaneStartCodes>& codes) {
  codes = text == "all"     ? fba::PlaneStartCodes::all
          : text == "intra" ? fba::PlaneStartCodes::intra
                            : fba::PlaneStartCodes::none;
  return {};
}

void add_options(OptionTable& cli, EncodeOptions& options) {
  cli.add("input", options.input, "FAP text (also .fba or a container, to encode it again)");
  cli.add("--bap", options.bap, "BAP text (or a stream) with the body");
  cli.add("-o,--output", options.output, "FBA stream to write, - for standard output")
      ->output(kStreamEndings)
      ->required();
  cli.add("--epf", options.epf,
          "Encoder parameter file: it makes all decisions, so that the bytes are determined");
  cli.add("--preset", parsed<parse_preset>(options.preset),
          "plain: all values of the clip, in every plane (the default)\nfile: smallest size; "
          "FAPs at rest are left out, and right sides that equal their left ones are "
          "mirrored by the decoder (decode --fill writes them)\nlive: all values of the clip, "
          "in the tightest ranges between random access points, every 2 s\nexact: as --epf "
          "says (the default with --epf)")
      ->one_of("plain file live exact");
  cli.add("--rms", options.rms,
          "file: smallest size with at most this error, FAP units RMS over the FAPs that "
          "move (half quantiser steps for angles and bodies); 2 is not visible")
      ->between(0.0, 1e6);
  cli.add("--kbps", options.kbps, "file: target bit rate, kbit/s")->between(0.0, 1e6);
  cli.add("--still-below", options.still_below,
          "file: hold FAPs still whose whole range is below this, FAP units")
      ->between(0.0, 1e6);
  cli.add("--skip-still", options.skip_still,
          "file: do not send planes without motion (receivers hold the previous one)");
  cli.add("--kept-ranges", options.kept_ranges,
          "file: the first plane is coarse and the ranges of the others are finer; about 5 % "
          "smaller for speech, for players that keep ranges as numbers of levels");
  add_default_ranges_option(cli, options.default_ranges);
  cli.get("--default-ranges")->help = "file, live: " + cli.get("--default-ranges")->help;
  cli.add("--quant", options.quant,
          "Quantiser of face and body; the error of 1 (the default) is not visible (a head "
          "turns in steps of 0.097 degrees, which our players ease), 0 is lossless up to +-1860")
      ->between(0, 31);
  cli.add("--intra-seconds", options.intra_seconds,
          "Seconds between random access points (intra planes); 0: only where needed (live: "
          "2)")
      ->at_least_zero();
  cli.add("--intra-period", options.intra_period, "The same in frames")->at_least_zero();
  cli.add("--plane-start-codes", parsed<parse_start_codes>(options.start_codes),
          "Planes that get a byte-aligned start code: none, intra (the default of live) or "
          "all")
      ->one_of("none intra all");
  cli.add("--json", options.json, "Print what was written and chosen");
  cli.add("--old-codes", options.old_codes, "Write plane start codes of the 1999 edition");
}

}  // namespace

const Command kEncode{"encode", "Encode FAP and BAP text as an FBA stream",
                      "  animeme encode talk.fap -o talk.fba\n"
                      "  animeme encode talk.fap --preset file -o small.fba\n"
                      "  animeme encode talk.fap --preset file --rms 2 -o smaller.fba\n"
                      "  animeme encode talk.fap --preset file --kbps 1 -o one_kilobit.fba\n"
                      "  animeme encode talk.fap --preset live --intra-seconds 1 "
                      "--plane-start-codes intra -o talk.fba\n"
                      "  animeme encode talk.fap --epf talk.epf -o talk.fba\n"
                      "  animeme encode face.fap --bap body.bap -o both.fba",
                      set_up<EncodeOptions>};

}  // namespace animeme::tools
