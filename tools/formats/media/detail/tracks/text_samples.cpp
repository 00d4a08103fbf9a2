#include "tools/formats/media/detail/tracks/text_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "tools/formats/media/detail/mp4/box_writer.h"
#include "tools/formats/media/detail/mp4/boxes.h"
#include "tools/formats/media/detail/tracks/track_names.h"
#include "tools/formats/media/language_codes.h"

namespace animeme::media {
namespace {

// Fine enough for the samples of any sound, and whole for times in milliseconds.
constexpr int kTextTicks = 1'000'000;
constexpr int kMatroskaTicks = 1000;
constexpr std::int64_t kLongestSample = 3'000'000'000;  // durations have 32 bits

// What follows the header of a tx3g sample entry. Source: 3GPP TS 26.245.
std::vector<std::uint8_t> text_sample_entry() {
  BoxWriter out;
  out.u32(0);                       // display flags
  out.u8(1);                        // in the middle
  out.u8(0xFF);                     // at the bottom
  out.u32(0);                       // no background
  out.zeros(8);                     // where: as the player likes
  out.u16(0), out.u16(0);           // style of all characters:
  out.u16(1), out.u8(0);            // font 1, plain
  out.u8(16), out.u32(0xFFFFFFFF);  // size, white
  out.begin("ftab");
  out.u16(1), out.u16(1);
  constexpr std::string_view kFont = "Arial";  // FFmpeg takes others for marks of style
  out.u8(unsigned(kFont.size())), out.text(kFont);
  out.end();
  return out.bytes();
}

// Without <b>, </i>, <00:01.000> and the like; WebVTT's entities as characters.
std::string without_marks(std::string_view text, bool entities) {
  constexpr std::array<std::array<std::string_view, 2>, 6> kEntities = {{{"&amp;", "&"},
                                                                         {"&lt;", "<"},
                                                                         {"&gt;", ">"},
                                                                         {"&nbsp;", " "},
                                                                         {"&lrm;", ""},
                                                                         {"&rlm;", ""}}};
  std::string out;
  while (!text.empty()) {
    if (text.front() == '<') {
      const std::size_t end = text.find('>');
      const bool mark = end != std::string_view::npos && end > 1 &&
                        text.substr(1, end - 1).find('<') == std::string_view::npos;
      if (mark) {
        text.remove_prefix(end + 1);
        continue;
      }
    }
    const auto* entity = std::find_if(kEntities.begin(), kEntities.end(), [&](const auto& each) {
      return entities && text.starts_with(each[0]);
    });
    if (entity != kEntities.end()) {
      out += (*entity)[1];
      text.remove_prefix((*entity)[0].size());
    } else {
      out += text.front();
      text.remove_prefix(1);
    }
  }
  return out;
}

std::string tag_of(const AVStream& stream, const char* key) {
  const AVDictionaryEntry* entry = av_dict_get(stream.metadata, key, nullptr, 0);
  return entry == nullptr ? std::string() : clean_text(entry->value, 100);
}

std::int64_t ticks(double seconds, int scale) { return std::llround(seconds * scale); }

void add_empty(TextSamples& out, std::int64_t until) {
  std::int64_t at = out.samples.empty() ? 0 : out.samples.back().time + out.samples.back().duration;
  for (; at < until; at += kLongestSample) {
    out.samples.push_back({at, std::min(until - at, kLongestSample), {0, 0}});
  }
}

// clean_text() of each line.
std::string clean_lines(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string line = clean_text(text.substr(0, end));
    if (!line.empty()) out += (out.empty() ? "" : "\n") + line;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  }
  return out;
}

// An arrow or an empty line would end a cue.
std::string webvtt_cue(const TextCue& cue) {
  const bool whole = !cue.webvtt.empty() && cue.webvtt.find("-->") == std::string::npos;
  return whole ? clean_lines(cue.webvtt) : escaped(clean_lines(cue.text));
}

}  // namespace

