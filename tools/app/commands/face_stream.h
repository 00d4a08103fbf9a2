/// @file
/// From a clip or stream to access units and media files, for speak and mux.
#pragma once

#include <string>

#include "codec/decode/access_unit.h"
#include "codec/decode/unit_reader.h"
#include "codec/encode/encode.h"
#include "tools/app/commands/common.h"
#include "tools/formats/media/mux.h"

namespace animeme::live {
struct Coding;
}

namespace animeme::tools {

/// How a face is coded for a container.
struct StreamSettings {
  int quant = 1;       ///< fap_quant
  double rms = 0;      ///< > 0: fewest bits at this error, see fba::EncodeOptions::max_rms
  double kbps = 0;     ///< > 0: smallest error at this rate
  bool small = false;  ///< smallest size that nobody sees: an error, and still planes skipped
  bool default_ranges = false;  ///< no intra ranges are sent, see add_default_ranges_option()
  double intra_seconds = 5;     ///< random access points of containers; raw streams have one
};

/// Error of --small, FAP units RMS: about that of quantiser 4.
inline constexpr double kSmallRms = 2;

/// Adds --quant, --rms, --kbps and --small.
void add_coding_options(OptionTable& cli, StreamSettings& settings);

/// Adds the last three of these, which exclude `others`, separated by blanks.
void add_limit_options(OptionTable& cli, StreamSettings& settings, const std::string& others);

/// Adds --default-ranges.
void add_default_ranges_option(OptionTable& cli, bool& default_ranges);

/// Warns of what --default-ranges has done, or that it had no effect as values lie outside.
void warn_of_default_ranges(bool done);

/// Adds --quant, these, --default-ranges and --intra-seconds.
void add_stream_options(OptionTable& cli, StreamSettings& settings);

/// The options for a raw stream: one intra plane. With a limit of error or rate, those of preset
/// `file`; else every FAP of the clip is coded.
fba::EncodeOptions encode_options(const StreamSettings& settings);

/// fba::encode(), and what there is to say about default ranges.
Result<std::vector<std::uint8_t>> encode_face(const fap::Sequence& face,
                                              const fba::EncodeOptions& options,
                                              std::span<const fba::BodyFrame> body = {});

/// The options for access units of containers.
fba::EncodeOptions unit_options(const StreamSettings& settings, fap::Rate rate);

/// The same limits for clips that are streamed.
void give_limits(const StreamSettings& settings, live::Coding& coding);

/// "1.25 s".
std::string seconds_text(double seconds);

/// The access units of a face: a stream keeps its own coding, a clip is coded with `settings`.
Result<fba::AccessUnits> access_units(const FaceInput& face, const StreamSettings& settings);

/// The units of a raw stream in a file, which stays there. Errors: those of fba::UnitReader.
Result<fba::UnitReader> open_units(const std::string& path);

/// How the sound of a container is coded, as it was asked for.
struct SoundSettings {
  std::string codec;  ///< "aac", "opus", "copy" (mux only); empty: as the container wants it
  int bit_rate = 0;   ///< bits a second; 0: usual
};

/// Adds --audio-codec and --audio-bitrate; with `copy`, sound may also be taken as it is.
void add_sound_options(OptionTable& cli, SoundSettings& settings, bool copy);

/// Adds --subtitles.
void add_subtitles_option(OptionTable& cli, bool& subtitles);

/// Whether captions go into a container of this name: in mp4 only with --subtitles.
bool shows_captions(const std::string& output, bool subtitles);

/// For a container of this name.
media::AudioSettings audio_settings(const SoundSettings& settings, const std::string& path);

/// What is known of the sound that write_media() gets.
enum class SoundState : std::uint8_t {
  plain,       ///< nothing
  reported,    ///< what is wrong with the sound file was reported before
  made_again,  ///< MuxInput::encoded was made of samples, and does not have the packets of a file
};

/// Writes a container with progress and says what was written. Ctrl-C completes what was written
/// so far: the exit code is kInterrupted then.
Result<int> write_media(const std::string& path, const media::MuxInput& input,
                        media::MuxOptions options, SoundState sound = SoundState::plain);

}  // namespace animeme::tools
