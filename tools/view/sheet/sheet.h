/// @file
/// A model and how well it speaks, as one HTML file that loads nothing.
///
///     sheet::Sheet sheet{.title = "me.dam", .corpus = "my corpus", .model = &model, .pairs =
///     &pairs,
///                        .evaluation = &evaluation};
///     std::string html = *sheet::make_sheet(sheet);
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dam/evaluation/evaluate.h"
#include "dam/model/model.h"
#include "fap/head/rig.h"
#include "fap/result.h"
#include "tools/view/viewer/viewer.h"

/// A character on one page.
namespace animeme::sheet {

/// What goes into a page; everything is borrowed.
struct Sheet {
  std::string title;                                      ///< shown as text, whatever is in it
  std::string corpus;                                     ///< likewise: what it was measured on
  const dam::Model* model = nullptr;                      ///< nothing: tracks of another system
  const std::vector<dam::SentencePair>* pairs = nullptr;  ///< not empty
  const dam::Evaluation* evaluation = nullptr;            ///< of these pairs, in their order
  const head::Head* head = nullptr;                       ///< nothing: no samples
  const head::Rig* rig = nullptr;                         ///< of the head
  /// The sound of a sentence by its id; nothing, or no function: it is silent.
  std::function<std::optional<viewer::Sound>(const std::string& id)> sound;
};

/// The page, about 1 MB a sample and 0.1 MB for the rest. Samples are the best, the median and the
/// worst sentence by NRMSE; controls that are neither FAPs nor shapes of ARKit have none, and the
/// page says so. The same input gives the same bytes. Errors: invalid_argument (no pair, no
/// evaluation or one of other pairs), those of plot::sentences_svg() and viewer::make_page().
Result<std::string> make_sheet(const Sheet& sheet);

}  // namespace animeme::sheet
