// Feeds arbitrary bytes to the reader of case.json. What it accepts has names that are names, and
// reads back equal from the writer.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "conformance/case_file.h"
#include "tests/fuzz/require.h"

using animeme::test::require;

namespace {

void check_name(const std::string& name) {
  require(!name.empty() && name != "." && name != ".." && name[0] != '-');
  for (const char c : name) {
    require(static_cast<unsigned char>(c) >= 0x20 && c != 0x7F && c != '/' && c != '\\');
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace animeme::conformance;
  const auto one = read_case({reinterpret_cast<const char*>(data), size});
  if (!one) {
    require(!one.error().message.empty());
    return 0;
  }
  check_name(one->name);
  require(one->file("stream") != nullptr);
  for (const CaseFile& file : one->files) check_name(file.name);
  const std::string text = write_case(*one);
  const auto again = read_case(text);
  require(again.has_value());
  require(write_case(*again) == text);
  return 0;
}
