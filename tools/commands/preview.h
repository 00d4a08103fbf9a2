/// @file
/// Rendered video of a face: what any player shows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "codec/decode/access_unit.h"
#include "dam/script/script.h"
#include "fap/frame.h"
#include "fap/result.h"
#include "tools/commands/common.h"
#include "tools/commands/head_view.h"
#include "tools/media/mux.h"

namespace animeme::tools {

/// How the video looks.
struct PreviewOptions {
  HeadLook look;                        ///< head and camera
  std::optional<fap::Rate> rate;        ///< pictures a second; nothing: one a frame of the clip
  int quality = 20;                     ///< as VideoSettings::quality
  const dam::Script* script = nullptr;  ///< phones to show below; nullptr: none
  std::vector<int> faps;                ///< curves to show below, three at most
  int audio_bit_rate = 0;               ///< bits a second; 0: usual
};

/// The same for a coded face, with its usual looks. Error: that of the stream.
Result<int> write_preview(const std::string& path, const fba::AccessUnits& face,
                          const media::MuxInput& sound);

/// Adds --preview. The name that it gets is empty, or that of a video.
void add_preview_option(CLI::App& app, std::string& path);

/// The extensions that write_preview() takes.
bool is_video(const std::string& extension);

/// Renders `clip` (filled) with progress and writes it with the sound that `sound` names (audio or
/// encoded; its face goes along as a track of its own). The video lasts as long as the clip or the
/// sound, whatever is longer. Ctrl-C completes what was rendered: exit code kInterrupted.
/// Errors: unsupported (extension, no encoder), those of VideoEncoder and write_container().
Result<int> write_preview(const std::string& path, const fap::Sequence& clip,
                          const media::MuxInput& sound, const PreviewOptions& options);

}  // namespace animeme::tools
