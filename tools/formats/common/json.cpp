#include "tools/formats/common/json.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

namespace animeme::tools {

struct Json::Object {
  std::vector<Member> members;
  bool sorted = false;

  /// Where `key` is, or would be added.
  std::size_t place_of(std::string_view key) const {
    if (sorted) {
      return std::size_t(std::partition_point(members.begin(), members.end(),
                                              [&](const Member& one) { return one.key < key; }) -
                         members.begin());
    }
    std::size_t at = 0;
    while (at < members.size() && members[at].key != key) ++at;
    return at;
  }
  bool is_at(std::size_t place, std::string_view key) const {
    return place < members.size() && members[place].key == key;
  }
  Json& member(std::string_view key) {
    const std::size_t place = place_of(key);
    if (!is_at(place, key)) {
      members.insert(members.begin() + std::ptrdiff_t(place), Member{std::string(key), {}});
    }
    return members[place].value;
  }
  void sort() {
    sorted = true;
    std::sort(members.begin(), members.end(),
              [](const Member& a, const Member& b) { return a.key < b.key; });
  }
};

namespace {

[[noreturn]] void wrong_kind(const char* wanted) {
  throw std::runtime_error(std::string("a JSON value is no ") + wanted);
}

const Json& nothing() {
  static const Json null;
  return null;
}

}  // namespace

Json::Json(bool value) noexcept : kind_(Kind::boolean) { payload_.boolean = value; }
Json::Json(long long value) noexcept : kind_(Kind::integer) { payload_.integer = value; }
Json::Json(unsigned long long value) noexcept : kind_(Kind::natural) { payload_.natural = value; }
Json::Json(double value) noexcept : kind_(Kind::real) { payload_.real = value; }
Json::Json(const char* text) : Json(std::string(text)) {}
Json::Json(std::string_view text) : Json(std::string(text)) {}
Json::Json(std::string text) {
  payload_.text = new std::string(std::move(text));
  kind_ = Kind::text;
}

Json::Json(std::initializer_list<Json> list) {
  const bool pairs = std::all_of(list.begin(), list.end(), [](const Json& one) {
    return one.is_array() && one.size() == 2 && one.front().is_string();
  });
  if (!pairs) {
    *this = array(list);
    return;
  }
  Object& object = make_object();
  object.members.reserve(list.size());
  for (const Json& one : list) {
    std::vector<Json>& pair = *one.payload_.array;
    const std::string& key = pair[0].text();
    if (object.is_at(object.place_of(key), key)) continue;
    object.members.push_back({std::move(*pair[0].payload_.text), std::move(pair[1])});
  }
}

Json Json::array(std::initializer_list<Json> list) {
  Json json;
  json.payload_.array = new std::vector<Json>(list.size());
  json.kind_ = Kind::array;
  std::size_t at = 0;
  for (const Json& one : list) {
    Json& entry = json[at++];
    entry.payload_ = one.payload_;
    entry.kind_ = std::exchange(one.kind_, Kind::null);
  }
  return json;
}

Json Json::object() {
  Json json;
  json.make_object();
  return json;
}

Json::Json(const Json& other) : payload_(other.payload_) {
  if (other.kind_ == Kind::text) payload_.text = new std::string(*payload_.text);
  if (other.kind_ == Kind::array) payload_.array = new std::vector<Json>(*payload_.array);
  if (other.kind_ == Kind::object) payload_.object = new Object(*payload_.object);
  kind_ = other.kind_;
}

Json& Json::operator=(Json other) noexcept {
  std::swap(kind_, other.kind_);
  std::swap(payload_, other.payload_);
  return *this;
}

Json::~Json() {
  if (kind_ == Kind::text) delete payload_.text;
  if (!is_structured()) return;
  // Text from outside may be nested deeper than the stack is: containers inside go one by one.
  std::vector<Json> waiting;
  const auto take_from = [&waiting](Json& json) {
    const auto take = [&waiting](Json& inside) {
      if (inside.is_structured() && !inside.empty()) waiting.push_back(std::move(inside));
    };
    for (Json& one : json) take(one);
    if (!json.is_object()) return;
    for (Member& one : json.payload_.object->members) take(one.value);
  };
  take_from(*this);
  while (!waiting.empty()) {
    Json one = std::move(waiting.back());
    waiting.pop_back();
    take_from(one);
  }
  if (is_array()) delete payload_.array;
  if (is_object()) delete payload_.object;
}

bool Json::is_number_unsigned() const {
  return kind_ == Kind::natural || (kind_ == Kind::integer && payload_.integer >= 0);
}

template <>
bool Json::get() const {
  if (!is_boolean()) wrong_kind("bool");
  return payload_.boolean;
}

template <>
double Json::get() const {
  if (!is_number()) wrong_kind("number");
  return kind_ == Kind::real      ? payload_.real
         : kind_ == Kind::natural ? double(payload_.natural)
                                  : double(payload_.integer);
}

template <>
long Json::get() const {
  if (!is_number()) wrong_kind("number");
  return kind_ == Kind::real ? long(payload_.real) : long(payload_.integer);
}

template <>
unsigned long Json::get() const {
  if (!is_number()) wrong_kind("number");
  return kind_ == Kind::real ? static_cast<unsigned long>(payload_.real) : payload_.natural;
}

template <>
int Json::get() const {
  return int(get<long>());
}

const std::string& Json::text() const {
  if (!is_string()) wrong_kind("text");
  return *payload_.text;
}

template <>
std::string Json::get() const {
  return text();
}

template <>
std::vector<std::string> Json::get() const {
  if (!is_array()) wrong_kind("array");
  std::vector<std::string> out;
  for (const Json& one : *this) out.push_back(one.text());
  return out;
}

std::size_t Json::size() const {
  if (is_array()) return payload_.array->size();
  if (is_object()) return payload_.object->members.size();
  return is_null() ? 0 : 1;
}

Json::Object& Json::make_object() {
  if (is_null()) {
    payload_.object = new Object;
    kind_ = Kind::object;
  }
  if (!is_object()) wrong_kind("object");
  return *payload_.object;
}

Json& Json::operator[](std::string_view key) { return make_object().member(key); }

const Json& Json::operator[](std::string_view key) const {
  const Json* found = find(key);
  return found == nullptr ? nothing() : *found;
}

const Json* Json::find(std::string_view key) const {
  if (!is_object()) return nullptr;
  const Object& object = *payload_.object;
  const std::size_t place = object.place_of(key);
  return object.is_at(place, key) ? &object.members[place].value : nullptr;
}

std::span<const Json::Member> Json::items() const {
  if (!is_object()) return {};
  return payload_.object->members;
}

Json Json::erase(std::string_view key) {
  if (!contains(key)) return nullptr;
  auto& members = payload_.object->members;
  const auto found = members.begin() + std::ptrdiff_t(payload_.object->place_of(key));
  Json value = std::move(found->value);
  members.erase(found);
  return value;
}

void Json::update(const Json& object) {
  Object& own = make_object();
  for (const Member& one : object.items()) own.member(one.key) = one.value;
}

void Json::sort() {
  for (Json& one : *this) one.sort();
  if (!is_object()) return;
  payload_.object->sort();
  for (Member& one : payload_.object->members) one.value.sort();
}

Json& Json::operator[](std::size_t index) {
  if (!is_array()) wrong_kind("array");
  return (*payload_.array)[index];
}

const Json& Json::operator[](std::size_t index) const {
  if (!is_array()) wrong_kind("array");
  return (*payload_.array)[index];
}

const Json* Json::begin() const { return is_array() ? payload_.array->data() : nullptr; }
const Json* Json::end() const { return is_array() ? begin() + size() : nullptr; }

void Json::push_back(Json value) {
  if (is_null()) *this = array();
  if (!is_array()) wrong_kind("array");
  payload_.array->push_back(std::move(value));
}

bool operator==(const Json& a, const Json& b) {
  if (a.is_number() && b.is_number()) {
    if (a.is_number_float() || b.is_number_float()) return a.get<double>() == b.get<double>();
    return a.payload_.natural == b.payload_.natural &&
           a.is_number_unsigned() == b.is_number_unsigned();
  }
  if (a.kind_ != b.kind_ || a.size() != b.size()) return false;
  if (a.is_boolean()) return a.payload_.boolean == b.payload_.boolean;
  if (a.is_string()) return a.text() == b.text();
  if (a.is_array()) return std::equal(a.begin(), a.end(), b.begin());
  const auto ones = a.items(), others = b.items();
  return std::equal(ones.begin(), ones.end(), others.begin(),
                    [](const Json::Member& one, const Json::Member& other) {
                      return one.key == other.key && one.value == other.value;
                    });
}

// ---- text

namespace {

void write_text(std::string& out, const std::string& text, bool ascii) {
  const bool plain = std::all_of(text.begin(), text.end(), [](char c) {
    return c >= ' ' && c <= '~' && c != '"' && c != '\\';
  });
  if (plain) {
    out += '"';
    out += text;
    out += '"';
  } else {
    out += nlohmann::json(text).dump(-1, ' ', ascii, nlohmann::json::error_handler_t::replace);
  }
}

template <class Integer>
void write_integer(std::string& out, Integer value) {
  char digits[24];
  out.append(digits, std::to_chars(digits, std::end(digits), value).ptr);
}

}  // namespace

void Json::write(std::string& out, int indent, bool ascii, int level) const {
  const auto line = [&](int depth) {
    if (indent < 0) return;
    out += '\n';
    out.append(std::size_t(indent) * std::size_t(depth), ' ');
  };
  const char* separator = "";
  switch (kind_) {
    case Kind::null:
      out += "null";
      break;
    case Kind::boolean:
      out += payload_.boolean ? "true" : "false";
      break;
    case Kind::integer:
      write_integer(out, payload_.integer);
      break;
    case Kind::natural:
      write_integer(out, payload_.natural);
      break;
    case Kind::real:
      out += nlohmann::json(payload_.real).dump();
      break;
    case Kind::text:
      write_text(out, *payload_.text, ascii);
      break;
    case Kind::array:
      out += '[';
      for (const Json& one : *this) {
        out += std::exchange(separator, ",");
        line(level + 1);
        one.write(out, indent, ascii, level + 1);
      }
      if (!empty()) line(level);
      out += ']';
      break;
    case Kind::object:
      out += '{';
      for (const Member& one : items()) {
        out += std::exchange(separator, ",");
        line(level + 1);
        write_text(out, one.key, ascii);
        out += indent < 0 ? ":" : ": ";
        one.value.write(out, indent, ascii, level + 1);
      }
      if (!empty()) line(level);
      out += '}';
      break;
  }
}

std::string Json::dump(int indent, bool ascii) const {
  std::string out;
  write(out, indent, ascii, 0);
  return out;
}

/// Hears from the parser what a text holds, part by part.
struct JsonBuilder {
  const Json::Reading& reading;
  std::vector<Json> open;         // arrays and objects that have not ended
  std::vector<std::string> keys;  // of the objects among them
  Json done;
  bool deep = false;
  std::size_t error = 0;  // byte

