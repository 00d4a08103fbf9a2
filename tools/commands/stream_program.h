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

struct StreamOptions {
  std::string input;
  std::string say;
  SpokenOptions spoken;
  std::vector<std::string> to;
  std::vector<std::string> sdp;
  LiveSinkOptions sink;
  LiveCoding coding;
  std::string codec;
  std::string model;
  std::string rate = "25";
  double style = 1;
  bool life = false;
  std::uint64_t seed = 1;
  bool loop = false;
  bool no_sound = false;
  bool fast = false;
  bool stats = false;
  bool json = false;
  double duration = std::numeric_limits<double>::infinity();
};

/// What is sent, and all that has to live as long.
struct Program {
  dam::Model model;
  int descriptor = -1;  ///< of the lines, if it is ours to close
  std::unique_ptr<speech::VoiceLines> lines;
  std::unique_ptr<speech::LiveSpeaker> speaker;
  std::unique_ptr<media::ClipInput> clip;

  Program() = default;
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program();
  media::LiveInput& input() const;
};

/// Reads, speaks and codes what the options name. `program` must stay where it is.
Result<void> open_program(const StreamOptions& options, fap::Rate rate, Program& program);

}  // namespace animeme::tools
