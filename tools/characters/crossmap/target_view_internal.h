// Pictures of a target. Internal.
#pragma once

#include <memory>
#include <string>

#include "fap/result.h"
#include "tools/characters/crossmap/target.h"

namespace animeme::crossmap {

/// Draws a target; movable. Pictures are addresses with a PNG inside ("data:image/png;base64,...");
/// empty where there is nothing to draw.
class TargetView {
 public:
  /// `size`: pixels of both sides. Errors: those of studio::HeadView::make().
  static Result<TargetView> make(const Target& target, int size);
  TargetView(TargetView&&) noexcept;
  ~TargetView();

  bool draws() const;
  /// A key shape, as it was adjusted or guessed; `values` are those of its controls.
  Result<std::string> key(std::size_t index, const double* values);
  /// The target at these values of its controls.
  Result<std::string> values(const double* values);

 private:
  struct State;
  explicit TargetView(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace animeme::crossmap
