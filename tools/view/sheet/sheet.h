/// @file
/// A report on a model and its evaluation, as one HTML file that loads nothing.
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

/// Reports on characters.
namespace animeme::sheet {

/// Contents of a page; everything is borrowed.
struct Sheet {
  std::string title;                  ///< shown as plain text
  std::string corpus;                 ///< shown as plain text: the evaluation data
  const dam::Model* model = nullptr;  ///< nullptr: tracks of another system
  const std::vector<dam::SentencePair>* pairs = nullptr;  ///< not empty
  const dam::Evaluation* evaluation = nullptr;            ///< of these pairs, in their order
  const head::Head* head = nullptr;                       ///< nullptr: no samples
  const head::Rig* rig = nullptr;                         ///< of the head
  /// Returns the sound of a sentence by its id; nullopt, or no function: silent.
  std::function<std::optional<viewer::Sound>(const std::string& id)> sound;
};

/// Makes the page, about 1 MB per sample plus 0.1 MB. Samples are the best, the median and the
/// worst sentence by NRMSE; for controls that are neither FAPs nor ARKit shapes there are none, and
/// the page says so. The same input gives the same bytes. Errors: invalid_argument (no pair, no
/// evaluation, or the evaluation of other pairs), those of plot::sentences_svg() and
/// viewer::make_page().
Result<std::string> make_sheet(const Sheet& sheet);

}  // namespace animeme::sheet
