/// @file
/// A head, a camera and a renderer: converts frames to pictures.
#pragma once

#include <memory>
#include <span>

#include "fap/frame.h"
#include "fap/result.h"
#include "tools/view/render/image.h"
#include "tools/view/studio/background.h"
#include "tools/view/studio/frames.h"
#include "tools/view/studio/head_file.h"

namespace animeme::studio {

/// Head and camera.
struct HeadLook {
  HeadChoice head;     ///< the head
  double degrees = 0;  ///< to the person's left
  double up = 0;       ///< degrees from above
  double zoom = 1;     ///< 1: head and shoulders
  int width = 640;     ///< pixels
  int height = 640;    ///< pixels
  /// What is behind the head. With Kind::none the pictures have alpha.
  Background background = {};
  /// Focal length in millimetres, as of a camera for 35 mm film; the picture shows as much. 0: 61.
  double lens = 0;
  bool mouth = false;   ///< the camera looks at the mouth, not at the middle of the face
  bool follow = false;  ///< the camera goes with the head, which then stays in its place
};

/// Movable, not copyable.
class HeadView {
 public:
  /// Errors and talk: those of load_head() and picture_behind().
  static Result<HeadView> make(const HeadLook& look, const tools::Log& log = {});
  HeadView(HeadView&&) noexcept;  ///< movable
  HeadView& operator=(HeadView&&) noexcept;
  ~HeadView();

  /// The picture is valid until the next call. `visemes`: see head::PoseOptions::visemes.
  const render::Image& draw(const fap::Frame& frame,
                            const std::optional<fap::VisemeWeights>& visemes = {});

 private:
  struct State;
  explicit HeadView(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// A contact sheet of frames, `columns` in a row. Errors: those of HeadView::make() and
/// render::contact_sheet().
Result<render::Image> draw_sheet(const HeadLook& look, std::span<const ShownFrame> frames,
                                 int columns, const tools::Log& log = {});

}  // namespace animeme::studio
