/// @file
/// Visemes of Oculus and Ready Player Me avatars, and the mouth shapes of Rhubarb Lip Sync: when
/// which is shown, from a phoneme script or from a face, and the files that players read.
///
///     auto script = animeme::dam::read_script(text);
///     auto track = animeme::exchange::track_of_events(
///         animeme::exchange::script_events(*script), {60, 1}, 0.08);
///     save("words.visemes.json", animeme::exchange::write_visemes_json(*track, "words.wav"));
///     save("words.tsv", animeme::exchange::write_rhubarb_tsv(*track));
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dam/script/script.h"
#include "fap/frame.h"
#include "fap/rate.h"
#include "fap/result.h"
#include "fap/viseme.h"

namespace animeme::exchange {

/// One viseme as long as it is shown.
struct VisemeEvent {
  double time = 0;      ///< seconds
  double duration = 0;  ///< seconds, > 0
  std::string phone;    ///< ARPAbet; empty: not known
  int viseme = 0;       ///< 0..14, see fap::kVisemes

  friend bool operator==(const VisemeEvent&, const VisemeEvent&) = default;
};

/// Visemes of a clip, as events and by frame.
struct VisemeTrack {
  fap::Rate rate;                          ///< frames a second
  std::vector<VisemeEvent> events;         ///< ascending, without gaps
  std::vector<fap::VisemeWeights> frames;  ///< from time 0; weights add up to 1
};

/// The visemes of dam/script/phones.h. A diphthong is two events of half its time; HH takes the
/// viseme of the sound behind it.
std::vector<VisemeEvent> script_events(const dam::Script& script);

/// Weights of the events, which are those of script_events(), at `rate`, as many frames as cover
/// them. One viseme fades into the next around their border, along half a cosine over `crossfade`
/// seconds (0: at once), or over the shorter of the two if that is less: each viseme has its moment
/// at 1, and the weights add up to 1.
/// Errors: invalid_argument (a rate that is not valid), out_of_range (more than 10 million frames).
Result<VisemeTrack> track_of_events(std::vector<VisemeEvent> events, const fap::Rate& rate,
                                    double crossfade);

/// Weights of a face whose frames are complete (fap::fill()): of FAP 1 if it ever shows anything
/// but silence, else those of fap::VisemeFitter. An event is a run of frames in which one viseme is
/// the strongest; runs shorter than 40 ms belong to the one before.
VisemeTrack track_of_face(const fap::Sequence& clip);

/// {"format": "animeme-visemes", "version": 1, "fps": 25, "rate": [25, 1], "audio": null,
///  "names": ["viseme_sil", ... 15], "events": [{"time": 0.21, "duration": 0.04, "phone": "B",
///  "viseme": "viseme_PP"}, ...], "frames": [[15 numbers], ...]}. Without "phone" where it is not
/// known. The names are those of morph targets of Ready Player Me and Oculus avatars. `audio` is
/// the name of the sound beside it; empty: null. Bytes that are no UTF-8 become U+FFFD.
std::string write_visemes_json(const VisemeTrack& track, std::string_view audio = {});

/// time_s and one column a viseme, a row a frame.
std::string write_visemes_csv(const VisemeTrack& track);

/// What TalkingHead's speakAudio() and streamAudio() take, once their user has put decoded sound
/// where its name is: {"audio": "talk.wav", "words": ["bin", ...], "wtimes": [210, ...],
/// "wdurations": [...], "visemes": ["PP", "I", ...], "vtimes": [210, ...], "vdurations": [40,
/// ...]} in milliseconds. Words are those of `script`, which may be empty. No viseme is shorter
/// than 40 ms, as in Rhubarb's files: what is shorter is left to the one before it, but PP and FF
/// take what they lack from a neighbour, or all of it. Silence is left out: its player closes the
/// mouth by itself.
std::string write_talking_head(const VisemeTrack& track, const dam::Script& script,
                               std::string_view audio = {});

/// Mouth shapes of Rhubarb Lip Sync: A to H and X. By viseme: X sil, A PP, B TH DD kk CH SS nn ih,
/// C E, D aa, E oh RR, F ou, G FF; H for the sound L, if sounds are known.
char rhubarb_shape(const VisemeEvent& event);

/// What Rhubarb Lip Sync lets its users choose.
struct RhubarbOptions {
  std::string extended = "GHX";  ///< which of the shapes G, H, X are drawn; else A, C, A are shown
  double dat_rate = 24;          ///< frames a second of .dat, > 0
  bool preston_blair = false;    ///< .dat: "MBP", "etc" ... in place of letters
};

/// {"metadata": {"soundFile": "", "duration": 2.5}, "mouthCues": [{"start": 0.00, "end": 0.05,
/// "value": "X"}, ...]}, as Rhubarb writes it. Equal neighbours are one cue, and no cue is shorter
/// than 0.04 s, as in the other formats (whose frames may round it, write_rhubarb_dat()): what is
/// shorter is left to the shape before it, but A and G take what they lack from a neighbour, or all
/// of it. (A file that is shorter has one cue.)
std::string write_rhubarb_json(const VisemeTrack& track, std::string_view audio = {},
                               const RhubarbOptions& options = {});

/// Start and shape, tab between; the end is a last X (A without it).
std::string write_rhubarb_tsv(const VisemeTrack& track, const RhubarbOptions& options = {});

/// XML as Rhubarb writes it: metadata, then a mouthCue each.
std::string write_rhubarb_xml(const VisemeTrack& track, std::string_view audio = {},
                              const RhubarbOptions& options = {});

/// Switch data of Moho (Anime Studio), also read by OpenToonz: "MohoSwitch1", then a frame, counted
/// from 1, and a mouth a line, the end last.
std::string write_rhubarb_dat(const VisemeTrack& track, const RhubarbOptions& options = {});

}  // namespace animeme::exchange
