/// @file
/// What `animeme stream` sends: a clip that is there as a whole, or a head that speaks line by
/// line.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "dam/model/model.h"
#include "fap/rate.h"
#include "tools/commands/live_address.h"
#include "tools/commands/live_clip.h"
#include "tools/media/live/presentation.h"
#include "tools/speech/live_speaker.h"

namespace animeme::tools {

/// The options of `animeme stream`, as the user gave them.
struct StreamOptions {
  std::string input;             ///< a clip; empty: `say`
  std::string say;               ///< --say: lines of text, or "-"
  SpokenOptions spoken;          ///< how lines are spoken
  std::vector<std::string> to;   ///< --to: addresses
  std::vector<std::string> sdp;  ///< --sdp: a file for each RTP address
  LiveSinkOptions sink;          ///< of the transports
  LiveCoding coding;             ///< how clips are coded
  std::string codec;             ///< --audio-codec: aac or opus
  std::string model;             ///< --model: empty: the one built in
  std::string rate = "25";       ///< --rate: frames a second
  double style = 1;              ///< --style, 0..1.5
  bool life = false;             ///< --life
  std::uint64_t seed = 1;        ///< --seed, of life
  bool loop = false;             ///< --loop
  bool no_sound = false;         ///< --no-sound
  bool fast = false;             ///< --fast: no waiting
  bool stats = false;            ///< --stats
  bool json = false;             ///< --json
  double duration = std::numeric_limits<double>::infinity();  ///< --duration, s
};

/// What is sent, and all that has to live as long.
struct Program {
  dam::Model model;                              ///< if it speaks
  int descriptor = -1;                           ///< of the lines, if it is ours to close
  std::unique_ptr<speech::VoiceLines> lines;     ///< if it speaks
  std::unique_ptr<speech::LiveSpeaker> speaker;  ///< if it speaks
  std::unique_ptr<media::ClipInput> clip;        ///< if a clip is sent

  Program() = default;
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program();
  media::LiveInput& input() const;  ///< whichever of the two there is
};

/// Reads, speaks and codes what the options name. `program` must stay where it is.
Result<void> open_program(const StreamOptions& options, fap::Rate rate, Program& program);

}  // namespace animeme::tools
