#include "codec/encode/encode.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "codec/text/epf.h"
#include "fap/rate_text.h"
#include "tools/app/commands/common.h"
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
  bool json = false;

  // Who joins a live stream looks for a start code; what is read from its begin needs none.
  fba::StreamOptions stream() const {
    return {start_codes.value_or(preset == Preset::live ? fba::PlaneStartCodes::intra
                                                        : fba::PlaneStartCodes::none),
            old_codes};
  }
};

using Bytes = std::vector<std::uint8_t>;

// What there is to code. Frames keep their numbers: an EPF names them in FFR and BFR, and those of
// face and body belong together.
struct Material {
  fap::Sequence face;
  fba::BodySequence body;
};

Result<Material> read_material(const EncodeOptions& options) {
  Material material;
  if (!options.input.empty()) {
    Result<MotionInput> input = read_motion(options.input, FrameNumbers::keep);
    if (!input) return input.error();
    if (input->kind == FileKind::bap_text) {
      return make_error(Code::not_found, "this is BAP text without a face: give it after --bap")
          .in_file(options.input);
    }
    if (input->body.frames.empty() && options.bap.empty()) {
      if (auto ok = require_face(*input, options.input); !ok) return ok.error();
    }
    material.face = std::move(input->face);
    material.body = std::move(input->body);
  }
  if (!options.bap.empty()) {
    Result<MotionInput> input = read_motion(options.bap, FrameNumbers::keep);
    if (!input) return input.error();
    if (input->body.frames.empty()) {
      return make_error(Code::not_found,
                        "there is no body here: --bap needs BAP text (version 3.1 or 3.2), or a "
                        "stream with a body")
          .in_file(options.bap);
    }
    material.body = std::move(input->body);
  }
  return material;
}

Result<void> check_material(const Material& material, const std::vector<fba::EpfPlane>& planes) {
  for (const fba::EpfPlane& plane : planes) {
    if (fba::has_face(plane.object_mask) && material.face.frames.empty()) {
      return make_error(Code::not_found, "the EPF codes a face: name a FAP text to take it from");
    }
    if (fba::has_body(plane.object_mask) && material.body.frames.empty()) {
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
  Result<Bytes> bytes =
      fba::encode_epf(material->face, material->body.frames, *planes, options.stream());
  if (!bytes) return bytes.error().in_file(options.epf);
  return bytes;
}

// Face and body of one stream have one rate.
Result<Material> read_clip(const EncodeOptions& options) {
  Result<Material> material = read_material(options);
  if (!material) return material;
  if (material->face.frames.empty()) {
    material->face.rate = material->body.rate;
  } else if (!material->body.frames.empty() && material->body.rate != material->face.rate) {
    return make_error(Code::invalid_argument,
                      "the body has " + fap::format_rate(material->body.rate) +
                          " frames per second and the face " +
                          fap::format_rate(material->face.rate) + ": convert one of them")
        .in_file(options.bap.empty() ? options.input : options.bap);
  }
  return material;
}

Result<Bytes> encode_clip(const EncodeOptions& options, fba::EncodeReport& report) {
  Result<Material> material = read_clip(options);
  if (!material) return material.error();
  fba::EncodeOptions settings;
  if (options.preset == Preset::file) settings = fba::file_options();
  if (options.preset == Preset::live) settings = fba::live_options();
  settings.leave_out = settings.leave_out || options.rms > 0 || options.kbps > 0;
  settings.fap_quant = settings.bap_quant = options.quant.value_or(1);
  if (options.intra_seconds) settings.intra_seconds = *options.intra_seconds;
  if (options.intra_period) {
    settings.intra_seconds = material->face.rate.seconds(*options.intra_period);
  }
  settings.stream = options.stream();
  settings.kept_ranges = options.kept_ranges;
  settings.max_rms = options.rms;
  settings.max_bits_per_second = options.kbps * 1000;
  settings.still_below = options.still_below;
  settings.skip_still = options.skip_still;
  ProgressLine progress("searching for the smallest stream");
  settings.progress = [&progress](double done) { progress.update(done); };
  AtStep step(Step::coding);
  auto bytes = fba::encode(material->face, settings, material->body.frames, &report);
  if (bytes) step.made(bytes->size());
  return bytes;
}

// What was written, counted as a receiver does.
struct Outcome {
  std::size_t planes = 0;
  std::size_t intra_planes = 0;
  double kbps = 0;
};

Outcome count(const Bytes& bytes) {
  Outcome outcome;
  const Result<fba::DecodedStream> decoded = fba::decode(bytes);
  if (!decoded) return outcome;
  outcome.planes = decoded->planes.size();
  for (const fba::Plane& plane : decoded->planes) outcome.intra_planes += plane.intra ? 1 : 0;
  const double seconds = decoded->rate.seconds(double(decoded->planes.back().number + 1));
  outcome.kbps = kbit_per_s(bytes.size(), seconds);
  return outcome;
}

void tell(const EncodeOptions& options, const Bytes& bytes, const fba::EncodeReport& report) {
  const Outcome outcome = count(bytes);
  std::string line =
      name_of_output(options.output) +
      format(": %zu planes, %zu bytes, %.2f kbit/s", outcome.planes, bytes.size(), outcome.kbps);
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
               {"bytes", bytes.size()},
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
                     {"kept_ranges", report.kept_ranges}});
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
  Result<Bytes> bytes =
      *options.preset == Preset::exact ? encode_by_epf(options) : encode_clip(options, report);
  if (!bytes) {
    if (!bytes.error().where.file.empty()) return bytes.error();
    return bytes.error().in_file(options.input.empty() ? options.bap : options.input);
  }
  if (auto written = write_file(options.output, *bytes); !written) return written.error();
  tell(options, *bytes, report);
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
