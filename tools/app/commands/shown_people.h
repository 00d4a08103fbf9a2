/// @file
/// People side by side: --people of `render` and `view`.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dam/script/script.h"
#include "fap/frame.h"
#include "fap/result.h"
#include "fap/viseme.h"
#include "tools/app/commands/common.h"
#include "tools/formats/media/track_labels.h"
#include "tools/formats/programs/scratch_folder.h"
#include "tools/speech/talking/voice_file.h"
#include "tools/view/studio/head_file.h"

namespace animeme::tools {

struct OptionTable;

/// What was given by add_people_options().
struct PeopleChoice {
  std::string people;  ///< all, or names with heads; empty: one face
  double turned = 20;  ///< degrees that they are turned to each other
};

/// Adds --people and --turned.
void add_people_options(OptionTable& cli, PeopleChoice& choice);

/// How faces are read.
struct PeopleReading {
  std::string input;            ///< a file with a face for each
  media::TrackLabels wanted;    ///< the language of --track
  studio::HeadChoice head;      ///< of those who have none of their own
  LengthLimit length;           ///< of clips
  std::string mouth;            ///< --mouth
  speech::ScriptInput reading;  ///< of their words
  bool interpolate = false;     ///< skipped frames get values between their neighbours
};

/// One of those who are shown.
struct PersonClip {
  std::string name;                         ///< as the file has it
  media::TrackLabels labels;                ///< of the tracks
  studio::HeadChoice head;                  ///< own, else the usual ones in turn
  fap::Sequence clip;                       ///< filled
  double start = 0;                         ///< of its first frame on the clock of the sound
  std::vector<fap::VisemeWeights> visemes;  ///< what is said, by frame; empty: unknown
  dam::Script script;                       ///< what they say; may be empty
};

/// The people of a file, in the order of --people, else that of the file. Errors: those of reading
/// it; not_found (it does not have faces of several people, or nobody of that name).
Result<std::vector<PersonClip>> read_people(const PeopleReading& reading,
                                            const PeopleChoice& choice);

/// What they say, all of them.
dam::Script words_of_people(const std::vector<PersonClip>& people);

/// The sound of people.
struct PeopleSound {
  std::unique_ptr<ScratchFolder> folder;  ///< where `path` is, if it was mixed
  std::string path;                       ///< empty: the one of the input is that of all
};

/// Mixes the sounds of those who have one of their own in the file. Errors: those of
/// media::probe() and media::mix_audio().
Result<PeopleSound> sound_of_people(const std::string& input,
                                    const std::vector<PersonClip>& people);

}  // namespace animeme::tools
