#include "tools/live/webrtc/detail/shared_transport.h"

#include <algorithm>
#include <sstream>
#include <string_view>
#include <vector>

namespace animeme::webrtc {
namespace {

using Lines = std::vector<std::string>;

// What belongs to a transport, candidates included.
bool is_transport(std::string_view line) {
  for (const std::string_view start :
       {"a=ice-ufrag:", "a=ice-pwd:", "a=ice-options:", "a=fingerprint:", "a=setup:",
        "a=candidate:", "a=end-of-candidates", "a=remote-candidates:"}) {
    if (line.starts_with(start)) return true;
  }
  return false;
}

std::string value_of(const Lines& lines, std::string_view start) {
  for (const std::string& line : lines) {
    if (line.starts_with(start)) return line.substr(start.size());
  }
  return {};
}

// The session and each medium.
std::vector<Lines> sections_of(const std::string& sdp) {
  std::vector<Lines> sections(1);
  std::istringstream stream(sdp);
  for (std::string line; std::getline(stream, line);) {
    while (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.starts_with("m=")) sections.emplace_back();
    sections.back().push_back(std::move(line));
  }
  return sections;
}

std::vector<std::string> bundle_of(const Lines& session) {
  std::vector<std::string> names;
  std::istringstream stream(value_of(session, "a=group:BUNDLE "));
  for (std::string name; stream >> name;) names.push_back(name);
  return names;
}

}  // namespace

std::string share_transport(const std::string& sdp) {
  std::vector<Lines> sections = sections_of(sdp);
  const std::vector<std::string> bundle = bundle_of(sections.front());
  if (bundle.size() < 2) return sdp;
  const auto named = [&](const std::string& name) {
    return std::find_if(sections.begin() + 1, sections.end(),
                        [&](const Lines& lines) { return value_of(lines, "a=mid:") == name; });
  };
  const auto first = named(bundle.front());
  if (first == sections.end()) return sdp;
  Lines transport;
  for (const std::string& line : *first) {
    if (is_transport(line)) transport.push_back(line);
  }
  bool changed = false;
  for (auto name = bundle.begin() + 1; name != bundle.end(); ++name) {
    const auto other = named(*name);
    if (other == sections.end()) continue;
    // A medium of the bundle without credentials has them from the session or from the first one.
    const std::string own = value_of(*other, "a=ice-ufrag:");
    if (own.empty() || own == value_of(*first, "a=ice-ufrag:")) continue;
    std::erase_if(*other, is_transport);
    other->insert(other->end(), transport.begin(), transport.end());
    changed = true;
  }
  if (!changed) return sdp;
  std::string text;
  for (const Lines& lines : sections) {
    for (const std::string& line : lines) text += line + "\r\n";
  }
  return text;
}

}  // namespace animeme::webrtc
