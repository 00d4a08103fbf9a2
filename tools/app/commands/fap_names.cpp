#include "tools/app/commands/fap_names.h"

#include <charconv>

#include "fap/frame.h"
#include "fap/tables.h"

namespace animeme::tools {

namespace {

// By number or name; 0 if it is no low-level FAP.
int number_of(std::string_view name) {
  const int number = fap::find_fap(name).value_or(fap_number(name));
  return number >= fap::kFirstLowLevel ? number : 0;
}

}  // namespace

int fap_number(std::string_view text) {
  int value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = status == std::errc() && end == text.data() + text.size();
  return whole && value >= fap::kFirstLowLevel && value <= fap::kFapCount ? value : 0;
}

Result<std::vector<int>> fap_numbers(const std::vector<std::string>& names) {
  std::vector<int> numbers;
  for (const std::string& name : names) {
    const std::size_t dash = name.find('-');
    const int first = number_of(std::string_view(name).substr(0, dash));
    const int last =
        dash == std::string::npos ? first : number_of(std::string_view(name).substr(dash + 1));
    if (first == 0 || last < first) {
      return make_error(Code::invalid_argument, name +
                                                    " is not a FAP; write numbers 3 to 68, names "
                                                    "such as open_jaw or ranges such as 3-13");
    }
    for (int fap = first; fap <= last; ++fap) numbers.push_back(fap);
  }
  return numbers;
}

Result<std::vector<int>> faps_of(const std::string& name) { return fap_numbers({name}); }

}  // namespace animeme::tools
