#include "tools/formats/media/detail/segments/playlist_text.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "tools/formats/media/detail/segments/autonym.h"

namespace animeme::media {
namespace {

// Clients that do not know this scheme must leave the adaptation set alone.
constexpr const char* kFaceScheme = "urn:animeme:face:2026";

std::string format(const char* pattern, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text, sizeof text, pattern, arguments);
  va_end(arguments);
  return text;
}

double seconds(const SegmentedTrack& track, std::int64_t ticks) {
  return double(ticks) / track.timescale;
}

double length(const SegmentedTrack& track) {
  const Segment& last = track.segments.back();
  return seconds(track, last.time + last.duration);
}

/// Bits a second of the most expensive segment.
std::int64_t peak(const SegmentedTrack& track) {
  double most = 0;
  for (const Segment& segment : track.segments) {
    most = std::max(most, double(segment.bytes) * 8 / seconds(track, segment.duration));
  }
  return std::int64_t(std::ceil(most));
}

std::int64_t average(const SegmentedTrack& track) {
  double bytes = 0;
  for (const Segment& segment : track.segments) bytes += double(segment.bytes);
  return std::int64_t(std::ceil(bytes * 8 / length(track)));
}

std::string variant(const SegmentedTrack& track, const std::string& folder, bool texts,
                    bool sounds = false) {
  return format("#EXT-X-STREAM-INF:BANDWIDTH=%lld,AVERAGE-BANDWIDTH=%lld,CODECS=\"%s\"%s%s\n",
                (long long)peak(track), (long long)average(track), track.codecs.c_str(),
                sounds ? ",AUDIO=\"sound\"" : "", texts ? ",SUBTITLES=\"text\"" : "") +
         folder + "/" + track.name + ".m3u8\n";
}

// What a person reads in a menu, in the language of the track as RFC 8216 recommends it for
// EXT-X-MEDIA, and unique in its group.
std::string name_of(const SegmentedTrack& track) {
  const TrackLabels& labels = track.labels;
  std::string name = autonym_of(labels.language);
  if (!labels.speaker.empty()) name = labels.speaker + (name.empty() ? "" : ", " + name);
  if (name.empty()) name = track.name;
  std::erase(name, '"');
  return name;
}

// Players that know no faces must not choose one.
std::string media_tag(const SegmentedTrack& track, const std::string& folder) {
  const bool chosen = !track.face && track.is_default;
  const std::string& language = track.labels.language;
  return std::string("#EXT-X-MEDIA:TYPE=") + (track.face ? "VIDEO" : "AUDIO") + ",GROUP-ID=\"" +
         (track.face ? "face" : "sound") + "\",NAME=\"" + name_of(track) + "\"" +
         (language.empty() ? "" : ",LANGUAGE=\"" + language + "\"") +
         ",DEFAULT=" + (chosen ? "YES" : "NO") + ",AUTOSELECT=" + (track.face ? "NO" : "YES") +
         (track.face ? "" : ",CHANNELS=\"" + std::to_string(track.channels) + "\"") + ",URI=\"" +
         folder + "/" + track.name + ".m3u8\"\n";
}

std::string timeline(const SegmentedTrack& track) {
  std::string text = "        <SegmentTimeline>\n";
  for (std::size_t i = 0; i < track.segments.size();) {
    const Segment& first = track.segments[i];
    std::size_t end = i + 1;
    while (end < track.segments.size() && track.segments[end].duration == first.duration &&
           track.segments[end].time ==
               track.segments[end - 1].time + track.segments[end - 1].duration) {
      ++end;
    }
    text += format("          <S t=\"%lld\" d=\"%lld\"", (long long)first.time,
                   (long long)first.duration);
    if (end - i > 1) text += format(" r=\"%zu\"", end - i - 1);
    text += "/>\n";
    i = end;
  }
  return text + "        </SegmentTimeline>\n";
}

std::string adaptation_set(const SegmentedTrack& track, int id, const std::string& folder) {
  const char* kind = track.face ? "video" : "audio";
  const std::string& tag = track.labels.language;
  const std::string language = tag.empty() ? "" : " lang=\"" + tag + "\"";
  std::string text = format(
      "    <AdaptationSet id=\"%d\" contentType=\"%s\" mimeType=\"%s/mp4\"%s "
      "segmentAlignment=\"true\" startWithSAP=\"1\">\n",
      id, kind, kind, language.c_str());
  if (track.face) text += format("      <EssentialProperty schemeIdUri=\"%s\"/>\n", kFaceScheme);
  if (!track.labels.empty()) {
    text += format("      <Role schemeIdUri=\"urn:mpeg:dash:role:2011\" value=\"%s\"/>\n",
                   track.is_default ? "main" : "dub");
  }
  text += format("      <SegmentTemplate timescale=\"%u\" startNumber=\"1\" ", track.timescale) +
          "initialization=\"" + folder + "/" + track.init + "\" media=\"" + folder + "/" +
          track.name + "-$Number%05d$.m4s\">\n" + timeline(track) + "      </SegmentTemplate>\n";
  text += format("      <Representation id=\"%s\" codecs=\"%s\" bandwidth=\"%lld\"",
                 track.name.c_str(), track.codecs.c_str(), (long long)peak(track));
  if (track.face) {
    const bool video = track.codecs.starts_with("mp4v");
    text += video ? " width=\"320\" height=\"240\"/>\n" : "/>\n";  // as in its sample entry
  } else {
    text += format(" audioSamplingRate=\"%d\">\n", track.sample_rate);
    text += format(
        "        <AudioChannelConfiguration "
        "schemeIdUri=\"urn:mpeg:dash:23003:3:audio_channel_configuration:2011\" value=\"%d\"/>\n",
        track.channels);
    text += "      </Representation>\n";
  }
  return text + "    </AdaptationSet>\n";
}

}  // namespace

