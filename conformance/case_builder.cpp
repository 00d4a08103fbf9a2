#include "conformance/case_builder.h"

#include <algorithm>

#include "codec/text/bap_text.h"
#include "fap/rate_text.h"
#include "fap/tables.h"
#include "fap/text.h"

namespace animeme::conformance {

namespace {

void tag(std::string& out, const char* name, std::initializer_list<std::int64_t> numbers) {
  out += name;
  for (const std::int64_t n : numbers) out += " " + std::to_string(n);
  out += "\n";
}

template <class Settings>
void ranges(std::string& out, char family, const Settings& settings, int first, int last) {
  constexpr const char* kNames[4] = {"IX", "IN", "PX", "PN"};
  for (std::size_t kind = 0; kind < 4; ++kind) {
    if (!settings.send_range[kind]) continue;
    out += family;
    out += kNames[kind];
    for (int n = first; n <= last; ++n) {
      const int limit = settings.range[kind][std::size_t(n)] * 60;
      out += " " + std::to_string(kind % 2 == 0 ? limit : -limit);
    }
    out += "\n";
  }
}

void face(std::string& out, const fba::FaceSettings& settings) {
  out += "FMT";
  for (std::size_t g = 0; g < fap::kGroupCount; ++g) {
    const int type = int(settings.mask_type[g]);
    out += " " + std::to_string(type);
    for (int i = 0; i < fap::kGroups[g].size && (type == 1 || type == 2); ++i) {
      out += settings.mask[std::size_t(fap::kGroups[g].first + i)] ? " 1" : " 0";
    }
  }
  out += "\n";
  tag(out, "FQU", {settings.fap_quant});
  ranges(out, 'F', settings, fap::kFirstLowLevel, fap::kFapCount);
}

void body(std::string& out, const fba::BodySettings& settings) {
  out += "BMT";
  std::size_t slot = 0;
  for (std::size_t g = 0; g < fba::kBodyGroupCount; ++g) {
    const int type = int(settings.mask_type[g]);
    out += " " + std::to_string(type);
    for (int i = 0; i < fba::kBodyGroupSizes[g]; ++i, ++slot) {
      if (type == 1) out += settings.mask[fba::kBapOrder[slot]] ? " 1" : " 0";
    }
  }
  out += "\n";
  tag(out, "BQU", {settings.bap_quant});
  ranges(out, 'B', settings, 1, fba::kBapCount);
}

bool expressible(const PlaneSpec& plane) {
  if (plane.object_mask == fba::ObjectMask::nothing || plane.damage != Damage::none) return false;
  if (!plane.object_start.empty()) return false;
  if (!plane.intra || !fba::has_face(plane.object_mask)) return true;
  const fba::FaceSettings& face = plane.face;
  const bool both = face.send_range[fba::kPredictiveMax] && face.send_range[fba::kPredictiveMin];
  return !both || face.range[fba::kPredictiveMax][4] != 0 ||
         face.range[fba::kPredictiveMin][4] != 0;
}

// The EPF from which an encoder makes the same planes out of a clip that has a frame for each
// face plane and each body plane, numbered from 0. Empty if an EPF cannot say it: a plane without
// face and body, or predictive limits of FAP 4 that are both 0, which reference encoders take
// for "no ranges given".
std::string write_epf(const std::vector<PlaneSpec>& planes) {
  std::string out;
  int faces = 0, bodies = 0;
  for (const PlaneSpec& plane : planes) {
    if (!expressible(plane)) return {};
    const bool has_face = fba::has_face(plane.object_mask);
    const bool has_body = fba::has_body(plane.object_mask);
    tag(out, "FBM", {int(plane.object_mask)});
    if (has_face) tag(out, "FFR", {faces++});
    if (has_body) tag(out, "BFR", {bodies++});
    tag(out, "ISI", {plane.intra});
    const fba::TemporalHeader& temporal = plane.temporal;
    if (temporal.rate) {
      tag(out, "FRR",
          {temporal.rate->frame_rate, temporal.rate->sixteenths, temporal.rate->frequency_offset});
    }
    if (temporal.time_code) {
      tag(out, "TC",
          {temporal.time_code->hours, temporal.time_code->minutes, 1, temporal.time_code->seconds});
    }
    if (temporal.skip) tag(out, "SKN", {*temporal.skip});
    if (!plane.intra) continue;
    if (has_face) face(out, plane.face);
    if (has_body) body(out, plane.body);
    tag(out, "GDR", {has_face ? plane.face.male : plane.body.male});
  }
  return out;
}

// A case's own sequence, so that new cases leave the old ones alone.
std::uint64_t mix(std::uint64_t seed, const std::string& name) {
  std::uint64_t hash = 1469598103934665603ULL;
  for (const char c : name) hash = (hash ^ std::uint8_t(c)) * 1099511628211ULL;
  return hash ^ (seed * 0x9E3779B97F4A7C15ULL);
}

int draw(Random& random, StreamWriter::Range range, Levels levels, int spread) {
  switch (levels) {
    case Levels::zero:
      return 0;
    case Levels::highest:
      return range.high;
    case Levels::lowest:
      return range.low;
    case Levels::mostly_high:
      if (random.chance(90)) return range.high;
      break;
    case Levels::random:
      break;
  }
  return random.range(std::max(range.low, -spread), std::min(range.high, spread));
}

std::string as_string(const std::vector<std::uint8_t>& bytes) {
  return {bytes.begin(), bytes.end()};
}

// A value that quantises to the same level as `exact`: anywhere within half a step.
std::int32_t near(Random& random, std::int32_t exact, int step) {
  const int slack = (step - 1) / 2;
  return exact + random.range(-slack, slack);
}

}  // namespace

CaseBuilder::CaseBuilder(std::uint64_t seed, std::string name, std::string title, std::string note,
                         std::uint32_t object_code)
    : random_(mix(seed, name)), writer_(object_code) {
  info_.name = std::move(name);
  info_.title = std::move(title);
  info_.note = std::move(note);
  info_.origin = "conformance/make_cases --seed " + std::to_string(seed);
}

// Levels of the high-level values from `which` on that lead to these.
void CaseBuilder::set_high(PlaneSpec& plane, int which, std::initializer_list<int> targets) const {
  const int quant = plane.intra ? plane.face.fap_quant : writer_.face_settings().fap_quant;
  for (const int target : targets) {
    const int step = is_selection(which) ? 1 : std::max(quant, 1);
    const int before = plane.intra ? 0 : writer_.high_value(which) / step;
    plane.high[std::size_t(which++)] = target - before;
  }
}

void CaseBuilder::set_viseme(PlaneSpec& plane, int select1, int select2, int blend,
                             bool def) const {
  set_high(plane, kSelect1, {select1, select2, blend});
  plane.viseme_def = def;
}

void CaseBuilder::set_expression(PlaneSpec& plane, int select1, int intensity1, int select2,
                                 int intensity2, bool init_face, bool def) const {
  set_high(plane, kExpression1, {select1, intensity1, select2, intensity2});
  plane.init_face = init_face;
  plane.expression_def = def;
}

void CaseBuilder::draw_levels(PlaneSpec& plane, Levels levels) {
  if (fba::has_face(plane.object_mask)) {
    const fap::Mask& mask = plane.intra ? plane.face.mask : writer_.face_settings().mask;
    const int blend = writer_.high_range(plane, kBlend);
    if (mask[1]) {
      set_viseme(plane, random_.range(0, 14), random_.range(0, 14), random_.range(0, blend),
                 random_.chance(30));
    }
    if (mask[2]) {
      set_expression(plane, random_.range(0, 6), random_.range(0, blend), random_.range(0, 6),
                     random_.range(0, blend), random_.chance(30), random_.chance(30));
    }
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (mask[fap]) plane.fap[fap] = draw(random_, writer_.fap_range(plane, fap), levels, spread);
    }
  }
  if (fba::has_body(plane.object_mask)) {
    const auto& mask = plane.intra ? plane.body.mask : writer_.body_settings().mask;
    for (std::size_t bap = 1; bap <= fba::kBapCount; ++bap) {
      if (mask[bap]) plane.bap[bap] = draw(random_, writer_.bap_range(plane, bap), levels, spread);
    }
  }
}

