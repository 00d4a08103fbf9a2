/// @file
/// A head, a camera and a renderer: frames in, pictures out.
#pragma once

#include <memory>
#include <string>

#include "fap/frame.h"
#include "fap/result.h"
#include "tools/commands/head_file.h"
#include "tools/render/image.h"

namespace animeme::tools {

/// How a head is looked at.
struct HeadLook {
  HeadChoice head;     ///< whose head
  double degrees = 0;  ///< to the person's left
  double up = 0;       ///< degrees from above
  double zoom = 1;     ///< 1: head and shoulders
  int width = 640;     ///< pixels
  int height = 640;    ///< pixels
};

/// Movable, not copyable.
class HeadView {
 public:
  /// Errors: those of load_head(). What it notes goes to standard error.
  static Result<HeadView> make(const HeadLook& look);
  HeadView(HeadView&&) noexcept;  ///< movable
  HeadView& operator=(HeadView&&) noexcept;
  ~HeadView();

  /// The picture is valid until the next call.
  const render::Image& draw(const fap::Frame& frame);

 private:
  struct State;
  explicit HeadView(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace animeme::tools
