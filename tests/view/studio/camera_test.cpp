// Where the camera of a picture looks, from how far away, and whether it goes with the head.
#include <gtest/gtest.h>

#include <cmath>

#include "fap/frame.h"
#include "tools/view/studio/head_view.h"

namespace animeme::studio {
namespace camera_test {

constexpr int kSide = 128;

HeadLook look_of(const HeadLook& from) {
  HeadLook look = from;
  look.head.head = "woman";
  look.width = look.height = kSide;
  look.background.kind = Background::Kind::none;
  return look;
}

render::Image drawn(const HeadLook& look, const fap::Frame& frame = {}) {
  auto view = HeadView::make(look_of(look));
  EXPECT_TRUE(view) << view.error().message;
  return view->draw(frame);
}

// Where something of the head is, in the upper half, where no shoulders are.
struct Extent {
  int left = kSide, right = 0, top = kSide;
  double middle() const { return 0.5 * (left + right); }
};

Extent extent_of(const render::Image& image) {
  Extent extent;
  for (int y = 0; y < kSide / 2; ++y) {
    for (int x = 0; x < kSide; ++x) {
      if (image.rgba[std::size_t(y * kSide + x) * 4 + 3] < 128) continue;
      extent.left = std::min(extent.left, x);
      extent.right = std::max(extent.right, x);
      extent.top = std::min(extent.top, y);
    }
  }
  return extent;
}

// Red by green in the middle of the picture.
double redness(const render::Image& image) {
  double red = 0, green = 0;
  for (int y = kSide / 2 - 4; y < kSide / 2 + 4; ++y) {
    for (int x = kSide / 2 - 4; x < kSide / 2 + 4; ++x) {
      const std::uint8_t* p = &image.rgba[std::size_t(y * kSide + x) * 4];
      red += p[0];
      green += p[1];
    }
  }
  return red / std::max(green, 1.0);
}

TEST(PictureCamera, LooksAtTheMouthFromAnySide) {
  for (const double degrees : {0.0, 35.0, 60.0}) {
    const double face = redness(drawn({.degrees = degrees, .zoom = 6}));
    const double mouth = redness(drawn({.degrees = degrees, .zoom = 6, .mouth = true}));
    EXPECT_GT(mouth, 1.2 * face) << degrees;  // lips, not skin
  }
}

TEST(PictureCamera, AnotherLensShowsAsMuch) {
  const Extent usual = extent_of(drawn({}));
  const Extent same = extent_of(drawn({.lens = 60.9}));
  const Extent wide = extent_of(drawn({.lens = 24}));
  const Extent far = extent_of(drawn({.lens = 300}));
  EXPECT_NEAR(same.right - same.left, usual.right - usual.left, 1);
  EXPECT_NEAR(wide.right - wide.left, usual.right - usual.left, 12);
  // From nearby, what is far behind the face is smaller: the hair at the sides.
  EXPECT_LT(wide.right - wide.left, far.right - far.left);
}

TEST(PictureCamera, GoesWithTheHead) {
  fap::Frame bent;
  bent.set(50, 30000);  // AU: rolled by 17 degrees, which moves the head to the side
  const double rest = extent_of(drawn({})).middle();
  const double moved = extent_of(drawn({}, bent)).middle();
  const double followed = extent_of(drawn({.follow = true}, bent)).middle();
  EXPECT_GT(std::abs(moved - rest), 8);
  EXPECT_LT(std::abs(followed - rest), 0.5 * std::abs(moved - rest));
}

}  // namespace camera_test
}  // namespace animeme::studio
