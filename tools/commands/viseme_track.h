/// @file
/// When which viseme is shown: from a phoneme script, or from a face.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dam/script/script.h"
#include "fap/frame.h"
#include "fap/rate.h"
#include "fap/viseme.h"

namespace animeme::tools {

/// One viseme as long as it is shown.
struct VisemeEvent {
  double time = 0;      ///< seconds
  double duration = 0;  ///< seconds, > 0
  std::string phone;    ///< ARPAbet; empty: not known
  int viseme = 0;       ///< 0..14

  friend bool operator==(const VisemeEvent&, const VisemeEvent&) = default;
};

/// Visemes of a clip, as events and by frame.
struct VisemeTrack {
  fap::Rate rate;                          ///< frames a second of `frames`
  std::vector<VisemeEvent> events;         ///< ascending, without gaps
  std::vector<fap::VisemeWeights> frames;  ///< from time 0
};

/// The visemes of dam/script/phones.h. A diphthong is two events of half its time; HH takes the
/// viseme of the sound behind it.
std::vector<VisemeEvent> script_events(const dam::Script& script);

/// Weights of the events at `rate`, as many frames as cover them. One viseme fades into the next
/// around their border, along half a cosine over `crossfade` seconds, or over the shorter of the
/// two if that is less: each viseme has its moment at 1, and the weights add up to 1.
VisemeTrack track_of_events(std::vector<VisemeEvent> events, const fap::Rate& rate,
                            double crossfade);

/// Weights of a face whose frames are complete (fap::fill()): of FAP 1 if it ever shows anything
/// but silence, else those of fap::VisemeFitter. An event is a run of frames in which one viseme is
/// the strongest; runs shorter than 40 ms belong to the one before.
VisemeTrack track_of_face(const fap::Sequence& clip);

}  // namespace animeme::tools
