// Reading DASH descriptions with segment templates and timelines, as segment_writer.cpp and FFmpeg
// write them.
#include <charconv>
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
  std::string initialization;
  std::string media;
  std::int64_t number = 1;
  std::vector<std::int64_t> times;  // of the timeline
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

/// What an element around a representation, or itself, adds.
Result<void> take_level(const XmlElement& level, Template& out) {
  for (const XmlElement& child : level.children) {
    if (child.name != "SegmentTemplate") continue;
    out.times.clear();
    out.initialization = text_of(child, "initialization", out.initialization);
    out.media = text_of(child, "media", out.media);
    if (auto ok = take_number(child, "startNumber", out.number); !ok) return ok;
    if (const XmlElement* timeline = child.child("SegmentTimeline")) {
      if (auto ok = take_timeline(*timeline, out.times); !ok) return ok;
    }
  }
  return {};
}

Result<Rendition> read_representation(const XmlElement& representation, Template segments) {
  if (auto ok = take_level(representation, segments); !ok) return ok.error();
  if (segments.media.empty() || segments.times.empty()) {
    return representation.error(Code::unsupported,
                                "only segment templates with a timeline are read; give the files "
                                "of the representation instead");
  }
  const std::string id = text_of(representation, "id");
  const auto unknown = [&] {
    return representation.error(Code::unsupported, "this segment template is not known");
  };
  Rendition rendition;
  for (const std::int64_t time : segments.times) {
    auto name = fill_in(segments.media, segments.number++, time, id);
    if (!name) return unknown();
    rendition.segments.push_back(std::move(*name));
  }
  auto init = fill_in(segments.initialization, 0, 0, id);
  if (!init) return unknown();
  rendition.init = std::move(*init);
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
    auto rendition = read_representation(*representation, std::move(segments));
    if (!rendition) return rendition.error();
    out.push_back(std::move(*rendition));
  }
  if (out.empty()) return nothing();
  return out;
}

}  // namespace animeme::media
