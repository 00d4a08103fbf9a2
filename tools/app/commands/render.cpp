#include <charconv>
#include <cmath>
#include <filesystem>

#include "dam/script/script.h"
#include "fap/rate_text.h"
#include "fap/turns.h"
#include "tools/app/commands/avatar_export.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/fap_names.h"
#include "tools/app/commands/head_options.h"
#include "tools/app/commands/preview.h"
#include "tools/app/commands/report.h"
#include "tools/app/commands/said_visemes.h"
#include "tools/app/commands/script_options.h"
#include "tools/app/commands/shown_people.h"
#include "tools/app/commands/track_option.h"
#include "tools/formats/files/cost.h"
#include "tools/speech/talking/voice_file.h"
#include "tools/view/render/png.h"
#include "tools/view/render/scene.h"
#include "tools/view/studio/frames.h"
#include "tools/view/studio/head_view.h"
#include "tools/view/studio/picture_file.h"

namespace animeme::tools {

namespace {

constexpr int kLargestPicture = 8192;  // pixels a side, a whole sheet
constexpr int kMostPictures = 400;

struct RenderOptions {
  std::string track;  // of several languages or people
  PeopleChoice people;
  LengthLimit length;
  std::string input;
  std::string output;
  std::string shapes;
  std::int64_t frame = -1;
  std::vector<double> times;
  std::string sheet;
  studio::HeadChoice head;
  std::string view = "front";
  double up = 0;
  double zoom = 1;
  double lens = 0;
  std::string aim = "face";
  bool follow = false;
  std::string size = "640x640";
  bool size_told = false;
  std::string background;
  bool captions = false;
  std::string audio;
  std::string script;
  std::string mouth = kMouthByVisemes;
  speech::ScriptInput reading;
  std::string rate;
  std::vector<std::string> curves;
  int quality = 20;
  int audio_bit_rate = 0;
};

struct Pair {
  int x = 0;
  int y = 0;
};

constexpr Pair kSizeOfPeople = {960, 540};

// "640x480"; both from 1 to `most`.
std::optional<Pair> parse_pair(const std::string& text, int most) {
  Pair pair;
  const char* end = text.data() + text.size();
  const auto [middle, bad_x] = std::from_chars(text.data(), end, pair.x);
  if (bad_x != std::errc() || middle == end || *middle != 'x') return std::nullopt;
  const auto [stop, bad_y] = std::from_chars(middle + 1, end, pair.y);
  if (bad_y != std::errc() || stop != end) return std::nullopt;
  if (pair.x < 1 || pair.y < 1 || pair.x > most || pair.y > most) return std::nullopt;
  return pair;
}

// What is wrong with a value, for the line that is read.
std::string problem_of_pixels(const std::string& text) {
  return parse_pair(text, kLargestPicture) ? "" : "write WIDTHxHEIGHT, such as 640x640, up to 8192";
}

std::string problem_of_sheet(const std::string& text) {
  const auto sheet = parse_pair(text, kMostPictures);
  return sheet && sheet->x * sheet->y <= kMostPictures
             ? ""
             : "write COLUMNSxROWS, such as 4x3, of at most 400 pictures";
}

std::string problem_of_view(const std::string& text) {
  const auto degrees = render::view_degrees(text);
  return degrees && std::abs(*degrees) <= 360
             ? ""
             : "write front, three-quarter, side or degrees to the left";
}

// What was asked for, checked.
struct Plan {
  Pair size;
  Pair sheet;
  studio::Background background;
  studio::HeadLook look;
};

Result<Plan> make_plan(const RenderOptions& options) {
  Plan plan;
  plan.size = parse_pair(options.size, kLargestPicture).value_or(Pair{});
  if (!options.people.people.empty() && !options.size_told) plan.size = kSizeOfPeople;
  plan.sheet = parse_pair(options.sheet, kMostPictures).value_or(Pair{1, 1});
  if (plan.size.x * plan.sheet.x > kLargestPicture ||
      plan.size.y * plan.sheet.y > kLargestPicture) {
    return make_error(
        Code::invalid_argument,
        "the sheet is larger than 8192 pixels: make the pictures smaller with --size");
  }
  if (std::string problem = studio::problem_of(options.head); !problem.empty()) {
    return make_error(Code::invalid_argument, std::move(problem));
  }
  if (!options.background.empty()) {
    const auto background = studio::parse_background(options.background);
    if (!background) return background.error();
    plan.background = *background;
  }
  plan.look = {options.head,
               render::view_degrees(options.view).value_or(0),
               options.up,
               options.zoom,
               plan.size.x,
               plan.size.y,
               plan.background,
               options.lens,
               options.aim == "mouth",
               options.follow};
  return plan;
}

// The user's own head may have faces for FAP 2.
fap::FillOptions filling_of(const RenderOptions& options) {
  return {.keep_expressions = moves_by_itself(options.head)};
}

Result<std::vector<studio::ShownFrame>> choose_frames(const RenderOptions& options,
                                                      const Plan& plan) {
  if (!options.shapes.empty()) return studio::shape_frames(options.shapes);
  Result<FaceInput> input = read_face(options.input);
  if (!input) return input.error();
  const Result<fap::Sequence> clip =
      shown_face(*input, options.input, filling_of(options), options.length);
  if (!clip) return clip.error();
  Result<std::vector<studio::ShownFrame>> frames =
      options.frame >= 0       ? studio::frame_number(*clip, options.frame)
      : !options.times.empty() ? studio::frames_at(*clip, options.times)
                               : studio::even_frames(*clip, plan.sheet.x * plan.sheet.y);
  if (!frames) return frames.error().in_file(options.input);
  const Result<dam::Script> script = script_for(options.script, {options.input}, options.reading);
  if (!script) return script.error();
  studio::say_in(*frames, *clip, said_visemes(*input, *clip, *script, options.mouth));
  return frames;
}

Result<std::vector<PersonClip>> people_of(const RenderOptions& options, bool interpolate) {
  return read_people({options.input, wanted_track_of(options.track), options.head, options.length,
                      options.mouth, options.reading, interpolate},
                     options.people);
}

std::vector<studio::StagePerson> stage_of(const std::vector<PersonClip>& people, double turned) {
  std::vector<studio::StagePerson> all;
  for (const PersonClip& person : people) {
    all.push_back({person.head, studio::turned_to_others(all.size(), people.size(), turned),
                   &person.clip, person.visemes});
  }
  return all;
}

// Columns that make the sheet about as wide as high.
int columns_for(std::size_t pictures) {
  int columns = 1;
  while (std::size_t(columns * columns) < pictures) ++columns;
  return columns;
}

// The pictures in rows of `columns`; 0: as fits, and it receives them. `count` receives how many.
Result<render::Image> sheet_of_face(const Plan& plan, const RenderOptions& options,
                                    std::size_t& count, int& columns) {
  const auto frames = choose_frames(options, plan);
  if (!frames) return frames.error();
  count = frames->size();
  if (columns == 0) columns = columns_for(count);
  return studio::draw_sheet(plan.look, *frames, columns, terminal_log());
}

// The same of people, by the frames of the first of them.
Result<render::Image> sheet_of_people(const Plan& plan, const RenderOptions& options,
                                      std::size_t& count, int& columns) {
  const auto people = people_of(options, false);
  if (!people) return people.error();
  const fap::Sequence& clip = people->front().clip;
  const auto frames = options.frame >= 0 ? studio::frame_number(clip, options.frame)
                      : !options.times.empty()
                          ? studio::frames_at(clip, options.times)
                          : studio::even_frames(clip, plan.sheet.x * plan.sheet.y);
  if (!frames) return frames.error().in_file(options.input);
  auto stage =
      studio::Stage::make(plan.look, stage_of(*people, options.people.turned), terminal_log());
  if (!stage) return stage.error();
  std::vector<render::Image> drawn;
  for (const studio::ShownFrame& shown : *frames) drawn.push_back(stage->draw(shown.seconds));
  count = drawn.size();
  if (columns == 0) columns = columns_for(count);
  return render::contact_sheet(drawn, std::min(columns, int(count)));
}

Result<std::vector<std::uint8_t>> file_of(const render::Image& sheet,
                                          const RenderOptions& options) {
  const std::string extension = options.output == "-" ? ".png" : extension_of(options.output);
  return studio::picture_of(sheet, extension, studio::picture_quality(options.quality));
}

const std::string& sound_path(const RenderOptions& options) {
  return options.audio.empty() ? options.input : options.audio;
}

// The sound of the video, copied where the file takes it; nothing where the face has none.
Result<std::optional<speech::SoundInput>> sound_of(const RenderOptions& options) {
  const bool own = options.audio.empty();
  const bool only_opus = media::usual_codec(options.output) == media::AudioCodec::opus;
  Result<speech::SoundInput> sound = speech::read_sound(
      sound_path(options),
      [only_opus](media::AudioCodec codec) {
        return !only_opus || codec == media::AudioCodec::opus;
      },
      terminal_log());
  if (sound) return std::optional(std::move(*sound));
  if (!own) return sound.error();
  return std::optional<speech::SoundInput>();
}

// A film with the sound of the options.
Result<int> write_with_sound(const RenderOptions& options, const fap::Sequence& clip,
                             const std::vector<media::TextTrack>& texts,
                             const studio::FilmOptions& preview) {
  const Result<std::optional<speech::SoundInput>> sound = sound_of(options);
  if (!sound) return sound.error();
  media::MuxInput tracks;
  if (*sound && (*sound)->samples && is_on_disk(sound_path(options))) {
    tracks.audio_file = &sound_path(options);  // with both of its channels
  } else if (*sound) {
    (*sound)->give_to(tracks);
  }
  tracks.texts = &texts;
  return write_preview(options.output, clip, tracks, preview);
}

Error no_words_for_captions(const RenderOptions& options) {
  return make_error(Code::not_found, "no words are known for --captions: give them with --script")
      .in_file(options.input);
}

Result<int> film_of_people(const RenderOptions& options, studio::FilmOptions preview) {
  const auto people = people_of(options, true);
  if (!people) return people.error();
  const dam::Script words = words_of_people(*people);
  if (options.captions) {
    if (words.phones.empty()) return no_words_for_captions(options);
    preview.captions = &words;
  }
  preview.people = stage_of(*people, options.people.turned);
  RenderOptions sounding = options;
  const auto own = sound_of_people(options.input, *people);
  if (!own) return own.error();
  if (options.audio.empty()) sounding.audio = own->path;
  const auto texts = speech::carried_texts(words, people->front().labels.language);
  return write_with_sound(sounding, people->front().clip, texts, preview);
}

Result<int> render_video(const RenderOptions& options, const Plan& plan) {
  studio::FilmOptions preview{
      .look = plan.look, .quality = options.quality, .audio_bit_rate = options.audio_bit_rate};
  if (!options.rate.empty()) {
    const Result<fap::Rate> rate = fap::parse_rate(options.rate);
    if (!rate) return rate.error();
    preview.rate = *rate;
  }
  Result<std::vector<int>> faps = fap_numbers(options.curves);
  if (!faps) return faps.error();
  if (faps->size() > 3) return usage_error("--curves shows at most three FAPs");
  preview.faps = std::move(*faps);
  if (!options.people.people.empty()) return film_of_people(options, std::move(preview));
  Result<FaceInput> input = read_face(options.input);
  if (!input) return input.error();
  fap::FillOptions filling = filling_of(options);
  filling.interpolate = true;
  Result<fap::Sequence> clip = shown_face(*input, options.input, filling, options.length);
  if (!clip) return clip.error();
  fap::smooth_turns(*clip);
  const Result<dam::Script> script = script_for(options.script, {options.input}, options.reading);
  if (!script) return script.error();
  if (!options.script.empty()) preview.script = &*script;
  if (options.captions) {
    if (script->phones.empty()) return no_words_for_captions(options);
    preview.captions = &*script;
  }
  preview.visemes = said_visemes(*input, *clip, *script, options.mouth);
  const auto texts = speech::carried_tracks(options.input, terminal_log());
  return write_with_sound(options, *clip, texts, preview);
}

Result<int> draw_all(const RenderOptions& options) {
  if (options.input.empty() == options.shapes.empty()) {
    return usage_error("give a file to show, or --shapes visemes or expressions");
  }
  if (!options.people.people.empty() && (!options.shapes.empty() || !options.script.empty())) {
    return usage_error("--people have the words of their file; leave out --shapes and --script");
  }
  const Result<Plan> plan = make_plan(options);
  if (!plan) return usage_error(plan.error().message);
  const std::string extension = extension_of(options.output);
  const bool still = options.frame >= 0 || !options.times.empty() || !options.sheet.empty();
  const bool pictures = still || !options.shapes.empty();
  const bool film =
      !pictures && (studio::is_film(extension) || studio::is_picture_sequence(options.output));
  if (options.captions && !film) return usage_error("--captions is for videos and frame_%04d.png");
  if (plan->look.background.kind == studio::Background::Kind::none && options.output != "-" &&
      !studio::keeps_alpha(extension)) {
    return usage_error(
        "--background none needs a file with transparency: .webm, .mov, .webp or .png");
  }
  if (pictures && studio::is_film(extension) && !studio::is_picture(extension)) {
    return usage_error(
        "a video shows the whole clip; --frame, --time, --sheet and --shapes are for "
        ".png, .jpg and .webp");
  }
  if (film) return render_video(options, *plan);
  std::size_t count = 0;
  int columns = options.sheet.empty() ? 0 : plan->sheet.x;
  Result<render::Image> sheet = options.people.people.empty()
                                    ? sheet_of_face(*plan, options, count, columns)
                                    : sheet_of_people(*plan, options, count, columns);
  if (!sheet) return sheet.error();
  const auto file = file_of(*sheet, options);
  if (!file) return file.error();
  if (auto written = write_file(options.output, *file); !written) return written.error();
  report_output(options.output, std::to_string(count) + (count == 1 ? " picture" : " pictures"),
                {{"pictures", count}, {"columns", columns}, {"bytes", file->size()}});
  return kOk;
}

Result<int> run(const RenderOptions& options) {
  const media::TrackScope tracks(wanted_track_of(options.track));
  AtStep step(Step::rendering);
  Result<int> code = draw_all(options);
  std::error_code unknown;
  const std::uintmax_t bytes = std::filesystem::file_size(options.output, unknown);
  if (code && !unknown) step.made(bytes);
  return code;
}

void add_options(OptionTable& cli, RenderOptions& options) {
  cli.add("input", options.input, "FAP text, FBA stream, container or table of curves");
  cli.add("-o,--output", options.output,
          "File to write: .mp4 or .mkv (H.264), .webm (VP9), .mov (ProRes 4444), .webp or .gif "
          "(animated, silent); a "
          "still or sheet as .png, .jpg or .webp (with --time and the like); frame_%04d.png, a "
          "picture a frame; - is PNG on standard output")
      ->output(".png .jpg .jpeg .webp .gif .mp4 .webm .mkv .mov", OutputKind::file_or_dash)
      ->required();
  cli.add("--shapes", options.shapes,
          "Instead of a file: neutral face and all visemes or expressions")
      ->one_of("visemes expressions");
  cli.add("--frame", options.frame, "Number of the frame to show, from 0")->at_least_zero();
  cli.add("--time", options.times, "Time in seconds to show; several make a sheet")
      ->at_commas()
      ->at_least_zero();
  cli.add("--sheet", options.sheet,
          "Contact sheet, COLUMNSxROWS: frames evenly spaced over the clip")
      ->type("COLUMNSxROWS")
      ->check(problem_of_sheet);
  cli.get("--frame")->excludes("--time --shapes --sheet");
  cli.get("--time")->excludes("--shapes");
  add_length_option(cli, options.length);
  add_head_options(cli, options.head);
  add_people_options(cli, options.people);
  cli.add("--view", options.view, "front, three-quarter, side, or degrees to the person's left")
      ->type("VIEW")
      ->check(problem_of_view)
      ->show_default();
  cli.add("--up", options.up, "Degrees that the camera looks down from above")
      ->between(-80, 80)
      ->show_default();
  cli.add("--zoom", options.zoom, "1: head and shoulders; 2: twice as near")
      ->between(0.2, 20.0)
      ->show_default();
  cli.add("--aim", options.aim, "What is in the middle of the picture: face or mouth")
      ->one_of("face mouth")
      ->show_default();
  cli.add("--lens", options.lens,
          "Focal length, as of 35 mm film: 24 exaggerates the nose, 135 flattens; the head keeps "
          "its size; default: 61")
      ->type("MM")
      ->between(10, 1000);
  cli.add("--follow", options.follow, "The camera goes with the head, which stays in its place");
  cli.add("--size", options.size, "Size of one picture in pixels, WIDTHxHEIGHT; of people 960x540")
      ->type("WIDTHxHEIGHT")
      ->check(problem_of_pixels)
      ->show_default()
      ->sets(options.size_told);
  cli.add("--background", options.background,
          "Behind the head: none (transparent: .webm, .mov, .webp, .png), a colour (#336699, "
          "white, lime "
          "...) or a picture (.png, .jpg, .webp), which fills the frame; default: grey")
      ->type("COLOUR|PICTURE")
      ->check(problem_of<studio::parse_background>);
  cli.add("--captions", options.captions,
          "Video: what is said, in the picture; the word that is said has another colour");
  cli.add("--audio", options.audio, "Video: sound; default: that of the input");
  cli.add("--script", options.script,
          "Phones: below the face of a video, and for --mouth; default for --mouth: those in the "
          "container");
  add_mouth_option(cli, options.mouth);
  add_script_options(cli, options.reading.reading, options.reading.language);
  cli.add("--curves", options.curves,
          "Video: up to three FAPs to plot below the face, by number or name")
      ->at_commas()
      ->at_most(3)
      ->type("FAPS")
      ->check(problem_of<faps_of>);
  cli.add("--rate", options.rate, "Video: frames per second; default: that of the clip")
      ->frame_rate();
  cli.add("--quality", options.quality, "Video, .jpg and .webp: 0 (best) to 51 (smallest)")
      ->between(0, 51)
      ->show_default();
  cli.add("--audio-bitrate", options.audio_bit_rate, "Video: bits per second of the sound")
      ->between(6000, 320000);
  add_track_option(cli, options.track);
  cli.show_in_help_all("Details of heads, cameras and scripts",
                       "--shape-name --shape-names --tier --speak-marks --script-format "
                       "--max-seconds --audio-bitrate --aim --lens --follow");
}

}  // namespace

const Command kRender{
    "render", "Render videos and pictures of a face",
    "  animeme render talk.mp4 -o video.mp4\n"
    "  animeme render talk.fba --audio voice.wav --script talk.TextGrid --curves "
    "open_jaw,raise_b_midlip -o talk.webm\n"
    "  animeme render talk.fap --time 1.5 -o still.png     # .jpg, .webp\n"
    "  animeme render talk.fap --size 256x256 -o talk.webp    # animated in READMEs and chats\n"
    "  animeme render talk.mp4 --size 1080x1920 --captions --background white -o short.mp4\n"
    "  animeme render talk.mp4 --background none -o over.webm    # or frame_%04d.png\n"
    "  animeme render talk.mp4 --sheet 4x3 --head man --view three-quarter "
    "-o sheet.png\n"
    "  animeme render talk.mp4 --people Ann=woman,Bob=man -o two.mp4   # side by side\n"
    "  animeme render --shapes visemes --size 200x200 -o visemes.png",
    set_up<RenderOptions>};

}  // namespace animeme::tools
