#include "tools/commands/fap_names.h"

#include <cstdlib>

#include "fap/frame.h"
#include "fap/tables.h"

namespace animeme::tools {

std::vector<int> fap_numbers(const std::vector<std::string>& names) {
  std::vector<int> numbers;
  for (const std::string& name : names) {
    int number = fap::find_fap(name).value_or(0);
    if (number == 0 && name.size() <= 2 &&
        name.find_first_not_of("0123456789") == std::string::npos) {
      number = std::atoi(name.c_str());
    }
    if (number < fap::kFirstLowLevel || number > fap::kFapCount) number = 0;
    numbers.push_back(number);
    if (number == 0) break;
  }
  return numbers;
}

}  // namespace animeme::tools
