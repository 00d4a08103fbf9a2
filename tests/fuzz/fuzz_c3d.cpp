// Feeds arbitrary bytes to the readers of captured points, C3D and tables, and what comes of them
// to what finds key shapes and fits frames.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "dam/crossmap/blend.h"
#include "dam/crossmap/face_points.h"
#include "dam/crossmap/key_shapes.h"
#include "tests/fuzz/require.h"
#include "tools/formats/exchange/c3d.h"
#include "tools/formats/exchange/points.h"

using animeme::test::require;

namespace {

using namespace animeme;
using namespace animeme::exchange;

void use(PointRecording take) {
  dam::PointTrack& track = take.track;
  require(track.rate.valid() && track.frames() > 0);
  require(track.values.size() == track.frames() * track.size());
  if (track.values.size() > 3000) return;
  const auto points = dam::face_points(track.names);
  for (const std::size_t point : dam::mouth_points(track.names, points)) {
    require(point < track.names.size());
  }
  const auto rest = dam::resting_shape({&track, 1});
  if (!rest) return;
  const auto face = dam::make_face(track.names, track.dimensions, *rest, points,
                                   {.axes = std::nullopt, .fapu = {}, .centimetres = 0.1});
  if (face) dam::fap_values(*face, track.frame(0));
  (void)dam::hold_head_still(track, dam::head_points(points), *rest);
  dam::subtract(track, *rest);
  const auto found = dam::find_key_frames({&track, 1}, {}, {.count = 2, .most_frames = 20});
  if (!found) return;
  dam::KeyShapes keys;
  for (const dam::KeyFrame& key : found->keys) {
    const auto shape = track.frame(key.frame);
    keys.names.emplace_back("key");
    keys.values.insert(keys.values.end(), shape.begin(), shape.end());
  }
  const auto blend = dam::fit_blend(track, keys);
  if (!blend) return;
  for (const double weight : blend->weights) require(weight >= 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  auto markers = read_c3d(bytes);
  if (markers) use(std::move(*markers));
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const bool rate : {false, true}) {
    PointTableOptions options;
    if (rate) options.rate = fap::Rate{25, 1};
    auto table = read_point_table(text, options);
    if (table) use(std::move(*table));
  }
  (void)dam::parse_axes(text.substr(0, 40));
  return 0;
}
