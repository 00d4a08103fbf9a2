#include "tools/characters/capture/read_capture.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "dam/corpus/corpus.h"
#include "dam/signal/fap_signal.h"
#include "fap/fill.h"
#include "tools/formats/common/text.h"
#include "tools/formats/exchange/arkit.h"
#include "tools/formats/exchange/face_file.h"
#include "tools/formats/exchange/file_kind.h"
#include "tools/formats/files/files.h"

namespace animeme::tools {

namespace {

using exchange::CaptureKind;

constexpr double kUsualPatience = 3600;  // seconds for a tracker
constexpr double kSlowest = 30;          // seconds of a tracker for one of the video
constexpr double kLongestGap = 0.2;      // seconds of shapes that are filled, as of points

// A video by its first bytes; nothing: no media file.
std::optional<Result<VideoFile>> video_at(const std::string& path) {
  std::error_code ignored;
  if (path == "-" || !std::filesystem::is_regular_file(path, ignored)) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  std::vector<std::uint8_t> head(4096);
  file.read(reinterpret_cast<char*>(head.data()), std::streamsize(head.size()));
  head.resize(std::size_t(std::max<std::streamsize>(file.gcount(), 0)));
  if (!exchange::foreign_sign(head).empty()) return std::nullopt;
  // A program stream (.mpg) begins as a raw FBA stream may.
  const exchange::FileKind kind = exchange::kind_of(head);
  if (kind != exchange::FileKind::media && kind != exchange::FileKind::fba_stream) {
    return std::nullopt;
  }
  if (exchange::is_playlist(head)) return std::nullopt;
  Result<VideoFile> video = look_at_video(path);
  if (!video && video.error().code != Code::not_found) return std::nullopt;
  return video;
}

exchange::LandmarkTableOptions table_options(const CaptureSettings& settings,
                                             const exchange::CaptureTable& table,
                                             const std::optional<VideoFile>& video) {
  exchange::LandmarkTableOptions options = settings.landmarks.table;
  if (!options.rate) options.rate = settings.rate;
  if (!options.rate && video && !exchange::has_times(table.table)) options.rate = video->rate;
  if (!options.size) options.size = table.size;
  if (!options.size && video) options.size = video->shown;
  if (!options.layout) options.layout = table.layout;
  return options;
}

Result<exchange::Imported> read_faps(const std::string& table, std::vector<std::int64_t>& made) {
  const Result<dam::Signal> signal = dam::read_curves(table);
  if (!signal) return signal.error();
  for (std::size_t i = 0; i < signal->measured.size(); ++i) {
    if (!signal->measured[i]) made.push_back(std::int64_t(i));
  }
  auto clip = dam::to_sequence(*signal);
  if (!clip) return clip.error();
  return exchange::Imported{std::move(*clip), {}};
}

// The straight line over frames that are missing between two that are there.
std::vector<std::int64_t> fill_gaps(fap::Sequence& clip) {
  std::vector<std::int64_t> made;
  const double most = kLongestGap * clip.rate.frames_per_second();
  std::vector<fap::Frame> out;
  for (const fap::Frame& frame : clip.frames) {
    const std::int64_t before = out.empty() ? frame.number - 1 : out.back().number;
    if (double(frame.number - before - 1) <= most) {
      const fap::Frame from = out.empty() ? frame : out.back();
      for (std::int64_t number = before + 1; number < frame.number; ++number) {
        fap::Frame between;
        between.number = number;
        const double share = double(number - before) / double(frame.number - before);
        for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
          const auto i = std::size_t(fap);
          if (!from.mask[i] || !frame.mask[i]) continue;
          between.set(fap,
                      int(std::lround(from.value[i] + share * (frame.value[i] - from.value[i]))));
        }
        out.push_back(between);
        made.push_back(number);
      }
    }
    out.push_back(frame);
  }
  clip.frames = std::move(out);
  return made;
}

// A recording that begins without a face begins with the first one that is seen.
void hold_the_first(CapturedFace& face) {
  fap::Frame first = face.clip.frames.front();
  if (first.number <= 0) return;
  face.warnings.push_back(
      format("no face in the first %.3g s, in which the first one that is seen is held",
             face.clip.rate.seconds(double(first.number))));
  first.number = 0;
  face.clip.frames.insert(face.clip.frames.begin(), first);
  face.made.insert(face.made.begin(), 0);
}

}  // namespace

Result<TrackedTable> read_capture_table(const std::string& path, const CaptureSettings& settings,
                                        const Log& log) {
  if (const auto video = video_at(path)) {
    if (!*video) return video->error();
    if (!settings.tracker) {
      return make_error(Code::unsupported,
                        "this is " + (*video)->text +
                            "; a tracker has to find the face in it: --tracker \"command {in} "
                            "{out}\" (tools/characters/trackers has two), or give the table that "
                            "one wrote")
          .in_file(path);
    }
    log.info(path + ": " + (*video)->text + ", tracking");
    const double most = std::max(kUsualPatience, kSlowest * (*video)->seconds);
    auto text =
        settings.tracker->run(path, settings.tracker_seconds.value_or(most), settings.tracking);
    if (!text) return text.error();
    return TrackedTable{std::move(*text), **video};
  }
  // A zero byte is for what foreign_file() knows.
  const auto bytes = read_file(path);
  if (!bytes) return bytes.error();
  return TrackedTable{std::string(bytes->begin(), bytes->end()), std::nullopt};
}

