// Reading whatever holds motion: what the library exchange reads, and containers.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <utility>

#include "codec/decode/access_unit.h"
#include "codec/decode/fill.h"
#include "fap/tables.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/damage.h"
#include "tools/formats/media/container.h"

namespace animeme::tools {

namespace {

Result<MotionInput> tell_quirks(Result<exchange::Motion> motion, const std::string& path) {
  if (!motion) return std::move(motion).error().in_file(path);
  for (const std::string& text : motion->warnings) warn(path + ": " + text);
  MotionInput input{std::move(*motion)};
  if (!input.stream.empty() && path != "-") {
    input.face.name = std::filesystem::path(path).stem().string();
    input.body.name = input.face.name;
  }
  return input;
}

Result<MotionInput> read_media(const std::vector<std::uint8_t>& bytes, const std::string& path) {
  const auto container = open_container(bytes, path);
  if (!container) return container.error().in_file(path);
  const fba::AccessUnits& face = container->face;
  auto input = tell_quirks(exchange::decode_motion(fba::join_access_units(face)), path);
  if (!input) return input;
  input->kind = FileKind::media;
  if (!face.units.empty()) input->start = double(face.units.front().time) / face.timescale;
  return input;
}

// Heads show expressions of their own where nothing else moves the brows (head::control_values())
// and the stream does not say what an expression looks like.
bool leaves_expressions(const fap::Sequence& clip) {
  constexpr int kBrows = 4;  // group
  return std::none_of(clip.frames.begin(), clip.frames.end(), [](const fap::Frame& frame) {
    if (frame.mask[2] && frame.expression.def) return true;
    const auto& [first, size, name] = fap::kGroups[kBrows - 1];
    for (int fap = first; fap < first + size; ++fap) {
      if (frame.mask[std::size_t(fap)]) return true;
    }
    return false;
  });
}

}  // namespace

bool is_on_disk(const std::string& path) {
  std::error_code unknown;
  return path != "-" && std::filesystem::is_regular_file(path, unknown);
}

Result<std::vector<std::uint8_t>> read_input(const std::string& path) {
  if (is_on_disk(path)) {
    std::ifstream in(path, std::ios::binary);
    std::vector<std::uint8_t> first(4096);
    in.read(reinterpret_cast<char*>(first.data()), std::streamsize(first.size()));
    first.resize(std::size_t(in.gcount()));
    if (!in.bad() && kind_of(first) == FileKind::media) return first;
  }
  return read_file(path);
}

Result<media::Container> open_container(std::span<const std::uint8_t> bytes,
                                        const std::string& path) {
  media::ReadOptions options;
  options.repair = !is_strict();
  auto container = is_on_disk(path) ? media::read_container(path, options)
                                    : media::read_container(bytes, options);
  if (!container) return container;
  for (const std::string& text : container->warnings) warn(path + ": " + text);
  report_damage(path, container->damage);
  return container;
}

Result<MotionInput> read_motion(const std::string& path, FrameNumbers numbers) {
  Result<std::vector<std::uint8_t>> bytes = read_input(path);
  if (!bytes) return bytes.error();
  return parse_motion(std::move(*bytes), path, numbers);
}

Result<MotionInput> parse_motion(std::vector<std::uint8_t> bytes, const std::string& path,
                                 FrameNumbers numbers) {
  if (kind_of(bytes) == FileKind::media) return read_media(bytes, path);
  std::vector<fba::Damage> damage;
  auto motion = exchange::read_motion(std::move(bytes), numbers, is_strict() ? nullptr : &damage);
  report_damage(path, damage);
  return tell_quirks(std::move(motion), path);
}

Result<FaceInput> read_face(const std::string& path) {
  Result<MotionInput> input = read_motion(path);
  if (!input) return input.error();
  return face_of(std::move(*input), path);
}

Result<FaceInput> parse_face(std::vector<std::uint8_t> bytes, const std::string& path) {
  Result<MotionInput> input = parse_motion(std::move(bytes), path);
  if (!input) return input.error();
  return face_of(std::move(*input), path);
}

Result<FaceInput> face_of(MotionInput input, const std::string& path) {
  if (auto ok = require_face(input, path); !ok) return ok.error();
  FaceInput face{std::move(input.face), std::move(input.stream), input.start};
  for (const fba::Plane& plane : input.decoded.planes) {
    if (!fba::has_face(plane.object_mask)) continue;
    const fba::FaceSettings none;
    face.rules.push_back(fba::group_rules(plane.face_settings ? *plane.face_settings : none));
  }
  return face;
}

Result<fap::Sequence> shown_face(const FaceInput& input, const std::string& path,
                                 fap::FillOptions options, const LengthLimit& limit) {
  options.expand = !options.keep_high_level;
  options.keep_expressions = options.keep_expressions && leaves_expressions(input.clip);
  options = limit.filling(options, input.clip.rate);
  Result<fap::Sequence> shown = fap::fill(input.clip, input.rules, options);
  if (shown) return shown;
  Error error = std::move(shown).error();
  if (error.code == Code::out_of_range) error.message += " (--max-seconds)";
  return std::move(error).in_file(path);
}

fap::FillOptions LengthLimit::filling(fap::FillOptions options, const fap::Rate& rate) const {
  if (seconds <= 0) return options;
  options.max_missing = std::int64_t(seconds * rate.frames_per_second());
  options.max_frames = std::max(options.max_frames, options.max_missing);
  return options;
}

void add_length_option(OptionTable& cli, LengthLimit& limit) {
  cli.add("--max-seconds", limit.seconds, "Longest script, and longest gap in a face, in seconds")
      ->value("SECONDS=3600")
      ->between(1.0, dam::kMaxScriptSeconds);
}

Result<void> require_face(const MotionInput& input, const std::string& path) {
  const char* what = nullptr;
  if (input.kind == FileKind::bap_text) {
    what = "this is BAP text: it has a body but no face";
  } else if (!input.stream.empty() && input.face.frames.empty()) {
    what = input.body.frames.empty() ? "the stream codes neither a face nor a body"
                                     : "the stream codes a body but no face";
  }
  if (what == nullptr) return {};
  return make_error(Code::not_found, what).in_file(path);
}

}  // namespace animeme::tools
