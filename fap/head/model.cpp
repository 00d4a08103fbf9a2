#include "fap/head/model.h"

#include "fap/head/detail/assemble.h"

namespace animeme::head {

const std::array<std::string_view, kPartCount> kPartNames = {
    "skin",   "left_eye", "right_eye", "upper_teeth", "lower_teeth",
    "tongue", "hair",     "brows",     "lashes",      "body"};

FeaturePoint Head::point(std::string_view id) const {
  for (std::size_t i = 0; i < fap::kFeaturePoints.size(); ++i) {
    if (fap::kFeaturePoints[i].id == id) return feature_points[i];
  }
  return {};
}

Vec3 chin_of(const Head& head) {
  if (head.point("2.1").exists()) return head.at("2.1");
  return Vec3{0, -1.75f, 1.1f} * float(head.fapu.es);  // on usual heads
}

Vec3 Head::at(std::string_view id) const {
  if (id == "7.1") return neck_pivot;
  const FeaturePoint found = point(id);
  return found.exists() ? part(found.part).positions[found.vertex] : Vec3{};
}

namespace {

using detail::Shape;
using detail::Skin;

std::optional<Error> check(const HeadParameters& p) {
  const struct {
    std::string_view name;
    double value;
    bool may_be_zero = false;
  } sizes[] = {{"scale", p.scale},
               {"skull_width", p.skull_width},
               {"skull_height", p.skull_height},
               {"face_width", p.face_width},
               {"jaw_width", p.jaw_width},
               {"chin_drop", p.chin_drop},
               {"chin_size", p.chin_size},
               {"cheek", p.cheek},
               {"brow_ridge", p.brow_ridge, true},
               {"neck", p.neck},
               {"eye_distance", p.eye_distance},
               {"eye_radius", p.eye_radius},
               {"eye_opening", p.eye_opening},
               {"eye_width", p.eye_width},
               {"iris", p.iris},
               {"nose_length", p.nose_length},
               {"nose_size", p.nose_size},
               {"nose_bridge", p.nose_bridge, true},
               {"mouth_drop", p.mouth_drop},
               {"mouth_width", p.mouth_width},
               {"lip_fullness", p.lip_fullness},
               {"smile", p.smile, true},
               {"brow_height", p.brow_height},
               {"brow_thickness", p.brow_thickness},
               {"ear", p.ear},
               {"lashes", p.lashes, true},
               {"lines", p.lines, true},
               {"freckles", p.freckles, true}};
  for (const auto& size : sizes) {
    const bool good = std::isfinite(size.value) &&
                      (size.may_be_zero ? size.value >= 0 : size.value > 0) && size.value < 100;
    if (!good) {
      return make_error(Code::invalid_argument, "head parameter " + std::string(size.name) +
                                                    " is " + std::to_string(size.value) +
                                                    " but has to be a positive size in cm");
    }
  }
  if (!(p.density >= 0.5 && p.density <= 2)) {
    return make_error(Code::invalid_argument, "the density of a head has to be from 0.5 to 2");
  }
  return std::nullopt;
}

Eye eye_of(const Shape& shape, int side) {
  return {Vec3(Vec3d{shape.eye.x * side, shape.eye.y, shape.eye.z}), float(shape.p.eye_radius),
          float(shape.p.iris), float(shape.p.iris * 0.4)};
}

fap::Fapu measure(const Head& head) {
  fap::FeaturePoints points;
  for (const fap::FeaturePointInfo& info : fap::kFeaturePoints) {
    const Vec3 p = head.at(info.id);
    points[std::string(info.id)] = {p.x, p.y, p.z};
  }
  const Result<fap::Fapu> fapu = fap::measure_fapu(points);
  return fapu ? *fapu : fap::Fapu{};
}

void enlarge(Head& head, float scale) {
  for (Mesh& mesh : head.parts) {
    for (Vec3& p : mesh.positions) p *= scale;
  }
  for (Eye& eye : head.eyes) {
    eye = {eye.centre * scale, eye.radius * scale, eye.iris_radius * scale,
           eye.pupil_radius * scale};
  }
  head.jaw_axis *= scale;
  head.neck_pivot *= scale;
}

}  // namespace

Result<Head> make_head(const HeadParameters& parameters) {
  if (auto error = check(parameters)) return std::move(*error);
  const Shape shape(parameters);
  Skin skin = detail::make_skin(shape, parameters.density);
  Head head;
  head.name = parameters.name;
  head.jaw_axis = Vec3(shape.jaw_axis);
  head.neck_pivot = Vec3(shape.neck_pivot);
  head.eyes = {eye_of(shape, 1), eye_of(shape, -1)};
  head.part(Part::skin) = skin.mesh;
  const detail::EarVertices ears = detail::add_ears(shape, head.part(Part::skin));
  head.part(Part::left_eye) = detail::make_eye(shape, 1);
  head.part(Part::right_eye) = detail::make_eye(shape, -1);
  head.part(Part::upper_teeth) = detail::make_teeth(shape, true);
  head.part(Part::lower_teeth) = detail::make_teeth(shape, false);
  head.part(Part::tongue) = detail::make_tongue(shape);
  head.part(Part::hair) = detail::make_hair(shape);
  detail::add_glasses(shape, head.part(Part::hair));
  head.part(Part::brows) = detail::make_brows(shape);
  head.part(Part::lashes) = detail::make_lashes(shape, skin, head.lash_anchors);
  head.part(Part::body) = detail::make_body(shape);
  detail::shade_parts(shape, skin, head);
  const std::size_t vertices = head.part(Part::skin).positions.size();
  detail::weigh_lids(shape, skin, vertices);
  skin.seams.jaw_weights.resize(vertices, 0);
  skin.seams.freedom = detail::freedom_below_hair(shape, head.part(Part::skin));
  detail::find_feature_points(shape, skin, ears, head);
  head.seams = std::move(skin.seams);
  enlarge(head, float(parameters.scale));
  head.fapu = measure(head);
  return head;
}

}  // namespace animeme::head
