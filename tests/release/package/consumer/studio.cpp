// A head of ours on a picture.
#include <animeme/studio/head_view.h>

int main() {
  animeme::studio::HeadLook look;
  look.width = look.height = 16;
  auto view = animeme::studio::HeadView::make(look);
  return view && view->draw({}).width == 16 ? 0 : 1;
}
