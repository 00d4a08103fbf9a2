#include "tools/formats/inspect/carriers.h"

#include <algorithm>
#include <cmath>

#include "codec/decode/decoder.h"
#include "codec/decode/fill.h"
#include "codec/encode/encode.h"
#include "codec/encode/live.h"
#include "tools/formats/common/bit_rate.h"
#include "tools/formats/common/text.h"
#include "tools/formats/inspect/carriers_internal.h"

namespace animeme::inspect {

namespace {

using Faces = std::vector<fap::Frame>;

constexpr std::size_t kLookedAt = 200;   // frames
constexpr std::size_t kFaceHeader = 13;  // bytes in front of a unit, tools/live/web/README.md
constexpr double kJoinSeconds = 1;       // between intra planes
constexpr int kMostQuant = 31;
// Limits of error in FAP units that are tried for files: from `kMostRms` down, four an octave.
constexpr double kMostRms = 64;
constexpr int kRmsSteps = 40, kAnOctave = 4;

struct LiveUnits {
  std::vector<Message> units;
  std::vector<bool> intra;
  Faces shown;
};

Result<LiveUnits> code_live(const fap::Sequence& clip, int quant, double join_seconds) {
  fba::LiveOptions live;
  live.rate = clip.rate;
  live.fap_quant = quant;
  live.intra_seconds = join_seconds;
  live.faps = clip.frames.front().mask;
  fba::LiveEncoder encoder(live);
  LiveUnits out;
  for (const fap::Frame& frame : clip.frames) {
    Result<Message> unit = encoder.write(frame);
    if (!unit) return unit.error();
    out.units.push_back(std::move(*unit));
    out.intra.push_back(encoder.intra());
    out.shown.push_back(encoder.reconstruction());
    out.shown.back().number = frame.number;
  }
  return out;
}

Result<Faces> code_file(const fap::Sequence& clip, double rms, std::size_t& bytes) {
  fba::EncodeOptions file = fba::file_options();
  file.max_rms = rms;
  const auto stream = fba::encode(clip, file);
  if (!stream) return stream.error();
  bytes = stream->size();
  const auto decoded = fba::decode(*stream);
  if (!decoded) return decoded.error();
  auto shown = fba::fill(*decoded);
  if (!shown) return shown.error();
  shown->frames.resize(clip.frames.size(), shown->frames.back());  // still ones are not sent
  return std::move(shown->frames);
}

Carrier sent_units(const char* name, int quant, bool fitted, Headers headers, double error,
                   const LiveUnits& live, std::size_t in_front = 0) {
  Carrier by = row_of(name, tools::format("quant %d", quant), fitted, headers, error);
  for (const Message& unit : live.units) send(by, unit.size() + in_front);
  return by;
}

// What pages without a decoder get.
void add_values(Carried& m, const Carrier& units, const LiveUnits& live) {
  Carrier json = row_of("FAPs, /faps JSON", units.setting, true, Headers::websocket, units.error);
  Carrier packed = json;
  packed.name += ", deflate, one join";
  Deflater deflater;
  for (std::size_t i = 0; i < live.units.size(); ++i) {
    const std::string text = faps_message(live.shown[i], live.shown[i].mask, m.clip->rate,
                                          live.intra[i], live.units[i].size());
    send(json, text.size());
    send(packed,
         deflater.pack({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}).size());
  }
  m.rows.insert(m.rows.end(), {std::move(json), std::move(packed)});
}

Result<void> add_live(Carried& m) {
  const auto plain = code_live(*m.clip, m.options->quant, kJoinSeconds);
  if (!plain) return plain.error();
  const auto quant = coarsest(0, kMostQuant, m.options->error, [&](int tried) -> Result<double> {
    const auto live = code_live(*m.clip, tried, kJoinSeconds);
    if (!live) return live.error();
    return m.error_of(live->shown);
  });
  if (!quant) return quant.error();
  const auto live = code_live(*m.clip, *quant, kJoinSeconds);
  const auto once = code_live(*m.clip, *quant, 0);
  if (!live) return live.error();
  if (!once) return once.error();
  const double error = m.error_of(live->shown);
  m.rows = {
      sent_units(kFbaLive, m.options->quant, false, Headers::rtp, m.error_of(plain->shown), *plain),
      sent_units(kFbaLive, *quant, true, Headers::rtp, error, *live),
      sent_units("FBA, joins each second, /face?as-sent", *quant, true, Headers::websocket, error,
                 *live, kFaceHeader),
      sent_units("FBA, one join", *quant, true, Headers::websocket, m.error_of(once->shown),
                 *once)};
  add_values(m, m.rows[1], *live);
  return {};
}

Result<void> add_file(Carried& m) {
  const auto rms_of = [](int step) { return kMostRms * std::exp2(-double(step) / kAnOctave); };
  std::size_t bytes = 0;
  const auto error_at = [&](int step) -> Result<double> {
    const auto shown = code_file(*m.clip, rms_of(step), bytes);
    if (!shown) return shown.error();
    return m.error_of(*shown);
  };
  const auto found = coarsest(kRmsSteps, 0, m.options->error, error_at);
  if (!found) return found.error();
  const auto error = error_at(*found);
  if (!error) return error.error();
  m.rows.push_back(
      row_of(kFbaFile, tools::format("rms %.3g", rms_of(*found)), true, Headers::none, *error));
  send(m.rows.back(), bytes);
  return {};
}

std::vector<fap::ArkitFrame> fitted_weights(const fap::Sequence& clip) {
  fap::ArkitFitter fitter;
  std::vector<fap::ArkitFrame> weights;
  for (const fap::Frame& frame : clip.frames) weights.push_back(fitter.fit(frame));
  return weights;
}

}  // namespace

std::vector<fap::Frame> faces_of(const std::vector<fap::ArkitFrame>& weights) {
  fap::ArkitChannels shapes;
  for (std::size_t i = 0; i < fap::kArkitShapeCount; ++i) shapes.set(i);
  Faces faces;
  for (const fap::ArkitFrame& frame : weights) faces.push_back(fap::arkit_to_fap(frame, shapes));
  return faces;
}

Carried::Carried(const fap::Sequence& given, std::vector<fap::ArkitFrame> all,
                 const CarrierOptions& wanted)
    : clip(&given),
      weights(std::move(all)),
      options(&wanted),
      face(given.frames, kLookedAt),
      shape_face(faces_of(weights), kLookedAt) {}

std::size_t Carried::second() const {
  return std::size_t(std::max(std::lround(clip->rate.frames_per_second()), 1L));
}

double Carried::error_of(const Faces& faces) {
  told();
  return face.error(faces);
}

double Carried::error_of_weights(const std::vector<fap::ArkitFrame>& sent) {
  told();
  return shape_face.error(faces_of(sent));
}

void Carried::told() {
  constexpr int kAbout = 32;  // looks in all
  if (options->progress) options->progress(std::min(1.0, ++looks / double(kAbout)));
}

double ClipCarriers::kbps(const Carrier& by, bool with_headers) const {
  return tools::kbit_per_s(by.bytes + (with_headers ? by.bytes_of_headers : 0), seconds);
}

Result<ClipCarriers> measure_carriers(const std::string& name, const fap::Sequence& clip,
                                      const std::vector<fap::ArkitFrame>& weights,
                                      const CarrierOptions& options) {
  if (clip.frames.empty()) return make_error(Code::truncated, "there is no frame to send");
  if (!weights.empty() && weights.size() != clip.frames.size()) {
    return make_error(Code::invalid_argument, "there must be as many weights as frames");
  }
  Carried m(clip, weights.empty() ? fitted_weights(clip) : weights, options);
  ClipCarriers out;
  out.name = name;
  out.frames = clip.frames.size();
  out.rate = clip.rate.frames_per_second();
  out.seconds = clip.rate.seconds(double(out.frames));
  out.points = m.face.points();
  out.shapes_error = m.error_of(faces_of(m.weights));
  if (auto ok = add_live(m); !ok) return ok.error();
  if (auto ok = add_file(m); !ok) return ok.error();
  add_weights(m);
  out.carriers = std::move(m.rows);
  return out;
}

}  // namespace animeme::inspect
