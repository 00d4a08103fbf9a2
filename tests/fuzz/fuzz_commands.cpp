// Lines of a live head that are commands or JSON: stream --say, --control, POST /heads/NAME/say.
#include <cstddef>
#include <cstdint>
#include <string>

#include "tests/fuzz/require.h"
#include "tools/speech/talking/line_command.h"

using animeme::test::require;

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
