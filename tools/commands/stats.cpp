#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "fap/rate_text.h"
#include "fap/tables.h"
#include "tools/commands/common.h"
#include "tools/inspect/activity.h"
#include "tools/inspect/bits.h"
#include "tools/inspect/sizes.h"

namespace animeme::tools {

namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::vector<std::string> inputs;
  bool json = false;
  bool sizes = false;
  double rms = 2;
};

// What was measured; each part has a describe() for --json and a print() for people.
struct Statistics {
  MotionInput input;
  std::optional<inspect::BitStatistics> bits;  // streams only
  std::vector<inspect::Activity> faps;
  std::vector<inspect::Activity> baps;
};

Result<Statistics> measure(const std::string& path) {
  Result<MotionInput> input = read_motion(path);
  if (!input) return input.error();
  Statistics out;
  if (!input->stream.empty())
    out.bits = inspect::measure_bits(input->decoded, input->stream.size());
  out.faps = inspect::measure_activity(input->face);
  out.baps = inspect::measure_activity(input->body);
  out.input = std::move(*input);
  return out;
}

const char* kind_name(FileKind kind) {
  switch (kind) {
    case FileKind::fap_text:
      return "fap";
    case FileKind::bap_text:
      return "bap";
    case FileKind::curves:
      return "curves";
    case FileKind::media:
      return "media";
    default:
      return "fba";
  }
}

double seconds_of(const Statistics& s) {
  if (s.bits) return s.bits->seconds;
  if (!s.input.face.frames.empty()) return s.input.face.duration();
  const auto& body = s.input.body;
  return body.frames.empty() ? 0.0 : body.rate.seconds(double(body.frames.back().number + 1));
}

fap::Rate rate_of(const Statistics& s) {
  return s.input.kind == FileKind::bap_text ? s.input.body.rate : s.input.face.rate;
}

// --- the stream as a whole

Json describe(const inspect::PlaneBits& bits) {
  return {{"planes", bits.planes},
          {"mean", bits.mean},
          {"median", bits.median},
          {"largest", bits.largest}};
}

void describe(const inspect::BitStatistics& bits, Json& json) {
  const double total = double(bits.framing_bits + bits.header_bits + bits.value_bits);
  json["planes"] = bits.intra.planes + bits.predictive.planes;
  json["intra_planes"] = bits.intra.planes;
  json["kbit_per_s"] = bits.kbit_per_s;
  json["peak_kbit_per_s"] = bits.peak_kbit_per_s;
  json["bits"] = std::int64_t(total);
  json["intra_bits"] = describe(bits.intra);
  json["predictive_bits"] = describe(bits.predictive);
  json["framing"] = {{"bits", bits.framing_bits}, {"share", double(bits.framing_bits) / total}};
  json["headers"] = {{"bits", bits.header_bits}, {"share", double(bits.header_bits) / total}};
  json["values"] = {{"bits", bits.value_bits},
                    {"share", double(bits.value_bits) / total},
                    {"ideal_bits", bits.ideal_bits()}};
}

void print(const char* name, const inspect::PlaneBits& bits) {
  if (bits.planes == 0) return;
  std::printf("%s %zu, bits a plane: mean %.1f, median %.1f, largest %lld\n", name, bits.planes,
              bits.mean, bits.median, (long long)bits.largest);
}

void print(const inspect::BitStatistics& bits) {
  const double total = double(bits.framing_bits + bits.header_bits + bits.value_bits);
  const auto percent = [total](std::int64_t part) { return 100 * double(part) / total; };
  std::printf("bit rate: %.3f kbit/s, %.3f in the costliest second\n", bits.kbit_per_s,
              bits.peak_kbit_per_s);
  print("I planes:", bits.intra);
  print("P planes:", bits.predictive);
  std::printf(
      "share of all bits: values %.1f %%, plane headers %.1f %%, start codes and stuffing "
      "%.1f %%\n",
      percent(bits.value_bits), percent(bits.header_bits), percent(bits.framing_bits));
  std::printf("values: %lld bits, ideal %.0f (the rest ends segments)\n",
              (long long)bits.value_bits, bits.ideal_bits());
}

// --- the parameters

Json describe(const std::vector<inspect::Activity>& list, const char* kind,
              const double* ideal_bits, double seconds) {
  Json out = Json::array();
  for (const inspect::Activity& one : list) {
    Json json = {{kind, one.number}};
    if (kind == std::string_view("fap")) {
      json["name"] = fap::info(one.number).name;
      json["group"] = fap::info(one.number).group;
    }
    json["frames"] = one.frames;
    if (one.is_amount) {
      json["min"] = one.min;
      json["max"] = one.max;
      json["rms_speed"] = one.rms_speed;
    }
    json["distinct"] = one.distinct;
    json["moves"] = one.moves;
    json["never_moves"] = one.never_moves();
    if (kind == std::string_view("fap")) json["equal_to"] = one.equal_to;
    if (ideal_bits != nullptr) json["ideal_bits_per_s"] = ideal_bits[one.number] / seconds;
    out.push_back(std::move(json));
  }
  return out;
}

std::string remark(const inspect::Activity& one) {
  std::string text = one.never_moves() ? "never moves" : "";
  for (const int other : one.equal_to) {
    text += (text.empty() ? "= " : ", = ") + std::to_string(other);
  }
  return text;
}

