#include "tools/view/studio/head_view.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "fap/head/rig.h"
#include "tools/view/render/png.h"
#include "tools/view/render/scene.h"

namespace animeme::studio {

struct HeadView::State {
  State(head::Head made, const HeadLook& look)
      : head(std::move(made)),
        rig(head::make_rig(head)),
        camera(render::fit_to(render::look_at(head, look.degrees, look.up, look.zoom), look.width,
                              look.height)),
        renderer({.width = look.width, .height = look.height}) {}

  head::Head head;
  head::Rig rig;
  render::Camera camera;
  render::Renderer renderer;
  head::Pose pose;
};

HeadView::HeadView(std::unique_ptr<State> state) : state_(std::move(state)) {}
HeadView::HeadView(HeadView&&) noexcept = default;
HeadView& HeadView::operator=(HeadView&&) noexcept = default;
HeadView::~HeadView() = default;

Result<HeadView> HeadView::make(const HeadLook& look, const tools::Log& log) {
  Result<head::Head> made = load_head(look.head, log);
  if (!made) return made.error();
  return HeadView(std::make_unique<State>(std::move(*made), look));
}

const render::Image& HeadView::draw(const fap::Frame& frame,
                                    const std::optional<fap::VisemeWeights>& visemes) {
  State& state = *state_;
  head::PoseOptions options;
  options.visemes = visemes;
  head::pose(state.rig, frame, state.pose, options);
  return state.renderer.render(render::scene_of(state.head, state.rig, state.pose), state.camera);
}

Result<render::Image> draw_sheet(const HeadLook& look, std::span<const ShownFrame> frames,
                                 int columns, const tools::Log& log) {
  Result<HeadView> view = HeadView::make(look, log);
  if (!view) return view.error();
  std::vector<render::Image> pictures;
  for (const ShownFrame& shown : frames) pictures.push_back(view->draw(shown.frame, shown.visemes));
  return render::contact_sheet(pictures, std::min(columns, int(pictures.size())));
}

}  // namespace animeme::studio
