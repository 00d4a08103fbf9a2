#include "dam/crossmap/face_points.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <set>

#include "fap/detail/text_scanner.h"
#include "fap/tables.h"

namespace animeme::dam {
namespace {

std::optional<int> landmark_number(std::string_view name) {
  int number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || end != name.data() + name.size() || number < 0) return std::nullopt;
  return number;
}

std::optional<fap::LandmarkLayout> told_layout(std::span<const std::string> names,
                                               std::optional<fap::LandmarkLayout> given) {
  if (given) return given;
  int largest = -1;
  for (const std::string& name : names)
    largest = std::max(largest, landmark_number(name).value_or(-1));
  if (largest < 0) return std::nullopt;
  return largest < 68 ? fap::LandmarkLayout::ibug68 : fap::LandmarkLayout::mediapipe;
}

bool names_feature_point(std::string_view id) {
  return id == fap::kNasion ||
         std::any_of(fap::kFeaturePoints.begin(), fap::kFeaturePoints.end(),
                     [&](const fap::FeaturePointInfo& info) { return info.id == id; });
}

// "8.1" of "8.1", "fp8.1", "FP 8.1"; else nothing.
std::string feature_point_of(std::string_view name) {
  std::string id = fap::detail::lower_case(name);
  for (const std::string_view prefix : {"fdp", "fp"}) {
    if (!id.starts_with(prefix)) continue;
    id.erase(0, prefix.size());
    id.erase(0, id.find_first_not_of(" _-."));
    break;
  }
  return names_feature_point(id) ? id : "";
}

// Landmarks of lips and chin that are no feature points as well. Outer and inner lips and the chin
// line of iBUG; the rings that MediaPipe draws around the lips.
constexpr int kIbugMouth[] = {6,  7,  9,  10, 48, 49, 50, 51, 52, 53, 54, 55,
                              56, 57, 58, 59, 60, 61, 62, 63, 64, 65, 66, 67};
constexpr int kMediapipeMouth[] = {
    61, 185, 40, 39, 37, 0,  267, 269, 270, 409, 291, 375, 321, 405, 314, 17, 84, 181, 91, 146,
    78, 191, 80, 81, 82, 13, 312, 311, 310, 415, 308, 324, 318, 402, 317, 14, 87, 178, 88, 95};

constexpr std::string_view kHeadIds[] = {"3.7",  "3.8",  "3.11", "3.12", "9.6",    "9.7",
                                         "9.12", "9.13", "9.14", "9.15", "nasion", "11.1",
                                         "11.2", "11.3", "10.7", "10.8", "10.9",   "10.10"};

}  // namespace

std::vector<FacePoint> face_points(std::span<const std::string> names,
                                   std::optional<fap::LandmarkLayout> layout) {
  std::vector<FacePoint> out;
  std::map<int, std::size_t> numbered;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (const std::string id = feature_point_of(names[i]); !id.empty()) {
      out.push_back({id, {i}});
    } else if (const auto number = landmark_number(names[i])) {
      numbered.emplace(*number, i);
    }
  }
  const auto known = told_layout(names, layout);
  if (!out.empty() || !known) return out;
  for (const fap::LandmarkSource& source : fap::landmark_sources(*known)) {
    const auto first = numbered.find(source.landmark), second = numbered.find(source.second);
    if (first == numbered.end() || (source.second >= 0 && second == numbered.end())) continue;
    FacePoint point{std::string(source.point), {first->second}};
    if (source.second >= 0) point.points.push_back(second->second);
    out.push_back(std::move(point));
  }
  return out;
}

std::vector<std::size_t> head_points(std::span<const FacePoint> points) {
  std::set<std::size_t> out;
  for (const FacePoint& point : points) {
    if (std::find(std::begin(kHeadIds), std::end(kHeadIds), point.id) == std::end(kHeadIds)) {
      continue;
    }
    out.insert(point.points.begin(), point.points.end());
  }
  return {out.begin(), out.end()};
}

std::vector<std::size_t> mouth_points(std::span<const std::string> names,
                                      std::span<const FacePoint> points,
                                      std::optional<fap::LandmarkLayout> layout) {
  std::set<std::size_t> out;
  bool numbers = false;
  for (const FacePoint& point : points) {
    numbers = numbers || (!point.points.empty() && landmark_number(names[point.points[0]]));
    const std::string_view group = std::string_view(point.id).substr(0, 2);
    if (group != "2." && group != "5." && group != "6." && group != "8.") continue;
    out.insert(point.points.begin(), point.points.end());
  }
  const auto known = told_layout(names, layout);
  if (numbers && known) {
    const std::span<const int> more =
        *known == fap::LandmarkLayout::ibug68 ? std::span<const int>(kIbugMouth) : kMediapipeMouth;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto number = landmark_number(names[i]);
      if (number && std::find(more.begin(), more.end(), *number) != more.end()) out.insert(i);
    }
  }
  return {out.begin(), out.end()};
}

std::vector<std::pair<std::size_t, std::size_t>> lip_contacts(std::span<const FacePoint> points) {
  const auto find = [&](std::string_view id) -> const FacePoint* {
    for (const FacePoint& point : points) {
      if (point.id == id && point.points.size() == 1) return &point;
    }
    return nullptr;
  };
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for (const auto& [upper, lower] : {std::pair{"2.2", "2.3"}, {"2.6", "2.8"}, {"2.7", "2.9"}}) {
    const FacePoint *a = find(upper), *b = find(lower);
    if (a != nullptr && b != nullptr) out.emplace_back(a->points[0], b->points[0]);
  }
  return out;
}

}  // namespace animeme::dam
