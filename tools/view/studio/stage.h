/// @file
/// Heads in a picture: one, or people side by side, who may be turned to each other.
///
///     auto stage = Stage::make(look, {{.head = {"woman"}, .turned = -25, .clip = &ann},
///                                     {.head = {"man"}, .turned = 25, .clip = &bob}});
///     stage->draw(1.5);                                  // how they look at 1.5 s
#pragma once

#include <memory>
#include <vector>

#include "fap/frame.h"
#include "fap/result.h"
#include "fap/viseme.h"
#include "tools/view/render/image.h"
#include "tools/view/studio/head_view.h"

namespace animeme::studio {

/// One of those who are shown.
struct StagePerson {
  HeadChoice head = {};                 ///< the head
  double turned = 0;                    ///< degrees that are added to those of the camera
  const fap::Sequence* clip = nullptr;  ///< filled; borrowed
  /// What is said, by frame of the clip: see head::PoseOptions::visemes. Empty: unknown.
  std::vector<fap::VisemeWeights> visemes = {};
};

/// `count` people side by side who are turned to each other: the one at the left of the picture by
/// `degrees` to the right, the last one as far to the left, those between them less.
double turned_to_others(std::size_t number, std::size_t count, double degrees);

/// Movable, not copyable.
class Stage {
 public:
  /// `people`: from left to right, at least one. The head of `look` is not used. Errors and talk:
  /// those of HeadView::make(); invalid_argument (nobody, or a clip without frames).
  static Result<Stage> make(const HeadLook& look, std::vector<StagePerson> people,
                            const tools::Log& log = {});
  Stage(Stage&&) noexcept;  ///< movable
  Stage& operator=(Stage&&) noexcept;
  ~Stage();

  /// How they look at a time, between two frames in proportion. Valid until the next call.
  const render::Image& draw(double seconds);

 private:
  struct State;
  explicit Stage(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace animeme::studio
