/// @file
/// Visemes of Oculus and Ready Player Me avatars, and mouth shapes of Rhubarb Lip Sync: computed
/// from a phoneme script or from a face, and written to files for players.
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

/// A viseme and the time when it is shown.
struct VisemeEvent {
  double time = 0;      ///< seconds
  double duration = 0;  ///< seconds, > 0
  std::string phone;    ///< ARPAbet; empty: unknown
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
/// viseme of the following phone.
std::vector<VisemeEvent> script_events(const dam::Script& script);

/// Samples the events of script_events() at `rate`, with as many frames as cover them. Adjacent
/// visemes are crossfaded around their boundary along half a cosine over `crossfade` seconds (0:
/// none), or over the shorter of the two if that is less, so each viseme reaches 1, and the weights
/// add up to 1.
/// Errors: invalid_argument (a rate that is not valid), out_of_range (more than 10 million frames).
Result<VisemeTrack> track_of_events(std::vector<VisemeEvent> events, const fap::Rate& rate,
                                    double crossfade);

/// Weights of a face with complete frames (fap::fill()): those of FAP 1 if it ever shows anything
/// but silence, else those of fap::VisemeFitter. An event is a run of frames in which one viseme is
/// the strongest; runs shorter than 40 ms are merged into the previous one.
VisemeTrack track_of_face(const fap::Sequence& clip);

/// {"format": "animeme-visemes", "version": 1, "fps": 25, "rate": [25, 1], "audio": null,
///  "names": ["viseme_sil", ... 15], "events": [{"time": 0.21, "duration": 0.04, "phone": "B",
///  "viseme": "viseme_PP"}, ...], "frames": [[15 numbers], ...]}. "phone" is omitted if unknown.
///  The names are those of morph targets of Ready Player Me and Oculus avatars. `audio` is the name
///  of the sound file; empty: null. Invalid UTF-8 becomes U+FFFD.
std::string write_visemes_json(const VisemeTrack& track, std::string_view audio = {});

/// Writes time_s and one column per viseme, one row per frame.
std::string write_visemes_csv(const VisemeTrack& track);

/// Writes the input of TalkingHead's speakAudio() and streamAudio(); replace the name of the sound
/// by decoded audio: {"audio": "talk.wav", "words": ["bin", ...], "wtimes": [210, ...],
/// "wdurations": [...], "visemes": ["PP", "I", ...], "vtimes": [210, ...], "vdurations": [40, ...]}
/// in milliseconds. Words are those of `script`, which may be empty. No viseme is shorter than 40
/// ms, as in Rhubarb's files: shorter ones are merged into the previous one, except that PP and FF
/// are extended at the cost of a neighbour. Silence is omitted, since the player closes the mouth
/// by itself.
std::string write_talking_head(const VisemeTrack& track, const dam::Script& script,
                               std::string_view audio = {});

/// Mouth shapes of Rhubarb Lip Sync: A to H and X. By viseme: X sil, A PP, B TH DD kk CH SS nn ih,
/// C E, D aa, E oh RR, F ou, G FF; H for the phone L, if phones are known.
char rhubarb_shape(const VisemeEvent& event);

/// Options as in Rhubarb Lip Sync.
struct RhubarbOptions {
  std::string extended = "GHX";  ///< which of the shapes G, H, X exist; the others become A, C, A
  double dat_rate = 24;          ///< frames a second of .dat, > 0
  bool preston_blair = false;    ///< .dat: "MBP", "etc" ... instead of letters
};

/// {"metadata": {"soundFile": "", "duration": 2.5}, "mouthCues": [{"start": 0.00, "end": 0.05,
/// "value": "X"}, ...]}, as Rhubarb writes it. Equal neighbours are merged, and no cue is shorter
/// than 0.04 s, as in the other formats (frames of write_rhubarb_dat() may round it): shorter ones
/// are merged into the previous shape, except that A and G are extended at the cost of a neighbour.
/// (A shorter file has one cue.)
std::string write_rhubarb_json(const VisemeTrack& track, std::string_view audio = {},
                               const RhubarbOptions& options = {});

/// Writes start and shape, separated by a tab; the end is a last X (A without X).
std::string write_rhubarb_tsv(const VisemeTrack& track, const RhubarbOptions& options = {});

/// Writes XML like Rhubarb: metadata, then one mouthCue each.
std::string write_rhubarb_xml(const VisemeTrack& track, std::string_view audio = {},
                              const RhubarbOptions& options = {});

/// Switch data of Moho (Anime Studio), also read by OpenToonz: "MohoSwitch1", then lines with a
/// frame, counted from 1, and a mouth shape, the end last.
std::string write_rhubarb_dat(const VisemeTrack& track, const RhubarbOptions& options = {});

}  // namespace animeme::exchange
