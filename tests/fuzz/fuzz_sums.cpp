// Any bytes as a file of sums; what is accepted must read back the same and merge with its like,
// and its model, if there is one, must be valid.
#include <cstdint>
#include <vector>

#include "dam/training/accumulate.h"
#include "tests/fuzz/require.h"
#include "tests/support/sealed_model.h"

using animeme::test::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace animeme::dam;
  std::vector<std::uint8_t> file(data, data + size);
  if (size > 4) animeme::test::seal(file);  // or nothing would get past the checksum
  auto sums = read_training_sums(file);
  if (!sums) return 0;
  const auto bytes = write_training_sums(*sums);
  auto again = read_training_sums(bytes);
  require(again && write_training_sums(*again) == bytes);
  (void)sums->merge(*again);
  const auto model = train_from_sums(std::move(*again));
  require(!model || validate(*model));
  return 0;
}
