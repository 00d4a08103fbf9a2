#include "tools/app/commands/shown_heads.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "tools/app/commands/common.h"
#include "tools/view/studio/page_pictures.h"
#include "tools/view/viewer/viewer.h"

namespace animeme::tools {

std::vector<studio::HeadChoice> HeadChoices::each() const {
  std::vector<studio::HeadChoice> choices(std::max<std::size_t>(heads.size(), 1), rest);
  for (std::size_t i = 0; i < heads.size(); ++i) choices[i].head = heads[i];
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
          " large textures are smaller in the page (1024 texels a side at most, WebP)");
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
