#include "dam/performance/kept_shares.h"

#include <algorithm>

#include "fap/detail/real_text.h"
#include "fap/edit.h"

namespace animeme::dam {

Result<fap::Mask> part_of_face(const std::string& name) {
  if (name == "all") return ~fap::Mask();
  if (const auto region = fap::region_faps(name)) return *region;
  std::string names;
  for (const fap::Region& region : fap::regions()) names += std::string(region.name) + ", ";
  return make_error(Code::invalid_argument,
                    "'" + name + "' is no part of the face; there are " + names + "all");
}

Result<KeptShares> parse_kept_shares(const std::string& text, const PartOfFace& part) {
  KeptShares shares;
  std::string rest = text;
  while (!rest.empty()) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::string one = rest.substr(0, comma);
    rest.erase(0, comma + 1);
    const std::size_t equals = one.find('=');
    const std::string number = equals == std::string::npos ? "" : one.substr(equals + 1);
    double share = -1;
    const auto [end, status] =
        fap::detail::read_real(number.data(), number.data() + number.size(), share);
    if (status != std::errc() || end != number.data() + number.size() ||
        !(share >= 0 && share <= 1)) {
      return make_error(Code::invalid_argument,
                        "'" + one + "' is not PART=SHARE with a share of 0 to 1, such as lips=0.5");
    }
    const std::string name = one.substr(0, equals);
    auto faps = part(name);
    if (!faps) return faps.error();
    const fap::Mask tongue = fap::region_faps("tongue").value_or(fap::Mask());
    const fap::Mask jaw = fap::region_faps("jaw").value_or(fap::Mask());
    if (name == "all") *faps &= ~(tongue | jaw);
    if ((*faps & tongue).any()) {
      return make_error(Code::invalid_argument,
                        "the tongue cannot be kept: it is that of the new speech");
    }
    shares.set(*faps, share);
  }
  return shares;
}

}  // namespace animeme::dam