void CaseBuilder::add(const PlaneSpec& plane, Levels levels) {
  constexpr int kTries = 50;
  PlaneSpec drawn;
  for (int turn = 0; turn < kTries; ++turn) {
    drawn = plane;
    draw_levels(drawn, levels);
    if (plane.start_code != StartCode::none || !plane.object_start.empty()) break;
    StreamWriter probe = writer_;
    const Expected written = probe.write(drawn);
    if (!looks_like_the_end(probe.bits().bit, written.bit_begin)) break;
  }
  add_exact(drawn);
}

void CaseBuilder::add_exact(const PlaneSpec& plane) {
  planes_.push_back(plane);
  const Expected now = writer_.write(plane);
  expected_.push_back(now);
  if (fba::has_face(plane.object_mask)) {
    fap::Frame source = now.face;
    source.number = std::int64_t(source_face_.size());
    const int quant = writer_.face_settings().fap_quant;
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      const std::size_t n = std::size_t(fap);
      if (source.mask[n] && quant > 0) {
        source.value[n] = near(random_, source.value[n], fap::info(fap).quant_step * quant);
      }
    }
    source_face_.push_back(source);
  }
  if (fba::has_body(plane.object_mask)) {
    fba::BodyFrame source = now.body;
    source.number = std::int64_t(source_body_.size());
    const int scale = fba::kBapScale[std::size_t(writer_.body_settings().bap_quant)];
    for (std::size_t slot = 0; slot < fba::kBapCount; ++slot) {
      const std::size_t bap = fba::kBapOrder[slot];
      if (source.mask[bap] && scale > 0) {
        source.value[bap] = near(random_, source.value[bap], fba::kBapSteps[slot] * scale);
      }
    }
    source_body_.push_back(source);
  }
}

