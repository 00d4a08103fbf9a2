#include "tools/formats/inspect/statistics.h"

#include <utility>

#include "fap/rate_text.h"
#include "fap/tables.h"
#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"

namespace animeme::inspect {

using tools::format;

namespace {

using tools::Json;

// --- the stream as a whole

Json describe(const PlaneBits& bits) {
  return {{"planes", bits.planes},
          {"mean", bits.mean},
          {"median", bits.median},
          {"largest", bits.largest}};
}

void describe(const BitStatistics& bits, Json& json) {
  const double total = double(bits.framing_bits + bits.header_bits + bits.value_bits);
  json["planes"] = bits.intra.planes + bits.predictive.planes;
  json["intra_planes"] = bits.intra.planes;
  json["kbit_per_s"] = bits.kbit_per_s;
  json["peak_kbit_per_s"] = bits.peak_kbit_per_s;
  json["bits"] = std::int64_t(total);
  json["intra_bits"] = describe(bits.intra);
  json["predictive_bits"] = describe(bits.predictive);
  json["framing"] = {{"bits", bits.framing_bits}, {"share", double(bits.framing_bits) / total}};
  json["headers"] = {{"bits", bits.header_bits}, {"share", double(bits.header_bits) / total}};
  json["values"] = {{"bits", bits.value_bits},
                    {"share", double(bits.value_bits) / total},
                    {"ideal_bits", bits.ideal_bits()}};
}

std::string text_of(const char* name, const PlaneBits& bits) {
  if (bits.planes == 0) return {};
  return format("%s %zu, bits a plane: mean %.1f, median %.1f, largest %lld\n", name, bits.planes,
                bits.mean, bits.median, (long long)bits.largest);
}

std::string text_of(const BitStatistics& bits) {
  const double total = double(bits.framing_bits + bits.header_bits + bits.value_bits);
  std::string text;
  const auto percent = [total](std::int64_t part) { return 100 * double(part) / total; };
  text += format("bit rate: %.3f kbit/s, %.3f in the largest second\n", bits.kbit_per_s,
                 bits.peak_kbit_per_s);
  text += text_of("I planes:", bits.intra) + text_of("P planes:", bits.predictive);
  text += format(
      "share of all bits: values %.1f %%, plane headers %.1f %%, start codes and stuffing "
      "%.1f %%\n",
      percent(bits.value_bits), percent(bits.header_bits), percent(bits.framing_bits));
  text += format("values: %lld bits, ideal %.0f (the rest are segment ends)\n",
                 (long long)bits.value_bits, bits.ideal_bits());
  return text;
}

// --- the parameters

Json describe(const std::vector<Activity>& list, const char* kind, const double* ideal_bits,
              double seconds) {
  Json out = Json::array();
  for (const Activity& one : list) {
    Json json = {{kind, one.number}};
    if (kind == std::string_view("fap")) {
      json["name"] = fap::info(one.number).name;
      json["group"] = fap::info(one.number).group;
    }
    json["frames"] = one.frames;
    if (one.is_amount) {
      json["min"] = one.min;
      json["max"] = one.max;
      json["rms_speed"] = one.rms_speed;
    }
    json["distinct"] = one.distinct;
    json["moves"] = one.moves;
    json["never_moves"] = one.never_moves();
    if (kind == std::string_view("fap")) json["equal_to"] = one.equal_to;
    if (ideal_bits != nullptr) json["ideal_bits_per_s"] = ideal_bits[one.number] / seconds;
    out.push_back(std::move(json));
  }
  return out;
}

std::string remark(const Activity& one) {
  std::string text = one.never_moves() ? "never moves" : "";
  for (const int other : one.equal_to) {
    text += (text.empty() ? "= " : ", = ") + std::to_string(other);
  }
  return text;
}

std::string text_of(const std::vector<Activity>& list, bool face, const double* ideal_bits,
                    double seconds) {
  if (list.empty()) return {};
  std::string text;
  text += format("\n%s%-*s %8s %8s %8s %10s %7s", face ? "FAP " : "BAP ", face ? 25 : 0,
                 face ? "name" : "", "min", "max", "distinct", "rms/s", "moves");
  text += ideal_bits != nullptr ? "  ideal bit/s\n" : "\n";
  for (const Activity& one : list) {
    text += format("%3d ", one.number);
    if (face) text += format("%-25s", std::string(fap::info(one.number).name).c_str());
    if (one.is_amount) {
      text += format(" %8d %8d %8zu %10.1f", one.min, one.max, one.distinct, one.rms_speed);
    } else {
      text += format(" %8s %8s %8zu %10s", "-", "-", one.distinct, "-");
    }
    text += format(" %5.1f %%", 100 * one.moves);
    if (ideal_bits != nullptr) text += format(" %12.1f", ideal_bits[one.number] / seconds);
    const std::string said = remark(one);
    text += said.empty() ? "\n" : "  " + said + "\n";
  }
  return text;
}

// --- all of it

const double* fap_bits(const Statistics& s) {
  return s.bits ? s.bits->ideal_fap_bits.data() : nullptr;
}
const double* bap_bits(const Statistics& s) {
  return s.bits ? s.bits->ideal_bap_bits.data() : nullptr;
}

}  // namespace

void Measurement::add(const fba::Plane& plane) {
  if (planes_++ == 0) rate_ = plane.rate;
  bits_.add(plane);
  if (fba::has_face(plane.object_mask)) add(plane.face);
  if (plane.body) add(*plane.body);
}

void Measurement::add(const fap::Frame& frame) {
  ++faces_;
  last_face_ = frame.number;
  face_.add(frame);
}

void Measurement::add(const fba::BodyFrame& frame) {
  ++bodies_;
  last_body_ = frame.number;
  body_.add(frame);
}

Statistics Measurement::measured(std::string kind, fap::Rate face, fap::Rate body,
                                 std::size_t bytes) const {
  if (planes_ > 0) face = body = rate_;
  Statistics out;
  out.kind = std::move(kind);
  out.faces = faces_;
  out.bodies = bodies_;
  out.rate = faces_ == 0 && bodies_ > 0 ? body : face;
  if (planes_ > 0) out.bits = bits_.measured(bytes);
  out.faps = face_.measured(face);
  out.baps = body_.measured(body);
  if (out.bits) {
    out.seconds = out.bits->seconds;
  } else if (faces_ > 0) {
    out.seconds = face.seconds(double(last_face_ + 1));
  } else if (bodies_ > 0) {
    out.seconds = body.seconds(double(last_body_ + 1));
  }
  return out;
}

std::string statistics_json(const Statistics& s) {
  Json json = {{"kind", s.kind},
               {"face_frames", s.faces},
               {"body_frames", s.bodies},
               {"rate", fap::format_rate(s.rate)},
               {"seconds", s.seconds}};
  if (s.bits) describe(*s.bits, json);
  json["faps"] = describe(s.faps, "fap", fap_bits(s), s.seconds);
  json["baps"] = describe(s.baps, "bap", bap_bits(s), s.seconds);
  return tools::pretty(json);
}

std::string statistics_text(const Statistics& s) {
  std::string text;
  text += format("%s: %.3f s, %s frames a second, ", s.kind.c_str(), s.seconds,
                 fap::format_rate(s.rate).c_str());
  if (s.faces > 0) text += format("%zu of a face%s", s.faces, s.bodies > 0 ? ", " : "\n");
  if (s.bodies > 0) text += format("%zu of a body%s\n", s.bodies, s.faces > 0 ? "" : ", no face");
  if (s.faces + s.bodies == 0) text += format("neither a face nor a body\n");
  if (s.bits) text += text_of(*s.bits);
  return text + text_of(s.faps, true, fap_bits(s), s.seconds) +
         text_of(s.baps, false, bap_bits(s), s.seconds);
}

}  // namespace animeme::inspect
