/// @file
/// Small vectors and rotations of the head model.
#pragma once

#include <algorithm>
#include <cmath>

namespace animeme::head {

/// A point or direction. Right-handed: +X to the person's left, +Y up, +Z forward (gaze).
template <class T>
struct Vector {
  T x = 0;  ///< to the person's left
  T y = 0;  ///< up
  T z = 0;  ///< forward

  friend Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vector operator*(Vector a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend Vector operator*(T s, Vector a) { return a * s; }
  /// Component by component, as colours are multiplied.
  friend Vector operator*(Vector a, Vector b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  Vector& operator+=(Vector b) { return *this = *this + b; }
  Vector& operator-=(Vector b) { return *this = *this - b; }
  Vector& operator*=(T s) { return *this = *this * s; }
  friend bool operator==(const Vector&, const Vector&) = default;

  /// Converts to another precision.
  template <class U>
  explicit operator Vector<U>() const {
    return {U(x), U(y), U(z)};
  }
};

using Vec3 = Vector<float>;    ///< in meshes and colours (linear RGB, 0..1)
using Vec3d = Vector<double>;  ///< during the construction of a head

/// Inner product.
template <class T>
inline T dot(Vector<T> a, Vector<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Cross product, right-handed.
template <class T>
inline Vector<T> cross(Vector<T> a, Vector<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Euclidean length.
template <class T>
inline T length(Vector<T> a) {
  return std::sqrt(dot(a, a));
}

/// Length 1; the zero vector stays.
template <class T>
inline Vector<T> normalised(Vector<T> a) {
  const T l = length(a);
  return l > 0 ? a * (T(1) / l) : a;
}

/// `a` at t = 0, `b` at t = 1.
template <class T>
inline Vector<T> mix(Vector<T> a, Vector<T> b, T t) {
  return a + (b - a) * t;
}

/// 0 up to `a`, 1 from `b` on, smooth between. a < b or a > b.
template <class T>
inline T smooth_step(T a, T b, T x) {
  const T t = std::clamp((x - a) / (b - a), T(0), T(1));
  return t * t * (T(3) - T(2) * t);
}

/// Rotation and translation: p becomes rows * p + shift.
struct Transform {
  Vec3 row_x = {1, 0, 0};  ///< gives x
  Vec3 row_y = {0, 1, 0};  ///< gives y
  Vec3 row_z = {0, 0, 1};  ///< gives z
  Vec3 shift = {0, 0, 0};  ///< added last

  /// Without the translation: for directions.
  Vec3 turn(Vec3 p) const { return {dot(row_x, p), dot(row_y, p), dot(row_z, p)}; }
  Vec3 operator()(Vec3 p) const { return turn(p) + shift; }  ///< transforms a point
  friend bool operator==(const Transform&, const Transform&) = default;
};

/// First `inner`, then `outer`.
Transform compose(const Transform& outer, const Transform& inner);

/// Inverse of a rotation and translation.
Transform inverse(const Transform& t);

/// Right-handed rotation by angles in rad about the axes through `pivot`: roll about Z first, then
/// pitch about X, then yaw about Y.
Transform rotation_about(Vec3 pivot, float pitch, float yaw, float roll);

}  // namespace animeme::head
