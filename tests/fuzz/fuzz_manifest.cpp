// Tables of clips in each format: rows have known columns and names that stay in the folder, and
// the second reading is the first one.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/require.h"
#include "tools/app/batch/manifest.h"

using animeme::test::require;

namespace {

// All rows and errors, as one text.
std::string rows_of(animeme::batch::Manifest& manifest, std::size_t bytes) {
  std::string all;
  // Each row takes a byte at least.
  for (std::size_t i = 0; i <= bytes + 1; ++i) {
    const auto row = manifest.next();
    if (!row) {
      require(!row.error().message.empty());
      all += row.error().describe() + "\n";
      continue;
    }
    if (!*row) return all;
    require((*row)->line > 0 && animeme::batch::problem_of_id((*row)->at("id")).empty());
    for (const auto& [column, value] : (*row)->values) {
      require(column != "tts" && value.find('\0') == std::string::npos);
      all += column + "=" + value + ";";
    }
    all += "\n";
  }
  require(false);
  return all;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace animeme::batch;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const Form form : {Form::table, Form::csv, Form::json, Form::list}) {
    auto manifest = Manifest::of_text(text, form);
    if (!manifest) {
      require(!manifest.error().message.empty());
      continue;
    }
    const std::string first = rows_of(*manifest, size);
    require(bool(manifest->rewind()));
    require(rows_of(*manifest, size) == first);
  }
  return 0;
}
