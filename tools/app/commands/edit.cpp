#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "fap/rate_text.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/edit_motion.h"
#include "tools/app/commands/edit_options.h"
#include "tools/app/commands/edit_planes.h"
#include "tools/app/commands/edit_sound.h"
#include "tools/app/commands/edit_source.h"
#include "tools/app/commands/face_stream.h"
#include "tools/app/commands/face_text.h"
#include "tools/app/commands/outputs.h"
#include "tools/app/commands/report.h"
#include "tools/app/commands/track_option.h"
#include "tools/formats/common/text.h"
#include "tools/formats/files/cost.h"
#include "tools/formats/files/files.h"
#include "tools/formats/files/output_file.h"
#include "tools/formats/programs/scratch_folder.h"

namespace animeme::tools {

namespace {

struct EditSettings {
  std::string track;  // of several languages or people
  std::vector<std::string> inputs;
  std::string output;
  EditSpan span;
  std::vector<std::string> at;
  bool copy = false;
  std::string rate;
  double speed = 1;
  double offset = 0;
  double fade = 0;
  double cross_fade = 0;
  bool mirror = false;
  std::vector<std::string> scale, smooth, take;
  StreamSettings stream;
  bool quant_given = false;
  SoundSettings sound;
  std::string sound_file;
  bool no_sound = false;
  bool subtitles = false;
};

// What the options say, read.
struct Plan {
  std::vector<EditPiece> pieces;
  EditChanges changes;
  std::vector<EditSource> sources;
  std::vector<EditCut> cuts;   // of sound and words
  std::vector<EditCut> shown;  // of the motion, moved by --offset
  fap::Rate rate;
  double later = 0;  // seconds, less than a frame, by which the face begins behind the sound
};

constexpr double kSameTime = 0.0005;  // seconds

Error invalid_option(const char* option, const Error& error) {
  return make_error(Code::invalid_argument, std::string(option) + ": " + error.message);
}

template <class Value>
Result<void> read_all(const char* option, const std::vector<std::string>& texts,
                      Result<Value> (*read)(const std::string&), std::vector<Value>& into) {
  for (const std::string& text : texts) {
    auto value = read(text);
    if (!value) return invalid_option(option, value.error());
    into.push_back(std::move(*value));
  }
  return {};
}

Result<void> read_options(EditSettings& options, Plan& plan) {
  if (auto ok = read_all("--at", options.at, parse_edit_piece, plan.pieces); !ok) return ok;
  if (options.span.given()) {
    auto piece = options.span.piece();
    if (!piece) return invalid_option("--from, --to", piece.error());
    plan.pieces.push_back(*piece);
  }
  EditChanges& changes = plan.changes;
  if (auto ok = read_all("--scale", options.scale, parse_edit_amount, changes.scale); !ok) {
    return ok;
  }
  if (auto ok = read_all("--smooth", options.smooth, parse_edit_amount, changes.smooth); !ok) {
    return ok;
  }
  if (auto ok = read_all("--take", options.take, parse_edit_take, changes.takes); !ok) return ok;
  for (const EditTake& take : changes.takes) {
    if (take.what != EditTake::What::rest) continue;
    if (!options.inputs.empty()) {
      return make_error(Code::invalid_argument,
                        "--take rest= names the input, which is given already");
    }
    options.inputs.push_back(take.path);
  }
  std::erase_if(changes.takes,
                [](const EditTake& take) { return take.what == EditTake::What::rest; });
  changes.speed = options.speed;
  changes.cross_fade = options.cross_fade;
  changes.mirror = options.mirror;
  changes.fade_in = changes.fade_out = options.fade;
  return {};
}

// A piece of all inputs, one behind the other, as cuts of each.
Result<void> add_cuts(Plan& plan, const EditPiece& piece) {
  const fap::Rate first = plan.sources.front().rate;
  double length = 0;
  for (const EditSource& source : plan.sources)
    length += source.rate.seconds(double(source.frames));
  const auto seconds = [&](const EditTime& time) {
    return time.frames ? first.seconds(time.value) : time.value;
  };
  const double from = seconds(piece.from);
  const double to = piece.to ? std::min(seconds(*piece.to), length) : length;
  const std::size_t before = plan.cuts.size();
  double begin = 0;
  for (const EditSource& source : plan.sources) {
    const auto frame = [&](double time) {
      const double at = std::round((time - begin) * source.rate.frames_per_second());
      return std::clamp<std::int64_t>(std::int64_t(at), 0, source.frames);
    };
    const EditCut cut{&source, frame(from), frame(to)};
    if (cut.end > cut.first) plan.cuts.push_back(cut);
    begin += source.rate.seconds(double(source.frames));
  }
  if (plan.cuts.size() == before) {
    return make_error(
        Code::invalid_argument,
        format("nothing is left from %.3f s to %.3f s; the input lasts %.3f s", from, to, length));
  }
  return {};
}

// --copy: to the nearest intra plane.
void move_to_intra_planes(Plan& plan) {
  for (EditCut& cut : plan.cuts) {
    std::int64_t best = 0;
    for (const std::int64_t frame : intra_frames(*cut.source)) {
      if (frame < cut.end && std::abs(frame - cut.first) < std::abs(best - cut.first)) best = frame;
    }
    if (best == cut.first) continue;
    say(format("%s: the cut at %.3f s moves to the intra plane at %.3f s", cut.source->path.c_str(),
               cut.source->rate.seconds(double(cut.first)),
               cut.source->rate.seconds(double(best))));
    cut.first = best;
  }
}

bool writes_text(const std::string& extension) {
  return extension == ".fap" || extension == ".txt" || extension == ".bap";
}
bool is_container(const std::string& path) {
  const std::string extension = extension_of(path);
  const std::string streams = std::string(" ") + kStreamEndings + " ";
  return path != "-" && !extension.empty() && !writes_text(extension) &&
         streams.find(" " + extension + " ") == std::string::npos;
}

// A later face is held at its beginning, an earlier one loses it. What is less than a frame is left
// to the times of a container.
void move_face(Plan& plan, double offset, bool container) {
  plan.shown = plan.cuts;
  const double rate = plan.rate.frames_per_second();
  std::int64_t frames = std::llround(offset * rate);
  if (container && std::abs(plan.rate.seconds(double(frames)) - offset) > kSameTime) {
    frames = std::int64_t(std::floor(offset * rate));
    plan.later = offset - plan.rate.seconds(double(frames));
  }
  const double exact = plan.rate.seconds(double(frames)) + plan.later;
  if (std::abs(exact - offset) > kSameTime) {
    say(format("--offset: %lld frames, %.3f s; containers move a face by less than a frame",
               static_cast<long long>(frames), exact));
  }
  plan.changes.hold = std::max<std::int64_t>(frames, 0);
  std::int64_t rest = std::max<std::int64_t>(-frames, 0);
  while (rest > 0 && !plan.shown.empty()) {
    EditCut& cut = plan.shown.front();
    const std::int64_t here = std::min(rest, cut.end - cut.first);
    cut.first += here;
    rest -= here;
    if (cut.first == cut.end) plan.shown.erase(plan.shown.begin());
  }
  if (frames < 0 && !plan.shown.empty()) plan.shown.back().end -= frames;
}

Result<void> make_plan(EditSettings& options, Plan& plan) {
  plan.sources.reserve(options.inputs.size());
  for (const std::string& input : options.inputs) {
    auto source = open_edit_source(input);
    if (!source) return source.error();
    plan.sources.push_back(std::move(*source));
  }
  plan.rate = plan.sources.front().rate;
  if (!options.rate.empty()) {
    const Result<fap::Rate> rate = fap::parse_rate(options.rate);
    if (!rate) return rate.error();
    plan.rate = *rate;
  }
  if (plan.pieces.empty()) plan.pieces.emplace_back();
  for (const EditPiece& piece : plan.pieces) {
    if (auto ok = add_cuts(plan, piece); !ok) return ok;
  }
  if (options.copy) move_to_intra_planes(plan);
  move_face(plan, options.offset, is_container(options.output));
  if (plan.shown.empty()) {
    return make_error(Code::invalid_argument, "--offset leaves nothing of the face");
  }
  return {};
}

std::string tell_planes(const fba::SpliceReport& report) {
  std::string text = std::to_string(report.planes) + " planes, ";
  text += report.recoded == 0 ? std::string("all copied")
          : report.recoded == report.planes
              ? std::string("all coded again behind cuts")
              : std::to_string(report.recoded) + " of them coded again behind cuts";
  if (report.changed > 0) {
    text += format(", %zu of those with the nearest value that a quantiser allows", report.changed);
  }
  return text;
}

// The number of planes that were given to `take`.
Result<std::int64_t> code_again(const Plan& plan, const EditSettings& options,
                                const TakeStream& take) {
  const auto motion = EditedMotion::open(plan.shown, plan.rate, plan.changes);
  if (!motion) return motion.error();
  fba::EncodeOptions coding = encode_options(options.stream);
  coding.leave_out = true;
  coding.bap_quant = options.stream.quant;
  if (is_container(options.output)) coding.intra_seconds = options.stream.intra_seconds;
  AtStep step(Step::coding);
  const fba::ClipSource source{
      motion->rate(), [&motion](const fba::TakeInstant& instant) { return motion->each(instant); }};
  const auto report = fba::encode_long(source, coding, take);
  if (!report) return report.error();
  if (coding.default_ranges) warn_of_default_ranges(report->default_ranges);
  return std::max(motion->faces(), motion->bodies());
}

Result<int> write_text(const Plan& plan, const EditSettings& options) {
  const auto motion = EditedMotion::open(plan.shown, plan.rate, plan.changes);
  if (!motion) return motion.error();
  const bool body = extension_of(options.output) == ".bap";
  if (body ? motion->bodies() == 0 : motion->faces() == 0) {
    return make_error(Code::not_found, body ? "there is no body for a .bap" : "there is no face")
        .in_file(plan.sources.front().path);
  }
  OutputFile file(options.output);
  std::int64_t frames = motion->bodies();
  if (body) {
    fba::BodySequence bodies{motion->rate(), {}, motion->name()};
    const auto keep = [&](const fap::Frame*, const fba::BodyFrame* frame) -> Result<void> {
      if (frame != nullptr) bodies.frames.push_back(*frame);
      return {};
    };
    if (auto done = motion->each(keep); !done) return done.error();
    if (auto done = file.write(fba::write_bap_text(bodies)); !done) return done.error();
  } else {
    FaceText text;
    text.frames = [&motion](const TakeFrame& take) {
      return motion->each([&take](const fap::Frame* face, const fba::BodyFrame*) {
        return face == nullptr ? Result<void>() : take(*face, fap::GroupRules{});
      });
    };
    text.rate = motion->rate();
    text.name = motion->name();
    text.expand_mixed = true;
    const auto written = write_face_text(file, name_of_output(options.output), text);
    if (!written) return written.error();
    frames = *written;
  }
  if (auto done = file.publish(); !done) return done.error();
  report_output(options.output, std::to_string(frames) + " frames", {{"frames", frames}});
  return kOk;
}

// What was written in place of a stream that has to be read again.
struct Scratch {
  std::unique_ptr<ScratchFolder> folder;
  std::string path;
};

Result<Scratch> make_scratch() {
  auto folder = ScratchFolder::make();
  if (!folder) return folder.error();
  std::string path = (*folder)->file("edited.fba");
  return Scratch{std::move(*folder), std::move(path)};
}

// `path`: of the coded face.
Result<int> write_container(const Plan& plan, const EditSettings& options,
                            const std::string& path) {
  media::MuxInput input;
  std::optional<fba::UnitReader> reader;
  fba::AccessUnits units;
  const std::int64_t later = std::llround(plan.later * 1e6);
  if (later == 0) {
    auto opened = open_units(path);
    if (!opened) return opened.error();
    reader = std::move(*opened);
    input.face_units = &*reader;
  } else {
    const auto bytes = read_file(path);
    if (!bytes) return bytes.error();
    auto split = fba::split_access_units(*bytes);
    if (!split) return split.error();
    units = std::move(*split);
    for (fba::AccessUnit& unit : units.units)
      unit.time += std::llround(plan.later * units.timescale);
    input.face = &units;
  }
  media::MuxOptions mux;
  mux.audio = audio_settings(options.sound, options.output);
  mux.text_track = media::TextTrackType::metadata;
  std::optional<media::EncodedAudio> sound;
  bool copied = true;
  if (!options.sound_file.empty()) {
    input.audio_file = &options.sound_file;
  } else if (!options.no_sound) {
    copied = options.sound.codec.empty() && options.sound.bit_rate == 0;
    auto cut = cut_sound(plan.cuts, mux.audio, plan.changes.speed, copied);
    if (!cut) return cut.error();
    sound = std::move(*cut);
    if (sound) input.encoded = &*sound;
  }
  std::vector<media::TextTrack> texts;
  if (media::takes_text(options.output)) {
    texts = cut_texts(plan.cuts, plan.changes.speed);
    if (shows_captions(options.output, options.subtitles)) speech::add_captions(texts);
    input.texts = &texts;
  }
  return write_media(options.output, input, mux,
                     copied ? SoundState::plain : SoundState::made_again);
}

std::string wrong_use(const EditSettings& options, const Plan& plan) {
  if (options.inputs.empty()) return "nothing to edit: name a file, or --take rest=FILE";
  if (options.copy && (plan.changes.any() || !options.rate.empty())) {
    return "--copy leaves all values as they are: it goes with cuts, joins and --offset only";
  }
  if (!is_container(options.output) && (!options.sound_file.empty() || options.no_sound)) {
    return "--sound and --no-sound are for files with sound: name an .mp4, .mkv or .ts with -o";
  }
  return {};
}

Result<int> run(EditSettings options) {
  const media::TrackScope tracks(wanted_track_of(options.track));
  Plan plan;
  if (auto ok = read_options(options, plan); !ok) return usage_error(ok.error().message);
  if (const std::string wrong = wrong_use(options, plan); !wrong.empty()) return usage_error(wrong);
  if (auto ok = make_plan(options, plan); !ok) {
    const bool usage = ok.error().code == Code::invalid_argument && ok.error().where.file.empty();
    return usage ? Result<int>(usage_error(ok.error().message)) : Result<int>(ok.error());
  }
  const bool container = is_container(options.output);
  const bool text = writes_text(extension_of(options.output));
  const bool copying = !text && !plan.changes.any() && !options.quant_given &&
                       !options.stream.default_ranges && can_copy(plan.shown, plan.rate);
  if (options.copy && !copying && !text) {
    return make_error(Code::unsupported,
                      "only FBA streams of one frame rate can be copied; leave --copy out")
        .in_file(plan.sources.front().path);
  }
  if (text) return write_text(plan, options);
  std::optional<Scratch> scratch;
  if (container) {
    auto made = make_scratch();
    if (!made) return made.error();
    scratch = std::move(*made);
  }
  OutputFile file(scratch ? scratch->path : options.output);
  std::size_t bytes = 0;
  const auto take = [&](std::span<const std::uint8_t> piece) {
    bytes += piece.size();
    return file.write(piece);
  };
  std::string planes;
  Json facts;
  if (copying) {
    const auto report = copy_planes(plan.shown, plan.changes.hold, container, take);
    if (!report) return report.error();
    planes = tell_planes(*report);
    facts = {
        {"planes", report->planes}, {"recoded", report->recoded}, {"changed", report->changed}};
  } else {
    const auto count = code_again(plan, options, take);
    if (!count) return count.error();
    planes = std::to_string(*count) + " planes coded again";
    facts = {{"planes", *count}, {"recoded", *count}};
  }
  if (auto done = file.publish(); !done) return done.error();
  if (container) {
    say(name_of_output(options.output) + ": " + planes);
    return write_container(plan, options, scratch->path);
  }
  facts["bytes"] = bytes;
  report_output(options.output, planes, facts);
  return kOk;
}

void add_options(OptionTable& cli, EditSettings& options) {
  cli.add("input", options.inputs,
          "Files with motion: FBA streams, .mp4 .mkv .ts with a face, FAP and BAP text; several "
          "are joined in this order");
  cli.add("-o,--output", options.output,
          "File to write: .fba, .fap, .bap, or .mp4, .mkv, .ts with sound and words")
      ->output("")
      ->required();
  add_span_options(cli, options.span);
  cli.add("--at", options.at, "Keep this piece, FROM-TO; several are joined: 0-2.5,10-12")
      ->type("PIECE")
      ->check(problem_of<parse_edit_piece>)
      ->at_commas()
      ->one_at_a_time()
      ->excludes("--from --to");
  cli.add("--copy", options.copy,
          "Cut at the nearest intra planes only, so that every plane keeps its bits; otherwise the "
          "planes from a cut to the next intra plane are coded again with the same values");
  cli.add("--offset", options.offset,
          "Move the face against the sound: later by so many seconds, earlier if negative")
      ->between(-600.0, 600.0);
  cli.add("--rate", options.rate, "Frame rate of the result, by linear interpolation")
      ->frame_rate();
  cli.add("--speed", options.speed,
          "Play faster or slower; 2: twice as fast; the sound keeps its pitch")
      ->between(0.05, 20.0);
  cli.add("--mirror", options.mirror, "Swap left and right");
  cli.add("--take", options.take,
          "Take a part of the face, or the body, from another file: lips=a.fba,rest=b.fba. Parts: "
          "lips jaw brows lids gaze cheeks nose tongue head ears expression body, FAPs such as "
          "open_jaw or 31-38, and rest, which is the input")
      ->type("PART=FILE")
      ->check(problem_of<parse_edit_take>)
      ->at_commas()
      ->one_at_a_time();
  cli.add("--scale", options.scale, "Multiply a part of the face: brows=1.4; 0.8 alone: all of it")
      ->type("PART=FACTOR")
      ->check(problem_of<parse_edit_amount>)
      ->at_commas()
      ->one_at_a_time();
  cli.add("--smooth", options.smooth,
          "Smooth a part of the face over so many seconds: head=0.2; without a delay")
      ->type("PART=SECONDS")
      ->check(problem_of<parse_edit_amount>)
      ->at_commas()
      ->one_at_a_time();
  cli.add("--fade", options.fade, "Begin and end at rest: seconds of each fade")
      ->between(0.0, 600.0);
  cli.add("--cross-fade", options.cross_fade,
          "Seconds in which motion goes over into the next piece at joints, and back where a part "
          "of --take ends")
      ->between(0.0, 60.0);
  add_stream_options(cli, options.stream);
  cli.get("--quant")->sets(options.quant_given);
  add_sound_options(cli, options.sound, false);
  cli.add("--sound", options.sound_file, "Sound file in place of the sound of the inputs");
  cli.add("--no-sound", options.no_sound, "Leave the sound out")->excludes("--sound");
  add_subtitles_option(cli, options.subtitles);
  add_track_option(cli, options.track);
}

}  // namespace

const Command kEdit{
    "edit", "Cut, join and change faces, with their sound and words",
    "  animeme edit talk.mp4 --from 12 --to 14.5 -o part.mp4\n"
    "  animeme edit talk.fba --at 0-2.5,10-12 -o best.fba    # without a change of any value\n"
    "  animeme edit a.mp4 b.mp4 -o ab.mp4                    # one behind the other\n"
    "  animeme edit talk.mp4 --offset 0.04 -o later.mp4      # face against sound\n"
    "  animeme edit talk.fba --rate 25 --speed 0.9 -o slow.fba\n"
    "  animeme edit talk.fba --scale brows=1.4,lips=0.9 --smooth head=0.2 -o calm.fba\n"
    "  animeme edit --take lips=a.fba,rest=b.fba -o both.fba",
    set_up<EditSettings>};

}  // namespace animeme::tools
