#include "tools/formats/scripts/script_text.h"

#include <algorithm>
#include <vector>

#include "dam/script/script_cues_internal.h"
#include "dam/script/script_text_internal.h"
#include "dam/script/script_values_internal.h"
#include "tools/formats/scripts/detail/json_script.h"

namespace animeme::scripts {

namespace {

// The first that recognises a text reads it: those with members of their own before lists of words.
const std::vector<JsonFormat>& json_formats() {
  static const std::vector<JsonFormat> all = [] {
    std::vector<JsonFormat> list;
    for (const auto part : {array_formats(), event_formats(), aligner_formats(), word_formats()}) {
      list.insert(list.end(), part.begin(), part.end());
    }
    return list;
  }();
  return all;
}

std::vector<dam::ScriptFormat> all_formats() {
  const auto text = dam::text_script_formats();
  std::vector<dam::ScriptFormat> all(text.begin(), text.end());
  for (const JsonFormat& format : json_formats()) {
    const bool known = std::any_of(all.begin(), all.end(), [&](const dam::ScriptFormat& other) {
      return other.name == format.shown.name;
    });
    if (!known) all.push_back(format.shown);
  }
  return all;
}

struct Documents {
  std::vector<Json> values;
  std::vector<std::size_t> offsets;

  std::vector<Node> roots() const {
    std::vector<Node> nodes;
    for (std::size_t i = 0; i < values.size(); ++i)
      nodes.push_back({&values[i], std::to_string(i)});
    return nodes;
  }
};

// One value, or one a line.
Result<Documents> parse_documents(std::string_view text) {
  Documents documents;
  Result<Json> whole = Json::parse(text, {.sorted = true});
  if (whole) {
    documents.values.push_back(std::move(*whole));
    documents.offsets.push_back(0);
    return documents;
  }
  dam::LineReader reader(text);
  dam::Line line;
  while (reader.next(line)) {
    if (dam::trimmed(line.text).empty()) continue;
    Result<Json> one = Json::parse(line.text, {.sorted = true});
    if (!one) {
      return error_at_line(Code::syntax,
                           documents.values.empty()
                               ? "this begins like JSON but is invalid; is the file complete?"
                               : "this line is no JSON, as those before it are",
                           line.number);
    }
    documents.values.push_back(std::move(*one));
    documents.offsets.push_back(std::size_t(line.text.data() - text.data()));
  }
  return documents;
}

// Lyrics begin with a bracket, too, and so do marks and X-SAMPA's vowel of "cat".
bool may_be_json(std::string_view text) {
  if (!text.starts_with('{') && !text.starts_with('[')) return false;
  const std::size_t next = text.find_first_not_of(" \t\r\n", 1);
  if (next == std::string_view::npos) return true;
  constexpr std::string_view kInObject = "\"}", kInArray = "[{]\"-0123456789";
  const std::string_view allowed = text[0] == '{' ? kInObject : kInArray;
  const std::size_t close = std::min(text.find(']'), text.size());
  return allowed.find(text[next]) != std::string_view::npos &&
         !dam::parse_clock(text.substr(1, close - 1));
}

Result<const JsonFormat*> choose_format(const std::vector<Node>& roots, std::string_view name) {
  const JsonFormat* named = nullptr;
  std::string names;
  for (const JsonFormat& format : json_formats()) {
    if (names.find(format.shown.name) == std::string::npos) {
      names += (names.empty() ? "" : ", ") + std::string(format.shown.name);
    }
    if (!name.empty() && format.shown.name != name) continue;
    if (named == nullptr) named = &format;
    if (format.looks_like(roots)) return &format;
  }
  if (!name.empty() && named != nullptr) return named;
  if (!name.empty()) {
    return make_error(Code::invalid_argument, "this is JSON, but not a script of the format " +
                                                  dam::in_quotes(name) +
                                                  "; of JSON, these are read: " + names);
  }
  return error_at_line(
      Code::syntax, "this JSON is not a script of a known format; supported JSON formats: " + names,
      1);
}

Result<dam::Timings> read_json(std::string_view text, const dam::ScriptOptions& options) {
  const auto documents = parse_documents(text);
  if (!documents) return documents.error();
  const std::vector<Node> roots = documents->roots();
  const auto format = choose_format(roots, options.format);
  if (!format) return format.error();
  JsonLabels out;
  auto done = (*format)->read(roots, options, out);
  drop_unspoken(out.labels);
  if (!done) {
    Error error = done.error();
    place_labels(text, documents->offsets, out, &error);
    return error;
  }
  place_labels(text, documents->offsets, out, nullptr);
  dam::Timings timings{(*format)->shown.name, out.alphabet, std::move(out.labels),
                       std::move(out.notes)};
  if (options.alphabet != dam::Alphabet::automatic) timings.alphabet = options.alphabet;
  if (auto kept = dam::finish_labels(timings, options, (*format)->unit); !kept) return kept.error();
  return timings;
}

}  // namespace

std::span<const dam::ScriptFormat> script_formats() {
  static const std::vector<dam::ScriptFormat> all = all_formats();
  return all;
}

Result<dam::Timings> read_labels(std::string_view text, const dam::ScriptOptions& options) {
  if (!options.format.empty()) {
    const auto formats = script_formats();
    const bool known = std::any_of(formats.begin(), formats.end(), [&](const auto& format) {
      return format.name == options.format;
    });
    if (!known) {
      std::string names;
      for (const auto& format : formats) names += " " + std::string(format.name);
      return make_error(Code::invalid_argument, "there is no script format named " +
                                                    dam::in_quotes(options.format) +
                                                    "; these are:" + names);
    }
  }
  dam::OddBytes odd;
  const std::string utf8 = dam::to_utf8(text, &odd);
  const std::size_t first = utf8.find_first_not_of(" \t\r\n");
  if (!may_be_json(std::string_view(utf8).substr(std::min(first, utf8.size()))))
    return dam::read_timings(text, options);
  auto timings = read_json(utf8, options);
  if (timings) dam::note_odd_bytes(timings->notes, odd);
  return timings;
}

}  // namespace animeme::scripts
