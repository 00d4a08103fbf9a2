#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <utility>

#include "fap/head/rig.h"
#include "tools/app/commands/avatar_export.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/face_stream.h"
#include "tools/app/commands/head_options.h"
#include "tools/app/commands/page_sound.h"
#include "tools/app/commands/report.h"
#include "tools/app/commands/said_visemes.h"
#include "tools/app/commands/script_options.h"
#include "tools/app/commands/shown_heads.h"
#include "tools/app/commands/shown_people.h"
#include "tools/app/commands/track_option.h"
#include "tools/formats/common/text.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/track_labels.h"
#include "tools/speech/talking/voice_file.h"
#include "tools/view/studio/stage.h"
#include "tools/view/viewer/viewer.h"

namespace animeme::tools {

namespace {

constexpr double kAboutEqual = 1;         // seconds
constexpr double kLargePage = 3'000'000;  // bytes
constexpr int kLeastKilobits = 12;        // a second; Opus is not worth hearing with less,
constexpr int kMostKilobits = 40;         // and with more not better

struct ViewOptions {
  std::string track;  // of several languages or people
  PeopleChoice people;
  std::string first;
  std::string second;
  std::string output;
  std::string audio;
  SoundSettings sound;
  std::string script;
  std::string mouth = kMouthByVisemes;
  speech::ScriptInput reading;
  LengthLimit length;
  HeadChoices heads;
};

// A clip, and whether it came with a container that may hold sound.
struct ViewedClip {
  viewer::Clip clip;
  FaceInput face;
  bool container = false;
};

Result<ViewedClip> read_shown(const std::string& path, const LengthLimit& length,
                              const fap::FillOptions& filling) {
  Result<MotionInput> input = read_motion(path);
  if (!input) return input.error();
  const bool container = input->kind == FileKind::media;
  Result<FaceInput> face = face_of(std::move(*input), path);
  if (!face) return face.error();
  Result<fap::Sequence> filled = shown_face(*face, path, filling, length);
  if (!filled) return filled.error();
  const std::string name = std::filesystem::path(path).filename().string();
  const double start = face->start;
  return ViewedClip{{std::move(*filled), start, name}, std::move(*face), container};
}

std::string megabytes(double bytes) { return format("%.2f MB", bytes / 1e6); }

// The sound that was asked for, else that of the first container that has one; nothing if none has.
Result<std::optional<PageSound>> sound_of(const ViewOptions& options,
                                          const std::vector<std::string>& containers) {
  const bool asked = !options.audio.empty();
  for (const std::string& path : asked ? std::vector{options.audio} : containers) {
    Result<PageSound> sound = page_sound(path, options.sound);
    if (sound) return std::optional(std::move(*sound));
    if (asked || sound.error().code != Code::not_found) return sound.error();
  }
  return std::optional<PageSound>();
}

// Languages and people of the file, in its order, if the page is to have all of them.
std::vector<media::TrackLabels> tracks_of(const ViewOptions& options) {
  const bool alone = !options.track.empty() || !options.second.empty() || options.first == "-" ||
                     !options.audio.empty() || !options.script.empty();
  std::vector<media::TrackLabels> all;
  if (alone) return all;
  const auto info = media::probe(options.first);
  if (!info) return all;
  for (const media::TrackInfo& track : info->tracks) {
    const bool face = track.kind == media::TrackKind::face;
    const bool known = std::find(all.begin(), all.end(), track.labels) != all.end();
    if (face && !track.labels.empty() && !known) all.push_back(track.labels);
  }
  if (all.size() < 2) all.clear();
  return all;
}

std::string language_of(const media::TrackLabels& labels) {
  return labels.language.empty() ? labels.code : labels.language;
}

// The tracks of a file behind the first one: face, sound and words of each.
Result<void> add_tracks(const ViewOptions& options, std::span<const media::TrackLabels> tracks,
                        const fap::FillOptions& filling, viewer::Page& page) {
  if (tracks.empty()) return {};
  page.lang = language_of(tracks.front());
  page.speaker = tracks.front().speaker;
  for (const media::TrackLabels& labels : tracks.subspan(1)) {
    const media::TrackScope scope(labels);
    Result<ViewedClip> shown = read_shown(options.first, options.length, filling);
    if (!shown) return shown.error();
    viewer::OtherTrack track{labels.language.empty() ? labels.code : labels.language,
                             labels.speaker,
                             std::move(shown->clip),
                             {},
                             {}};
    auto sound = sound_of(options, {options.first});
    if (!sound) return sound.error();
    if (*sound) track.sound = std::move((*sound)->sound);
    auto script = script_for({}, {options.first}, options.reading);
    if (!script) return script.error();
    track.script = std::move(*script);
    track.clip.visemes = said_visemes(shown->face, track.clip.motion, track.script, options.mouth);
    page.tracks.push_back(std::move(track));
  }
  return {};
}

// What belongs together lasts about equally long.
void warn_of_lengths(const viewer::Page& page, const ViewOptions& options, double sound) {
  const double face = page.clips.front().motion.duration();
  const auto check = [face](const std::string& what, double seconds) {
    if (std::abs(seconds - face) <= kAboutEqual) return;
    warn("the face lasts " + seconds_text(face) + ", " + what + " " + seconds_text(seconds));
  };
  if (page.clips.size() > 1) check(options.second, page.clips[1].motion.duration());
  if (page.sound) check("the sound", sound);
  if (!options.script.empty()) check(options.script, page.script.duration());
}

// A page that is too large for mail and phones, and what makes it smaller.
void warn_of_size(const viewer::Page& page, std::size_t size, double seconds) {
  if (double(size) <= kLargePage) return;
  const double sound = page.sound ? double(page.sound->file.size()) * 4 / 3 : 0;
  std::string text = "the page has more than 3 MB, which is much for mail and phones";
  if (page.sound) text += "; " + megabytes(sound) + " of it are sound";
  // What is left for the sound, in base64 and with what an mp4 needs besides.
  const double left = kLargePage - (double(size) - sound);
  const int kilobits = left > 0 && page.sound ? int(left * 3 / 4 * 8 / seconds * 0.9 / 1000) : 0;
  if (kilobits >= kLeastKilobits) {
    text += ": --audio-codec opus --audio-bitrate " +
            std::to_string(std::min(kilobits, kMostKilobits)) + "000 makes it small enough";
  } else {
    text += "; show a shorter clip or a head with fewer vertices";
  }
  warn(text);
}

Result<int> write_page(const ViewOptions& options, const viewer::Page& page, std::size_t heads,
                       double seconds) {
  const Result<std::string> html = viewer::make_page(page);
  if (!html) return html.error();
  if (auto written = write_file(options.output, *html); !written) return written.error();
  report_output(options.output,
                megabytes(double(html->size())) + (page.sound ? ", with sound" : ", silent") +
                    "; open it in a browser",
                {{"bytes", html->size()},
                 {"sound", page.sound.has_value()},
                 {"heads", heads},
                 {"people", std::max<std::size_t>(page.people.size(), 1)},
                 {"languages", 1 + page.tracks.size()}});
  warn_of_size(page, html->size(), seconds);
  return kOk;
}

// People side by side.
Result<int> view_people(const ViewOptions& options) {
  const media::TrackScope tracks(wanted_track_of(options.track));
  std::vector<std::string> heads = options.heads.heads;
  studio::HeadChoice usual = options.heads.rest;
  if (!heads.empty()) usual.head = heads.front();
  auto people = read_people({options.first, wanted_track_of(options.track), usual, options.length,
                             options.mouth, options.reading},
                            options.people);
  if (!people) return people.error();
  const auto own = sound_of_people(options.first, *people);
  if (!own) return own.error();
  ViewOptions sounding = options;
  if (options.audio.empty()) sounding.audio = own->path;
  auto sound = sound_of(sounding, {options.first});
  if (!sound) return sound.error();
  viewer::Page page;
  page.title = std::filesystem::path(options.first).filename().string();
  const double seconds = *sound ? (*sound)->seconds : 0;
  if (*sound) page.sound = std::move((*sound)->sound);
  page.script = words_of_people(*people);
  std::map<std::string, std::unique_ptr<ShownHead>> loaded;
  for (PersonClip& person : *people) {
    std::unique_ptr<ShownHead>& head = loaded[person.head.head];
    if (!head) {
      auto read = load_shown({{person.head.head}, person.head});
      if (!read) return read.error();
      head = std::move(read->front());
    }
    const double turned =
        studio::turned_to_others(page.people.size(), people->size(), options.people.turned);
    page.people.push_back(
        {&head->head,
         &head->rig,
         turned,
         {std::move(person.clip), person.start, person.name, std::move(person.visemes)}});
    page.scripts.push_back(std::move(person.script));
  }
  return write_page(options, page, loaded.size(), seconds);
}

Result<int> run(const ViewOptions& options) {
  if (!options.people.people.empty()) {
    if (!options.second.empty() || !options.script.empty()) {
      return usage_error("--people are those of one file, with its words");
    }
    return view_people(options);
  }
  const std::vector<media::TrackLabels> all = tracks_of(options);
  const media::TrackScope tracks(all.empty() ? wanted_track_of(options.track) : all.front());
  if (const std::string problem = problem_of(options.heads); !problem.empty()) {
    return usage_error(problem);
  }
  auto loaded = load_shown(options.heads);
  if (!loaded) return loaded.error();
  const std::vector<std::unique_ptr<ShownHead>> heads = std::move(*loaded);
  viewer::Page page;
  std::vector<std::string> containers;
  std::vector<FaceInput> faces;
  const auto choices = options.heads.each();
  const fap::FillOptions filling{.keep_expressions =
                                     std::any_of(choices.begin(), choices.end(), moves_by_itself)};
  for (const std::string& path : {options.first, options.second}) {
    if (path.empty()) continue;
    Result<ViewedClip> shown = read_shown(path, options.length, filling);
    if (!shown) return shown.error();
    if (shown->container && path == "-")
      warn("the sound of standard input is not read; give --audio");
    if (shown->container && path != "-") containers.push_back(path);
    page.clips.push_back(std::move(shown->clip));
    faces.push_back(std::move(shown->face));
  }
  Result<std::optional<PageSound>> sound = sound_of(options, containers);
  if (!sound) return sound.error();
  const double seconds = *sound ? (*sound)->seconds : 0;
  if (*sound) page.sound = std::move((*sound)->sound);
  Result<dam::Script> script = script_for(options.script, containers, options.reading);
  if (!script) return script.error();
  page.script = std::move(*script);
  // Two clips are compared: what they say of the mouth is what differs.
  if (faces.size() == 1) {
    viewer::Clip& clip = page.clips.front();
    clip.visemes = said_visemes(faces.front(), clip.motion, page.script, options.mouth);
  }
  if (auto added = add_tracks(options, all, filling, page); !added) return added.error();
  page.head = &heads.front()->head;
  page.rig = &heads.front()->rig;
  page.head_name = heads.front()->name;
  for (std::size_t i = 1; i < heads.size(); ++i) {
    page.others.push_back({&heads[i]->head, &heads[i]->rig, heads[i]->name});
  }
  const auto written = write_page(options, page, heads.size(), seconds);
  if (written) warn_of_lengths(page, options, seconds);
  return written;
}

void add_options(OptionTable& cli, ViewOptions& options) {
  cli.add("input", options.first,
          "FAP text, FBA stream, a container with a face, or a table of curves")
      ->required();
  cli.add("second", options.second, "Another clip to compare with");
  cli.add("-o,--output", options.output, "HTML file to write, - for standard output")
      ->output(".html .htm")
      ->required();
  cli.add("--audio", options.audio,
          "Sound in any format that FFmpeg reads; default: that of the container. AAC and "
          "Opus are kept unless one of the options below is given");
  cli.add("--script", options.script,
          "Phoneme script (of any format) to show with the curves; default: that in the "
          "container");
  add_mouth_option(cli, options.mouth);
  add_script_options(cli, options.reading.reading, options.reading.language);
  add_sound_options(cli, options.sound, false);
  add_length_option(cli, options.length);
  add_heads_options(cli, options.heads.heads, options.heads.rest);
  add_people_options(cli, options.people);
  add_track_option(cli, options.track);
}

}  // namespace

const Command kView{
    "view", "Write an HTML page that shows the talking head in any browser",
    "  animeme view talk.mp4 -o talk.html\n"
    "  animeme view talk.fap --audio voice.wav --script voice.TextGrid --head man "
    "-o talk.html\n"
    "  animeme view talk.mp4 --head woman,man,me.glb -o heads.html\n"
    "  animeme view original.fap coded.fba --audio voice.wav -o loss.html\n"
    "  animeme view film.mp4 -o film.html               # all languages of film.mp4, with a menu\n"
    "  animeme view talk.mp4 --people Ann=woman,Bob=man -o talk.html    # side by side\n"
    "  animeme view lecture.mp4 --audio-codec opus --audio-bitrate 20000 -o lecture.html\n"
    "The page needs no network; ? shows its keys.",
    set_up<ViewOptions>};

}  // namespace animeme::tools