  bool add(Json value) {
    deep = deep || open.size() > reading.deepest;
    if (open.empty()) {
      done = std::move(value);
    } else if (open.back().is_array()) {
      open.back().push_back(std::move(value));
    } else {
      open.back().payload_.object->members.push_back({std::move(keys.back()), std::move(value)});
      keys.pop_back();
    }
    return true;
  }
  bool begin(Json container) {
    deep = deep || open.size() > reading.deepest;
    open.push_back(std::move(container));
    return true;
  }
  bool end() {
    Json container = std::move(open.back());
    open.pop_back();
    return add(std::move(container));
  }

  bool null() { return add(nullptr); }
  bool boolean(bool value) { return add(value); }
  bool number_integer(std::int64_t value) { return add(value); }
  bool number_unsigned(std::uint64_t value) { return add(value); }
  bool number_float(double value, const std::string&) { return add(value); }
  bool string(std::string& value) { return add(std::move(value)); }
  bool binary(nlohmann::json::binary_t&) { return false; }  // none in text
  bool start_array(std::size_t) { return begin(Json::array()); }
  bool end_array() { return end(); }
  bool start_object(std::size_t) { return begin(Json::object()); }
  bool key(std::string& key) {
    deep = deep || open.size() > reading.deepest;
    keys.push_back(std::move(key));
    return true;
  }
  bool end_object() {
    unite(*open.back().payload_.object);
    return end();
  }
  bool parse_error(std::size_t byte, const std::string&, const nlohmann::json::exception&) {
    error = std::max<std::size_t>(byte, 1);
    return false;
  }

