#include "tools/app/commands/shown_people.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "dam/script/turns.h"
#include "fap/head/people.h"
#include "fap/turns.h"
#include "tools/app/commands/avatar_export.h"
#include "tools/app/commands/options.h"
#include "tools/app/commands/said_visemes.h"
#include "tools/app/commands/script_options.h"
#include "tools/formats/common/text.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/mix_audio.h"

namespace animeme::tools {

namespace {

constexpr const char* kUsualHeads[] = {"woman", "man"};
constexpr std::size_t kMostPeople = 8;

// "Ann" or "Ann=man".
struct NamedHead {
  std::string name, head;
};

Result<std::vector<NamedHead>> parse_people(const std::string& text) {
  std::vector<NamedHead> list;
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::string part = media::next_label(rest);
    const std::size_t equals = part.find('=');
    NamedHead one{part.substr(0, equals),
                  equals == std::string::npos ? std::string() : part.substr(equals + 1)};
    if (one.name.empty() || (one.head.empty() && equals != std::string::npos)) {
      return make_error(Code::invalid_argument,
                        "'" + part + "' is no name, nor a name and a head, such as Ann=woman");
    }
    list.push_back(std::move(one));
  }
  if (list.empty()) {
    return make_error(Code::invalid_argument, "write all, or names: Ann,Bob or Ann=woman,Bob=man");
  }
  if (list.size() > kMostPeople) {
    return make_error(Code::invalid_argument,
                      "at most " + std::to_string(kMostPeople) + " people are shown");
  }
  return list;
}

// Speakers of the faces of a file in this language, in its order.
Result<std::vector<media::TrackLabels>> speakers_in(const std::string& input,
                                                    const media::TrackLabels& wanted) {
  const auto info = media::probe(input);
  if (!info) return info.error();
  std::vector<media::TrackLabels> list;
  for (const media::TrackInfo& track : info->tracks) {
    const media::TrackLabels& labels = track.labels;
    if (track.kind != media::TrackKind::face || labels.speaker.empty()) continue;
    if (!media::is_wanted(wanted, labels)) continue;
    const bool known = std::any_of(list.begin(), list.end(),
                                   [&](const auto& one) { return one.speaker == labels.speaker; });
    if (!known) list.push_back(labels);
  }
  return list;
}

studio::HeadChoice head_for(const std::string& own, const studio::HeadChoice& usual,
                            std::size_t number) {
  studio::HeadChoice choice = usual;
  if (!own.empty()) {
    choice.head = own;
  } else if (usual.head == kUsualHeads[0]) {
    choice.head = kUsualHeads[number % std::size(kUsualHeads)];
  }
  if (choice.head == usual.head || !head::names_person(choice.head)) return choice;
  studio::HeadChoice built;  // points and shapes are those of files
  built.head = choice.head;
  built.gain = usual.gain;
  return built;
}

Result<void> read_person(const PeopleReading& reading, PersonClip& person) {
  const media::TrackScope scope(person.labels);
  auto input = read_face(reading.input);
  if (!input) return input.error();
  const fap::FillOptions filling{.interpolate = reading.interpolate,
                                 .keep_expressions = moves_by_itself(person.head)};
  auto clip = shown_face(*input, reading.input, filling, reading.length);
  if (!clip) return clip.error();
  if (clip->frames.empty()) {
    return make_error(Code::not_found, "the face of " + person.name + " has no frames")
        .in_file(reading.input);
  }
  if (reading.interpolate) fap::smooth_turns(*clip);
  auto script = script_for({}, {reading.input}, reading.reading);
  if (!script) return script.error();
  person.start = input->start;
  person.visemes = said_visemes(*input, *clip, *script, reading.mouth);
  person.clip = std::move(*clip);
  person.script = std::move(*script);
  return {};
}

}  // namespace

void add_people_options(OptionTable& cli, PeopleChoice& choice) {
  cli.add("--people", choice.people,
          "People of the file side by side: all, or names from left to right, with heads of their "
          "own (Ann=woman,Bob=me.glb)")
      ->value("NAME")
      ->check(problem_of<parse_people>);
  cli.add("--turned", choice.turned, "Degrees that they are turned to each other")
      ->value("0..60=20")
      ->between(0.0, 60.0);
}

Result<std::vector<PersonClip>> read_people(const PeopleReading& reading,
                                            const PeopleChoice& choice) {
  const auto names = parse_people(choice.people);
  if (!names) return names.error();
  media::TrackLabels wanted = reading.wanted;
  wanted.speaker.clear();
  const auto speakers = speakers_in(reading.input, wanted);
  if (!speakers) return speakers.error();
  std::string list;
  for (const auto& one : *speakers) list += (list.empty() ? "" : ", ") + one.speaker;
  if (speakers->empty()) {
    return make_error(Code::not_found,
                      "the file has no faces with names of speakers (speak --cast and mux --track "
                      "speaker= write them)")
        .in_file(reading.input);
  }
  std::vector<PersonClip> people;
  const auto add = [&](const media::TrackLabels& labels, const std::string& head) {
    PersonClip& person = people.emplace_back();
    person.name = labels.speaker;
    person.labels = labels;
    person.head = head_for(head, reading.head, people.size() - 1);
  };
  const bool all = names->size() == 1 && names->front().name == "all";
  if (all) {
    for (const auto& labels : *speakers) add(labels, names->front().head);
    if (people.size() > kMostPeople) people.resize(kMostPeople);
  }
  for (const NamedHead& one : *names) {
    if (all) break;
    const auto found = std::find_if(speakers->begin(), speakers->end(),
                                    [&](const auto& labels) { return labels.speaker == one.name; });
    if (found == speakers->end()) {
      return make_error(Code::not_found,
                        "nobody called '" + one.name + "' is in it; there are " + list)
          .in_file(reading.input);
    }
    add(*found, one.head);
  }
  for (PersonClip& person : people) {
    if (std::string problem = studio::problem_of(person.head); !problem.empty()) {
      return make_error(Code::invalid_argument, std::move(problem));
    }
    if (auto done = read_person(reading, person); !done) return done.error();
  }
  return people;
}

dam::Script words_of_people(const std::vector<PersonClip>& people) {
  std::vector<dam::Script> scripts;
  for (const PersonClip& person : people) scripts.push_back(person.script);
  return dam::said_together(scripts);
}

Result<PeopleSound> sound_of_people(const std::string& input,
                                    const std::vector<PersonClip>& people) {
  PeopleSound sound;
  const auto info = media::probe(input);
  if (!info) return info.error();
  std::vector<media::MixPart> parts;
  for (const PersonClip& person : people) {
    const bool own = std::any_of(info->tracks.begin(), info->tracks.end(), [&](const auto& track) {
      return track.kind == media::TrackKind::audio && track.labels.speaker == person.name &&
             media::is_wanted(person.labels, track.labels);
    });
    if (own) parts.push_back({input, person.labels});
  }
  if (parts.empty()) return sound;
  auto folder = ScratchFolder::make();
  if (!folder) return folder.error();
  sound.folder = std::move(*folder);
  sound.path = sound.folder->file("all.wav");
  if (auto done = media::mix_audio(sound.path, parts); !done) return done.error();
  return sound;
}

}  // namespace animeme::tools
