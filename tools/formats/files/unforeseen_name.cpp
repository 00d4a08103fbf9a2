#include "tools/formats/files/unforeseen_name_internal.h"

#include <random>
#include <string_view>

namespace animeme::tools {

std::string unforeseen_name() {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz0123456789";
  std::random_device random;
  std::string name = ".animeme-";
  for (int i = 0; i < 12; ++i) name += kLetters[random() % kLetters.size()];
  return name + ".part";
}

}  // namespace animeme::tools
