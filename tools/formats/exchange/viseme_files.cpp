#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "dam/script/textgrid.h"
#include "fap/tables.h"
#include "tools/formats/exchange/detail/json_text.h"
#include "tools/formats/exchange/visemes.h"

namespace animeme::exchange {

namespace {

constexpr std::string_view kPrefix = "viseme_";
std::string_view morph(int viseme) { return fap::kVisemes[std::size_t(viseme)].morph; }

// Bytes that XML cannot hold are left out.
std::string xml_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (static_cast<unsigned char>(c) >= 0x20)
      out += c;
  }
  return out;
}

// Times in the unit that is written: hundredths of a second, or milliseconds.
struct Cue {
  std::int64_t from;
  std::int64_t to;
  int shape;

  std::int64_t length() const { return to - from; }
  double start() const { return double(from) / 100; }
  double end() const { return double(to) / 100; }
  char letter() const { return char(shape); }
};

// What a player must be left time for.
struct Shapes {
  std::int64_t shortest;  // cue: a frame of 25 a second
  int closed;             // lips
  int lip_on_teeth;
};

constexpr Shapes kOfRhubarb = {4, 'A', 'G'};
constexpr Shapes kOfOculus = {40, 1, 2};  // PP, FF

std::int64_t hundredths(double seconds) { return std::int64_t(std::llround(seconds * 100)); }
std::int64_t milliseconds(double seconds) { return std::int64_t(std::llround(seconds * 1000)); }

// Longer than a player's frame, each of them. What is shorter is left to the shape before it; but
// lips that close, and teeth on a lip, are what one misses: those take what they lack from a
// neighbour that can spare it, else all of the one before.
std::vector<Cue> without_short(std::vector<Cue> cues, const Shapes& shapes) {
  std::vector<Cue> out;
  for (std::size_t i = 0; i < cues.size(); ++i) {
    Cue cue = cues[i];
    if (!out.empty()) cue.from = out.back().to;
    Cue* next = i + 1 < cues.size() ? &cues[i + 1] : nullptr;
    const std::int64_t missing = shapes.shortest - cue.length();
    const bool alike = !out.empty() && out.back().shape == cue.shape;
    if (missing > 0 && !alike) {
      const bool contact = cue.shape == shapes.closed || cue.shape == shapes.lip_on_teeth;
      if (contact && !out.empty() && out.back().length() >= shapes.shortest + missing) {
        out.back().to = cue.from -= missing;
      } else if (contact && next != nullptr && next->length() >= shapes.shortest + missing) {
        next->from = cue.to += missing;
      } else if (contact && !out.empty()) {
        cue.from = out.back().from;
        out.pop_back();
      } else if (!out.empty()) {
        out.back().to = cue.to;
        continue;
      } else if (next != nullptr) {
        next->from = cue.from;
        if (contact && next->shape != shapes.closed) next->shape = cue.shape;
        continue;
      }
    }
    if (!out.empty() && out.back().shape == cue.shape) {
      out.back().to = cue.to;
    } else if (cue.length() > 0) {
      out.push_back(cue);
    }
  }
  return out;
}

// Equal neighbours are one.
template <class ShapeOf>
std::vector<Cue> cues_of(const VisemeTrack& track, const ShapeOf& shape_of,
                         std::int64_t time_of(double), const Shapes& shapes) {
  std::vector<Cue> cues;
  for (const VisemeEvent& event : track.events) {
    const int shape = shape_of(event);
    const std::int64_t end = time_of(event.time + event.duration);
    if (!cues.empty() && cues.back().shape == shape) {
      cues.back().to = end;
    } else {
      cues.push_back({time_of(event.time), end, shape});
    }
  }
  return without_short(std::move(cues), shapes);
}

// What is drawn for a shape.
char drawn(char shape, const RhubarbOptions& options) {
  constexpr std::string_view kExtended = "GHX", kInstead = "ACA";
  const std::size_t which = kExtended.find(shape);
  const bool there =
      which == std::string_view::npos || options.extended.find(shape) != std::string::npos;
  return there ? shape : kInstead[which];
}

std::vector<Cue> cues_of(const VisemeTrack& track, const RhubarbOptions& options) {
  const auto shape_of = [&](const VisemeEvent& event) {
    return drawn(rhubarb_shape(event), options);
  };
  return cues_of(track, shape_of, hundredths, kOfRhubarb);
}

