/// @file
/// Complete clips for streaming: a coded face and its sound.
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

/// Options for encoding face and sound.
struct Coding {
  int quant = 1;       ///< fap_quant, 0..31
  double max_rms = 0;  ///< as fba::EncodeOptions::max_rms; > 0: coded streams are re-encoded
  double max_bits_per_second = 0;  ///< likewise, with start codes
  bool skip_still = false;         ///< likewise
  bool default_ranges = false;     ///< likewise
  double intra_seconds = 1;        ///< coded streams with longer intervals are re-encoded
  bool copy = false;               ///< never re-encode coded streams
  bool sound = true;               ///< false: face only
  media::AudioSettings audio;      ///< audio encoder settings
  bool codec_given = false;        ///< re-encode sound of another codec
};

/// Coded face and sound.
struct Clip {
  fba::AccessUnits face;      ///< planes
  media::EncodedAudio sound;  ///< no packets: silent
};

/// Of a bit rate of units what is left for their planes: a unit takes a start code and about four
/// bits of stuffing besides. A tenth at least.
double bit_rate_of_planes(double bits_per_second, fap::Rate rate);

/// Encodes a clip with fba::live_options(), and the limits of `coding`: every intra plane is
/// self-contained.
/// Errors: those of fba::encode(); not_found (no frames).
Result<fba::AccessUnits> live_units(const fap::Sequence& clip, const Coding& coding);

/// Seconds of the longest stretch between two intra planes, or from the last one to the end.
double longest_intra_interval(const fba::AccessUnits& units);

/// Re-encodes units of a stream, `decoded`, so that intra planes are Coding::intra_seconds apart,
/// with the same times, and the same quantisers unless `coding` has limits; nullopt: not necessary.
Result<std::optional<fba::AccessUnits>> with_joints(const fba::AccessUnits& units,
                                                    const fba::DecodedStream& decoded,
                                                    const Coding& coding);

/// Units of a stream, `decoded`, unchanged, or re-encoded if their intra planes are farther apart
/// than `coding` requires. Logs this; warns about streams that can be joined only at their
/// beginning. `name` is the file name for messages and errors.
Result<fba::AccessUnits> for_live_use(fba::AccessUnits units, const fba::DecodedStream& decoded,
                                      const std::string& name, const Coding& coding,
                                      const tools::Log& log = {});

/// Sound from any file: its packets unchanged if possible and allowed by `coding`.
/// Errors: those of speech::read_coded_sound().
Result<media::EncodedAudio> live_sound(const std::string& path, const Coding& coding,
                                       const tools::Log& log = {});

/// Encodes a clip and its sound (may be null).
Result<Clip> code_live_clip(const fap::Sequence& clip, const media::Pcm* audio,
                            const Coding& coding);

}  // namespace animeme::live
