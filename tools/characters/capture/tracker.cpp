#include "tools/characters/capture/tracker.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "dam/script/table_text_internal.h"
#include "fap/rate_text.h"
#include "tools/formats/common/text.h"
#include "tools/formats/files/files.h"
#include "tools/formats/media/container.h"
#include "tools/formats/programs/run_program.h"
#include "tools/formats/programs/scratch_folder.h"

namespace animeme::tools {

namespace {

namespace fs = std::filesystem;

constexpr double kMostApart = 10;                             // seconds: else a start is not stated
constexpr std::uint64_t kMostTable = std::uint64_t(1) << 30;  // bytes, as read_file()

// How far a tracker is, if a line of it ends in "42 %"; else -1.
double share_told(std::string_view line) {
  const auto trim = [&line] { line = line.substr(0, line.find_last_not_of(" \t") + 1); };
  trim();
  if (!line.ends_with('%')) return -1;
  line.remove_suffix(1);
  trim();
  line.remove_prefix(line.find_last_not_of("0123456789.") + 1);  // none: the whole line
  const std::optional<double> percent = dam::parse_number(line);
  if (!percent || *percent > 100) return -1;
  return *percent / 100;
}

}  // namespace

Result<VideoFile> look_at_video(const std::string& path) {
  const Result<media::ContainerInfo> info = media::probe(path);
  if (!info) return info.error();
  VideoFile video;
  const media::TrackInfo* picture = nullptr;
  const media::TrackInfo* sound = nullptr;
  for (const media::TrackInfo& track : info->tracks) {
    if (sound == nullptr && track.kind == media::TrackKind::audio) sound = &track;
    if (picture == nullptr && track.kind == media::TrackKind::video) picture = &track;
  }
  video.sound = sound != nullptr;
  if (picture == nullptr || picture->width <= 0 || picture->height <= 0) {
    return make_error(Code::not_found,
                      video.sound ? "this is sound without a picture; a face needs a video, or the "
                                    "table of a tracker"
                                  : "this has no picture; a face needs a video, or the table of a "
                                    "tracker")
        .in_file(path);
  }
  video.pixel_aspect = picture->pixel_aspect;
  video.shown = {picture->width * picture->pixel_aspect, double(picture->height)};
  video.seconds = info->duration;
  if (sound != nullptr) {
    const double after = picture->start - sound->start;
    if (std::abs(after) <= kMostApart) video.picture_after_sound = after;
  }
  if (picture->frame_rate > 0) {
    const auto rate = fap::parse_rate(format("%.3f", picture->frame_rate));
    if (rate && rate->valid()) video.rate = *rate;
  }
  video.text =
      format("a video (%s, %dx%d", picture->codec.c_str(), picture->width, picture->height);
  if (video.pixel_aspect != 1)
    video.text += format(" shown as %gx%g", std::round(video.shown.width), video.shown.height);
  if (video.rate) video.text += ", " + fap::format_rate(*video.rate) + " frames a second";
  video.text += format(", %.3g s)", video.seconds);
  return video;
}

Result<Tracker> Tracker::parse(const std::string& command) {
  Tracker tracker;
  tracker.line_ = command;
  const bool places = command.find("{in}") != std::string::npos;
  if (!places && command.find("{out}") != std::string::npos) {
    return make_error(
        Code::invalid_argument,
        "the tracker's command has {out} and no {in}; write {in} where the video goes");
  }
  Result<CommandTemplate> parsed = parse_command(places ? command : command + " {in} {out}");
  if (!parsed) return parsed.error();
  tracker.command_ = std::move(*parsed);
  return tracker;
}

Result<std::string> Tracker::run(const std::string& video, double seconds,
                                 const Progress& progress) const {
  const auto scratch = ScratchFolder::make();
  if (!scratch) return scratch.error();
  const std::string out = (*scratch)->file("track.csv");
  ChildJob job;
  const std::string in = path_argument(video);
  Result<std::vector<std::string>> arguments = fill_in(command_, {{{"in", in}, {"out", out}}});
  if (!arguments) return arguments.error();
  job.arguments = std::move(*arguments);
  job.out = command_.names("out") ? (*scratch)->file("said.out") : out;
  job.err = (*scratch)->file("said");
  job.most_bytes = kMostTable;
  const ProgramRun how{"the tracker", "--tracker-seconds", seconds, progress, share_told};
  if (auto done = run_program(job, how); !done) return done.error().in_file(video);
  std::error_code ignored;
  if (!fs::is_regular_file(out, ignored) || fs::file_size(out, ignored) == 0) {
    return make_error(Code::not_found, "the tracker wrote no table" + last_words(job.err, how))
        .in_file(video);
  }
  auto text = read_text_file(out, kMostTable);
  if (!text) {
    Error error = text.error();
    error.message = "what the tracker wrote cannot be read: " + error.message;
    return std::move(error).in_file(video);
  }
  return text;
}

}  // namespace animeme::tools