// "words": [...], "wtimes": [...], "wdurations": [...]; what a list of cues is made of.
template <class Item, class Text, class Time>
std::string three_lists(const std::vector<Item>& items, std::string_view names, std::string_view of,
                        const Text& text_of, const Time& time_of) {
  std::string texts, times, durations;
  for (const Item& item : items) {
    const char* comma = texts.empty() ? "" : ", ";
    const auto [from, to] = time_of(item);
    texts += comma + text_of(item);
    times += comma + std::to_string(from);
    durations += comma + std::to_string(to - from);
  }
  const auto list = [](std::string_view name, const std::string& content) {
    return " \"" + std::string(name) + "\": [" + content + "]";
  };
  return list(names, texts) + ",\n" + list(std::string(of) + "times", times) + ",\n" +
         list(std::string(of) + "durations", durations);
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

std::string write_rhubarb_json(const VisemeTrack& track, std::string_view audio,
                               const RhubarbOptions& options) {
  const std::vector<Cue> cues = cues_of(track, options);
  std::string text = "{\n  \"metadata\": {\n    \"soundFile\": " + json_text(audio) +
                     ",\n    \"duration\": " + decimals(cues.empty() ? 0 : cues.back().end(), 2) +
                     "\n  },\n  \"mouthCues\": [";
  for (std::size_t i = 0; i < cues.size(); ++i) {
    text += std::string(i == 0 ? "" : ",") + "\n    { \"start\": " + decimals(cues[i].start(), 2) +
            ", \"end\": " + decimals(cues[i].end(), 2) + ", \"value\": \"" + cues[i].letter() +
            "\" }";
  }
  return text + "\n  ]\n}\n";
}

std::string write_talking_head(const VisemeTrack& track, const dam::Script& script,
                               std::string_view audio) {
  std::vector<Cue> cues = cues_of(
      track, [](const VisemeEvent& event) { return event.viseme; }, milliseconds, kOfOculus);
  std::erase_if(cues, [](const Cue& cue) { return cue.shape == 0; });  // it closes by itself
  std::vector<dam::TextGridItem> words = dam::textgrid_of(script).tiers.front().items;
  std::erase_if(words, [](const dam::TextGridItem& word) { return word.text.empty(); });
  return "{\"audio\": " + (audio.empty() ? std::string("null") : json_text(audio)) + ",\n" +
         three_lists(
             words, "words", "w", [](const auto& word) { return json_text(word.text); },
             [](const auto& word) {
               return std::pair(milliseconds(word.start), milliseconds(word.end));
             }) +
         ",\n" +
         three_lists(
             cues, "visemes", "v",
             [](const Cue& cue) { return json_text(morph(cue.shape).substr(kPrefix.size())); },
             [](const Cue& cue) { return std::pair(cue.from, cue.to); }) +
         "}\n";
}

std::string write_rhubarb_tsv(const VisemeTrack& track, const RhubarbOptions& options) {
  std::string text;
  const std::vector<Cue> cues = cues_of(track, options);
  for (const Cue& cue : cues) text += decimals(cue.start(), 2) + "\t" + cue.letter() + "\n";
  if (!cues.empty()) {
    text += decimals(cues.back().end(), 2) + "\t" + drawn('X', options) + "\n";
  }
  return text;
}

std::string write_rhubarb_xml(const VisemeTrack& track, std::string_view audio,
                              const RhubarbOptions& options) {
  const std::vector<Cue> cues = cues_of(track, options);
  std::string text =
      "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<rhubarbResult>\n  <metadata>\n    <soundFile>" +
      xml_text(audio) + "</soundFile>\n    <duration>" +
      decimals(cues.empty() ? 0 : cues.back().end(), 2) +
      "</duration>\n  </metadata>\n  <mouthCues>\n";
  for (const Cue& cue : cues) {
    text += "    <mouthCue start=\"" + decimals(cue.start(), 2) + "\" end=\"" +
            decimals(cue.end(), 2) + "\">" + cue.letter() + "</mouthCue>\n";
  }
  return text + "  </mouthCues>\n</rhubarbResult>\n";
}

std::string write_rhubarb_dat(const VisemeTrack& track, const RhubarbOptions& options) {
  constexpr std::string_view kLetters = "ABCDEFGHX";
  constexpr std::string_view kPrestonBlair[] = {"MBP", "etc", "E", "AI",  "O",
                                                "U",   "FV",  "L", "rest"};
  const auto name = [&](char shape) {
    return options.preston_blair ? std::string(kPrestonBlair[kLetters.find(shape)])
                                 : std::string(1, shape);
  };
  // Times count in hundredths of a second, as in the other formats.
  const auto frame_of = [&](double time) {
    return 1 + std::int64_t(std::floor(options.dat_rate * std::round(time * 100) / 100 + 1e-9));
  };
  const std::vector<Cue> cues = cues_of(track, options);
  std::string text = "MohoSwitch1\n";
  std::int64_t last = 0;
  for (const Cue& cue : cues) {
    const std::int64_t frame = frame_of(cue.start());
    if (frame == last) continue;
    text += std::to_string(frame) + " " + name(cue.letter()) + "\n";
    last = frame;
  }
  if (cues.empty()) return text;
  const std::int64_t end = std::max(frame_of(cues.back().end()), last + 1);
  return text + std::to_string(end) + " " + name(drawn('X', options)) + "\n";
}

}  // namespace animeme::exchange
