// Feeds arbitrary bytes to the readers of tables: curves of controls, anything with a header line,
// the list of sentences of a corpus, and poses. The first byte chooses the options. Curves that
// were read are written and read again; a face whose poses are its own keeps its values.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "dam/corpus/corpus.h"
#include "dam/corpus/rows_internal.h"
#include "dam/signal/gain_offset.h"
#include "tests/fuzz/require.h"
#include "tools/formats/exchange/curves.h"
#include "tools/formats/exchange/pose_table.h"

using animeme::test::require;

namespace {

using namespace animeme;

void read_with_blanks(std::string_view text) {
  std::vector<dam::BlankNote> blanks;
  auto signal = dam::read_curves(text, &blanks);
  if (!signal) return require(!signal.error().message.empty());
  dam::leave_out_blanks(*signal);
  require(signal->measured.size() == signal->frames());
  for (const double value : signal->values) require(std::isfinite(value));
  for (const dam::BlankNote& note : blanks)
    require(note.rows > 0 && note.rows <= note.of && note.of == signal->frames());
}

void read_as_curves(std::string_view text) {
  read_with_blanks(text);
  const auto signal = dam::read_curves(text);
  if (!signal) return require(!signal.error().message.empty());
  require(signal->rate.valid() && signal->frames() > 0 && !signal->names.empty());
  require(signal->values.size() == signal->frames() * signal->names.size());
  std::string again = exchange::write_curve_header(signal->names);
  for (std::size_t frame = 0; frame < signal->frames(); ++frame) {
    again += exchange::write_curve_row(*signal, frame);
  }
  const auto back = dam::read_curves(again);
  // A rate is told by times with six digits, so the fastest ones may not come back.
  if (back) require(back->names == signal->names && back->frames() == signal->frames());
}

void read_as_rows(std::string_view text, const dam::CorpusOptions& options) {
  const auto rows = dam::parse_rows(text, options);
  if (!rows) return require(!rows.error().message.empty());
  require(!rows->empty());
  std::set<std::string> seen;
  for (const dam::Utterance& row : *rows) {
    require(seen.insert(row.id).second);
    require(!row.id.empty() && row.id != "." && row.id != "..");
    require(row.id.find_first_of(std::string_view("/\\:\0", 4)) == std::string::npos);
  }
}

void read_as_poses(std::string_view text, exchange::Blanks blanks) {
  const auto poses = exchange::read_pose_table(text, blanks);
  if (!poses) return require(!poses.error().message.empty());
  require(!poses->names.empty() && !poses->labels.empty());
  require(poses->values.size() == poses->names.size() * poses->labels.size());
  double largest = 0;
  for (const double value : poses->values) largest = std::max(largest, std::abs(value));
  const auto gains = dam::fit_gain_offset(*poses, *poses);
  if (!gains) return require(!gains.error().message.empty());
  require(gains->size() == poses->names.size());
  for (const dam::GainOffset& one : *gains) {
    require(std::abs(one.gain - 1) < 1e-3 && std::abs(one.offset) <= 1e-3 * largest);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 6) {
    case 0:
      read_as_curves(text);
      break;
    case 1: {
      const auto table = exchange::read_any_table(text);
      if (table) {
        require(!table->clip.frames.empty() && table->clip.rate.valid());
      } else {
        require(!table.error().message.empty());
      }
      break;
    }
    case 2:
      read_as_rows(text, {});
      break;
    case 4:
      read_as_poses(text, exchange::Blanks::refused);
      break;
    case 5:
      read_as_poses(text, exchange::Blanks::allowed);
      break;
    default: {
      dam::CorpusOptions options;
      options.split_value = "train";
      read_as_rows(text, options);
    }
  }
  return 0;
}
