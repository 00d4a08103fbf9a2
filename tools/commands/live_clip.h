/// @file
/// What is there as a whole before it is streamed: a face and its sound, coded.
#pragma once

#include <string>

#include "codec/decode/access_unit.h"
#include "tools/commands/common.h"
#include "tools/commands/spoken.h"
#include "tools/media/encoded_audio.h"

namespace animeme::tools {

/// How face and sound are coded where they are not yet.
struct LiveCoding {
  int quant = 1;               ///< fap_quant
  double intra_seconds = 1;    ///< coded streams with longer distances are coded again
  bool copy = false;           ///< coded streams stay as they are, whatever is asked for
  bool sound = true;           ///< false: the face alone
  media::AudioSettings audio;  ///< if it is to be coded
  bool codec_given = false;    ///< coded sound of another codec is coded again
};

/// A clip that is ready to be sent.
struct LiveClip {
  fba::AccessUnits face;      ///< may have no units
  media::EncodedAudio sound;  ///< no packets: silent
};

/// A clip as the live encoder codes it: every intra plane tells all that a receiver needs.
/// Errors: those of fba::LiveEncoder; not_found (no frames).
Result<fba::AccessUnits> live_units(const fap::Sequence& clip, const LiveCoding& coding);

/// Seconds of the longest stretch between two intra planes, or from the last one to the end.
double longest_intra_interval(const fba::AccessUnits& units);

/// A file with a face, and with sound if it is a container or `audio` names one. Coded streams and
/// coded sound keep their bytes, but for what `coding` says. Warns of streams that can be joined at
/// their begin only.
Result<LiveClip> load_live_clip(const std::string& path, const std::string& audio,
                                const LiveCoding& coding);

/// A clip and its sound (may be null) coded.
Result<LiveClip> code_live_clip(const fap::Sequence& clip, const media::Pcm* audio,
                                const LiveCoding& coding);

}  // namespace animeme::tools
