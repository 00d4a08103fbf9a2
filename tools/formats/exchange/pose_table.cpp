#include "tools/formats/exchange/pose_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <vector>

#include "tools/formats/exchange/detail/table.h"

namespace animeme::exchange {
namespace {

struct PoseColumns {
  std::size_t label = 0, count = 0;
  std::vector<std::size_t> controls;
};

Result<PoseColumns> read_header(const Row& header, dam::Poses& poses) {
  PoseColumns columns;
  columns.count = header.size();
  std::optional<std::size_t> label;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::string name(header.text(i));
    if (name == "key" || name == "pose") {
      if (label) return header.named_twice(i);
      label = i;
      continue;
    }
    if (name.empty()) return header.error(i, "a control needs a name");
    if (std::find(poses.names.begin(), poses.names.end(), name) != poses.names.end()) {
      return header.named_twice(i);
    }
    poses.names.push_back(name);
    columns.controls.push_back(i);
  }
  if (!label || columns.controls.empty()) {
    return error_at_line(Code::not_found,
                         "a table of poses has the column \"pose\" and one for each control", 1);
  }
  columns.label = *label;
  return columns;
}

}  // namespace

Result<dam::Poses> read_pose_table(std::string_view text, Blanks blanks) {
  const auto lines = dam::table_lines(text);
  if (lines.size() < 2) {
    return make_error(Code::truncated,
                      "a table of poses needs a header \"pose,CONTROL,...\" and one row per pose");
  }
  const char separator = separator_of(lines[0].text);
  dam::Poses poses;
  const auto columns = read_header(Row(lines[0], separator), poses);
  if (!columns) return columns.error();
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const Row row(lines[i], separator);
    if (auto ok = row.check_size(columns->count); !ok) return ok.error();
    const std::string label(row.text(columns->label));
    if (label.empty()) return row.error(columns->label, "a pose needs a name");
    if (std::find(poses.labels.begin(), poses.labels.end(), label) != poses.labels.end()) {
      return row.error(columns->label, "the pose " + label + " is there twice");
    }
    poses.labels.push_back(label);
    for (std::size_t c = 0; c < poses.names.size(); ++c) {
      const std::size_t field = columns->controls[c];
      if (blanks == Blanks::allowed && row.text(field).empty()) {
        poses.values.push_back(std::numeric_limits<double>::quiet_NaN());
        continue;
      }
      const auto value = row.number(field);
      if (!value || !std::isfinite(*value)) return row.wrong(field, poses.names[c], "no number");
      poses.values.push_back(*value);
    }
  }
  return poses;
}

std::string write_pose_table(const dam::Poses& poses, std::string_view first) {
  std::string out(first);
  for (const std::string& name : poses.names) out += "," + name;
  out += "\n";
  for (std::size_t p = 0; p < poses.labels.size(); ++p) {
    out += poses.labels[p];
    for (std::size_t c = 0; c < poses.names.size(); ++c) {
      std::array<char, 400> text{};
      std::snprintf(text.data(), text.size(), ",%.6f", poses.at(p, c));
      out += text.data();
    }
    out += "\n";
  }
  return out;
}

}  // namespace animeme::exchange
