/// @file
/// The heads of a page: --head of `view` and `stream`.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fap/head/rig.h"
#include "tools/live/web/web.h"
#include "tools/view/studio/head_file.h"

namespace animeme::tools {

/// What was given by add_heads_options().
struct HeadChoices {
  std::vector<std::string> heads;  ///< names, files, or lists of them; none: the usual head
  studio::HeadChoice rest;         ///< --points, --gain

  /// One choice for each head.
  std::vector<studio::HeadChoice> each() const;
};

/// A head with its rig, at a place that stays.
struct ShownHead {
  std::string name;  ///< the file's without its ending
  head::Head head;   ///< textures not larger than a page can bear
  head::Rig rig;     ///< of `head`
};

/// What is wrong with them, as far as names tell. Empty: nothing.
std::string problem_of(const HeadChoices& choices);

/// Loads them and logs which textures were scaled. Errors: those of studio::load_head().
Result<std::vector<std::unique_ptr<ShownHead>>> load_shown(const HeadChoices& choices);

/// Loads them for the page of a web server. Errors: as load_shown().
Result<void> give_heads(const HeadChoices& choices, web::WebOptions& options);

}  // namespace animeme::tools
