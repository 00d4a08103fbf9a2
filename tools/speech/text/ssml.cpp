#include "tools/speech/text/ssml.h"

#include <expat.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <memory>
#include <set>

#include "dam/script/ipa.h"
#include "dam/script/script_text_internal.h"
#include "tools/speech/text/spoken_text.h"
#include "tools/speech/text/ssml_values.h"

namespace animeme::text {
namespace {

// What emphasis does to the intensity of a mood.
double emphasised(std::string_view level) {
  if (level == "strong") return 1.3;
  if (level == "reduced") return 0.7;
  return level == "none" ? 1 : 1.15;
}

// Azure's styledegree, 0.01 to 2, and Amazon's words for the same.
std::optional<double> degree_of(std::string_view text) {
  if (text.empty() || text == "medium") return 1;
  if (text == "low") return 0.6;
  if (text == "high") return 1.4;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !(value >= 0))
    return std::nullopt;
  return std::min(value, 2.0);
}

constexpr double kSentencePause = 0.2, kParagraphPause = 0.5;  // seconds

struct ExpatCloser {
  void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
};

using Attributes = std::map<std::string, std::string, std::less<>>;

// What the elements around a text say of it.
struct Frame {
  Item item;            // kind text, without text
  double pause = 0;     // behind it
  bool silent = false;  // its text is not spoken
};

class SsmlReader {
 public:
  explicit SsmlReader(XML_Parser parser) : parser_(parser) { frames_.emplace_back(); }

  void open(std::string_view name, const Attributes& attributes) {
    if (frames_.size() > std::size_t(kMostDepth)) return fail("elements are nested too deeply");
    if (frames_.size() == 1 && name != "speak") {
      return fail("an SSML document begins with <speak>, not with <" + std::string(name) + ">");
    }
    Frame frame = frames_.back();
    frame.pause = 0;
    if (const auto lang = attributes.find("xml:lang"); lang != attributes.end()) {
      frame.item.manner.language = lang->second;
      frame.item.manner.voice.clear();
    }
    read(name, attributes, frame);
    frames_.push_back(std::move(frame));
  }

  void close() {
    const double seconds = frames_.back().pause;
    frames_.pop_back();
    if (seconds > 0) pause(seconds, false);
  }

  void characters(std::string_view text) {
    const Frame& frame = frames_.back();
    if (frame.silent) return;
    std::u32string more = code_points(text);
    std::vector<Item>& items = document.items;
    // expat gives long texts, and those with entities, in parts.
    if (!items.empty() && continued_ == frames_.size()) {
      items.back().text += more;
      return;
    }
    Item item = frame.item;
    item.text = std::move(more);
    items.push_back(std::move(item));
    continued_ = frames_.size();
  }

  void end_text() { continued_ = 0; }

  void fail(const std::string& why) {
    if (!failure.empty()) return;
    failure = why;
    line = std::int64_t(XML_GetCurrentLineNumber(parser_));
    column = std::int64_t(XML_GetCurrentColumnNumber(parser_)) + 1;
    XML_StopParser(parser_, XML_FALSE);
  }

  Document document;
  std::string failure;  // empty: none
  std::int64_t line = 0, column = 0;

 private:
  void warn(const std::string& text) {
    if (warned_.insert(text).second) document.warnings.push_back(text);
  }

  void pause(double seconds, bool is_break) {
    Item item;
    item.kind = ItemKind::pause;
    item.seconds = seconds;
    item.is_break = is_break;
    item.manner = frames_.back().item.manner;
    document.items.push_back(std::move(item));
  }

  static std::string value(const Attributes& attributes, std::string_view name) {
    const auto at = attributes.find(name);
    return at == attributes.end() ? std::string() : std::string(dam::trimmed(at->second));
  }

  template <class Read>
  void number(const Attributes& attributes, std::string_view name, Read read_value, int& out) {
    const std::string text = value(attributes, name);
    if (text.empty()) return;
    if (const std::optional<int> percent = read_value(text, out)) {
      out = *percent;
    } else {
      warn("<prosody " + std::string(name) + "=\"" + text + "\"> is not known, and left out");
    }
  }

  void read(std::string_view name, const Attributes& attributes, Frame& frame) {
    Item& item = frame.item;
    if (name == "speak" || name == "lang" || name == "w" || name == "token") return;
    if (name == "p" || name == "paragraph") {
      frame.pause = kParagraphPause;
    } else if (name == "s" || name == "sentence") {
      frame.pause = kSentencePause;
    } else if (name == "break") {
      read_break(attributes);
    } else if (name == "mark") {
      Item mark;
      mark.kind = ItemKind::mark;
      mark.name = value(attributes, "name");
      mark.manner = item.manner;
      document.items.push_back(std::move(mark));
    } else if (name == "prosody") {
      number(attributes, "rate", rate_of, item.manner.rate);
      number(attributes, "pitch", pitch_of, item.manner.pitch);
      number(attributes, "range", pitch_of, item.manner.range);
      number(attributes, "volume", volume_of, item.manner.volume);
      for (const char* other : {"contour", "duration"}) {
        if (attributes.contains(other)) {
          warn("<prosody " + std::string(other) + "> is not followed");
        }
      }
    } else if (name == "emphasis") {
      const std::string level = value(attributes, "level");
      if (!emphasise(level, item.manner)) warn("<emphasis level=\"" + level + "\"> is not known");
      item.mood_gain = std::min(item.mood_gain * emphasised(level), 2.0);
    } else if (name.ends_with(":express-as")) {
      read_mood(name, attributes, "style", "styledegree", item);
    } else if (name == "amazon:emotion") {
      read_mood(name, attributes, "name", "intensity", item);
    } else if (name == "google:style") {
      read_mood(name, attributes, "name", "", item);
    } else if (name == "voice") {
      read_voice(attributes, item.manner);
    } else if (name == "sub") {
      item.alias = code_points(value(attributes, "alias"));
    } else if (name == "phoneme") {
      const std::string alphabet = value(attributes, "alphabet");
      const std::string known = dam::lower_case(alphabet);
      if (known == "ipa" || alphabet.empty()) {
        item.ipa = value(attributes, "ph");
      } else if (known == "x-sampa" || known == "sampa") {
        item.ipa = dam::x_sampa_to_ipa(value(attributes, "ph"));
      } else {
        warn("<phoneme alphabet=\"" + alphabet + "\"> is not known, its text is spoken");
      }
    } else if (name == "say-as") {
      const std::string how = value(attributes, "interpret-as");
      const auto known = say_as_of(how);
      if (!known) warn("<say-as interpret-as=\"" + how + "\"> is not known, its text is read");
      item.say_as = known.value_or(SayAs::words);
      item.format = dam::lower_case(value(attributes, "format"));
    } else if (name == "metadata" || name == "meta" || name == "desc") {
      frame.silent = true;
    } else if (name == "audio") {
      warn("<audio> is not played, its text is spoken");
    } else {
      warn("<" + std::string(name) + "> is not known, its text is spoken");
    }
  }

