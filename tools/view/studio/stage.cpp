#include "tools/view/studio/stage.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "tools/view/render/raster.h"

namespace animeme::studio {

namespace {

// Each gets a picture that is so much wider than its share, so that shoulders are not cut off.
constexpr double kWider = 1.3;

// The face at `seconds`: between two frames, in proportion.
fap::Frame face_at(const fap::Sequence& clip, double seconds) {
  const double at = seconds * clip.rate.frames_per_second();
  const auto last = clip.frames.size() - 1;
  // A picture that falls on a frame shows it exactly.
  const auto index = std::size_t(std::clamp(std::floor(at + 1e-6), 0.0, double(last)));
  fap::Frame frame = clip.frames[index];
  const double share = at - double(index);
  if (index == last || share < 1e-3 || frame.mask[1]) return frame;
  const fap::Frame& next = clip.frames[index + 1];
  const auto between = [share](std::int32_t a, std::int32_t b) {
    return std::int32_t(std::lround(a + share * (double(b) - a)));
  };
  fap::Expression& mood = frame.expression;
  if (mood.select1 == next.expression.select1) {
    mood.intensity1 = between(mood.intensity1, next.expression.intensity1);
  }
  if (mood.select2 == next.expression.select2) {
    mood.intensity2 = between(mood.intensity2, next.expression.intensity2);
  }
  for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    frame.value[fap] = between(frame.value[fap], next.value[fap]);
  }
  return frame;
}

// What is said there, likewise.
std::optional<fap::VisemeWeights> said_at(std::span<const fap::VisemeWeights> visemes,
                                          const fap::Rate& rate, double seconds) {
  if (visemes.empty()) return std::nullopt;
  const auto last = visemes.size() - 1;
  const double at = std::clamp(seconds * rate.frames_per_second(), 0.0, double(last));
  const auto index = std::size_t(at + 1e-6);
  fap::VisemeWeights weights = visemes[index];
  const double share = at - double(index);
  if (index == last || share < 1e-3) return weights;
  for (std::size_t v = 0; v < weights.size(); ++v) {
    weights[v] += share * (visemes[index + 1][v] - weights[v]);
  }
  return weights;
}

// A picture of one over that of all, from column `left` on. Both may have alpha, which is not
// multiplied into the colours.
void put_over(const render::Image& one, int left, render::Image& all) {
  for (int y = 0; y < one.height; ++y) {
    for (int x = std::max(0, -left); x < std::min(one.width, all.width - left); ++x) {
      const std::uint8_t* from = &one.rgba[std::size_t(y * one.width + x) * 4];
      std::uint8_t* to = &all.rgba[std::size_t(y * all.width + left + x) * 4];
      const int alpha = from[3], below = to[3] * (255 - alpha) / 255, sum = alpha + below;
      if (alpha == 0) continue;
      for (int k = 0; k < 3; ++k) {
        to[k] = std::uint8_t((from[k] * alpha + to[k] * below + sum / 2) / sum);
      }
      to[3] = std::uint8_t(sum);
    }
  }
}

// What is behind all of them.
Result<render::Image> whole_background(const HeadLook& look) {
  render::Image image{look.width, look.height, {}};
  if (look.background.kind == Background::Kind::none) {
    image.rgba.assign(std::size_t(look.width) * std::size_t(look.height) * 4, 0);
    return image;
  }
  auto behind = picture_behind(look.background, look.width, look.height);
  if (!behind) return behind.error();
  render::RenderOptions options{.width = look.width, .height = look.height};
  if (look.background.kind == Background::Kind::colour)
    options.background_top = options.background_bottom = look.background.colour;
  options.background = std::move(*behind);
  return render::render({}, {}, options);
}

}  // namespace

double turned_to_others(std::size_t number, std::size_t count, double degrees) {
  if (count < 2) return 0;
  return degrees * (2 * double(number) / double(count - 1) - 1);
}

struct Stage::State {
  std::vector<StagePerson> people;
  std::vector<HeadView> views;  // of each
  int width = 0;                // of each view
  render::Image background;     // of several
  render::Image image;          // likewise
};

Stage::Stage(std::unique_ptr<State> state) : state_(std::move(state)) {}
Stage::Stage(Stage&&) noexcept = default;
Stage& Stage::operator=(Stage&&) noexcept = default;
Stage::~Stage() = default;

Result<Stage> Stage::make(const HeadLook& look, std::vector<StagePerson> people,
                          const tools::Log& log) {
  if (people.empty()) return make_error(Code::invalid_argument, "there is nobody to show");
  auto state = std::make_unique<State>();
  const bool several = people.size() > 1;
  HeadLook own = look;
  if (several) {
    auto background = whole_background(look);
    if (!background) return background.error();
    state->background = std::move(*background);
    own.background.kind = Background::Kind::none;
    own.width = std::min(look.width, int(kWider * look.width / double(people.size())));
  }
  state->width = own.width;
  for (const StagePerson& person : people) {
    if (person.clip == nullptr || person.clip->frames.empty()) {
      return make_error(Code::invalid_argument, "a clip has no frames");
    }
    own.head = person.head;
    own.degrees = look.degrees + person.turned;
    auto view = HeadView::make(own, log);
    if (!view) return view.error();
    state->views.push_back(std::move(*view));
  }
  state->people = std::move(people);
  return Stage(std::move(state));
}

const render::Image& Stage::draw(double seconds) {
  State& state = *state_;
  const auto drawn = [&](std::size_t i) -> const render::Image& {
    const StagePerson& person = state.people[i];
    return state.views[i].draw(face_at(*person.clip, seconds),
                               said_at(person.visemes, person.clip->rate, seconds));
  };
  if (state.people.size() == 1) return drawn(0);
  state.image = state.background;
  const double share = double(state.image.width) / double(state.people.size());
  for (std::size_t i = 0; i < state.people.size(); ++i) {
    const double middle = (double(i) + 0.5) * share;
    put_over(drawn(i), int(std::lround(middle - state.width / 2.0)), state.image);
  }
  return state.image;
}

}  // namespace animeme::studio
