// The model file. Layout: dam/model/README.md.
#include <algorithm>

#include "dam/model/bytes_internal.h"
#include "dam/model/file_frame_internal.h"
#include "dam/model/kind_internal.h"
#include "dam/model/model.h"

namespace animeme::dam {
namespace {

constexpr FileFormat kModelFormat{"ANIMEDAM", 2, 3, "model file", "train the model again"};
/// What has no articulation is written as before there was one.
constexpr FileFormat kPlainFormat{"ANIMEDAM", 2, 2, "model file", "train the model again"};

Error damaged_model(const std::string& how) { return damaged_file(kModelFormat, how); }

/// Since 2.1: behind everything else, and only if something is limited.
void write_limits(const Model& model, ByteWriter& out) {
  const auto limited = std::count_if(model.limits.begin(), model.limits.end(),
                                     [](const ControlLimit& limit) { return !limit.free(); });
  out.count(std::size_t(limited));
  for (std::size_t c = 0; c < model.limits.size(); ++c) {
    const ControlLimit& limit = model.limits[c];
    if (!limit.free())
      out.put(std::uint32_t(c), limit.low, limit.high, limit.opposite, limit.shared);
  }
}

bool read_limits(ByteReader& in, Model& model) {
  const std::size_t limited = in.count(4 + 2 * 8 + 4 + 8);
  if (limited > 0) model.limits.resize(model.controls.size());
  for (std::size_t i = 0; i < limited; ++i) {
    const auto control = in.next<std::uint32_t>();
    ControlLimit limit;
    in.get(limit.low, limit.high, limit.opposite, limit.shared);
    if (in.failed() || control >= model.limits.size() || limit.free()) return false;
    model.limits[control] = limit;
  }
  return true;
}

Result<Model> read_payload(ByteReader& in, bool newer_minor) {
  Model model;
  in.get(model.method);
  if (method_name(model.method).empty())
    return make_error(
        Code::unsupported,
        "the model was made by a method that this version does not know; use a newer one");
  in.get(model.pause_edge, model.closure_gap);
  const auto has_raise = in.next<std::uint8_t>();
  const auto raise = in.next<double>();
  if (has_raise > 1) return damaged_model("unknown flag");
  if (has_raise == 1) model.lip_tooth_raise = raise;
  in.get(model.rate.num, model.rate.den, model.attribution, model.provenance);
  model.controls.resize(in.count(4 + 3 * 8));
  for (Control& c : model.controls) in.get(c.name, c.rest, c.mean, c.sd);
  model.phones.resize(in.count(4 + 4 + 4 + 8 + 8));
  for (PhoneModel& p : model.phones)
    in.get(p.label, p.examples, p.context_class, p.duration, p.longest);
  if (auto ok = kind_of(model.method).read(in, model); !ok)
    return damaged_model(ok.error().message);
  if (!in.at_end()) {  // since 2.1
    const auto has_shut = in.next<std::uint8_t>();
    ClosureDuration shut;
    in.get(shut.base, shut.slope);
    if (has_shut > 1) return damaged_model("unknown flag");
    if (has_shut == 1) model.closure_duration = shut;
    if (!in.failed() && !read_limits(in, model))
      return damaged_model("limits of a control that does not exist");
  }
  if (!in.failed() && !in.at_end()) in.get(model.articulation);  // since 2.3
  if (in.failed()) return damaged_model("its parts are larger than the file");
  if (!in.at_end() && !newer_minor) return damaged_model("there is data after the model");
  if (auto ok = validate(model); !ok) return make_error(Code::syntax, ok.error().message);
  return model;
}

}  // namespace

std::vector<std::uint8_t> write_model(const Model& model) {
  ByteWriter body;
  body.put(model.method, model.pause_edge, model.closure_gap);
  body.put(std::uint8_t(model.lip_tooth_raise ? 1 : 0), model.lip_tooth_raise.value_or(0));
  body.put(model.rate.num, model.rate.den, model.attribution, model.provenance);
  body.count(model.controls.size());
  for (const Control& c : model.controls) body.put(c.name, c.rest, c.mean, c.sd);
  body.count(model.phones.size());
  for (const PhoneModel& p : model.phones)
    body.put(p.label, p.examples, p.context_class, p.duration, p.longest);
  kind_of(model.method).write(model, body);
  const ClosureDuration shut = model.closure_duration.value_or(ClosureDuration{});
  body.put(std::uint8_t(model.closure_duration ? 1 : 0), shut.base, shut.slope);
  write_limits(model, body);
  if (model.articulation == 0) return frame_file(kPlainFormat, body.bytes);
  body.put(model.articulation);
  return frame_file(kModelFormat, body.bytes);
}

Result<Model> read_model(std::span<const std::uint8_t> bytes) {
  const auto body = open_frame(kModelFormat, bytes);
  if (!body) return body.error();
  ByteReader in(body->bytes);
  return read_payload(in, body->newer_minor);
}

Result<Model> load_model(const std::filesystem::path& path) {
  const auto bytes = load_file(kModelFormat, path);
  if (!bytes) return bytes.error();
  auto model = read_model(*bytes);
  if (!model) return std::move(model).error().in_file(path.string());
  return model;
}

}  // namespace animeme::dam