std::string hls_master(const std::vector<SegmentedTrack>& tracks, const std::string& folder,
                       const std::vector<SidecarText>& texts) {
  std::string text = "#EXTM3U\n#EXT-X-VERSION:7\n#EXT-X-INDEPENDENT-SEGMENTS\n";
  const bool has_sound = std::any_of(tracks.begin(), tracks.end(),
                                     [](const SegmentedTrack& track) { return !track.face; });
  const bool labelled = std::any_of(tracks.begin(), tracks.end(), [](const SegmentedTrack& track) {
    return !track.labels.empty();
  });
  for (const SidecarText& each : texts) {
    std::string name = each.name;
    if (labelled) {
      name += " (" + each.speaker + (each.speaker.empty() || each.language.empty() ? "" : ", ") +
              each.language + ")";
    }
    std::erase(name, '"');
    text += "#EXT-X-MEDIA:TYPE=SUBTITLES,GROUP-ID=\"text\",NAME=\"" + name + "\",LANGUAGE=\"" +
            each.language + "\",DEFAULT=NO,AUTOSELECT=NO," +
            (each.language.starts_with("zxx")  // phones
                 ? ""
                 : "CHARACTERISTICS=\"public.accessibility.transcribes-spoken-dialog\",") +
            "URI=\"" + folder + "/" + each.playlist + "\"\n";
  }
  for (const SegmentedTrack& track : tracks) {
    if (labelled && (has_sound || !track.is_default)) text += media_tag(track, folder);
  }
  for (const SegmentedTrack& track : tracks) {
    if (labelled) {
      if (track.is_default && track.face != has_sound)
        text += variant(track, folder, !texts.empty(), has_sound);
    } else if (track.face && has_sound) {
      text +=
          "#EXT-X-MEDIA:TYPE=VIDEO,GROUP-ID=\"face\",NAME=\"face\",DEFAULT=NO,AUTOSELECT=NO,"
          "URI=\"" +
          folder + "/" + track.name + ".m3u8\"\n";
    } else {
      text += variant(track, folder, !texts.empty());
    }
  }
  return text;
}

std::string hls_media(const SegmentedTrack& track) {
  double longest = 0;
  for (const Segment& segment : track.segments) {
    longest = std::max(longest, seconds(track, segment.duration));
  }
  std::string text = "#EXTM3U\n#EXT-X-VERSION:7\n";
  text += format("#EXT-X-TARGETDURATION:%lld\n", std::max(1LL, std::llround(longest)));
  text += "#EXT-X-MEDIA-SEQUENCE:1\n#EXT-X-PLAYLIST-TYPE:VOD\n#EXT-X-INDEPENDENT-SEGMENTS\n";
  text += "#EXT-X-MAP:URI=\"" + track.init + "\"\n";
  for (const Segment& segment : track.segments) {
    text += format("#EXTINF:%.6f,\n", seconds(track, segment.duration)) + segment.name + "\n";
  }
  return text + "#EXT-X-ENDLIST\n";
}

std::string hls_text(const std::string& file, double seconds) {
  return format(
             "#EXTM3U\n#EXT-X-VERSION:7\n#EXT-X-TARGETDURATION:%lld\n#EXT-X-PLAYLIST-TYPE:VOD\n"
             "#EXTINF:%.6f,\n",
             std::max(1LL, std::llround(std::ceil(seconds))), seconds) +
         file + "\n#EXT-X-ENDLIST\n";
}

std::string dash_description(const std::vector<SegmentedTrack>& tracks, const std::string& folder) {
  double longest_segment = 0;
  double end = 0;
  for (const SegmentedTrack& track : tracks) {
    end = std::max(end, length(track));
    for (const Segment& segment : track.segments) {
      longest_segment = std::max(longest_segment, seconds(track, segment.duration));
    }
  }
  std::string text = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n";
  text += format(
      "<MPD xmlns=\"urn:mpeg:dash:schema:mpd:2011\" "
      "profiles=\"urn:mpeg:dash:profile:isoff-live:2011\" type=\"static\" "
      "mediaPresentationDuration=\"PT%.6fS\" maxSegmentDuration=\"PT%.6fS\" "
      "minBufferTime=\"PT%.6fS\">\n",
      end, longest_segment, longest_segment);
  text += "  <Period id=\"0\" start=\"PT0S\">\n";
  int id = 0;
  // The sound first: it is what an ordinary player is to find.
  for (const bool face : {false, true}) {
    for (const SegmentedTrack& track : tracks) {
      if (track.face == face) text += adaptation_set(track, id++, folder);
    }
  }
  return text + "  </Period>\n</MPD>\n";
}

}  // namespace animeme::media
