// Reading DASH descriptions, the small part of them that local files need.
#include <algorithm>
#include <cmath>
#include <optional>

#include "tools/media/detail/dash_text.h"
#include "tools/media/detail/playlist_text.h"
#include "tools/media/detail/xml_tags.h"

namespace animeme::media {
namespace {

constexpr int kMostSets = 64;

// What a SegmentTemplate or SegmentList says; a representation inherits from its set.
struct Template {
  std::string initialization;
  std::string media;
  std::int64_t number = 1;
  std::int64_t timescale = 1;
  std::int64_t duration = 0;        // of each segment, where there is no timeline
  std::vector<std::int64_t> times;  // of a timeline
  std::vector<std::string> list;    // of a SegmentList
};

struct Level {
  std::string element;
  std::string base;  // folder of relative names, with its slash
  Template segments;
};

bool holds_segments(const std::string& element) {
  return element == "Representation" || element == "AdaptationSet" || element == "Period";
}

class DashReader {
 public:
  Result<std::vector<Rendition>> read(std::string_view text);

 private:
  Result<void> open(const XmlTag& tag);
  Result<void> close(const std::string& name);
  Result<void> take_mpd(const XmlTag& tag);
  Result<void> take_template(const XmlTag& tag);
  Result<void> take_time(const XmlTag& tag);
  Result<void> finish_representation();
  Result<std::vector<std::string>> names(const Template& segments) const;
  Result<std::int64_t> number(const XmlTag& tag, const char* key, std::int64_t otherwise) const;
  Error wrong(Code code, const std::string& what) const { return error_at_line(code, what, line_); }
  Template& current();

