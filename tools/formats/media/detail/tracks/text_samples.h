// Timed text as tracks carry it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"
#include "tools/formats/media/text_track.h"

namespace animeme::media {

/// One packet of a text track.
struct TextSample {
  std::int64_t time = 0;
  std::int64_t duration = 0;
  std::vector<std::uint8_t> bytes;
};

/// A track on its way into a file. `codec`: AV_CODEC_ID_MOV_TEXT, whose samples follow each other
/// without gaps from time 0 on, or AV_CODEC_ID_SUBRIP.
struct TextSamples {
  AVCodecID codec = AV_CODEC_ID_SUBRIP;
  AVRational time_base{1, 1000};
  std::string name;
  std::string language;              ///< as the format writes it
  std::vector<std::uint8_t> config;  ///< what belongs into the sample entry
  std::vector<TextSample> samples;
};

/// Of a legal track. What is shorter than half a tick is left out.
TextSamples mov_text_samples(const TextTrack& track);
TextSamples subrip_samples(const TextTrack& track);

/// The same as a WebVTT file.
std::string webvtt_of(const TextTrack& track);

/// Texts in a whole `moov` box are not enabled from now on: libavformat enables the first one, as
/// the first of each kind of tracks, and a player would show it without being asked.
void hide_texts(std::span<std::uint8_t> moov);

/// The text of a packet; empty for other codecs than those above and WebVTT.
std::string text_of_packet(AVCodecID codec, const AVPacket& packet);

/// What a track of an open file is called, and its language; cleaned.
std::string name_of_text(const AVStream& stream);
std::string language_of_text(const AVStream& stream);

/// Is it one of these codecs?
bool is_plain_text(AVCodecID codec);

}  // namespace animeme::media
