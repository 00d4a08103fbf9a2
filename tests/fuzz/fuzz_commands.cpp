// Lines of a live head that are commands or JSON: stream --say, --control, POST /heads/NAME/say.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "tools/speech/talking/line_command.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace animeme;
  const std::string line(reinterpret_cast<const char*>(data), size);
  for (const bool json : {false, true}) {
    const auto command = speech::read_line(line, json);
    if (!command) {
      require(!command.error().message.empty());
      continue;
    }
    require(command->text.size() <= line.size() + 1 && command->id.size() <= line.size());
  }
  return 0;
}