  std::vector<Rendition> out_;
  std::vector<Level> levels_;
  std::int64_t line_ = 0;
  double seconds_ = 0;
  int periods_ = 0;
  int sets_ = 0;
  bool set_has_one_ = false;  // representation
  std::string id_;            // of the representation
};

// The template that tags change: of the representation if we are in one, else of what is open.
Template& DashReader::current() {
  for (std::size_t i = levels_.size(); i-- > 0;) {
    if (holds_segments(levels_[i].element)) return levels_[i].segments;
  }
  return levels_.front().segments;
}

Result<std::int64_t> DashReader::number(const XmlTag& tag, const char* key,
                                        std::int64_t otherwise) const {
  const std::string* text = tag.find(key);
  if (text == nullptr) return otherwise;
  const std::optional<std::int64_t> value = whole_number(*text);
  constexpr std::int64_t kLargest = std::int64_t(1) << 53;
  if (value && *value >= -1 && *value <= kLargest) return *value;
  return wrong(Code::syntax, std::string(key) + " is not a number that can be used");
}

Result<void> DashReader::take_mpd(const XmlTag& tag) {
  const std::string* type = tag.find("type");
  if (type != nullptr && *type != "static") {
    return wrong(Code::unsupported, "this describes a live presentation; give a finished one");
  }
  if (const std::string* length = tag.find("mediaPresentationDuration")) {
    seconds_ = period_seconds(*length).value_or(0);
  }
  return {};
}

Result<void> DashReader::take_template(const XmlTag& tag) {
  Template& segments = current();
  segments.times.clear();
  segments.list.clear();
  const std::string* init = tag.find("initialization");
  if (init != nullptr) segments.initialization = *init;
  if (const std::string* media = tag.find("media")) segments.media = *media;
  const auto number_of_first = number(tag, "startNumber", segments.number);
  const auto timescale = number(tag, "timescale", segments.timescale);
  const auto duration = number(tag, "duration", segments.duration);
  if (!number_of_first) return number_of_first.error();
  if (!timescale) return timescale.error();
  if (!duration) return duration.error();
  if (*timescale <= 0) return wrong(Code::syntax, "the time scale must be positive");
  segments.number = *number_of_first;
  segments.timescale = *timescale;
  segments.duration = *duration;
  return {};
}

Result<void> DashReader::take_time(const XmlTag& tag) {
  std::vector<std::int64_t>& times = current().times;
  Template& segments = current();
  // `duration` keeps the length of the last entry, so that the next one finds its time.
  const std::int64_t expected = times.empty() ? 0 : times.back() + segments.duration;
  const auto time = number(tag, "t", expected);
  const auto duration = number(tag, "d", 0);
  const auto repeat = number(tag, "r", 0);
  if (!time) return time.error();
  if (!duration) return duration.error();
  if (!repeat) return repeat.error();
  if (*duration <= 0) return wrong(Code::syntax, "a segment needs a duration");
  if (*repeat < 0) return wrong(Code::unsupported, "segments without a count are not read");
  if (std::uint64_t(*repeat) + times.size() >= kMostSegments) {
    return wrong(Code::out_of_range, "the description is too long");
  }
  segments.duration = *duration;
  for (std::int64_t i = 0; i <= *repeat; ++i) times.push_back(*time + i * *duration);
  return {};
}

Result<std::vector<std::string>> DashReader::names(const Template& segments) const {
  if (!segments.list.empty()) return segments.list;
  if (segments.media.empty()) {
    return wrong(Code::unsupported, "a representation is not in segments; give its file instead");
  }
  std::vector<std::int64_t> times = segments.times;
  if (times.empty() && segments.duration > 0) {
    const double count =
        std::ceil(seconds_ * double(segments.timescale) / double(segments.duration));
    if (!(count >= 1 && count <= double(kMostSegments))) {
      return wrong(Code::unsupported, "the number of segments is not stated");
    }
    for (std::int64_t i = 0; i < std::int64_t(count); ++i) times.push_back(i * segments.duration);
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < times.size(); ++i) {
    auto name = fill_in(segments.media, segments.number + std::int64_t(i), times[i], id_);
    if (!name) return wrong(Code::unsupported, "this segment template is not known");
    names.push_back(std::move(*name));
  }
  return names;
}

Result<void> DashReader::finish_representation() {
  if (set_has_one_) return {};
  set_has_one_ = true;
  const Level& level = levels_.back();
  Result<std::vector<std::string>> segments = names(level.segments);
  if (!segments) return segments.error();
  const auto init = fill_in(level.segments.initialization, 0, 0, id_);
  if (!init) return wrong(Code::unsupported, "this segment template is not known");
  Rendition rendition;
  if (!init->empty()) rendition.init = level.base + *init;
  for (const std::string& name : *segments) rendition.segments.push_back(level.base + name);
  if (!rendition.segments.empty()) out_.push_back(std::move(rendition));
  return {};
}

Result<void> DashReader::open(const XmlTag& tag) {
  const std::string& name = tag.name;
  if (levels_.empty() && name != "MPD") {
    return wrong(Code::syntax, "a DASH description begins with MPD");
  }
  Level level;
  level.element = name;
  if (!levels_.empty()) level.base = levels_.back().base;
  // Of several representations only the first is read.
  if (holds_segments(name) && !levels_.empty() && !(name == "Representation" && set_has_one_)) {
    level.segments = current();
  }
  levels_.push_back(std::move(level));
  if (name == "MPD") return take_mpd(tag);
  if (name == "Period" && ++periods_ > 1) {
    return wrong(Code::unsupported, "several periods are not read");
  }
  if (name == "AdaptationSet") {
    set_has_one_ = false;
    if (++sets_ > kMostSets) return wrong(Code::out_of_range, "too many adaptation sets");
  }
  if (name == "Representation") {
    const std::string* id = tag.find("id");
    id_ = id == nullptr ? "" : *id;
  }
  if (name == "BaseURL") {
    // Holds for the element around it and all in it.
    std::string& base = levels_[levels_.size() >= 2 ? levels_.size() - 2 : 0].base;
    base += tag.text.substr(0, tag.text.rfind('/') + 1);
    if (base.size() > kLongestName) return wrong(Code::out_of_range, "a name is too long");
  }
  if (name == "SegmentTemplate" || name == "SegmentList") return take_template(tag);
  if (name == "S") return take_time(tag);
  if (name == "Initialization" && tag.find("sourceURL") != nullptr) {
    if (tag.find("range") != nullptr) return wrong(Code::unsupported, "byte ranges are not read");
    current().initialization = *tag.find("sourceURL");
  }
  if (name == "SegmentURL") {
    const std::string* media = tag.find("media");
    if (media == nullptr || tag.find("mediaRange") != nullptr) {
      return wrong(Code::unsupported, "byte ranges are not read");
    }
    if (current().list.size() >= kMostSegments) {
      return wrong(Code::out_of_range, "the description is too long");
    }
    current().list.push_back(*media);
  }
  return {};
}

Result<void> DashReader::close(const std::string& name) {
  if (levels_.empty() || levels_.back().element != name) {
    return wrong(Code::syntax, "the tags do not match");
  }
  if (name == "Representation") {
    if (auto done = finish_representation(); !done) return done;
  }
  levels_.pop_back();
  return {};
}

Result<std::vector<Rendition>> DashReader::read(std::string_view text) {
  constexpr std::size_t kDeepest = 32;
  Result<std::vector<XmlTag>> tags = read_tags(text);
  if (!tags) return tags.error();
  for (const XmlTag& tag : *tags) {
    line_ = tag.line;
    if (levels_.size() > kDeepest) return wrong(Code::syntax, "the tags are nested too deeply");
    Result<void> done;
    if (tag.begins) done = open(tag);
    if (done && tag.ends) done = close(tag.name);
    if (!done) return done.error();
  }
  if (!levels_.empty()) return wrong(Code::truncated, "the description ends too early");
  if (out_.empty()) return make_error(Code::truncated, "the description names no segments");
  return std::move(out_);
}

}  // namespace

Result<std::vector<Rendition>> read_dash(std::string_view text) { return DashReader().read(text); }

}  // namespace animeme::media
