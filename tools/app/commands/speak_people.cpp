#include "tools/app/commands/speak_people.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "dam/script/script.h"
#include "dam/script/turns.h"
#include "dam/speaking/conversation.h"
#include "fap/rate_text.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/options.h"
#include "tools/app/commands/text_or_file.h"
#include "tools/formats/common/text.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/mix_audio.h"
#include "tools/formats/media/track_labels.h"
#include "tools/formats/programs/scratch_folder.h"
#include "tools/formats/scripts/script_text.h"
#include "tools/speech/text/unicode.h"
#include "tools/speech/voice/pitch.h"

namespace animeme::tools {

namespace {

constexpr std::string_view kEverybody = "all";
constexpr int kProsodyRate = 16000;          // Hz
constexpr std::uint64_t kSeedsApart = 7919;  // of idle motion, from one person to the next
// Variants of a voice of espeak-ng, for those who have no voice of their own.
constexpr std::string_view kVariants[] = {"", "+f3", "+m7", "+f2", "+m4", "+f4"};

// Who plays, and what tells them apart. Empty: as for all.
struct CastMember {
  std::string name;
  std::string language, model, audio, tts, mood, over;
  std::optional<int> pitch, speed;
};

// "Ann,lang=en+f3,model=ann.dam"; a comma of a name is behind a backslash.
Result<CastMember> parse_cast_member(const std::string& text) {
  const auto wrong = [&](const std::string& what) {
    return make_error(Code::invalid_argument, "'" + text + "': " + what);
  };
  std::string_view rest = text;
  CastMember member{.name = media::next_label(rest)};
  if (member.name.empty() || member.name.find('=') != std::string::npos) {
    return wrong("a name comes first, such as Ann,lang=en+f3, or " + std::string(kEverybody));
  }
  if (member.name.size() > 60) return wrong("the name is longer than 60 bytes");
  while (!rest.empty()) {
    const std::string part = media::next_label(rest);
    const std::size_t equals = std::min(part.find('='), part.size());
    const std::string key = part.substr(0, equals);
    const std::string value = part.substr(std::min(equals + 1, part.size()));
    if (value.empty()) return wrong("'" + part + "' lacks a value behind " + key + "=");
    const auto number = [&](int least, int most, std::optional<int>& into) -> Result<void> {
      const bool digits =
          value.size() <= 3 && value.find_first_not_of("0123456789") == std::string::npos;
      const int told = digits ? std::stoi(value) : -1;
      if (told < least || told > most) {
        return wrong(key + " is a number from " + std::to_string(least) + " to " +
                     std::to_string(most));
      }
      into = told;
      return {};
    };
    Result<void> done;
    if (key == "lang") {
      member.language = value;
    } else if (key == "model") {
      member.model = value;
    } else if (key == "audio") {
      member.audio = value;
    } else if (key == "tts") {
      member.tts = value;
    } else if (key == "over") {
      member.over = value;
    } else if (key == "mood") {
      member.mood = value;
      if (std::string problem = problem_of<dam::read_mood>(value); !problem.empty()) {
        return wrong(problem);
      }
    } else if (key == "pitch") {
      done = number(0, 100, member.pitch);
    } else if (key == "speed") {
      done = number(80, 450, member.speed);
    } else {
      return wrong("there is no " + key +
                   "; there are lang, model, audio, tts, mood, over, pitch, speed");
    }
    if (!done) return done.error();
  }
  return member;
}

// A person of the clip.
struct Person {
  CastMember member;
  SpeakOptions options;
  speech::Spoken spoken;
  fap::Sequence clip;
  dam::SynthesisReport synthesis;
  ShownFace shown;
};

// Who speaks when, by --turns.
Result<std::vector<dam::SpokenTurn>> read_turns(const SpeakOptions& options) {
  if (options.turns.empty()) return std::vector<dam::SpokenTurn>();
  const auto text = read_text_file(options.turns);
  if (!text) return text.error();
  auto turns = dam::read_rttm(*text);
  if (!turns) return turns.error().in_file(options.turns);
  return turns;
}

// Who speaks in the script, in the order in which they begin.
Result<std::vector<std::string>> people_in_script(const speech::SpokenOptions& options) {
  const auto text = read_text_file(options.script);
  if (!text) return text.error();
  dam::ScriptOptions reading = options.script_reading;
  reading.everyone = true;
  const auto timings = scripts::read_labels(*text, reading);
  if (!timings) return timings.error().in_file(options.script);
  std::vector<dam::SpokenTurn> turns;
  for (const dam::TimedLabel& label : timings->labels) {
    if (label.speaker.empty() || label.label.empty()) continue;
    turns.push_back({label.start, label.end, label.speaker});
  }
  std::stable_sort(turns.begin(), turns.end(),
                   [](const auto& a, const auto& b) { return a.start < b.start; });
  if (turns.empty()) {
    return make_error(Code::not_found,
                      "the script does not say who speaks, which --cast needs: WebVTT says it by "
                      "<v Ann>, TextGrids by a tier each; else give --turns, an RTTM file")
        .in_file(options.script);
  }
  return dam::speakers_of(turns);
}

// Those of --cast, in its order, and behind them, with `all`, whoever else speaks.
Result<std::vector<CastMember>> cast_of(const SpeakOptions& options,
                                        const std::vector<std::string>& known) {
  std::vector<CastMember> cast;
  std::optional<CastMember> others;
  for (const std::string& text : options.cast) {
    auto member = parse_cast_member(text);
    if (!member) return member.error();
    if (member->name == kEverybody) {
      others = std::move(*member);
      continue;
    }
    if (std::find(known.begin(), known.end(), member->name) == known.end()) {
      return make_error(Code::not_found, "nobody called '" + member->name + "' speaks; there are " +
                                             joined(known, ", "));
    }
    cast.push_back(std::move(*member));
  }
  const auto is_cast = [&](const std::string& name) {
    return std::any_of(cast.begin(), cast.end(),
                       [&](const CastMember& one) { return one.name == name; });
  };
  for (const std::string& name : known) {
    if (is_cast(name)) continue;
    if (others) {
      cast.push_back(*others);
      cast.back().name = name;
    } else {
      say(name + " is not in the cast and has no face; --cast all adds whoever speaks");
    }
  }
  return cast;
}

// Who has a named face in the file of --over. Errors: nobody.
Result<std::vector<std::string>> people_in_performance(const std::string& path) {
  const auto about = media::probe(path);
  std::vector<std::string> names;
  for (const media::TrackInfo& track : about ? about->tracks : std::vector<media::TrackInfo>()) {
    const bool named = track.kind == media::TrackKind::face && !track.labels.speaker.empty();
    if (named) names.push_back(track.labels.speaker);
  }
  if (!names.empty()) return names;
  return make_error(Code::not_found,
                    "no face in it has a name; give each person a performance, --cast "
                    "Ann,over=ann.fba")
      .in_file(path);
}

// The face that is kept under the lips of each: a file of its own, or the one of its name in the
// file of --over.
Result<void> give_performances(const SpeakOptions& options, std::vector<Person>& people) {
  std::vector<std::string> named;
  if (!options.over.path.empty()) {
    auto known = people_in_performance(options.over.path);
    if (!known) return known.error();
    named = std::move(*known);
  }
  for (Person& person : people) {
    SpeakOptions& own = person.options;
    const CastMember& member = person.member;
    const bool own_file = !member.over.empty();
    if (own_file) own.over.path = member.over;
    if (own.over.path.empty()) continue;
    if (!own_file && std::find(named.begin(), named.end(), member.name) == named.end()) {
      say(options.over.path + " has no face of " + member.name + ", who gets idle motion");
      own.over.path.clear();
      continue;
    }
    std::optional<media::TrackScope> scope;
    if (!own_file) scope.emplace(media::TrackLabels{.speaker = member.name});
    if (auto done = read_over(own.over, own.performance, own.keep); !done) return done;
  }
  return {};
}

// The options of speech for a person.
speech::SpokenOptions spoken_for(const SpeakOptions& options, const CastMember& member,
                                 std::size_t number) {
  speech::SpokenOptions spoken = options.spoken;
  spoken.script_reading.speaker = member.name;
  spoken.audio = member.audio;
  if (!member.tts.empty()) spoken.tts = member.tts;
  if (!member.audio.empty()) spoken.tts.clear();
  spoken.words_per_minute = member.speed.value_or(spoken.words_per_minute);
  spoken.pitch = member.pitch.value_or(spoken.pitch);
  const bool own = !member.language.empty();
  if (own) spoken.language = member.language;
  const bool plain = spoken.language != "auto" && spoken.language.find('+') == std::string::npos;
  if (!own && spoken.tts.empty() && plain)
    spoken.language += kVariants[number % std::size(kVariants)];
  return spoken;
}

// What each says, in the order of the cast.
Result<void> hear_people(const SpeakOptions& options, std::span<const dam::SpokenTurn> turns,
                         std::vector<Person>& people) {
  std::optional<speech::Spoken> whole;
  if (!turns.empty()) {
    ProgressLine progress("listening");
    speech::SpokenOptions source = options.spoken;
    source.heard = [&](double done) { progress.update(done); };
    auto spoken = speech::get_spoken(source, terminal_log());
    progress.clear();
    if (!spoken) return spoken.error();
    whole = std::move(*spoken);
  }
  for (std::size_t i = 0; i < people.size(); ++i) {
    Person& person = people[i];
    person.options.spoken = spoken_for(options, person.member, i);
    if (whole) {
      person.spoken.script = dam::said_by(whole->script, turns, person.member.name);
      person.spoken.times = whole->times;
      person.spoken.languages = whole->languages;
      for (const dam::MoodSpan& mood : whole->moods) {
        if (dam::speaks_at(turns, (mood.start + mood.end) / 2, person.member.name)) {
          person.spoken.moods.push_back(mood);
        }
      }
      continue;
    }
    auto spoken = speech::get_spoken(person.options.spoken, terminal_log());
    if (!spoken) return spoken.error();
    person.spoken = std::move(*spoken);
  }
  return {};
}

// Of a sound with all voices, as far as one of them is heard.
dam::Prosody own_prosody(const dam::Prosody& all, const dam::Script& script) {
  dam::Prosody own{all.step, std::vector<float>(all.pitch.size()),
                   std::vector<float>(all.level.size())};
  for (const dam::Phone& phone : script.phones) {
    if (phone.label == dam::kSilence) continue;
    const auto last = std::min(std::size_t(phone.end / all.step) + 1, all.level.size());
    for (auto i = std::size_t(phone.start / all.step); i < last; ++i) {
      own.pitch[i] = all.pitch[i];
      own.level[i] = all.level[i];
    }
  }
  return own;
}

// What is heard, of all of them.
struct CommonSound {
  std::unique_ptr<ScratchFolder> folder;
  std::string path;  // empty: nothing
  double seconds = 0;
};

Result<CommonSound> sound_of_all(const SpeakOptions& options, std::vector<Person>& people) {
  CommonSound sound;
  std::vector<media::MixPart> parts;
  for (const Person& person : people) {
    const speech::Spoken& spoken = person.spoken;
    sound.seconds = std::max(sound.seconds, spoken.sound_seconds());
    if (!spoken.recording.empty()) parts.push_back({spoken.recording});
  }
  if (!options.spoken.audio.empty()) {
    auto audio = speech::read_voice(options.spoken.audio, terminal_log(), kProsodyRate);
    if (!audio) return audio.error();
    for (Person& person : people) {
      auto fits = dam::check_against_audio(person.spoken.script, audio->duration());
      if (!fits) return fits.error().in_file(options.spoken.audio);
    }
    sound.path = options.spoken.audio;
    sound.seconds = audio->duration();
    const dam::Prosody prosody = voice::measure_prosody(*audio);
    for (Person& person : people) {
      person.options.prosody = own_prosody(prosody, person.spoken.script);
    }
    return sound;
  }
  const auto is_heard = [](const Person& person) { return person.spoken.has_sound(); };
  if (std::none_of(people.begin(), people.end(), is_heard)) return sound;
  auto folder = ScratchFolder::make();
  if (!folder) return folder.error();
  sound.folder = std::move(*folder);
  // What is in memory only.
  for (std::size_t i = 0; i < people.size(); ++i) {
    const speech::Spoken& spoken = people[i].spoken;
    if (!spoken.recording.empty() || !spoken.audio) continue;
    const std::string name = "voice" + std::to_string(i) + ".wav";
    const std::string path = sound.folder->file(name.c_str());
    if (auto done = media::write_wav(path, *spoken.audio); !done) return done.error();
    parts.push_back({path});
  }
  sound.path = sound.folder->file("all.wav");
  if (auto done = media::mix_audio(sound.path, parts); !done) return done.error();
  return sound;
}

// Faces that last equally long.
Result<void> move_people(const SpeakOptions& options, double seconds, std::vector<Person>& people) {
  const auto rate = fap::parse_rate(options.rate);
  if (!rate) return rate.error();
  std::vector<dam::Script> scripts;
  for (const Person& person : people) {
    scripts.push_back(person.spoken.script);
    seconds = std::max(seconds, person.spoken.script.duration());
  }
  std::vector<dam::Attention> attention = dam::attention_of(scripts);
  for (std::size_t i = 0; i < people.size(); ++i) {
    Person& person = people[i];
    SpeakOptions& own = person.options;
    speech::Spoken& spoken = person.spoken;
    const auto model =
        speech::read_model(person.member.model.empty() ? options.model : person.member.model);
    if (!model) return model.error();
    dam::SynthesisOptions settings = options.motion;
    settings.rate = *rate;
    settings.closure = !options.no_closure;
    settings.tail = std::max(0.0, seconds - spoken.script.duration());
    auto signal = speech::move_face(*model, spoken, settings, &person.synthesis);
    if (!signal) return signal.error().in_file(options.spoken.script);
    person.shown.frames = signal->frames();
    person.shown.seconds = signal->rate.seconds(double(signal->frames()));
    if (own.idle.on.value_or(true) && !own.prosody) {
      own.prosody = std::move(spoken.prosody);
      if (spoken.audio) own.prosody = voice::measure_prosody(*spoken.audio);
    }
    if (!person.member.mood.empty()) own.mood = person.member.mood;
    own.idle.motion.seed += kSeedsApart * i;
    // Who is told where to look does not look at the others.
    if (!(own.idle.motion.look == dam::Look{})) attention[i].looks.clear();
    own.attention = &attention[i];
    own.output = options.outputs.front();
    if (auto done = add_life(own, *signal, spoken, person.shown); !done) return done;
    auto clip = shown_clip(own, *signal, spoken);
    if (!clip) return clip.error();
    clip->name = person.member.name;
    person.clip = std::move(*clip);
    own.attention = nullptr;
    if (!spoken.recording.empty() && spoken.audio) spoken.audio->samples = {};
  }
  return {};
}

media::TrackLabels labels_of(const Person& person) {
  media::TrackLabels labels;
  const std::string language = language_of(person.options, person.spoken);
  const std::string tag = language.substr(0, language.find('+'));
  if (media::is_language_tag(tag) && tag != "auto") {
    labels.language = tag;
    labels.code = text::language_code(tag);
    if (labels.code == "und") labels.code.clear();
  }
  labels.speaker = person.member.name;
  return labels;
}

Result<int> write_people(const SpeakOptions& options, const std::string& output,
                         std::vector<Person>& people, const CommonSound& sound) {
  std::vector<fba::AccessUnits> faces(people.size());
  std::vector<std::vector<media::TextTrack>> texts(people.size());
  media::MuxInput input;
  input.more.resize(people.size() - 1);
  for (std::size_t i = 0; i < people.size(); ++i) {
    media::MuxInput& place = i == 0 ? input : input.more[i - 1];
    auto units = access_units({people[i].clip, {}}, options.stream);
    if (!units) return units.error();
    faces[i] = std::move(*units);
    place.face = &faces[i];
    place.labels = labels_of(people[i]);
    if (options.no_words || !media::takes_text(output)) continue;
    texts[i] = speech::carried_texts(people[i].spoken.script, place.labels.language);
    if (shows_captions(output, options.subtitles)) speech::add_captions(texts[i]);
    place.texts = &texts[i];
  }
  if (!sound.path.empty()) {
    // One sound is that of all: it has no name.
    media::MuxInput& last = input.more.emplace_back();
    last.labels = labels_of(people.front());
    last.labels.speaker.clear();
    if (options.coded) {
      last.encoded = options.coded.get();
    } else {
      last.audio_file = &sound.path;
    }
  } else {
    warn("there is no recorded voice (--audio), and no --fit to speak: the file will be silent");
  }
  media::MuxOptions mux;
  mux.audio = audio_settings(options.sound, output);
  mux.text_track = media::TextTrackType::metadata;
  return write_media(output, input, mux, SoundState::reported);
}

Json people_json(const SpeakOptions& options, const std::vector<Person>& people) {
  Json list = Json::array();
  for (const Person& person : people) {
    Json one = report_json(person.options, person.spoken, person.synthesis, person.shown);
    one["speaker"] = person.member.name;
    list.push_back(std::move(one));
  }
  Json json = {{"output", options.outputs.front()},
               {"seconds", people.front().shown.seconds},
               {"people", list}};
  if (options.outputs.size() > 1) json["outputs"] = options.outputs;
  return json;
}

}  // namespace

void add_cast_options(OptionTable& cli, SpeakOptions& options) {
  cli.add("--cast", options.cast,
          "A face for each speaker of the script, in one file: all, or NAME with lang=, model=, "
          "audio=, tts=, mood=, over=, pitch=, speed= (Ann,lang=en+f3); may be repeated")
      ->value("NAME")
      ->check(problem_of<parse_cast_member>)
      ->one_at_a_time();
  cli.add("--turns", options.turns,
          "Who of the cast speaks when (RTTM), for a script or a recording that does not tell")
      ->value("FILE")
      ->needs("--cast");
}

std::string problem_with_cast(const SpeakOptions& options) {
  const speech::SpokenOptions& spoken = options.spoken;
  if (options.turns.empty() && spoken.script.empty()) {
    return "--cast needs --script, which tells who speaks, or --turns";
  }
  if (spoken.has_text || !spoken.text_file.empty()) return "--cast is for scripts and recordings";
  if (!options.turns.empty() && spoken.fit) {
    return "--turns keeps the times of its recording; leave out --fit";
  }
  if (!spoken.script_reading.speaker.empty()) return "--speaker is one face, and --cast several";
  if (!spoken.audio.empty() && spoken.fit) {
    return "--fit moves what each one says: give the recordings of each, --cast "
           "Ann,audio=ann.wav";
  }
  std::error_code unknown;
  if (!spoken.audio.empty() && !std::filesystem::is_regular_file(spoken.audio, unknown)) {
    return "with --cast the recording is read more than once; give --audio a file";
  }
  if (!options.preview.empty()) return "--preview shows one face; render --people shows several";
  if (!options.save_script.empty()) {
    return "--save-script is for one face; demux --track speaker=Ann -o ann.TextGrid reads what "
           "each says";
  }
  for (const std::string& output : options.outputs) {
    const std::string extension = extension_of(output);
    const bool several =
        extension == ".mp4" || extension == ".mkv" || extension == ".m3u8" || extension == ".mpd";
    if (!several) return output + " takes one face; .mp4, .mkv, .m3u8 and .mpd take several";
  }
  return {};
}

Result<int> speak_people(const SpeakOptions& options) {
  const auto turns = read_turns(options);
  if (!turns) return turns.error();
  auto known = turns->empty() ? people_in_script(options.spoken)
                              : Result<std::vector<std::string>>(dam::speakers_of(*turns));
  if (!known) return known.error();
  const auto cast = cast_of(options, *known);
  if (!cast) return cast.error();
  std::vector<Person> people;
  for (const CastMember& member : *cast) people.push_back({.member = member, .options = options});
  if (auto done = give_performances(options, people); !done) return done.error();
  if (auto done = hear_people(options, *turns, people); !done) return done.error();
  const auto sound = sound_of_all(options, people);
  if (!sound) return sound.error();
  if (auto done = move_people(options, sound->seconds, people); !done) return done.error();
  Result<int> written = kOk;
  for (const std::string& output : options.outputs) {
    written = write_people(options, output, people, *sound);
    if (!written || *written != kOk) return written;
  }
  if (options.json || !options.report.empty()) {
    if (auto done = give_report(options, people_json(options, people)); !done) return done.error();
  }
  return written;
}

}  // namespace animeme::tools
