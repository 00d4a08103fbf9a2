/// @file
/// What is there as a whole before it is streamed: a face and its sound, coded.
#pragma once

#include <optional>
#include <string>

#include "codec/decode/access_unit.h"
#include "codec/decode/decoder.h"
#include "fap/frame.h"
#include "fap/result.h"
#include "tools/formats/files/log.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/formats/media/pcm.h"

namespace animeme::live {

/// How face and sound are coded where they are not yet.
struct Coding {
  int quant = 1;               ///< fap_quant, 1..31
  double intra_seconds = 1;    ///< coded streams with longer distances are coded again
  bool copy = false;           ///< coded streams stay as they are, whatever is asked for
  bool sound = true;           ///< false: the face alone
  media::AudioSettings audio;  ///< how sound is coded
  bool codec_given = false;    ///< coded sound of another codec is coded again
};

/// Face and sound, coded.
struct Clip {
  fba::AccessUnits face;      ///< planes
  media::EncodedAudio sound;  ///< no packets: silent
};

/// A clip as fba::live_options() code it: every intra plane tells all that a receiver needs.
/// Errors: those of fba::encode(); not_found (no frames).
Result<fba::AccessUnits> live_units(const fap::Sequence& clip, const Coding& coding);

/// Seconds of the longest stretch between two intra planes, or from the last one to the end.
double longest_intra_interval(const fba::AccessUnits& units);

/// Coded units of a stream, `decoded`, coded again so that joining points lie
/// Coding::intra_seconds apart, with their quantisers and times; nothing: they do already.
Result<std::optional<fba::AccessUnits>> with_joints(const fba::AccessUnits& units,
                                                    const fba::DecodedStream& decoded,
                                                    const Coding& coding);

/// Coded units of a stream, `decoded`, as they are, or coded again where their intra planes lie
/// farther apart than `coding` wants. Says so; warns of streams that can be joined at their begin
/// only. `name` is that of the file in what is said and in errors.
Result<fba::AccessUnits> for_live_use(fba::AccessUnits units, const fba::DecodedStream& decoded,
                                      const std::string& name, const Coding& coding,
                                      const tools::Log& log = {});

/// Sound from any file: its packets as they are where that is possible and `coding` allows it.
/// Errors: those of speech::read_coded_sound().
Result<media::EncodedAudio> live_sound(const std::string& path, const Coding& coding,
                                       const tools::Log& log = {});

/// A clip and its sound (may be null) coded.
Result<Clip> code_live_clip(const fap::Sequence& clip, const media::Pcm* audio,
                            const Coding& coding);

}  // namespace animeme::live