void CaseBuilder::add_group(const fba::FaceSettings& face, int count, Levels levels) {
  add(intra_face(face), levels);
  for (int i = 0; i < count; ++i) add(predictive(), levels);
}

std::vector<int> CaseBuilder::indices(int first, int last) {
  std::vector<int> out;
  for (int i = first; i < last; ++i) out.push_back(i);
  return out;
}

MadeCase CaseBuilder::start(std::vector<std::uint8_t> bytes) const {
  MadeCase made;
  made.info = info_;
  bool face = false, body = false;
  for (const Expected& one : expected_) {
    face |= fba::has_face(one.object_mask);
    body |= fba::has_body(one.object_mask);
  }
  made.info.object = face && body ? "both" : body ? "body" : "face";
  std::string stream = as_string(headers) + as_string(bytes);
  made.content["stream"] = std::move(stream);
  return made;
}

void CaseBuilder::add_text(MadeCase& made, const char* face_role, const char* body_role,
                           const std::vector<int>& which) const {
  fap::Sequence clip;
  fba::BodySequence bodies;
  clip.name = bodies.name = info_.name;
  clip.rate = bodies.rate = {30, 1};  // until the stream sends one
  for (const int i : which) {
    const auto& rate = planes_[std::size_t(i)].temporal.rate;
    if (i == which.front() && rate) clip.rate = bodies.rate = rate->rate();
    const Expected& one = expected_[std::size_t(i)];
    if (fba::has_face(one.object_mask)) clip.frames.push_back(one.face);
    if (fba::has_body(one.object_mask)) bodies.frames.push_back(one.body);
  }
  if (!which.empty()) made.info.rate = fap::format_rate(clip.rate);
  if (!clip.frames.empty()) made.content[face_role] = fap::write_text(clip);
  if (!bodies.frames.empty() && body_role != nullptr) {
    made.content[body_role] = fba::write_bap_text(bodies);
  }
}

void CaseBuilder::add_parameters(MadeCase& made) const {
  int with_code = 0, intra = 0, intra_with_code = 0, old_codes = 0;
  for (const PlaneSpec& plane : planes_) {
    with_code += plane.start_code != StartCode::none;
    old_codes += plane.start_code == StartCode::old_plane;
    intra += plane.intra;
    intra_with_code += plane.intra && plane.start_code != StartCode::none;
  }
  // An encoder gives start codes of one kind to no plane, to all, or to the intra planes.
  if (old_codes != 0 && old_codes != with_code) return;
  const bool only_intra = with_code == intra_with_code && with_code == intra;
  if (with_code != 0 && with_code != planes() && !only_intra) return;
  std::string epf = write_epf(planes_);
  if (epf.empty()) return;
  made.content["parameters"] = std::move(epf);
  if (!source_face_.empty()) {
    made.content["source_face"] = fap::write_text({{25, 1}, source_face_, info_.name});
  }
  if (!source_body_.empty()) {
    made.content["source_body"] = fba::write_bap_text({{25, 1}, source_body_, info_.name});
  }
}

MadeCase CaseBuilder::finish(bool parameters) {
  MadeCase made = finish_with(writer_.finish());
  if (parameters && headers.empty()) add_parameters(made);
  return made;
}

MadeCase CaseBuilder::finish_with(std::vector<std::uint8_t> bytes) {
  MadeCase made = start(std::move(bytes));
  add_text(made, "face", "body", indices(0, planes()));
  return made;
}

MadeCase CaseBuilder::finish_damaged(std::vector<std::uint8_t> bytes, std::vector<int> intact,
                                     std::vector<std::string> errors,
                                     std::vector<std::string> features, bool ignored) {
  MadeCase made = start(std::move(bytes));
  if (ignored) add_text(made, "face_ignored", nullptr, indices(0, planes()));
  // Lost planes are not counted: nobody knows how many there were.
  std::int64_t number = 0;
  for (const int i : intact) {
    expected_[std::size_t(i)].face.number = expected_[std::size_t(i)].body.number = number;
    number += 1 + std::int64_t(planes_[std::size_t(i)].temporal.skip.value_or(0));
  }
  add_text(made, "face", "body", intact);
  made.info.damaged = true;
  made.info.errors = std::move(errors);
  made.info.features = std::move(features);
  made.info.planes = planes();
  for (const PlaneSpec& plane : planes_) made.info.intra_planes += plane.intra;
  for (const Expected& one : expected_) {
    made.info.largest_plane_bits =
        std::max(made.info.largest_plane_bits, std::int64_t(one.bit_end - one.bit_begin));
  }
  return made;
}

std::vector<MadeCase> make_all_cases(std::uint64_t seed) {
  std::vector<MadeCase> out;
  make_face_cases(seed, out);
  make_high_level_cases(seed, out);
  make_coder_cases(seed, out);
  make_stream_cases(seed, out);
  make_body_cases(seed, out);
  make_damaged_cases(seed, out);
  std::sort(out.begin(), out.end(),
            [](const MadeCase& a, const MadeCase& b) { return a.info.name < b.info.name; });
  return out;
}

}  // namespace animeme::conformance
