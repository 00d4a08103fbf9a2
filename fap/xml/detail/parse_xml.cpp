// All calls of libxml2. An object of its own: the program has tools/app/late/xml_late.cpp instead.
#include "fap/xml/detail/document.h"

#include <libxml/SAX2.h>
#include <libxml/parser.h>
#include <libxml/parserInternals.h>

#include <cstring>
#include <optional>

namespace animeme::head::detail {
namespace {

constexpr std::size_t kMostBytes = 200'000'000;
constexpr std::size_t kMostElements = 1'000'000;
constexpr std::size_t kDeepest = 100;
constexpr std::size_t kMostAttributes = 1000;  // of one element

std::string_view view(const xmlChar* text) {
  return text == nullptr ? std::string_view() : reinterpret_cast<const char*>(text);
}

std::string one_line(const char* message) {
  std::string text = message == nullptr ? "the XML is not well formed" : message;
  for (char& c : text) {
    if (c == '\n' || c == '\r' || c == '\t') c = ' ';
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

// Collects elements while libxml2 reads. The callbacks of libxml2 get it as their user data.
class Builder {
 public:
  xmlParserCtxtPtr context = nullptr;
  std::optional<Error> error;
  XmlElement root;  // holds the document element as its child

  Builder() { open_.push_back(&root); }

  void fail(Code code, std::string message) {
    if (!error) error = error_at_line(code, std::move(message), line());
    xmlStopParser(context);
  }

  void begin(std::string_view name, int count, const xmlChar** attributes) {
    if (error) return;
    if (open_.size() > kDeepest) return fail(Code::out_of_range, "more than 100 levels of XML");
    if (++elements_ > kMostElements) {
      return fail(Code::out_of_range, "more than a million XML elements");
    }
    // Children of an element move only while none of them is open.
    XmlElement& element = open_.back()->children.emplace_back();
    element.name = name;
    element.line = line();
    for (int i = 0; i < count; ++i) {
      const xmlChar** a = attributes + 5 * i;  // name, prefix, URI, begin, end of the value
      std::string value(reinterpret_cast<const char*>(a[3]), a[4] - a[3]);
      // As long as libxml2 replaces no entities, it leaves each & of an attribute written so.
      for (std::size_t at = value.find("&#38;"); at != std::string::npos;
           at = value.find("&#38;", at + 1)) {
        value.erase(at + 1, 4);
      }
      element.attributes.push_back({std::string(view(a[0])), std::move(value)});
    }
    open_.push_back(&element);
  }
  void end() {
    if (!error && open_.size() > 1) open_.pop_back();
  }
  void add(const xmlChar* text, int size) {
    if (!error) open_.back()->text.append(reinterpret_cast<const char*>(text), std::size_t(size));
  }

 private:
  std::int64_t line() const { return context->input == nullptr ? 0 : context->input->line; }

  std::vector<XmlElement*> open_;
  std::size_t elements_ = 0;
};

Builder& builder(void* user) { return *static_cast<Builder*>(user); }

void on_begin(void* user, const xmlChar* name, const xmlChar*, const xmlChar*, int, const xmlChar**,
              int count, int, const xmlChar** attributes) {
  builder(user).begin(view(name), count, attributes);
}
void on_end(void* user, const xmlChar*, const xmlChar*, const xmlChar*) { builder(user).end(); }
void on_text(void* user, const xmlChar* text, int size) { builder(user).add(text, size); }

// Called once the parser is within "[...]" of a document type.
void on_entity(void* user, const xmlChar*, int, const xmlChar*, const xmlChar*, xmlChar*) {
  builder(user).fail(Code::unsupported,
                     "the document type declares entities, which are not read; remove <!DOCTYPE>");
}

void on_error(void* user, xmlErrorPtr found) {
  Builder& b = builder(user);
  if (b.error || found == nullptr || found->level < XML_ERR_ERROR) return;
  const bool encoding = found->code == XML_ERR_UNSUPPORTED_ENCODING;
  b.error = error_at_line(encoding ? Code::unsupported : Code::syntax, one_line(found->message),
                          found->line, std::max(found->int2, 0));
}

xmlSAXHandler handler() {
  xmlSAXHandler sax;
  std::memset(&sax, 0, sizeof sax);
  sax.initialized = XML_SAX2_MAGIC;
  sax.startElementNs = on_begin;
  sax.endElementNs = on_end;
  sax.characters = on_text;
  sax.cdataBlock = on_text;
  sax.ignorableWhitespace = on_text;
  sax.entityDecl = on_entity;
  sax.serror = on_error;
  return sax;
}

// libxml2 compares each attribute of an element with all others, so their number is bounded before
// it sees them. Line of the first tag with too many; 0: there is none.
std::int64_t crowded_tag(std::string_view text) {
  std::int64_t line = 1;
  std::size_t attributes = 0;
  char quote = 0;
  bool in_tag = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    line += c == '\n' ? 1 : 0;
    if (!in_tag) {
      // Comments and CDATA begin so; what is in them is no tag.
      in_tag = c == '<' && text.substr(i, 2) != "<!";
      attributes = 0;
    } else if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
      if (++attributes > kMostAttributes) return line;
    } else if (c == '>') {
      in_tag = false;
    }
  }
  return 0;
}

struct FreeContext {
  void operator()(xmlParserCtxtPtr context) const {
    if (context->myDoc != nullptr) xmlFreeDoc(context->myDoc);
    xmlFreeParserCtxt(context);
  }
};

}  // namespace

Result<XmlElement> parse_xml(std::string_view text) {
  if (text.size() > kMostBytes) {
    return make_error(Code::out_of_range, "the XML has more than 200 MB");
  }
  if (text.empty()) return error_at_line(Code::syntax, "the file is empty", 1);
  if (const std::int64_t line = crowded_tag(text); line > 0) {
    return error_at_line(Code::out_of_range, "an element has more than 1000 attributes", line);
  }
  xmlInitParser();
  const std::unique_ptr<xmlParserCtxt, FreeContext> context(
      xmlCreateMemoryParserCtxt(text.data(), int(text.size())));
  if (context == nullptr) return make_error(Code::internal, "libxml2 cannot start");
  Builder b;
  b.context = context.get();
  *context->sax = handler();
  context->userData = &b;
  // No network, and lists of numbers may be longer than 10 MB.
  xmlCtxtUseOptions(context.get(), XML_PARSE_NONET | XML_PARSE_HUGE);
  xmlParseDocument(context.get());
  if (b.error) return *b.error;
  if (context->wellFormed == 0 || b.root.children.size() != 1) {
    return error_at_line(Code::syntax, "the XML is not well formed", 1);
  }
  return std::move(b.root.children.front());
}

}  // namespace animeme::head::detail