void print(const std::vector<inspect::Activity>& list, bool face, const double* ideal_bits,
           double seconds) {
  if (list.empty()) return;
  std::printf("\n%s%-*s %8s %8s %8s %10s %7s", face ? "FAP " : "BAP ", face ? 25 : 0,
              face ? "name" : "", "min", "max", "distinct", "rms/s", "moves");
  std::printf(ideal_bits != nullptr ? " %12s\n" : "\n", "ideal bit/s");
  for (const inspect::Activity& one : list) {
    std::printf("%3d ", one.number);
    if (face) std::printf("%-25s", std::string(fap::info(one.number).name).c_str());
    if (one.is_amount) {
      std::printf(" %8d %8d %8zu %10.1f", one.min, one.max, one.distinct, one.rms_speed);
    } else {
      std::printf(" %8s %8s %8zu %10s", "-", "-", one.distinct, "-");
    }
    std::printf(" %5.1f %%", 100 * one.moves);
    if (ideal_bits != nullptr) std::printf(" %12.1f", ideal_bits[one.number] / seconds);
    const std::string text = remark(one);
    std::printf(text.empty() ? "\n" : "  %s\n", text.c_str());
  }
}

// --- all of it

const double* fap_bits(const Statistics& s) {
  return s.bits ? s.bits->ideal_fap_bits.data() : nullptr;
}
const double* bap_bits(const Statistics& s) {
  return s.bits ? s.bits->ideal_bap_bits.data() : nullptr;
}

Json describe(const Statistics& s) {
  const double seconds = seconds_of(s);
  Json json = {{"kind", kind_name(s.input.kind)},
               {"face_frames", s.input.face.frames.size()},
               {"body_frames", s.input.body.frames.size()},
               {"rate", fap::format_rate(rate_of(s))},
               {"seconds", seconds}};
  if (s.bits) describe(*s.bits, json);
  json["faps"] = describe(s.faps, "fap", fap_bits(s), seconds);
  json["baps"] = describe(s.baps, "bap", bap_bits(s), seconds);
  return json;
}

void print(const Statistics& s) {
  const double seconds = seconds_of(s);
  const std::size_t faces = s.input.face.frames.size();
  const std::size_t bodies = s.input.body.frames.size();
  std::printf("%s: %.3f s, %s frames a second, ", kind_name(s.input.kind), seconds,
              fap::format_rate(rate_of(s)).c_str());
  if (faces > 0) std::printf("%zu of a face%s", faces, bodies > 0 ? ", " : "\n");
  if (bodies > 0) std::printf("%zu of a body%s\n", bodies, faces > 0 ? "" : ", no face");
  if (faces + bodies == 0) std::printf("neither a face nor a body\n");
  if (s.bits) print(*s.bits);
  print(s.faps, true, fap_bits(s), seconds);
  print(s.baps, false, bap_bits(s), seconds);
}

// Row by row: a clip takes its time.
Result<int> print_sizes(const Options& options) {
  std::vector<inspect::ClipSizes> clips;
  const auto print = [&](const std::string& text) {
    if (!options.json) std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
  };
  print(inspect::sizes_heading());
  for (const std::string& file : options.inputs) {
    Result<FaceInput> input = read_face(file);
    if (!input) return input.error();
    const std::string name = std::filesystem::path(file).stem().string();
    Result<inspect::ClipSizes> clip = inspect::measure_sizes(name, input->clip, options.rms);
    if (!clip) return clip.error().in_file(file);
    print(inspect::sizes_row(*clip));
    clips.push_back(std::move(*clip));
  }
  print(inspect::sizes_means(clips, options.rms));
  if (options.json) std::printf("%s\n", inspect::sizes_json(clips, options.rms).c_str());
  const bool same = std::all_of(clips.begin(), clips.end(),
                                [](const inspect::ClipSizes& clip) { return clip.same_values; });
  return same ? kOk : kCheckFailed;
}

Result<int> run(const Options& options) {
  if (options.sizes) return print_sizes(options);
  if (options.inputs.size() != 1)
    return usage_error("several files can be given with --sizes only");
  Result<Statistics> statistics = measure(options.inputs.front());
  if (!statistics) return statistics.error();
  if (options.json) {
    std::printf("%s\n", describe(*statistics).dump(2).c_str());
  } else {
    print(*statistics);
  }
  return kOk;
}

Action add(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("file", options->inputs, "FBA stream, container, FAP or BAP text, curves")
      ->required();
  CLI::Option* sizes = app.add_flag(
      "--sizes", options->sizes,
      "How small each clip gets with encode --preset file, beside the form common in the wild");
  app.add_option("--rms", options->rms, "With --sizes: limit of the error of the last column")
      ->check(CLI::Range(1e-3, 1e6))
      ->capture_default_str()
      ->needs(sizes);
  app.add_flag("--json", options->json, "Machine-readable result");
  return [options] { return run(*options); };
}

}  // namespace

const Command kStats{"stats", "Bit rate of a stream, activity of each FAP and BAP",
                     "  animeme stats talk.fba\n"
                     "  animeme stats talk.fap --json\n"
                     "  animeme stats --sizes clips/*.fap",
                     add};

}  // namespace animeme::tools
