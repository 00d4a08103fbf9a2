#include "conformance/case_file.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace animeme::conformance {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLongestName = 200;  // bytes

struct Role {
  const char* name;
  const char* extension;
  const char* damaged;
};
constexpr Role kRoles[] = {
    {"stream", ".fba", ".fba"},
    {"face", ".dec.fap", ".intact.fap"},
    {"body", ".dec.bap", ".intact.bap"},
    {"face_ignored", ".ignored.fap", ".ignored.fap"},
    {"source_face", ".src.fap", ".src.fap"},
    {"source_body", ".src.bap", ".src.bap"},
    {"parameters", ".epf", ".epf"},
};

// Lists of short words on few lines: files that people read.
std::string word_list(const std::vector<std::string>& words, const std::string& indent) {
  std::size_t length = 0;
  for (const std::string& word : words) length += word.size() + 4;
  const bool one_line = length < 80;
  std::string out = "[";
  std::size_t column = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string word = Json(words[i]).dump() + (i + 1 < words.size() ? "," : "");
    if (!one_line && (i == 0 || column + word.size() + 1 > 96)) {
      out += "\n" + indent + "  " + word;
      column = indent.size() + 2 + word.size();
    } else {
      out += (i == 0 ? "" : " ") + word;
      column += word.size() + 1;
    }
  }
  return out + (one_line ? "]" : "\n" + indent + "]");
}

void strings(const Json& json, const char* key, std::vector<std::string>& out) {
  for (const Json& one : json.at(key)) out.push_back(one.get<std::string>());
}

// Names become parts of paths and of command lines, and are shown in terminals.
void check_name(const std::string& name) {
  const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= 0x20 && byte != 0x7F && c != '/' && c != '\\';
  });
  if (!plain || name.empty() || name[0] == '-' || name == "." || name == ".." ||
      name.size() > kLongestName) {
    throw std::invalid_argument("\"" + name.substr(0, kLongestName) + "\" is no name of a file");
  }
}

Case parse(const Json& json) {
  Case out;
  json.at("name").get_to(out.name);
  check_name(out.name);
  json.at("title").get_to(out.title);
  json.at("note").get_to(out.note);
  json.at("origin").get_to(out.origin);
  json.at("object").get_to(out.object);
  const std::string expected = json.at("expected").get<std::string>();
  if (expected != "decode" && expected != "error") {
    throw std::invalid_argument("\"expected\" is neither \"decode\" nor \"error\"");
  }
  out.damaged = expected == "error";
  if (out.damaged) strings(json, "errors", out.errors);
  json.at("certainty").get_to(out.certainty);
  strings(json, "features", out.features);
  strings(json, "sections", out.sections);
  if (json.contains("rate")) json["rate"].get_to(out.rate);
  const Json& limits = json.at("limits");
  limits.at("planes").get_to(out.planes);
  limits.at("intra_planes").get_to(out.intra_planes);
  limits.at("largest_alphabet").get_to(out.largest_alphabet);
  limits.at("largest_plane_bits").get_to(out.largest_plane_bits);
  if (json.contains("encode")) {
    json["encode"].at("plane_start_codes").get_to(out.plane_start_codes);
    json["encode"].at("old_codes").get_to(out.old_codes);
  }
  for (const auto& [role, file] : json.at("files").items()) {
    CaseFile one;
    one.role = role;
    file.at("name").get_to(one.name);
    file.at("bytes").get_to(one.bytes);
    file.at("sha256").get_to(one.sha256);
    check_name(one.name);
    out.files.push_back(std::move(one));
  }
  if (out.file("stream") == nullptr) throw std::invalid_argument("no file is the \"stream\"");
  return out;
}

}  // namespace

std::string extension_of_role(std::string_view role, bool damaged) {
  for (const Role& one : kRoles) {
    if (role == one.name) return damaged ? one.damaged : one.extension;
  }
  return {};
}

const std::vector<std::string>& file_roles() {
  static const std::vector<std::string> roles = [] {
    std::vector<std::string> out;
    for (const Role& one : kRoles) out.emplace_back(one.name);
    return out;
  }();
  return roles;
}

Result<Case> read_case(std::string_view text) {
  try {
    return parse(Json::parse(text));
  } catch (const std::exception& error) {
    return make_error(Code::syntax, std::string("not a case.json: ") + error.what());
  }
}

std::string write_case(const Case& one) {
  const auto text = [](const std::string& value) { return Json(value).dump(); };
  std::string out = "{\n";
  const auto member = [&](const char* key, const std::string& value) {
    out += std::string("  \"") + key + "\": " + value + ",\n";
  };
  member("name", text(one.name));
  member("title", text(one.title));
  member("note", text(one.note));
  member("origin", text(one.origin));
  member("object", text(one.object));
  member("expected", one.damaged ? "\"error\"" : "\"decode\"");
  if (one.damaged) member("errors", word_list(one.errors, "  "));
  member("certainty", text(one.certainty));
  member("sections", word_list(one.sections, "  "));
  member("features", word_list(one.features, "  "));
  if (!one.rate.empty()) member("rate", text(one.rate));
  member("limits", "{\"planes\": " + std::to_string(one.planes) +
                       ", \"intra_planes\": " + std::to_string(one.intra_planes) +
                       ", \"largest_alphabet\": " + std::to_string(one.largest_alphabet) +
                       ", \"largest_plane_bits\": " + std::to_string(one.largest_plane_bits) + "}");
  if (one.file("parameters") != nullptr) {
    member("encode", "{\"plane_start_codes\": " + text(one.plane_start_codes) +
                         ", \"old_codes\": " + (one.old_codes ? "true" : "false") + "}");
  }
  out += "  \"files\": {";
  for (std::size_t i = 0; i < one.files.size(); ++i) {
    const CaseFile& file = one.files[i];
    out += (i == 0 ? "\n    " : ",\n    ") + text(file.role) + ": {\"name\": " + text(file.name) +
           ", \"bytes\": " + std::to_string(file.bytes) +
           ",\n      \"sha256\": " + text(file.sha256) + "}";
  }
  return out + "\n  }\n}\n";
}

}  // namespace animeme::conformance
