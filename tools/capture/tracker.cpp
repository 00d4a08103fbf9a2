#include "tools/capture/tracker.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "dam/script/table_text_internal.h"
#include "fap/rate_text.h"
#include "tools/check/children.h"
#include "tools/files/files.h"
#include "tools/media/container.h"
#include "tools/text.h"

namespace animeme::tools {

namespace {

namespace fs = std::filesystem;

constexpr double kMostApart = 10;                             // seconds: else a start is not stated
constexpr std::size_t kLastWords = 600;                       // bytes of what a tracker said
constexpr std::streamoff kLastRead = 16384;                   // of which those are found
constexpr double kLook = 0.2;                                 // seconds between looks at it
constexpr std::uint64_t kMostTable = std::uint64_t(1) << 30;  // bytes, as read_file()

// A folder that goes with all its files.
class Scratch {
 public:
  Scratch() {
    std::error_code error;
    std::string name = (fs::temp_directory_path(error) / "animeme-track-XXXXXX").string();
    if (!error && ::mkdtemp(name.data()) != nullptr) path_ = name;
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  bool good() const { return !path_.empty(); }
  std::string file(const char* name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

// How far a tracker is, if a line of it ends in "42 %".
std::optional<double> share_told(std::string_view line) {
  const auto trim = [&line] { line = line.substr(0, line.find_last_not_of(" \t") + 1); };
  trim();
  if (!line.ends_with('%')) return std::nullopt;
  line.remove_suffix(1);
  trim();
  line.remove_prefix(line.find_last_not_of("0123456789.") + 1);  // none: the whole line
  const std::optional<double> percent = dam::parse_number(line);
  if (!percent || *percent > 100) return std::nullopt;
  return *percent / 100;
}

// What a tracker said last: how far it is, and the rest.
struct Said {
  std::optional<double> share;
  std::string words;
};

Said said_in(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? std::streamoff(file.tellg()) : 0;
  std::string text(std::size_t(std::min(size, kLastRead)), '\0');
  file.seekg(size - std::streamoff(text.size()));
  file.read(text.data(), std::streamsize(text.size()));
  text.resize(std::size_t(std::max<std::streamsize>(file.gcount(), 0)));
  Said said;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    if (const auto share = share_told(line)) {
      said.share = share;
    } else if (!line.empty()) {
      said.words += (said.words.empty() ? "" : "\n") + line;
    }
  }
  return said;
}

std::string last_words(const std::string& path) {
  const std::string words = said_in(path).words;
  if (words.empty()) return {};
  return "; it said: " +
         (words.size() > kLastWords ? words.substr(words.size() - kLastWords) : words);
}

std::string how(const ChildEnd& end) {
  if (end.how == ChildEnd::How::crashed) return "ended by " + signal_text(end.code);
  return "ended with exit code " + std::to_string(end.code);
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
  const Scratch scratch;
  if (!scratch.good()) {
    return make_error(Code::io, "no folder for temporary files can be made; set TMPDIR");
  }
  const std::string out = scratch.file("track.csv");
  const std::string said = scratch.file("said");
  ChildJob job;
  // A name that begins with - would be an option.
  const std::string in = video.starts_with("-") ? "./" + video : video;
  job.arguments = fill_in(command_, in, out, {});
  job.out = command_.names_out ? said + ".out" : out;
  job.err = said;
  job.most_bytes = kMostTable;
  Children children(seconds);
  if (auto started = children.start(0, job); !started) return started.error().in_file(video);
  std::optional<Children::Finished> finished;
  while (!(finished = children.wait_for(kLook))) {
    if (progress.stop()) {
      return make_error(Code::io, "the tracker was stopped before its end").in_file(video);
    }
    if (const auto share = said_in(said).share) progress.at(*share);
  }
  const ChildEnd end = finished->end;
  if (end.how == ChildEnd::How::timed_out) {
    return make_error(Code::out_of_range,
                      format("the tracker took more than %g s and was stopped; --tracker-seconds "
                             "allows more",
                             seconds) +
                          last_words(said))
        .in_file(video);
  }
  if (end.how != ChildEnd::How::exited || end.code != 0) {
    return make_error(Code::not_found, "the tracker " + how(end) + last_words(said)).in_file(video);
  }
  std::error_code ignored;
  if (!fs::is_regular_file(out, ignored) || fs::file_size(out, ignored) == 0) {
    return make_error(Code::not_found, "the tracker wrote no table" + last_words(said))
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
