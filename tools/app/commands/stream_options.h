/// @file
/// Options of stream.
#pragma once

#include <string>
#include <vector>

#include "tools/app/commands/face_stream.h"
#include "tools/app/commands/idle_options.h"
#include "tools/app/commands/over_options.h"
#include "tools/app/commands/shown_heads.h"
#include "tools/live/sessions/address.h"
#include "tools/live/sessions/program.h"

namespace animeme::tools {

struct OptionTable;

/// What was said on the command line.
struct StreamOptions {
  std::string track;                  ///< --track
  std::string input;                  ///< the clip
  std::vector<std::string> to;        ///< --to
  std::vector<std::string> sdp;       ///< --sdp
  live::SinkOptions sink;             ///< --mtu, --repeat, --bundle, --max-clients ...
  std::vector<std::string> ice;       ///< --ice-server
  std::string audio_repeat = "auto";  ///< --audio-repeat
  std::string audio_fec = "auto";     ///< --audio-fec
  HeadChoices heads;                  ///< --head, for the page
  live::ProgramOptions program;       ///< what is sent, and how it is coded
  std::string codec;                  ///< --audio-codec
  StreamSettings limits;              ///< --rms, --kbps and --small
  std::string rate = "25";            ///< --rate
  std::string mood;                   ///< --mood
  IdleOptions idle;                   ///< --idle-motion and its like
  OverChoice over;                    ///< --over, --keep
  std::string pcm;                    ///< --pcm
  std::string hear_pcm;               ///< --hear-pcm
  std::string events;                 ///< --events
  bool no_sound = false;              ///< --no-sound
  bool fast = false;                  ///< --fast
  bool stats = false;                 ///< --stats
  bool json = false;                  ///< --json
};

/// Adds them.
void add_options(OptionTable& cli, StreamOptions& options);

/// Adds --allow-origin and --host-name: who may use a web server, and by which names.
void add_guard_options(OptionTable& cli, web::WebOptions& options);

/// Adds --ice-server and --audio-repeat.
void add_rtc_options(OptionTable& cli, std::vector<std::string>& servers,
                     std::string& audio_repeat);

/// Makes the WebRTC of a web server use them. Errors: those of webrtc::add_ice_server().
Result<void> use_rtc_options(const std::vector<std::string>& servers,
                             const std::string& audio_repeat, web::WebOptions& options);

/// Runs the command with them.
Result<int> run(StreamOptions& options);

}  // namespace animeme::tools
