#include "tools/app/commands/over_options.h"

#include <utility>

#include "dam/performance/kept_shares.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/edit_options.h"
#include "tools/app/commands/options.h"

namespace animeme::tools {

Result<dam::KeptShares> parse_kept_shares(const std::string& text) {
  // As an option, it says something.
  return dam::parse_kept_shares(text.empty() ? "=" : text, parse_edit_faps);
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
