// Any bytes as a model file; what is accepted must be writable and speak.
#include <cstdint>
#include <cstdlib>

#include "dam/model.h"
#include "dam/synthesise.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto model = animeme::dam::read_model({data, size});
  if (!model) return 0;
  if (!animeme::dam::read_model(animeme::dam::write_model(*model))) std::abort();
  animeme::dam::Script script;
  script.phones = {{0, 0.3, "SIL", ""}, {0.3, 0.4, "P", "pa"}, {0.4, 0.6, "AA", "pa"}};
  (void)animeme::dam::synthesise(*model, script);
  return 0;
}
