#include "tools/formats/inspect/left_out.h"

#include <algorithm>

#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"

namespace animeme::inspect {
namespace {

using tools::format;

constexpr std::size_t kGlitches = 8;
constexpr std::size_t kNamed = 10;    // sentences
constexpr std::size_t kControls = 4;  // of a sentence

bool alike(const dam::BlankNote& a, const dam::BlankNote& b) {
  return a.id == b.id && a.rows == b.rows && a.first_line == b.first_line;
}

/// The notes [from, to) are alike.
std::string line_of(const std::vector<dam::BlankNote>& blanks, std::size_t from, std::size_t to) {
  std::string controls;
  for (std::size_t i = from; i < to && i < from + kControls; ++i)
    controls += (controls.empty() ? "" : ", ") + blanks[i].control;
  if (to - from > kControls) controls += format(" and %zu more", to - from - kControls);
  const dam::BlankNote& note = blanks[from];
  if (note.rows == note.of)
    return format("sentence '%s' is skipped: %s blank throughout", note.id.c_str(),
                  (controls + (to - from > 1 ? " are" : " is")).c_str());
  return format("sentence '%s': %s blank in %zu of %zu rows, first in line %zu; skipped",
                note.id.c_str(), controls.c_str(), note.rows, note.of, note.first_line);
}

}  // namespace

std::vector<std::string> blanks_text(const dam::LeftOut& left_out) {
  std::vector<std::string> lines;
  std::size_t sentences = 0;
  const auto& blanks = left_out.blanks;
  for (std::size_t from = 0; from < blanks.size();) {
    std::size_t to = from + 1;
    while (to < blanks.size() && alike(blanks[from], blanks[to])) ++to;
    if (from == 0 || blanks[from].id != blanks[from - 1].id) ++sentences;
    if (sentences <= kNamed) lines.push_back(line_of(blanks, from, to));
    from = to;
  }
  if (sentences > kNamed)
    lines.push_back(
        format("... and blanks in %zu more sentences (--json names them all)", sentences - kNamed));
  if (left_out.sentences > 1)
    lines.push_back(
        format("%zu sentences are skipped completely; if many of them lack a control, exclude it "
               "with --controls",
               left_out.sentences));
  return lines;
}

std::vector<std::string> glitches_text(std::span<const dam::Glitch> glitches) {
  std::vector<std::string> lines;
  for (const dam::Glitch& glitch : glitches.first(std::min(glitches.size(), kGlitches)))
    lines.push_back(dam::describe(glitch));
  if (glitches.size() > kGlitches)
    lines.push_back(format("... and %zu more glitches of the tracker (--json names them all)",
                           glitches.size() - kGlitches));
  return lines;
}

std::string glitches_json(std::span<const dam::Glitch> glitches) {
  return tools::json_list(glitches,
                          [](const dam::Glitch& one) {
                            return tools::Json{{"id", one.id},
                                               {"control", one.control},
                                               {"kind", dam::glitch_name(one.kind)},
                                               {"time_s", one.time},
                                               {"frames", one.frames},
                                               {"bridged", one.bridged}};
                          })
      .dump();
}

std::string blanks_json(const dam::LeftOut& left_out) {
  return tools::json_list(left_out.blanks,
                          [](const dam::BlankNote& one) {
                            return tools::Json{{"id", one.id},
                                               {"control", one.control},
                                               {"rows", one.rows},
                                               {"of", one.of},
                                               {"first_line", one.first_line}};
                          })
      .dump();
}

}  // namespace animeme::inspect
