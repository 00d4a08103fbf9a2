// Captions in XML: TTML, DFXP and their relatives. Their paragraphs and spans are plain enough to
// be found without a parser of XML, which dam does without.
#include <algorithm>
#include <cmath>

#include "dam/script/script_cues_internal.h"
#include "dam/script/script_readers_internal.h"
#include "dam/script/table_text_internal.h"

namespace animeme::dam {
namespace {

struct TtmlRates {
  double frames = 30, ticks = 1;
};

// The name of a tag without its namespace: "p" of "tt:p begin=...".
std::string_view tag_name(std::string_view tag) {
  std::string_view name = tag.substr(0, tag.find_first_of(" \t\r\n/", 1));
  const std::size_t colon = name.find(':');
  if (colon == std::string_view::npos) return name;
  const bool end = name.starts_with('/');
  return end ? name : name.substr(colon + 1);
}

// The value of an attribute, whatever its namespace and its quotes.
std::string_view attribute_of(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    std::string_view rest = tag.substr(at + name.size());
    const char before = at > 0 ? tag[at - 1] : ' ';
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r\n"), rest.size()));
    if ((before != ' ' && before != ':' && before != '\n' && before != '\t') ||
        !rest.starts_with('=')) {
      continue;
    }
    rest.remove_prefix(std::min(rest.find_first_of("\"'"), rest.size()));
    if (rest.empty()) return {};
    return rest.substr(1, rest.find(rest[0], 1) - 1);
  }
  return {};
}

// "00:00:01.5", "00:00:01:12" with frames, "1.5s", "1500ms", "36f", "15000000t", "1.5".
std::optional<double> ttml_time(std::string_view text, const TtmlRates& rates) {
  const std::size_t colons = std::size_t(std::count(text.begin(), text.end(), ':'));
  if (colons == 3) {
    const std::size_t last = text.rfind(':');
    const auto clock = parse_clock(text.substr(0, last));
    const auto frames = parse_number(text.substr(last + 1));
    if (!clock || !frames || !(*frames >= 0)) return std::nullopt;
    return *clock + *frames / rates.frames;
  }
  if (colons > 0) return parse_clock(text);
  const std::size_t unit = std::min(text.find_first_not_of("0123456789."), text.size());
  const auto number = parse_number(text.substr(0, unit));
  const std::string_view name = text.substr(unit);
  if (!number || !(*number >= 0) || !(*number < 1e15)) return std::nullopt;
  if (name == "ms") return *number / 1000;
  if (name == "f") return *number / rates.frames;
  if (name == "t") return *number / rates.ticks;
  if (name == "m") return *number * 60;
  if (name == "h") return *number * 3600;
  return name.empty() || name == "s" ? number : std::nullopt;
}

double rate_of(std::string_view tag, std::string_view name, double usual) {
  const auto rate = parse_number(attribute_of(tag, name));
  return rate && *rate > 0 && std::isfinite(*rate) ? *rate : usual;
}

// White space of XML is one blank.
void append_text(std::string& out, std::string_view text) {
  for (const char c : without_references(text)) {
    const bool blank = c == ' ' || c == '\n' || c == '\r' || c == '\t';
    if (!blank) out += c;
    if (blank && !out.empty() && out.back() != ' ') out += ' ';
  }
}

// Reads paragraphs one tag after the other.
class TtmlReader {
 public:
  explicit TtmlReader(std::string_view text) : text_(text), rest_(text) {}

  Result<std::vector<Cue>> read() {
    while (!rest_.empty()) {
      const std::size_t open = std::min(rest_.find('<'), rest_.size());
      if (inside_) append_text(cues_.back().lines.back().back().text, rest_.substr(0, open));
      take(open);
      if (rest_.empty()) break;
      const bool comment = rest_.starts_with("<!--");
      const std::size_t close = rest_.find(comment ? "-->" : ">");
      if (close == std::string_view::npos) {
        return error_at_line(Code::truncated, "the tag that begins here does not end", line_);
      }
      const std::string_view tag = rest_.substr(1, close - 1);
      if (!comment && !begin(tag)) {
        return error_at_line(Code::syntax, "a paragraph needs the times begin and end, or dur",
                             line_);
      }
      take(close + (comment ? 3 : 1));
    }
    return std::move(cues_);
  }

 private:
  void take(std::size_t count) {
    line_ += std::count(rest_.begin(), rest_.begin() + std::ptrdiff_t(count), '\n');
    rest_.remove_prefix(count);
  }

  void add_piece(std::optional<double> start) {
    cues_.back().lines.back().push_back({{}, start, line_, 1, false, speaker_});
  }

  // False: a paragraph whose times cannot be read.
  bool begin(std::string_view tag) {
    const std::string_view name = tag_name(tag);
    if (name == "tt") {
      rates_ = {rate_of(tag, "frameRate", 30), rate_of(tag, "tickRate", 1)};
    } else if (name == "p") {
      const auto start = ttml_time(attribute_of(tag, "begin"), rates_);
      auto end = ttml_time(attribute_of(tag, "end"), rates_);
      const auto length = ttml_time(attribute_of(tag, "dur"), rates_);
      if (start && length && !end) end = *start + *length;
      if (!start || !end) return false;
      speaker_ = attribute_of(tag, "agent");
      cues_.push_back({*start, *end, line_, {{}}});
      add_piece(std::nullopt);
      inside_ = !tag.ends_with('/');
    } else if (name.starts_with('/') && (name == "/p" || name.ends_with(":p"))) {
      inside_ = false;
    } else if (inside_ && name == "br") {
      cues_.back().lines.emplace_back();
      add_piece(std::nullopt);
    } else if (inside_ && name == "span") {
      // Times of spans count from the paragraph; some programs write those of the file.
      const Cue& cue = cues_.back();
      auto start = ttml_time(attribute_of(tag, "begin"), rates_);
      if (start && (*start < cue.start || *start + cue.start < cue.end)) *start += cue.start;
      if (start) add_piece(start);
    }
    return true;
  }

  std::string_view text_, rest_;
  std::vector<Cue> cues_;
  TtmlRates rates_;
  std::string speaker_;
  std::int64_t line_ = 1;
  bool inside_ = false;
};

}  // namespace

bool looks_like_ttml(std::string_view text) {
  const std::string_view head = text.substr(0, 4096);
  return text.starts_with('<') && (head.find("<tt ") != std::string_view::npos ||
                                   head.find("<tt:tt") != std::string_view::npos ||
                                   head.find("<tt>") != std::string_view::npos);
}

Result<Timings> read_ttml(std::string_view text, const ScriptOptions& options) {
  auto cues = TtmlReader(text).read();
  if (!cues) return cues.error();
  Timings timings;
  add_words_of_cues(std::move(*cues), options, timings);
  return timings;
}

}  // namespace animeme::dam
