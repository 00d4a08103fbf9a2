// Reading whatever holds motion: text, streams, containers, tables of curves.
#include <filesystem>
#include <utility>

#include "codec/decode/access_unit.h"
#include "dam/corpus/corpus.h"
#include "dam/signal/fap_signal.h"
#include "fap/text.h"
#include "tools/commands/arkit_csv.h"
#include "tools/commands/common.h"
#include "tools/commands/landmark_import.h"
#include "tools/media/container.h"

namespace animeme::tools {

namespace {

std::string_view text_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Decodes the stream of `input`.
Result<MotionInput> with_decoded(MotionInput input, const std::string& path) {
  Result<fba::DecodedStream> decoded = fba::decode(input.stream);
  if (!decoded) return decoded.error().in_file(path);
  for (const std::string& text : decoded->warnings) warn(path + ": " + text);
  input.face = fba::face_sequence(*decoded);
  input.body = fba::body_sequence(*decoded);
  if (path != "-") {
    input.face.name = std::filesystem::path(path).stem().string();
    input.body.name = input.face.name;
  }
  input.decoded = std::move(*decoded);
  return input;
}

template <class Sequence>
Result<Sequence> tell_quirks(Result<Sequence> clip, const std::vector<std::string>& warnings,
                             const std::string& path) {
  if (!clip) return clip.error().in_file(path);
  for (const std::string& text : warnings) warn(path + ": " + text);
  return clip;
}

// Curves of FAPs, of a phone's face capture, or landmarks.
Result<fap::Sequence> read_table_of_curves(std::string_view text,
                                           std::vector<std::string>& warnings) {
  if (is_arkit_csv(text)) return read_arkit_csv(text, {}, warnings);
  if (is_landmark_csv(text)) {
    auto face = import_landmarks(text, {}, warnings);
    if (!face) return face.error();
    return std::move(face->clip);
  }
  Result<dam::Signal> signal = dam::read_curves(text);
  if (!signal) return signal.error();
  return dam::to_sequence(*signal);
}

}  // namespace

Result<MotionInput> read_motion(const std::string& path, FrameNumbers numbers) {
  Result<std::vector<std::uint8_t>> bytes = read_file(path);
  if (!bytes) return bytes.error();
  return parse_motion(std::move(*bytes), path, numbers);
}

Result<MotionInput> parse_motion(std::vector<std::uint8_t> bytes, const std::string& path,
                                 FrameNumbers numbers) {
  if (bytes.empty()) return make_error(Code::truncated, "the file is empty").in_file(path);
  MotionInput input;
  input.kind = kind_of(bytes);
  std::vector<std::string> warnings;
  switch (input.kind) {
    case FileKind::fap_text: {
      fap::ReadTextOptions options;
      options.keep_numbers = numbers == FrameNumbers::keep;
      auto clip = fap::read_text(text_of(bytes), options, &warnings);
      clip = tell_quirks(std::move(clip), warnings, path);
      if (!clip) return clip.error();
      input.face = std::move(*clip);
      return input;
    }
    case FileKind::bap_text: {
      auto body = fba::read_bap_text(text_of(bytes), &warnings);
      body = tell_quirks(std::move(body), warnings, path);
      if (!body) return body.error();
      input.body = std::move(*body);
      return input;
    }
    case FileKind::curves: {
      auto clip = read_table_of_curves(text_of(bytes), warnings);
      clip = tell_quirks(std::move(clip), warnings, path);
      if (!clip) return clip.error();
      input.face = std::move(*clip);
      return input;
    }
    case FileKind::media: {
      auto container = is_playlist(bytes)
                           ? media::read_container(path)
                           : media::read_container(std::span<const std::uint8_t>(bytes));
      if (!container) return container.error().in_file(path);
      for (const std::string& text : container->warnings) warn(path + ": " + text);
      const fba::AccessUnits& face = container->face;
      if (!face.units.empty()) {
        input.start = double(face.units.front().time) / face.timescale;
      }
      input.stream = fba::join_access_units(face);
      return with_decoded(std::move(input), path);
    }
    case FileKind::fba_stream:
      input.stream = std::move(bytes);
      return with_decoded(std::move(input), path);
    default:
      return make_error(Code::syntax,
                        "this holds no face: .fap text, a raw .fba stream or an mp4, mkv or ts "
                        "file with an FBA track is needed")
          .in_file(path);
  }
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
  return FaceInput{std::move(input.face), std::move(input.stream), input.start};
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
