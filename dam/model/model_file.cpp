// The model file. Layout: dam/model/README.md.
#include "dam/model/bytes_internal.h"
#include "dam/model/file_frame_internal.h"
#include "dam/model/kind_internal.h"
#include "dam/model/model.h"

namespace animeme::dam {
namespace {

constexpr FileFormat kModelFormat{"ANIMEDAM", 2, 0, "model file", "train the model anew"};

Error damaged_model(const std::string& how) { return damaged_file(kModelFormat, how); }

Result<Model> read_payload(ByteReader& in, bool newer_minor) {
  Model model;
  model.method = Method(in.number<std::uint8_t>());
  if (method_name(model.method).empty())
    return make_error(
        Code::unsupported,
        "the model was made by a method that this version does not know; use a newer one");
  model.pause_edge = in.real();
  model.closure_gap = in.real();
  const auto has_raise = in.number<std::uint8_t>();
  const double raise = in.real();
  if (has_raise > 1) return damaged_model("unknown flag");
  if (has_raise == 1) model.lip_tooth_raise = raise;
  model.rate.num = in.number<std::uint32_t>();
  model.rate.den = in.number<std::uint32_t>();
  model.attribution = in.text();
  model.provenance = in.text();
  model.controls.resize(in.count(4 + 3 * 8));
  for (Control& c : model.controls) {
    c.name = in.text();
    c.rest = in.real();
    c.mean = in.real();
    c.sd = in.real();
  }
  model.phones.resize(in.count(4 + 4 + 4 + 8 + 8));
  for (PhoneModel& p : model.phones) {
    p.label = in.text();
    p.examples = in.number<std::uint32_t>();
    p.context_class = in.number<std::uint32_t>();
    p.duration = in.real();
    p.longest = in.real();
  }
  if (auto ok = kind_of(model.method).read(in, model); !ok)
    return damaged_model(ok.error().message);
  if (in.failed()) return damaged_model("its parts are larger than the file");
  if (!in.at_end() && !newer_minor) return damaged_model("something follows the model");
  if (auto ok = validate(model); !ok) return make_error(Code::syntax, ok.error().message);
  return model;
}

}  // namespace

std::vector<std::uint8_t> write_model(const Model& model) {
  ByteWriter body;
  body.number(std::uint8_t(model.method));
  body.real(model.pause_edge);
  body.real(model.closure_gap);
  body.number(std::uint8_t(model.lip_tooth_raise ? 1 : 0));
  body.real(model.lip_tooth_raise.value_or(0));
  body.number(model.rate.num);
  body.number(model.rate.den);
  body.text(model.attribution);
  body.text(model.provenance);
  body.number(std::uint32_t(model.controls.size()));
  for (const Control& c : model.controls) {
    body.text(c.name);
    body.real(c.rest);
    body.real(c.mean);
    body.real(c.sd);
  }
  body.number(std::uint32_t(model.phones.size()));
  for (const PhoneModel& phone : model.phones) {
    body.text(phone.label);
    body.number(phone.examples);
    body.number(phone.context_class);
    body.real(phone.duration);
    body.real(phone.longest);
  }
  kind_of(model.method).write(model, body);
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

Result<void> save_model(const Model& model, const std::filesystem::path& path) {
  if (auto ok = validate(model); !ok) return ok;
  return save_file(kModelFormat, write_model(model), path);
}

}  // namespace animeme::dam
