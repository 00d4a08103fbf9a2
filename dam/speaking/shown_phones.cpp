#include "dam/speaking/shown_phones_internal.h"

namespace animeme::dam::internal {

std::vector<ShownPhone> shown_phones(const Script& script) {
  std::vector<ShownPhone> phones;
  phones.reserve(script.phones.size());
  for (std::size_t i = 0; i < script.phones.size(); ++i) {
    std::size_t shown = i;
    while (shown + 1 < script.phones.size() && script.phones[shown].label == "HH") ++shown;
    const PhoneInfo* info = find_phone(script.phones[shown].label);
    ShownPhone& phone = phones.emplace_back();
    phone.start = script.phones[i].start;
    phone.end = script.phones[i].end;
    if (info == nullptr) continue;
    phone.first = info->viseme_start;
    phone.last = shown == i ? info->viseme_end : phone.first;
    if (shown == i) phone.own = info;
  }
  return phones;
}

}  // namespace animeme::dam::internal
