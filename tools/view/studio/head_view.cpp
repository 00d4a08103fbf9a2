#include "tools/view/studio/head_view.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "fap/head/rig.h"
#include "tools/view/render/png.h"
#include "tools/view/render/scene.h"

namespace animeme::studio {

namespace {

// Upright pictures see more of the head than others, and would see the lower edge of its bust. So
// their camera stands higher, by this share of what is seen more.
constexpr float kRise = 0.75f;

void move(render::Camera& camera, const head::Vec3& by) {
  camera.eye += by;
  camera.target += by;
}

// The middle of the lips where they touch: of their two contact points.
head::Vec3 mouth_of(const head::Head& head, const head::Vec3& otherwise) {
  if (!head.point("2.2").exists() || !head.point("2.3").exists()) return otherwise;
  return (head.at("2.2") + head.at("2.3")) * 0.5f;
}

// As much at the target from nearer or from further away: of film for photographs, 24 mm are high.
void set_lens(render::Camera& camera, double millimetres) {
  constexpr double kHalfHeight = 12;
  const double tangent = kHalfHeight / millimetres;
  const double ratio = std::tan(camera.view_angle / 2.0) / tangent;
  camera.eye = camera.target + (camera.eye - camera.target) * float(ratio);
  camera.view_angle = float(2 * std::atan(tangent));
}

render::Camera camera_of(const head::Head& head, const HeadLook& look) {
  render::Camera usual = render::look_at(head, look.degrees, look.up, look.zoom);
  if (look.mouth) move(usual, mouth_of(head, usual.target) - usual.target);
  render::Camera camera = render::fit_to(usual, look.width, look.height);
  const float more = std::tan(camera.view_angle / 2) - std::tan(usual.view_angle / 2);
  const head::Vec3 rise = camera.up * (kRise * more * length(camera.eye - camera.target));
  if (!look.mouth) move(camera, rise);
  if (look.lens > 0) set_lens(camera, look.lens);
  return camera;
}

render::RenderOptions options_of(const HeadLook& look,
                                 std::shared_ptr<const render::Image> behind) {
  render::RenderOptions options{.width = look.width, .height = look.height};
  if (look.background.kind == Background::Kind::colour)
    options.background_top = options.background_bottom = look.background.colour;
  options.background = std::move(behind);
  options.transparent = look.background.kind == Background::Kind::none;
  return options;
}

}  // namespace

struct HeadView::State {
  State(head::Head made, const HeadLook& look, std::shared_ptr<const render::Image> behind)
      : head(std::move(made)),
        rig(head::make_rig(head)),
        camera(camera_of(head, look)),
        follow(look.follow),
        renderer(options_of(look, std::move(behind))) {}

  head::Head head;
  head::Rig rig;
  render::Camera camera;
  bool follow;
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
  auto behind = picture_behind(look.background, look.width, look.height);
  if (!behind) return behind.error();
  return HeadView(std::make_unique<State>(std::move(*made), look, std::move(*behind)));
}

const render::Image& HeadView::draw(const fap::Frame& frame,
                                    const std::optional<fap::VisemeWeights>& visemes) {
  State& state = *state_;
  head::PoseOptions options;
  options.visemes = visemes;
  head::pose(state.rig, frame, state.pose, options);
  render::Camera camera = state.camera;
  if (state.follow) move(camera, state.pose.head(camera.target) - camera.target);
  return state.renderer.render(render::scene_of(state.head, state.rig, state.pose), camera);
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
