#include "tools/app/commands/shown_heads.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "tools/app/commands/common.h"
#include "tools/view/studio/page_pictures.h"
#include "tools/view/viewer/viewer.h"

namespace animeme::tools {

std::vector<studio::HeadChoice> HeadChoices::each() const {
  std::vector<studio::HeadChoice> choices;
  for (std::string list : heads) {
    // "woman,man" is two heads, unless a file is called so.
    std::error_code none;
    const bool file = std::filesystem::exists(list, none);
    for (std::size_t comma; !file && (comma = list.find(',')) != std::string::npos;) {
      choices.push_back(rest);
      choices.back().head = list.substr(0, comma);
      list.erase(0, comma + 1);
    }
    choices.push_back(rest);
    choices.back().head = list;
  }
  if (choices.empty()) choices.push_back(rest);
  return choices;
}

std::string problem_of(const HeadChoices& choices) {
  for (const studio::HeadChoice& choice : choices.each()) {
    if (std::string problem = studio::problem_of(choice); !problem.empty()) return problem;
  }
  return {};
}

Result<std::vector<std::unique_ptr<ShownHead>>> load_shown(const HeadChoices& choices) {
  std::vector<std::unique_ptr<ShownHead>> heads;
  for (const studio::HeadChoice& choice : choices.each()) {
    Result<head::Head> head = studio::load_head(choice, terminal_log());
    if (!head) return head.error();
    if (const std::size_t count = studio::shrink_pictures(*head); count > 0) {
      say(choice.head + ": " + std::to_string(count) +
          " large textures were scaled down (at most 1024 texels a side, WebP)");
    }
    head::Rig rig = head::make_rig(*head);
    heads.push_back(std::unique_ptr<ShownHead>(new ShownHead{
        std::filesystem::path(choice.head).stem().string(), std::move(*head), std::move(rig)}));
  }
  return heads;
}

Result<void> give_heads(const HeadChoices& choices, web::WebOptions& options) {
  auto heads = load_shown(choices);
  if (!heads) return heads.error();
  options.head_script = viewer::head_script();
  options.other_heads.clear();
  for (const std::unique_ptr<ShownHead>& each : *heads) {
    web::WebHead packed{each->name, viewer::pack_head(each->head, each->rig)};
    if (each == heads->front()) {
      options.head_name = std::move(packed.name);
      options.head_model = std::move(packed.model);
    } else {
      options.other_heads.push_back(std::move(packed));
    }
  }
  return {};
}

}  // namespace animeme::tools
