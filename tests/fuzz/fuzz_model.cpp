// Any bytes as a model file; what is accepted must be writable and speak. Each input is tried as it
// is and with size and checksum made right, else hardly any would get beyond these.
#include <cstdint>
#include <vector>

#include "dam/model/model.h"
#include "dam/speaking/synthesise.h"
#include "tests/fuzz/require.h"
#include "tests/support/sealed_model.h"

using animeme::test::require;

namespace {

void try_model(std::span<const std::uint8_t> bytes) {
  const auto model = animeme::dam::read_model(bytes);
  if (!model) return;
  require(bool(animeme::dam::read_model(animeme::dam::write_model(*model))));
  animeme::dam::Script script;
  script.phones = {{0, 0.3, "SIL", ""}, {0.3, 0.4, "P", "pa"}, {0.4, 0.6, "AA", "pa"}};
  (void)animeme::dam::synthesise(*model, script);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try_model({data, size});
  std::vector<std::uint8_t> sealed(data, data + size);
  animeme::test::seal_with_size(sealed);
  try_model(sealed);
  return 0;
}