Result<Capture> parse_capture(const TrackedTable& tracked, const std::string& path,
                              const CaptureSettings& settings) {
  auto table = exchange::capture_table(tracked.text, settings.table);
  if (!table) return std::move(table).error().in_file(path);
  Capture capture{path, {}, {}, {}, std::move(table->warnings)};
  switch (table->kind) {
    case CaptureKind::landmarks: {
      auto points = exchange::read_landmark_table(table->table,
                                                  table_options(settings, *table, tracked.video));
      if (!points) return std::move(points).error().in_file(path);
      capture.points = std::move(*points);
      return capture;
    }
    case CaptureKind::arkit: {
      std::optional<fap::Rate> rate = settings.rate;
      if (!rate && tracked.video && !exchange::has_times(table->table)) rate = tracked.video->rate;
      auto motion = exchange::read_arkit_table(table->table, {rate, settings.degrees});
      if (!motion) return std::move(motion).error().in_file(path);
      capture.motion = std::move(*motion);
      return capture;
    }
    case CaptureKind::faps: {
      auto motion = read_faps(table->table, capture.made);
      if (!motion) return std::move(motion).error().in_file(path);
      capture.motion = std::move(*motion);
      return capture;
    }
  }
  return make_error(Code::internal, "a kind of capture without a reader");
}

Result<Capture> read_capture(const std::string& path, const CaptureSettings& settings,
                             const Log& log) {
  const auto table = read_capture_table(path, settings, log);
  if (!table) return table.error();
  return parse_capture(*table, path, settings);
}

Result<CapturedFace> face_of_capture(Capture capture, const CaptureSettings& settings,
                                     const std::optional<fap::RestingFace>& rest) {
  CapturedFace face;
  face.warnings = std::move(capture.warnings);
  const auto add = [&](std::vector<std::string>& warnings) {
    for (std::string& text : warnings) face.warnings.push_back(std::move(text));
  };
  if (capture.motion) {
    add(capture.motion->warnings);
    face.clip = std::move(capture.motion->clip);
    if (settings.landmarks.repair) face.made = fill_gaps(face.clip);
    if (!face.made.empty()) {
      face.warnings.push_back("frames without a face, interpolated: " +
                              std::to_string(face.made.size()));
    }
    face.made.insert(face.made.end(), capture.made.begin(), capture.made.end());
    return face;
  }
  exchange::LandmarkImportOptions options = settings.landmarks;
  if (rest) {
    options.face.rest = rest;
    options.neutral.clear();
  }
  auto import = exchange::import_landmarks(std::move(*capture.points), options);
  if (!import) return std::move(import).error().in_file(capture.path);
  add(import->warnings);
  face.clip = std::move(import->face.clip);
  face.made = import->repairs.made;
  face.start = import->start;
  face.points = std::move(*import);
  if (settings.landmarks.repair) hold_the_first(face);
  return face;
}

void mark_made(dam::Signal& signal, const std::vector<std::int64_t>& made) {
  if (made.empty()) return;
  if (signal.measured.empty()) signal.measured.assign(signal.frames(), true);
  for (const std::int64_t number : made) {
    if (number >= 0 && std::size_t(number) < signal.frames()) {
      signal.measured[std::size_t(number)] = false;
    }
  }
}

Result<std::optional<fap::RestingFace>> neutral_face(const NeutralSource& source,
                                                     const std::vector<Capture>& captures,
                                                     const CaptureSettings& settings,
                                                     const Log& log) {
  using Rest = std::optional<fap::RestingFace>;
  if (!source.face_file.empty()) {
    if (!source.from.empty() || !settings.landmarks.neutral.empty()) {
      return make_error(Code::invalid_argument,
                        "--face-file is the neutral face; leave --neutral and --neutral-from out");
    }
    const auto text = read_text_file(source.face_file, kMostWritten);
    if (!text) return text.error();
    auto rest = exchange::read_face_file(*text);
    if (!rest) return std::move(rest).error().in_file(source.face_file);
    return Rest(std::move(*rest));
  }
  std::vector<exchange::LandmarkTable> tables;
  if (!source.from.empty()) {
    auto capture = read_capture(source.from, settings, log);
    if (!capture) return capture.error();
    if (!capture->points) {
      return make_error(Code::invalid_argument,
                        "this has shapes or FAPs, which have their neutral face in them; "
                        "--neutral-from is for landmarks")
          .in_file(source.from);
    }
    tables.push_back(std::move(*capture->points));
    auto rest = exchange::common_face(tables, settings.landmarks);
    if (!rest) return std::move(rest).error().in_file(source.from);
    return Rest(std::move(*rest));
  }
  for (const Capture& capture : captures) {
    if (capture.points) tables.push_back(*capture.points);
  }
  if (tables.size() < 2) return Rest();
  auto rest = exchange::common_face(tables, settings.landmarks);
  if (!rest) return std::move(rest).error();
  return Rest(std::move(*rest));
}

}  // namespace animeme::tools
