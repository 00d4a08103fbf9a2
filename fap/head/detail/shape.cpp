#include "fap/head/detail/shape.h"

namespace animeme::head::detail {
namespace {

constexpr double kEyeDepth = 2.11;  // before the ears, in half distances of the pupils

// Skull, jaw and neck.
void add_bones(Form& form, const HeadParameters& p) {
  const double chin = -p.chin_drop;
  form.ball({0, 3.4, -0.4}, {p.skull_width, p.skull_height, 9.0}, 0);
  form.ball({0, 3.3, 2.4}, {p.skull_width * 0.84, 5.4, 6.5}, 2.0);
  form.ball({0, 0.23 * chin, 2.6}, {p.face_width, 0.76 * p.chin_drop, 6.0}, 2.0);
  form.ball({0, chin + 3.5, 3.4}, {p.jaw_width * 1.24, 3.2, 4.7}, 2.2);
  form.ball({0, chin + p.chin_size, 8.15}, {p.chin_size * 1.12, p.chin_size, 1.5}, 1.5);
  // The bone of the jaw, from the chin to below the ear.
  form.limb({p.chin_size * 0.75, chin + 1.25, 7.1}, {p.jaw_width * 1.24, chin + 4.8, 0.9}, 0.7,
            0.55, 1.6);
  // The neck is narrower below the jaw than at the shoulders.
  form.limb({0, chin + 5.5, -1.1}, {0, -20, -3.6}, p.neck * 0.93, p.neck * 1.13, 1.2);
}

void add_flesh(Form& form, const HeadParameters& p) {
  form.ball({3.6, -0.29 * p.chin_drop, 5.7}, {p.cheek, p.cheek * 0.9, p.cheek}, 1.9);
  form.ball({0, -p.mouth_drop + 0.15, 7.2}, {2.45, 0.98 * (p.mouth_drop - p.nose_length), 2.12},
            1.8);
  // Between the lower lip and the chin.
  form.hollow({0, -p.mouth_drop - 0.55 * (p.chin_drop - p.mouth_drop), 9.75}, {1.5, 0.35, 0.42},
              0.9);
  if (p.brow_ridge > 0) {
    form.limb({0.9, 1.75, 8.0}, {4.6, 1.75, 6.2}, 0.55 + p.brow_ridge, 0.5 + p.brow_ridge, 1.3);
  }
}

// Bone and cartilage from the brows to the tip, the wings beside it, the bridge of skin between
// the nostrils, and these.
void add_nose(Form& form, const HeadParameters& p) {
  const double tip = -p.nose_length;
  const double r = p.nose_size;
  form.limb({0, 0.2, 7.7 + p.nose_bridge}, {0, tip + 0.3, 10.0}, 0.58, r * 0.78, 1.3);
  form.ball({0, tip, 10.3}, {r * 0.92, r * 0.84, r * 0.95}, 0.5);
  form.ball({r * 1.2, tip - 0.18, 9.35}, {r * 0.52, r * 0.6, r * 0.95}, 0.62);
  form.limb({0, tip - r * 0.5, 10.1}, {0, tip - r * 1.1, 9.05}, r * 0.34, r * 0.38, 0.3);
  form.hollow(nostril(p), {r * 0.36, r * 0.42, r * 0.55}, 0.16);
}

}  // namespace

Vec3d nostril(const HeadParameters& p) {
  return {p.nose_size * 0.78, -p.nose_length - p.nose_size * 0.9, 9.4};
}

Shape::Shape(const HeadParameters& parameters) : p(parameters) {
  eye = {p.eye_distance, 0, kEyeDepth * p.eye_distance};
  lid = p.eye_radius + 0.15;
  jaw_axis = {0, -2.4, 0.6};
  neck_pivot = {0, -6.2, -2.2};
  add_bones(skin, p);
  add_flesh(skin, p);
  skin.hollow({eye.x + 0.1, 0.2, 9.5}, {2.2, 1.4, 1.6}, 1.7);
  skin.ball(eye, {lid, lid, lid}, 0.75);
  add_nose(skin, p);
  // Between nose and upper lip.
  const double groove = 0.5 * (upper_lip(0) + nose_base());
  // It is shallow in children, whose nose is near to the mouth.
  const double grown = std::clamp((p.mouth_drop - p.nose_length - 2.2) / 0.3, 0.0, 1.0);
  skin.hollow({0, groove, front(0, groove).z + 0.30},
              {0.26, 0.44 + 0.18 * grown, 0.32 + 0.04 * grown}, 0.4 + 0.05 * grown);
  // From the height of the eyes to that of the nose, as tall as its size says.
  const auto side = [this](double y) { return outer_hit(skin, {0, y, -0.3}, {1, 0, 0}, 14); };
  const double half = 2.1 * p.ear;
  ear = side(0.9 - half);
  ear_lean = (side(0.9).x - side(0.9 - 2 * half).x) / (2 * half);
}

double Shape::upper_lid(double x) const {
  const double q = (x - eye.x) / (p.eye_width / 2);
  const double shifted = std::clamp(q + 0.10 * (1 - q * q), -1.0, 1.0);
  const double arch = std::pow(std::max(1 - std::pow(std::abs(shifted), 2.4), 0.0), 0.72);
  return p.eye_opening * 0.5 * arch + 0.11 * std::clamp(q, -1.2, 1.2);
}

double Shape::lower_lid(double x) const {
  const double q = (x - eye.x) / (p.eye_width / 2);
  const double shifted = std::clamp(q - 0.08 * (1 - q * q), -1.0, 1.0);
  const double arch = std::pow(std::max(1 - shifted * shifted, 0.0), 0.85);
  return -p.eye_opening * 0.5 * arch + 0.11 * std::clamp(q, -1.2, 1.2);
}

double Shape::crease(double x) const {
  const double q = (x - eye.x) / (p.eye_width / 2);
  return p.eye_opening * 0.5 * (1 - 0.55 * q * q) + 0.42 + 0.1 * q;
}

double Shape::lip_line(double x) const {
  const double t = x / p.mouth_width;
  const double dip = 0.07 * std::exp(-std::pow(t / 0.22, 2)) - 0.05;
  return -p.mouth_drop - dip + p.smile * std::pow(std::min(std::abs(t), 1.3), 3.0);
}

double Shape::upper_lip(double x) const {
  const double t = std::min(x / (p.mouth_width * 1.09), 1.0);
  const double bow =
      0.10 * std::exp(-std::pow((t - 0.2) / 0.14, 2)) - 0.05 * std::exp(-std::pow(t / 0.1, 2));
  const double arch = 0.66 * std::pow(1 - std::pow(t, 1.7), 0.85) + bow;
  return lip_line(x) + p.lip_fullness * std::max(arch, 0.0) + 0.025;
}

double Shape::lower_lip(double x) const {
  const double t = std::min(x / (p.mouth_width * 1.06), 1.0);
  const double arch = 0.84 * std::pow(1 - std::pow(t, 2.6), 0.72);
  // The dip of the contact line would be a keel here.
  const double level = 0.05 * std::exp(-std::pow(t / 0.22, 2));
  return lip_line(x) + level - p.lip_fullness * arch - 0.025;
}

double Shape::lip_body(double x) const {
  const double t = std::min(x / (p.mouth_width * 1.05), 1.0);
  return std::pow(std::max(1 - t * t, 0.0), 0.6);
}

Vec3d Shape::brow(double t) const {
  const double x = 1.25 + t * 3.75;
  const double arch = 0.36 * std::sin(3.14159265 * std::pow(t, 1.25)) - 0.18 * t * t;
  return front(x, p.brow_height + arch - 0.04);
}

Vec3d Shape::front(double x, double y) const { return outer_hit(skin, {x, y, 0}, {0, 0, 1}, 14); }

}  // namespace animeme::head::detail
