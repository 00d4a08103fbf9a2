// Reading DASH descriptions, the small part of them that local files need.
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

#include "fap/xml/detail/document.h"
#include "tools/formats/media/detail/segments/playlist_text.h"

namespace animeme::media {
namespace {

using head::detail::XmlElement;

constexpr std::size_t kMostSets = 64;
constexpr std::size_t kLongestName = 2048;
constexpr std::int64_t kLargest = std::int64_t(1) << 53;

// Of a representation: what is around it says first, what is in it has the last word.
struct Template {
  std::string base;  // folder of relative names, with its slash
  std::string initialization;
  std::string media;
  std::int64_t number = 1;
  std::int64_t timescale = 1;
  std::int64_t duration = 0;        // of each segment, where there is no timeline
  std::vector<std::int64_t> times;  // of a timeline
  std::vector<std::string> list;    // of a SegmentList
};

std::string text_of(const XmlElement& element, std::string_view attribute,
                    const std::string& otherwise = {}) {
  const std::string* text = element.attribute(attribute);
  return text == nullptr ? otherwise : *text;
}

/// Replaces `value` if the attribute is there.
Result<void> take_number(const XmlElement& element, const char* attribute, std::int64_t& value) {
  const std::string* text = element.attribute(attribute);
  if (text == nullptr) return {};
  const char* end = text->data() + text->size();
  const auto [at, error] = std::from_chars(text->data(), end, value);
  if (error == std::errc() && at == end && value >= -1 && value <= kLargest) return {};
  return element.error(Code::syntax, std::string(attribute) + " is not a number that can be used");
}

/// "PT1H2M3.5S" in seconds; 0: another form, which is not used for clips.
double period_seconds(std::string_view text) {
  if (!text.starts_with("PT")) return 0;
  text.remove_prefix(2);
  double total = 0;
  while (!text.empty()) {
    double value = 0;
    const auto [at, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const auto used = std::size_t(at - text.data());
    if (error != std::errc() || used >= text.size()) return 0;
    const char unit = text[used];
    total += value * (unit == 'H' ? 3600 : unit == 'M' ? 60 : unit == 'S' ? 1 : NAN);
    text.remove_prefix(used + 1);
  }
  return total >= 0 && total < 1e9 ? total : 0;
}

/// Fills in $Number$, $Number%05d$, $Time$, $RepresentationID$ and $$; nullopt: another name, or
/// the pattern is too long.
std::optional<std::string> fill_in(std::string_view pattern, std::int64_t number, std::int64_t time,
                                   const std::string& id) {
  std::string out;
  if (pattern.size() + id.size() > kLongestName) return std::nullopt;
  while (!pattern.empty()) {
    const std::size_t begin = pattern.find('$');
    out += pattern.substr(0, begin);
    if (begin == std::string_view::npos) break;
    const std::size_t end = pattern.find('$', begin + 1);
    if (end == std::string_view::npos) return std::nullopt;
    std::string_view name = pattern.substr(begin + 1, end - begin - 1);
    pattern.remove_prefix(end + 1);
    int width = 1;
    if (const std::size_t percent = name.find('%'); percent != std::string_view::npos) {
      const std::string_view form = name.substr(percent);  // %05d
      if (form.size() != 4 || form[1] != '0' || form[2] < '1' || form[2] > '9' || form[3] != 'd') {
        return std::nullopt;
      }
      width = form[2] - '0';
      name = name.substr(0, percent);
    }
    if (name == "RepresentationID") {
      out += id;
    } else if (name == "Number" || name == "Time") {
      char text[40];
      std::snprintf(text, sizeof text, "%0*lld", width,
                    (long long)(name == "Time" ? time : number));
      out += text;
    } else if (name.empty()) {
      out += '$';
    } else {
      return std::nullopt;
    }
  }
  return out;
}

Result<void> take_timeline(const XmlElement& timeline, std::vector<std::int64_t>& times) {
  std::int64_t time = 0;
  for (const XmlElement& entry : timeline.children) {
    if (entry.name != "S") continue;
    std::int64_t duration = 0, repeat = 0;
    for (const auto& ok : {take_number(entry, "t", time), take_number(entry, "d", duration),
                           take_number(entry, "r", repeat)}) {
      if (!ok) return ok;
    }
    if (duration <= 0) return entry.error(Code::syntax, "a segment needs a duration");
    if (repeat < 0) {
      return entry.error(Code::unsupported, "segments without a count are not read");
    }
    if (std::size_t(repeat) + times.size() >= kMostSegments ||
        duration > (kLargest - time) / (repeat + 1)) {
      return entry.error(Code::out_of_range, "the description is too long");
    }
    for (std::int64_t i = 0; i <= repeat; ++i, time += duration) times.push_back(time);
  }
  return {};
}

Result<void> take_list(const XmlElement& element, Template& out) {
  for (const XmlElement& child : element.children) {
    if (child.name == "Initialization" && child.attribute("range") == nullptr) {
      out.initialization = text_of(child, "sourceURL", out.initialization);
    } else if (child.name == "SegmentURL" && child.attribute("mediaRange") == nullptr &&
               child.attribute("media") != nullptr) {
      if (out.list.size() >= kMostSegments) {
        return child.error(Code::out_of_range, "the description is too long");
      }
      out.list.push_back(*child.attribute("media"));
    } else if (child.name == "Initialization" || child.name == "SegmentURL") {
      return child.error(Code::unsupported, "byte ranges are not read");
    }
  }
  return {};
}

/// What an element around a representation, or itself, adds.
Result<void> take_level(const XmlElement& level, Template& out) {
  for (const XmlElement& child : level.children) {
    if (child.name == "BaseURL") {
      out.base += child.text.substr(0, child.text.rfind('/') + 1);
      if (out.base.size() > kLongestName) {
        return child.error(Code::out_of_range, "a name is too long");
      }
    }
    if (child.name != "SegmentTemplate" && child.name != "SegmentList") continue;
    out.times.clear();
    out.list.clear();
    out.initialization = text_of(child, "initialization", out.initialization);
    out.media = text_of(child, "media", out.media);
    for (const auto& ok : {take_number(child, "startNumber", out.number),
                           take_number(child, "timescale", out.timescale),
                           take_number(child, "duration", out.duration), take_list(child, out)}) {
      if (!ok) return ok;
    }
    if (out.timescale <= 0) return child.error(Code::syntax, "the time scale must be positive");
    if (const XmlElement* timeline = child.child("SegmentTimeline")) {
      if (auto ok = take_timeline(*timeline, out.times); !ok) return ok;
    }
  }
  return {};
}

Result<Rendition> read_representation(const XmlElement& representation, Template segments,
                                      double seconds) {
  if (auto ok = take_level(representation, segments); !ok) return ok.error();
  const auto unknown = [&](const char* what) {
    return representation.error(Code::unsupported, what);
  };
  const std::string id = text_of(representation, "id");
  std::vector<std::string> names = std::move(segments.list);
  if (names.empty()) {
    if (segments.media.empty()) {
      return unknown("a representation is not in segments; give its file instead");
    }
    std::vector<std::int64_t>& times = segments.times;
    if (times.empty() && segments.duration > 0) {
      const double count =
          std::ceil(seconds * double(segments.timescale) / double(segments.duration));
      if (!(count >= 1 && count <= double(kMostSegments) &&
            count * double(segments.duration) <= double(kLargest))) {
        return unknown("the number of segments is not stated");
      }
      for (std::int64_t i = 0; i < std::int64_t(count); ++i) times.push_back(i * segments.duration);
    }
    for (const std::int64_t time : times) {
      auto name = fill_in(segments.media, segments.number++, time, id);
      if (!name) return unknown("this segment template is not known");
      names.push_back(std::move(*name));
    }
  }
  const auto init = fill_in(segments.initialization, 0, 0, id);
  if (!init) return unknown("this segment template is not known");
  Rendition rendition;
  if (!init->empty()) rendition.init = segments.base + *init;
  for (const std::string& name : names) rendition.segments.push_back(segments.base + name);
  return rendition;
}

Error nothing() { return make_error(Code::truncated, "the description names no segments"); }

}  // namespace

Result<std::vector<Rendition>> read_dash(std::string_view text) {
  const Result<XmlElement> mpd = head::detail::parse_xml(text);
  if (!mpd) return mpd.error();
  if (mpd->name != "MPD") return mpd->error(Code::syntax, "a DASH description begins with MPD");
  if (text_of(*mpd, "type", "static") != "static") {
    return mpd->error(Code::unsupported, "this describes a live presentation; give a finished one");
  }
  const double seconds = period_seconds(text_of(*mpd, "mediaPresentationDuration"));
  const XmlElement* period = mpd->child("Period");
  if (period == nullptr) return nothing();
  for (const XmlElement& other : mpd->children) {
    if (other.name == "Period" && &other != period) {
      return other.error(Code::unsupported, "several periods are not read");
    }
  }
  Template around;
  for (const XmlElement* level : {&*mpd, period}) {
    if (auto ok = take_level(*level, around); !ok) return ok.error();
  }
  std::vector<Rendition> out;
  std::size_t sets = 0;
  for (const XmlElement& set : period->children) {
    if (set.name != "AdaptationSet") continue;
    if (++sets > kMostSets) return set.error(Code::out_of_range, "too many adaptation sets");
    Template segments = around;
    if (auto ok = take_level(set, segments); !ok) return ok.error();
    const XmlElement* representation = set.child("Representation");
    if (representation == nullptr) continue;
    auto rendition = read_representation(*representation, std::move(segments), seconds);
    if (!rendition) return rendition.error();
    if (!rendition->segments.empty()) out.push_back(std::move(*rendition));
  }
  if (out.empty()) return nothing();
  return out;
}

}  // namespace animeme::media