  /// Members of one name become one: the place of the first, the value of the last.
  void unite(Json::Object& object) const {
    auto& members = object.members;
    std::vector<std::size_t> order(members.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      const int sign = members[a].key.compare(members[b].key);
      return sign != 0 ? sign < 0 : a < b;
    });
    std::vector<bool> repeated(members.size());
    bool any = false;
    for (std::size_t i = order.size(); i-- > 1;) {
      Json::Member &before = members[order[i - 1]], &after = members[order[i]];
      if (before.key != after.key) continue;
      before.value = std::move(after.value);
      repeated[order[i]] = any = true;
    }
    if (any) {
      std::size_t at = 0;
      std::erase_if(members, [&](const Json::Member&) { return repeated[at++]; });
    }
    if (reading.sorted) object.sort();
  }
};

Result<Json> Json::parse(std::string_view text, const Reading& reading) {
  JsonBuilder builder{reading};
  if (!nlohmann::json::sax_parse(text, &builder)) {
    return Error{Code::syntax,
                 "it is no JSON from its byte " + std::to_string(builder.error) + " on",
                 {{}, 0, std::int64_t(builder.error), -1}};
  }
  if (builder.deep) return make_error(Code::out_of_range, "the JSON is nested too deep");
  return std::move(builder.done);
}

}  // namespace animeme::tools
