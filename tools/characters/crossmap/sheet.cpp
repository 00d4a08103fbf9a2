#include "tools/characters/crossmap/sheet.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "tools/characters/crossmap/target.h"
#include "tools/formats/common/text.h"
#include "tools/formats/common/xml.h"
#include "tools/formats/files/base64.h"
#include "tools/view/render/png.h"
#include "tools/view/render/raster.h"
#include "tools/view/studio/head_view.h"

namespace animeme::crossmap {

namespace {

// Draws a target; movable. Pictures are addresses with a PNG inside ("data:image/png;base64,...");
// empty where there is nothing to draw.
class TargetView {
 public:
  // `size`: pixels of both sides. Errors: those of studio::HeadView::make().
  static Result<TargetView> make(const Target& target, int size);
  TargetView(TargetView&&) noexcept;
  ~TargetView();

  bool draws() const;
  // A key shape, as it was adjusted or guessed; `values` are those of its controls.
  Result<std::string> key(std::size_t index, const double* values);
  // The target at these values of its controls.
  Result<std::string> values(const double* values);

 private:
  struct State;
  explicit TargetView(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

using head::Vec3;

Result<std::string> address_of(const render::Image& image) {
  const auto png = render::png_of(image);
  if (!png) return png.error();
  return "data:image/png;base64," + tools::base64_of(*png);
}

// What the camera of a mesh looks at: the part that its controls move most.
struct Aim {
  Vec3 middle;
  float size = 1;
};

Aim aim_of(const TargetMesh& mesh) {
  std::vector<float> moved(mesh.vertices.size(), 0.0f);
  for (const MeshControl& control : mesh.controls) {
    const float full = control.high > 2 ? 300.0f : 1.0f;  // FAP units
    for (const auto& [v, move] : control.moves) moved[v] = std::max(moved[v], length(move) * full);
  }
  const float most = *std::max_element(moved.begin(), moved.end());
  Vec3 low{1e9f, 1e9f, 1e9f}, high{-1e9f, -1e9f, -1e9f};
  for (std::size_t v = 0; v < moved.size(); ++v) {
    if (moved[v] < 0.3f * most) continue;
    const Vec3 p = mesh.vertices[v];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return {(low + high) * 0.5f, 1.25f * std::max({high.x - low.x, high.y - low.y, 1e-6f})};
}

struct TargetView::State {
  explicit State(const Target& target_, int size_)
      : target(target_), size(size_), renderer({.width = size_, .height = size_}) {}

  const Target& target;
  int size;
  std::optional<studio::HeadView> woman;
  render::Renderer renderer;
  Aim aim;
  std::vector<head::Triangle> triangles;
  std::vector<float> open_sky;

  // Imported meshes have either winding: what faces the camera is the outside.
  void prepare_mesh() {
    const TargetMesh& mesh = *target.mesh;
    aim = aim_of(mesh);
    const float near = 0.5f * aim.size;
    float forward = 0;
    for (const head::Triangle& t : mesh.triangles) {
      const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
      const Vec3 off = a - aim.middle;
      if (std::abs(off.x) < near && std::abs(off.y) < near) forward += cross(b - a, c - a).z;
    }
    triangles = mesh.triangles;
    if (forward < 0) {
      for (head::Triangle& t : triangles) std::swap(t[1], t[2]);
    }
    open_sky.assign(mesh.vertices.size(), 1.0f);
  }

  Result<std::string> draw_mesh(const std::vector<Vec3>& moves) {
    const TargetMesh& mesh = *target.mesh;
    // Ten units wide, before a camera that is made for heads in centimetres.
    const float scale = 10 / aim.size;
    std::vector<Vec3> places(mesh.vertices.size()), normals(mesh.vertices.size());
    for (std::size_t v = 0; v < places.size(); ++v) {
      places[v] = (mesh.vertices[v] + moves[v] - aim.middle) * scale;
    }
    for (const head::Triangle& t : triangles) {
      const Vec3 n = cross(places[t[1]] - places[t[0]], places[t[2]] - places[t[0]]);
      for (const std::uint32_t v : t) normals[v] += n;
    }
    for (Vec3& n : normals) n = normalised(n);
    render::Scene scene;
    scene.surfaces.push_back({places, normals, mesh.colours, open_sky, triangles,
                              head::SurfaceKind::skin, head::Transform{}});
    render::Camera camera;
    camera.eye = {0, 0, 60};
    camera.view_angle = float(2 * std::atan(5.0 / 60));
    return address_of(renderer.render(scene, camera));
  }
};

TargetView::TargetView(std::unique_ptr<State> state) : state_(std::move(state)) {}
TargetView::TargetView(TargetView&&) noexcept = default;
TargetView::~TargetView() = default;

Result<TargetView> TargetView::make(const Target& target, int size) {
  auto state = std::make_unique<State>(target, size);
  if (target.mesh) {
    state->prepare_mesh();
  } else if (target.kind != TargetKind::keys &&
             shown_faps(target, target.values.data()).has_value()) {
    studio::HeadLook look;
    look.zoom = 2.4;
    look.width = look.height = size;
    auto woman = studio::HeadView::make(look);
    if (!woman) return woman.error();
    state->woman = std::move(*woman);
  }
  return TargetView(std::move(state));
}

bool TargetView::draws() const { return state_->woman || state_->target.mesh; }

Result<std::string> TargetView::key(std::size_t index, const double* controls) {
  if (state_->target.mesh) return state_->draw_mesh(state_->target.mesh_keys[index]);
  return values(controls);
}

Result<std::string> TargetView::values(const double* controls) {
  const Target& target = state_->target;
  if (target.mesh) {
    std::vector<Vec3> moves(target.mesh->vertices.size());
    for (std::size_t c = 0; c < target.mesh->controls.size(); ++c) {
      for (const auto& [v, move] : target.mesh->controls[c].moves) {
        moves[v] += move * float(controls[c]);
      }
    }
    return state_->draw_mesh(moves);
  }
  if (!state_->woman) return std::string();
  return address_of(state_->woman->draw(shown_faps(target, controls).value_or(fap::Frame{})));
}

constexpr int kCell = 170, kPoints = 130, kText = 34, kColumns = 6, kMargin = 16, kRowGap = 12;
constexpr std::size_t kMostKeys = 48;
constexpr const char *kRest = "#b8b8b8", *kCaptured = "#0072b2", *kFitted = "#d55e00";

struct Spot {
  double x = 0, y = 0;
};

// Places in the plane of the face, as one sees a person: their left is on the right.
class Projection {
 public:
  explicit Projection(const Mapped& mapped)
      : dimensions_(mapped.capture.tracks[0].dimensions), neutral_(mapped.capture.neutral) {
    if (mapped.capture.face) {
      left_ = mapped.capture.face->axes.of[0];
      up_ = mapped.capture.face->axes.of[1];
    } else {
      left_ = {1, 0, 0};
      up_ = {0, dimensions_ == 2 ? -1.0 : 1.0, 0};  // rows of a picture count downwards
    }
    // All key shapes have to fit.
    const auto& keys = mapped.keys.shapes;
    const std::size_t size = neutral_.size();
    Spot low{1e300, 1e300}, high{-1e300, -1e300};
    for (std::size_t k = 0; k <= keys.names.size(); ++k) {
      const double* shape = k == 0 ? nullptr : &keys.values[(k - 1) * size];
      for (std::size_t p = 0; p < size / dimensions_; ++p) {
        const Spot s = flat(shape, p);
        low = {std::min(low.x, s.x), std::min(low.y, s.y)};
        high = {std::max(high.x, s.x), std::max(high.y, s.y)};
      }
    }
    const double wide = std::max({high.x - low.x, 1e-9}), tall = std::max(high.y - low.y, 1e-9);
    scale_ = std::min((kCell - 24) / wide, (kPoints - 20) / tall);
    middle_ = {(low.x + high.x) / 2, (low.y + high.y) / 2};
  }

  /// In a cell of kCell x kPoints; `shape`: displacement, nullptr: neutral.
  Spot at(const double* shape, std::size_t point) const {
    const Spot s = flat(shape, point);
    return {kCell / 2.0 + (s.x - middle_.x) * scale_, kPoints / 2.0 + (s.y - middle_.y) * scale_};
  }
  std::size_t points() const { return neutral_.size() / dimensions_; }

 private:
  Spot flat(const double* shape, std::size_t point) const {
    Spot out;
    for (std::size_t k = 0; k < dimensions_; ++k) {
      const std::size_t i = point * dimensions_ + k;
      const double place = neutral_[i] + (shape == nullptr ? 0 : shape[i]);
      out.x += left_[k] * place;
      out.y -= up_[k] * place;
    }
    return out;
  }

  std::size_t dimensions_;
  const std::vector<double>& neutral_;
  fap::Point left_{}, up_{};
  double scale_ = 1;
  Spot middle_;
};

std::string circle(Spot at, double radius, const char* fill, const char* stroke) {
  return tools::format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"%s\" stroke=\"%s\"/>\n",
                       at.x, at.y, radius, fill, stroke);
}

// Captured points, the way they went from rest, and where `fitted` puts them (nullptr: not drawn).
std::string drawn(const Projection& projection, const double* shape, const double* fitted) {
  std::string out;
  for (std::size_t p = 0; p < projection.points(); ++p) {
    const Spot rest = projection.at(nullptr, p), at = projection.at(shape, p);
    out += circle(rest, 1.2, kRest, "none");
    if (!std::isfinite(at.x + at.y)) continue;
    out += tools::format(
        "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\" "
        "stroke-width=\"0.7\"/>\n",
        rest.x, rest.y, at.x, at.y, kRest);
    out += circle(at, 2, kCaptured, "none");
    if (fitted != nullptr) out += circle(projection.at(fitted, p), 3.2, "none", kFitted);
  }
  return out;
}

// One column of the sheet: two lines of text, the points, the target.
std::string cell(std::size_t place, int top, int target, const std::string& title,
                 const std::string& subtitle, const std::string& points, const std::string& png) {
  const int x = kMargin + int(place % kColumns) * kCell;
  const int y = top + int(place / kColumns) * (kText + kPoints + target + kRowGap);
  std::string out = tools::format("<g transform=\"translate(%d %d)\">\n", x, y);
  out += tools::format("<text x=\"%d\" y=\"13\" font-weight=\"bold\">", kCell / 2) +
         tools::escape_xml(title) + "</text>\n";
  out += tools::format("<text x=\"%d\" y=\"27\" fill=\"#555\" font-size=\"10\">", kCell / 2) +
         tools::escape_xml(subtitle) + "</text>\n";
  out += tools::format("<g transform=\"translate(0 %d)\">\n", kText) + points + "</g>\n";
  if (!png.empty()) {
    out += tools::format("<image x=\"5\" y=\"%d\" width=\"%d\" height=\"%d\" href=\"",
                         kText + kPoints, kCell - 10, kCell - 10);
    out += png + "\"/>\n";
  }
  return out + "</g>\n";
}

// Frames of the first recording: the worst, and others evenly between its ends.
std::vector<std::size_t> frames_of(const Mapped& mapped) {
  const std::size_t frames = mapped.takes[0].blend.measured.size();
  std::size_t worst = 0;
  double most = -1;
  for (std::size_t r = 0; r < mapped.capture.regions.size(); ++r) {
    const RegionResidual residual = region_residual(mapped, 0, r);
    if (residual.worst <= most) continue;
    most = residual.worst;
    worst = residual.frame;
  }
  std::vector<std::size_t> out = {worst};
  for (std::size_t i = 1; i < std::size_t(kColumns); ++i) out.push_back(frames * i / kColumns);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

int rows_of(std::size_t cells) { return int((cells + kColumns - 1) / kColumns); }

}  // namespace

Result<std::string> sheet_svg(const Mapped& mapped) {
  Result<TargetView> view = TargetView::make(mapped.target, kCell * 2);
  if (!view) return view.error();
  const Projection projection(mapped);
  const dam::KeyShapes& keys = mapped.keys.shapes;
  const dam::PointTrack& track = mapped.capture.tracks[0];
  const std::size_t shapes = std::min(keys.names.size(), kMostKeys);
  const std::size_t controls = mapped.target.character.controls.size();
  const int target = view->draws() ? kCell : 0;
  const std::vector<std::size_t> frames = frames_of(mapped);
  const int first = kMargin + 26, row = kText + kPoints + target + kRowGap;
  const int second = first + rows_of(shapes) * row + 26;

  std::string body;
  const auto heading = [&](int y, const std::string& text) {
    body += tools::format("<text x=\"%d\" y=\"%d\" text-anchor=\"start\" font-size=\"15\">",
                          kMargin, y) +
            tools::escape_xml(text) + "</text>\n";
  };
  heading(kMargin + 12, "Key shapes: captured (blue, from rest in grey)" +
                            std::string(target > 0 ? " and on the target" : ""));
  for (std::size_t k = 0; k < shapes; ++k) {
    const KeySource& source = mapped.keys.sources[k];
    std::string from = tools::format("%s %.2f s", source.input.c_str(), source.seconds);
    if (source.share > 0) from += tools::format(", %.0f %%", 100 * source.share);
    const auto png = view->key(k, &mapped.target.values[k * controls]);
    if (!png) return png.error();
    body += cell(k, first, target, keys.names[k] + (mapped.target.adjusted[k] ? " (adjusted)" : ""),
                 from, drawn(projection, &keys.values[k * track.size()], nullptr), *png);
  }
  heading(second - 14, track.name + ": frames captured (blue), fitted (orange)" +
                           std::string(target > 0 ? ", on the target" : ""));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::size_t frame = frames[i];
    const auto fitted = dam::blended(mapped.takes[0].blend, keys, frame);
    const auto png = view->values(&mapped.takes[0].retarget.signal.values[frame * controls]);
    if (!png) return png.error();
    double worst = 0;
    for (std::size_t r = 0; r < mapped.capture.regions.size(); ++r) {
      const double value =
          mapped.takes[0].blend.residuals[frame * mapped.capture.regions.size() + r];
      if (std::isfinite(value)) worst = std::max(worst, value);
    }
    body += cell(i, second, target, tools::format("%.2f s", track.rate.seconds(double(frame))),
                 tools::format("residual %.3g %s", worst, mapped.capture.unit.c_str()),
                 drawn(projection, track.frame(frame).data(), fitted.data()), *png);
  }
  const int width = 2 * kMargin + kColumns * kCell, height = second + row + kMargin;
  return tools::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
             "viewBox=\"0 0 %d %d\" font-family=\"sans-serif\" font-size=\"12\" "
             "text-anchor=\"middle\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
             width, height, width, height) +
         body + "</svg>\n";
}

}  // namespace animeme::crossmap
