#include "tools/commands/fap_names.h"

#include <charconv>
#include <string_view>

#include "fap/frame.h"
#include "fap/tables.h"

namespace animeme::tools {

namespace {

// 0 if it is no low-level FAP.
int number_of(std::string_view name) {
  int number = fap::find_fap(name).value_or(0);
  if (number == 0) {
    const char* end = name.data() + name.size();
    if (std::from_chars(name.data(), end, number).ptr != end) return 0;
  }
  return number >= fap::kFirstLowLevel && number <= fap::kFapCount ? number : 0;
}

}  // namespace

Result<std::vector<int>> fap_numbers(const std::vector<std::string>& names) {
  std::vector<int> numbers;
  for (const std::string& name : names) {
    const std::size_t dash = name.find('-');
    const int first = number_of(std::string_view(name).substr(0, dash));
    const int last =
        dash == std::string::npos ? first : number_of(std::string_view(name).substr(dash + 1));
    if (first == 0 || last < first) {
      return make_error(Code::invalid_argument,
                        name +
                            " is no FAP; give numbers 3 to 68, names like open_jaw or ranges "
                            "like 3-13");
    }
    for (int fap = first; fap <= last; ++fap) numbers.push_back(fap);
  }
  return numbers;
}

}  // namespace animeme::tools
