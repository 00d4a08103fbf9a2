#include "fap/tables.h"
#include "tools/exchange/detail/json_text.h"
#include "tools/exchange/visemes.h"

namespace animeme::exchange {

namespace {

std::string_view morph(int viseme) { return fap::kVisemes[std::size_t(viseme)].morph; }

struct Cue {
  double start;
  double end;
  char shape;
};

std::vector<Cue> cues_of(const VisemeTrack& track) {
  std::vector<Cue> cues;
  for (const VisemeEvent& event : track.events) {
    const char shape = rhubarb_shape(event);
    const double end = event.time + event.duration;
    if (!cues.empty() && cues.back().shape == shape) {
      cues.back().end = end;
    } else {
      cues.push_back({event.time, end, shape});
    }
  }
  return cues;
}

}  // namespace

std::string write_visemes_json(const VisemeTrack& track, std::string_view audio) {
  std::string text = track_head("animeme-visemes", track.rate, audio);
  for (int viseme = 0; viseme < fap::kVisemeCount; ++viseme) {
    text += (viseme == 0 ? "[" : ", ") + json_text(morph(viseme));
  }
  text += "],\n \"events\": [";
  for (std::size_t i = 0; i < track.events.size(); ++i) {
    const VisemeEvent& event = track.events[i];
    text += std::string(i == 0 ? "" : ",") + "\n  {\"time\": " + decimals(event.time, 4) +
            ", \"duration\": " + decimals(event.duration, 4) +
            (event.phone.empty() ? "" : ", \"phone\": " + json_text(event.phone)) +
            ", \"viseme\": " + json_text(morph(event.viseme)) + "}";
  }
  return text + "]" + track_frames(track.frames, 4);
}

std::string write_visemes_csv(const VisemeTrack& track) {
  std::string text = "time_s";
  for (int viseme = 0; viseme < fap::kVisemeCount; ++viseme) {
    text += "," + std::string(morph(viseme));
  }
  text += "\n";
  for (std::size_t i = 0; i < track.frames.size(); ++i) {
    text += decimals(track.rate.seconds(double(i)), 6);
    for (const double weight : track.frames[i]) text += "," + decimals(weight, 4);
    text += "\n";
  }
  return text;
}

char rhubarb_shape(const VisemeEvent& event) {
  if (event.phone == "L") return 'H';
  constexpr std::string_view kShapes = "XAGBBBBBBEDCBEF";  // by viseme number
  return kShapes[std::size_t(event.viseme)];
}

std::string write_rhubarb_json(const VisemeTrack& track, std::string_view audio) {
  const std::vector<Cue> cues = cues_of(track);
  std::string text = "{\n  \"metadata\": {\n    \"soundFile\": " + json_text(audio) +
                     ",\n    \"duration\": " + decimals(cues.empty() ? 0 : cues.back().end, 2) +
                     "\n  },\n  \"mouthCues\": [";
  for (std::size_t i = 0; i < cues.size(); ++i) {
    text += std::string(i == 0 ? "" : ",") + "\n    { \"start\": " + decimals(cues[i].start, 2) +
            ", \"end\": " + decimals(cues[i].end, 2) + ", \"value\": \"" + cues[i].shape + "\" }";
  }
  return text + "\n  ]\n}\n";
}

std::string write_rhubarb_tsv(const VisemeTrack& track) {
  std::string text;
  const std::vector<Cue> cues = cues_of(track);
  for (const Cue& cue : cues) text += decimals(cue.start, 2) + "\t" + cue.shape + "\n";
  if (!cues.empty()) text += decimals(cues.back().end, 2) + "\tX\n";
  return text;
}

}  // namespace animeme::exchange