TextSamples mov_text_samples(const TextTrack& track) {
  TextSamples out{AV_CODEC_ID_MOV_TEXT, {1, kTextTicks},     clean_text(track.name),
                  track.language,       text_sample_entry(), {}};
  for (const TextCue& cue : track.cues) {
    const std::string text = clean_lines(cue.text);
    const std::int64_t start = ticks(cue.start, kTextTicks), end = ticks(cue.end, kTextTicks);
    if (text.empty() || end <= start) continue;
    add_empty(out, start);
    BoxWriter sample;
    sample.u16(unsigned(text.size()));
    sample.text(text);
    out.samples.push_back({start, std::min(end - start, kLongestSample), sample.bytes()});
  }
  if (out.samples.empty()) add_empty(out, kTextTicks);
  return out;
}

TextSamples subrip_samples(const TextTrack& track) {
  TextSamples out{AV_CODEC_ID_SUBRIP,
                  {1, kMatroskaTicks},
                  clean_text(track.name),
                  bibliographic_code(track.language),
                  {},
                  {}};
  for (const TextCue& cue : track.cues) {
    const std::string text = clean_lines(cue.text);
    const std::int64_t start = ticks(cue.start, kMatroskaTicks);
    const std::int64_t end = ticks(cue.end, kMatroskaTicks);
    if (text.empty() || end <= start) continue;
    out.samples.push_back({start, end - start, {text.begin(), text.end()}});
  }
  return out;
}

std::string webvtt_of(const TextTrack& track) {
  const auto clock = [](std::int64_t milliseconds) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%02lld:%02d:%02d.%03d",
                  (long long)(milliseconds / 3600000), int(milliseconds / 60000 % 60),
                  int(milliseconds / 1000 % 60), int(milliseconds % 1000));
    return std::string(text.data());
  };
  std::string out = "WEBVTT\n";
  for (const TextCue& cue : track.cues) {
    const std::string text = webvtt_cue(cue);
    const std::int64_t start = ticks(cue.start, 1000), end = ticks(cue.end, 1000);
    if (text.empty() || end <= start) continue;
    out += "\n" + clock(start) + " --> " + clock(end) + "\n" + text + "\n";
  }
  return out;
}

void hide_texts(std::span<std::uint8_t> moov) {
  const Box whole = box_at(moov, 0, moov.size());
  const auto each_in = [moov](const Box& parent, std::string_view type, const auto& visit) {
    for_each_box(moov, parent.begin, parent.end, [&](const Box& box) {
      if (box.type == type) visit(box);
    });
  };
  each_in(whole, "trak", [&](const Box& trak) {
    bool text = false;
    each_in(trak, "mdia", [&](const Box& media) {
      each_in(media, "hdlr", [&](const Box& handler) {
        const auto content = moov.subspan(handler.begin, handler.end - handler.begin);
        constexpr std::string_view kSubtitles = "sbtl";
        text = content.size() >= 12 &&
               std::equal(kSubtitles.begin(), kSubtitles.end(), content.begin() + 8);
      });
    });
    if (!text) return;
    each_in(trak, "tkhd", [&](const Box& header) {
      constexpr unsigned kEnabled = 1;  // in the last byte of the flags
      if (header.end - header.begin >= 4) moov[header.begin + 3] &= std::uint8_t(~kEnabled);
    });
  });
}

std::string name_of_text(const AVStream& stream) {
  // libavformat tells a handler of each track of an mp4; a title, if there is one, is meant.
  const std::string title = tag_of(stream, "title");
  return name_without_speaker(title.empty() ? tag_of(stream, "handler_name") : title);
}

std::string language_of_text(const AVStream& stream) {
  const std::string language = tag_of(stream, "language");
  return language.empty() ? "und" : terminological_code(language);
}

bool is_plain_text(AVCodecID codec) {
  return codec == AV_CODEC_ID_MOV_TEXT || codec == AV_CODEC_ID_SUBRIP ||
         codec == AV_CODEC_ID_TEXT || codec == AV_CODEC_ID_WEBVTT;
}

std::string text_of_packet(AVCodecID codec, const AVPacket& packet) {
  if (packet.size <= 0 || !is_plain_text(codec)) return {};
  std::string_view text(reinterpret_cast<const char*>(packet.data), std::size_t(packet.size));
  if (codec != AV_CODEC_ID_MOV_TEXT) return without_marks(text, codec == AV_CODEC_ID_WEBVTT);
  if (text.size() < 2) return {};
  const auto length = std::size_t(read_big_endian({packet.data, 2}, 0, 2));
  return std::string(text.substr(2, length));  // boxes of style follow
}

}  // namespace animeme::media
