// Feeds arbitrary bytes to what makes tables of captures, and to the readers that it names; the
// same bytes are a column map and a neutral face, too. The last byte chooses.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "tests/fuzz/require.h"
#include "tools/formats/exchange/arkit.h"
#include "tools/formats/exchange/capture_table.h"
#include "tools/formats/exchange/face_file.h"

using animeme::test::require;

namespace {

using namespace animeme;
using namespace animeme::exchange;

template <class T>
void says_why(const Result<T>& result) {
  require(result || !result.error().message.empty());
}

void import_all(const std::string& table) {
  LandmarkImportOptions options;
  options.table.rate = fap::Rate{25, 1};
  auto points = read_landmark_table(table, options.table);
  says_why(points);
  if (!points) return;
  const auto common = common_face({*points, *points}, options);
  says_why(common);
  if (common) {
    const auto back = read_face_file(write_face_file(*common));
    require(back && back->points.size() == common->points.size());
    options.face.rest = *back;
  }
  const auto take = import_landmarks(std::move(*points), options);
  says_why(take);
  if (!take) return;
  std::int64_t last = -1;
  for (const fap::Frame& frame : take->face.clip.frames) {
    require(frame.number > last);
    last = frame.number;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::uint8_t choice = data[size - 1];
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  CaptureTableOptions options;
  options.shapes = (choice & 1) != 0;
  const auto map = read_column_map(text);
  says_why(map);
  if (map) options.columns = *map;
  if (choice & 2) options.columns = {{"x*", "x_*", 2}, {"frame", "time_s", 1}};
  says_why(parse_column_rule(text.substr(0, 60)));
  says_why(read_face_file(text));
  const auto table = capture_table(text, options);
  says_why(table);
  if (!table) return 0;
  require(!table->table.empty());
  if (table->kind == CaptureKind::landmarks) import_all(table->table);
  if (table->kind == CaptureKind::arkit) says_why(read_arkit_table(table->table));
  return 0;
}
