// What the rows of carriers.h are made of: a clip that is being measured, and its rows by weights.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "fap/arkit.h"
#include "tools/formats/inspect/carriers.h"
#include "tools/formats/inspect/face_ruler_internal.h"

namespace animeme::inspect {

// FBA that others are compared with.
inline constexpr const char* kFbaLive = "FBA, joins each second";
inline constexpr const char* kFbaFile = "FBA, file";

struct Carried {
  Carried(const fap::Sequence& given, std::vector<fap::ArkitFrame> all,
          const CarrierOptions& wanted);

  const fap::Sequence* clip;
  std::vector<fap::ArkitFrame> weights;
  const CarrierOptions* options;
  FaceRuler face, shape_face;
  std::vector<Carrier> rows;
  int looks = 0;

  // Frames in a second.
  std::size_t second() const;
  // mm RMS of faces from those of the clip, and of the weights with each replaced by what `change`
  // makes of it.
  double error_of(const std::vector<fap::Frame>& faces);
  template <class Change>
  double error_of_changed(Change change) {
    std::vector<fap::ArkitFrame> sent = weights;
    for (const std::size_t i : shape_face.looked_at()) {
      for (double& weight : sent[i]) weight = change(weight);
    }
    return error_of_weights(sent);
  }

 private:
  double error_of_weights(const std::vector<fap::ArkitFrame>& sent);
  void told();
};

// The faces that 52 shapes show.
std::vector<fap::Frame> faces_of(const std::vector<fap::ArkitFrame>& weights);

inline Carrier row_of(std::string name, std::string setting, bool fitted, Headers headers,
                      double error) {
  Carrier row;
  row.name = std::move(name);
  row.setting = std::move(setting);
  row.fitted = fitted;
  row.headers = headers;
  row.error = error;
  return row;
}

inline void send(Carrier& by, std::size_t bytes) {
  ++by.messages;
  by.bytes += bytes;
  by.bytes_of_headers += header_bytes(by.headers, bytes);
}

// The coarsest of `finest`..`most` whose error is within `limit`, or the finest; errors grow on the
// way, which may go up or down.
template <class Error>
Result<int> coarsest(int finest, int most, double limit, Error error) {
  int good = finest, bad = most + (finest < most ? 1 : -1);
  while (std::abs(bad - good) > 1) {
    const int middle = (good + bad) / 2;
    const Result<double> found = error(middle);
    if (!found) return found.error();
    (*found <= limit ? good : bad) = middle;
  }
  return good;
}

// Adds the rows of carriers that send ARKit's weights.
void add_weights(Carried& m);

}  // namespace animeme::inspect