  void read_break(const Attributes& attributes) {
    const std::string time = value(attributes, "time"), strength = value(attributes, "strength");
    const auto seconds = !time.empty()      ? seconds_of(time)
                         : strength.empty() ? break_strength("medium")
                                            : break_strength(strength);
    if (!seconds) warn("<break> with \"" + (time.empty() ? strength : time) + "\" is not known");
    if (seconds && *seconds > 0) pause(*seconds, true);
  }

  void read_mood(std::string_view element, const Attributes& attributes, std::string_view style,
                 std::string_view degree, Item& item) {
    const std::string name = value(attributes, style), number = value(attributes, degree);
    const std::string what = "<" + std::string(element) + " ";
    const auto factor = degree_of(number);
    if (!factor) warn(what + std::string(degree) + "=\"" + number + "\"> is not known");
    auto mood = dam::make_mood(name, factor.value_or(1));
    if (mood) {
      item.mood = std::move(*mood);
    } else {
      warn(what + std::string(style) + "=\"" + name + "\"> is no mood that the face has");
    }
  }

  void read_voice(const Attributes& attributes, Manner& manner) {
    const std::string name = value(attributes, "name"), gender = value(attributes, "gender"),
                      languages = value(attributes, "languages");
    if (!languages.empty()) manner.language = languages.substr(0, languages.find_first_of(" :"));
    if (!name.empty()) {
      manner.voice = name;
    } else if (gender == "female") {
      manner.voice = "f2";
    } else if (gender == "male") {
      manner.voice = "m1";
    } else if (!gender.empty() && gender != "neutral") {
      warn("<voice gender=\"" + gender + "\"> is not known");
    }
    for (const char* other : {"age", "variant", "required"}) {
      if (attributes.contains(other)) warn("<voice " + std::string(other) + "> is not followed");
    }
  }

  XML_Parser parser_;
  std::vector<Frame> frames_;
  std::size_t continued_ = 0;  // depth of the text that the next characters belong to; 0: none
  std::set<std::string> warned_;
};

SsmlReader& reader_of(void* user) { return *static_cast<SsmlReader*>(user); }

// Removes the prefix of the SSML namespace ("ssml:break"); other prefixes stay.
std::string_view local_name(std::string_view name) {
  return name.starts_with("ssml:") ? name.substr(5) : name;
}

void on_open(void* user, const XML_Char* name, const XML_Char** attributes) {
  Attributes all;
  for (; *attributes != nullptr; attributes += 2) all[attributes[0]] = attributes[1];
  reader_of(user).end_text();
  reader_of(user).open(local_name(name), all);
}

void on_close(void* user, const XML_Char*) {
  reader_of(user).end_text();
  reader_of(user).close();
}

void on_text(void* user, const XML_Char* text, int length) {
  reader_of(user).characters({text, std::size_t(length)});
}

void on_type(void* user, const XML_Char*, const XML_Char*, const XML_Char*, int inside) {
  if (inside != 0) reader_of(user).fail("a document that declares entities is not read");
}

}  // namespace

Result<Document> read_ssml(std::string_view text) {
  const std::unique_ptr<XML_ParserStruct, ExpatCloser> parser(XML_ParserCreate("UTF-8"));
  if (!parser) return make_error(Code::io, "no memory to read SSML");
  SsmlReader reader(parser.get());
  XML_SetUserData(parser.get(), &reader);
  XML_SetElementHandler(parser.get(), on_open, on_close);
  XML_SetCharacterDataHandler(parser.get(), on_text);
  XML_SetStartDoctypeDeclHandler(parser.get(), on_type);
  const XML_Status status = XML_Parse(parser.get(), text.data(), int(text.size()), XML_TRUE);
  if (!reader.failure.empty()) {
    return error_at_line(Code::syntax, reader.failure, reader.line, reader.column);
  }
  if (status != XML_STATUS_OK) {
    return error_at_line(Code::syntax,
                         std::string("this is no well-formed XML: ") +
                             XML_ErrorString(XML_GetErrorCode(parser.get())) +
                             "; close all elements, write & as &amp;",
                         std::int64_t(XML_GetCurrentLineNumber(parser.get())),
                         std::int64_t(XML_GetCurrentColumnNumber(parser.get())) + 1);
  }
  return std::move(reader.document);
}

}  // namespace animeme::text
