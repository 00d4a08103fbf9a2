#include "fap/head/detail/shape.h"

namespace animeme::head::detail {
namespace {

constexpr double kEyeDepth = 6.75;

// Skull, jaw and neck.
void add_bones(Form& form, const HeadParameters& p) {
  form.ball({0, 3.4, -0.4}, {p.skull_width, p.skull_height, 9.0}, 0);
  form.ball({0, 3.3, 2.4}, {p.skull_width * 0.84, 5.4, 6.5}, 2.0);
  form.ball({0, -1.9, 2.5}, {p.face_width, 6.6, 6.0}, 2.0);
  form.ball({0, -p.chin_drop + 3.4, 3.0}, {p.jaw_width * 1.42, 3.3, 4.6}, 2.6);
  form.ball({0, -p.chin_drop + p.chin_size, 7.0}, {p.chin_size * 1.25, p.chin_size, 1.45}, 2.2);
  // The bone of the jaw, from the chin to below the ear.
  form.limb({p.chin_size * 0.9, -p.chin_drop + 1.25, 6.4},
            {p.jaw_width * 1.26, -p.chin_drop + 4.3, 0.9}, 0.9, 0.75, 2.1);
  form.limb({0, -5, -1.7}, {0, -18, -3.2}, p.neck, p.neck * 1.08, 1.5);
}

void add_flesh(Form& form, const HeadParameters& p) {
  form.ball({3.55, -2.55, 5.7}, {p.cheek, p.cheek * 0.92, p.cheek}, 1.9);
  form.ball({0, -p.mouth_drop + 0.15, 6.6}, {2.25, 2.2, 2.15}, 1.8);
  if (p.brow_ridge > 0) {
    form.limb({0.9, 1.75, 8.0}, {4.6, 1.75, 6.2}, 0.55 + p.brow_ridge, 0.5 + p.brow_ridge, 1.3);
  }
}

void add_nose(Form& form, const HeadParameters& p) {
  const double tip = -p.nose_length;
  const double r = p.nose_size;
  form.limb({0, -0.3, 7.75 + p.nose_bridge}, {0, tip + 0.2, 9.5}, 0.40, r * 0.8, 1.5);
  form.ball({0, tip, 9.7}, {r * 0.98, r * 0.88, r}, 0.55);
  form.ball({r * 1.16, tip - 0.2, 9.05}, {r * 0.58, r * 0.56, r * 0.85}, 0.42);
  form.hollow({r * 0.66, tip - r * 0.98, 9.42}, {r * 0.27, r * 0.32, r * 0.42}, 0.22);
}

}  // namespace

Shape::Shape(const HeadParameters& parameters) : p(parameters) {
  eye = {p.eye_distance, 0, kEyeDepth};
  lid = p.eye_radius + 0.15;
  jaw_axis = {0, -2.4, 0.6};
  neck_pivot = {0, -6.2, -2.2};
  add_bones(skin, p);
  add_flesh(skin, p);
  skin.hollow({eye.x + 0.1, 0.2, 9.5}, {2.2, 1.4, 1.6}, 1.7);
  skin.ball(eye, {lid, lid, lid}, 0.75);
  add_nose(skin, p);
  // Between nose and upper lip.
  const double groove = 0.5 * (upper_lip(0) - p.nose_length - 0.62);
  skin.hollow({0, groove, front(0, groove).z + 0.30}, {0.26, 0.62, 0.36}, 0.45);
  const auto side = [this](double y) { return outer_hit(skin, {0, y, -0.3}, {1, 0, 0}, 14); };
  ear = side(-0.75);
  ear_lean = (side(1.0).x - side(-2.5).x) / 3.5;
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
  const double arch = 0.84 * std::pow(1 - std::pow(t, 2.1), 0.8);
  return lip_line(x) - p.lip_fullness * arch - 0.025;
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
