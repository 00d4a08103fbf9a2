#include "tools/app/commands/over_options.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "fap/edit.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/edit_options.h"
#include "tools/app/commands/options.h"

namespace animeme::tools {

Result<dam::KeptShares> parse_kept_shares(const std::string& text) {
  dam::KeptShares shares;
  std::string rest = text;
  for (bool first = true; first || !rest.empty(); first = false) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::string one = rest.substr(0, comma);
    rest.erase(0, comma + 1);
    const std::size_t equals = one.find('=');
    const std::string number = equals == std::string::npos ? "" : one.substr(equals + 1);
    double share = -1;
    const auto [end, status] = std::from_chars(number.data(), number.data() + number.size(), share);
    if (status != std::errc() || end != number.data() + number.size() ||
        !(share >= 0 && share <= 1)) {
      return make_error(Code::invalid_argument,
                        "'" + one + "' is not PART=SHARE with a share of 0 to 1, such as lips=0.5");
    }
    const std::string name = one.substr(0, equals);
    auto faps = parse_edit_faps(name);
    if (!faps) return faps.error();
    const fap::Mask tongue = *fap::region_faps("tongue"), jaw = *fap::region_faps("jaw");
    if (name == "all") *faps &= ~(tongue | jaw);
    if ((*faps & tongue).any()) {
      return make_error(Code::invalid_argument,
                        "the tongue cannot be kept: it is that of the new speech");
    }
    shares.set(*faps, share);
  }
  return shares;
}

void add_over_options(OptionTable& cli, OverChoice& choice, bool bends) {
  cli.add("--over", choice.path,
          bends ? "Keep the face of this performance (a file with a face) under the new lips"
                : "Keep the face of this performance (a file with a face) under the lips; repeats")
      ->value("FILE");
  cli.add("--keep", choice.keep,
          "Shares of the performance to keep, by part as edit names them: lips=0.5,brows=0; "
          "default: all of it but jaw and tongue")
      ->value("PART=0..1,...")
      ->check(problem_of<parse_kept_shares>)
      ->needs("--over");
  if (!bends) return;
  cli.add("--bend", choice.bend,
          "How much faster or slower the performance may run to meet the speech; 0: not at all")
      ->value("0..0.25=0.25")
      ->between(0.0, dam::kMostBend)
      ->needs("--over");
}

Result<dam::Performance> read_performance(const std::string& path) {
  const auto face = read_face(path);
  if (!face) return face.error();
  auto clip = shown_face(*face, path);
  if (!clip) return clip.error();
  speech::ScriptInput input;
  auto script = speech::carried_script(path, input);
  auto performance = dam::Performance::make(std::move(*clip), script ? *script : dam::Script(),
                                            std::max(0.0, face->start));
  if (!performance) return performance.error().in_file(path);
  return performance;
}

Result<void> read_over(const OverChoice& choice, std::shared_ptr<const dam::Performance>& over,
                       dam::KeptShares& keep) {
  if (choice.path.empty()) return {};
  if (!choice.keep.empty()) {
    const auto shares = parse_kept_shares(choice.keep);
    if (!shares) return shares.error();
    keep = *shares;
  }
  auto performance = read_performance(choice.path);
  if (!performance) return performance.error();
  over = std::make_shared<const dam::Performance>(std::move(*performance));
  return {};
}

}  // namespace animeme::tools
