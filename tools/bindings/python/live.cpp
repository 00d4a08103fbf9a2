// Streams while they are sent: push bytes, pull planes; frames in, units out.
#include <algorithm>

#include "codec/decode/access_unit.h"
#include "codec/decode/decoder.h"
#include "codec/encode/live.h"
#include "codec/syntax/body_tables.h"
#include "fap/tables.h"
#include "tools/bindings/python/python_internal.h"

namespace animeme::python {

namespace {

constexpr py::ssize_t kFaceRow = fap::kFapCount, kBodyRow = fba::kBapCount;

struct Decoder {
  fba::Decoder decoder;
  std::vector<std::string> warnings;
  bool ended = false;
};

// The next plane, or None: more bytes are needed, or the stream is over.
py::object pull(Decoder& self) {
  for (;;) {
    auto event = self.decoder.next();
    if (!event) {
      self.ended = event.error().code == Code::end_of_stream;
      if (self.ended || event.error().code == Code::need_data) return py::none();
      raise(event.error());
    }
    if (event->kind == fba::Event::Kind::plane) return py::cast(std::move(event->plane));
    if (event->kind == fba::Event::Kind::warning) {
      self.warnings.push_back("bit " + std::to_string(event->bit) + ": " + event->text);
    }
  }
}

py::object next_plane(Decoder& self) {
  py::object plane = pull(self);
  if (plane.is_none()) throw py::stop_iteration();
  return plane;
}

// n values behind an unused first one.
template <class Values>
py::array_t<std::int32_t> row_of(const Values& values, py::ssize_t count) {
  return py::array_t<std::int32_t>(count, values.data() + 1);
}

template <class Mask>
py::array_t<bool> flags_of(const Mask& mask, py::ssize_t count) {
  py::array_t<bool> flags(count);
  for (py::ssize_t i = 0; i < count; ++i) flags.mutable_at(i) = mask[std::size_t(i + 1)];
  return flags;
}

py::object viseme_of(const fba::Plane& plane) {
  const fap::Viseme& v = plane.face.viseme;
  return plane.face.mask[1] ? py::object(py::make_tuple(v.select1, v.select2, v.blend, int(v.def)))
                            : py::object(py::none());
}

py::object expression_of(const fba::Plane& plane) {
  const fap::Expression& e = plane.face.expression;
  if (!plane.face.mask[2]) return py::none();
  return py::make_tuple(e.select1, e.intensity1, e.select2, e.intensity2, int(e.init_face),
                        int(e.def));
}

py::object body_of(const fba::Plane& plane) {
  if (!plane.body) return py::none();
  return py::make_tuple(row_of(plane.body->value, kBodyRow), flags_of(plane.body->mask, kBodyRow));
}

std::unique_ptr<fba::LiveEncoder> make_encoder(const py::object& rate, int quant,
                                               double intra_seconds) {
  fba::LiveOptions options;
  options.rate = rate_of(rate);
  options.fap_quant = quant;
  options.intra_seconds = intra_seconds;
  // The encoder checks its options with the first frame; check them here.
  if (auto tried = fba::LiveEncoder(options).write({}); !tried) raise(tried.error());
  return std::make_unique<fba::LiveEncoder>(options);
}

py::bytes unit_bytes(const std::vector<std::uint8_t>& unit) {
  return py::bytes(reinterpret_cast<const char*>(unit.data()), unit.size());
}

// The same for all streams of a face: Simple Face Animation, level 2.
py::bytes config_of(const fba::LiveEncoder&) {
  constexpr std::size_t kProfileByte = 4;
  constexpr std::uint8_t kSimpleFaceLevel2 = 0x62;
  fba::LiveEncoder encoder;
  auto stream = value_of(encoder.write({}));
  const auto end = encoder.finish();
  stream.insert(stream.end(), end.begin(), end.end());
  auto config = value_of(fba::split_access_units(stream)).config;
  config[kProfileByte] = kSimpleFaceLevel2;
  return unit_bytes(config);
}

void bind_plane(py::module_& module) {
  py::class_<fba::Plane>(module, "Plane", "A decoded plane of a stream: what it codes.")
      .def_readonly("number", &fba::Plane::number, "Running number at the rate, from 0.")
      .def_readonly("seconds", &fba::Plane::seconds, "When it is shown.")
      .def_readonly("intra", &fba::Plane::intra, "True: decoding can begin here.")
      .def_property_readonly(
          "face", [](const fba::Plane& p) { return fba::has_face(p.object_mask); },
          "True: the plane codes a face, possibly an empty one.")
      .def_property_readonly(
          "rate", [](const fba::Plane& p) { return p.rate.frames_per_second(); },
          "Planes a second in force; 30 until the stream sends a rate.")
      .def_property_readonly(
          "values", [](const fba::Plane& p) { return row_of(p.face.value, kFaceRow); },
          "int32 (68,): FAP n at n - 1, FAP units; 0 if not coded.")
      .def_property_readonly(
          "mask", [](const fba::Plane& p) { return flags_of(p.face.mask, kFaceRow); },
          "bool (68,): True if a value was coded.")
      .def_property_readonly("viseme", &viseme_of,
                             "FAP 1 if it was coded: (select1, select2, blend, def); else None.")
      .def_property_readonly("expression", &expression_of,
                             "FAP 2 if it was coded: (select1, intensity1, select2, intensity2,\n"
                             "init_face, def); else None.")
      .def_property_readonly(
          "body", &body_of,
          "(values, mask) of BAP 1..296 if a body was coded: int32 (296,), 1e-5\n"
          "rad, and bool (296,); else None.")
      .def_property_readonly(
          "bits", [](const fba::Plane& p) { return py::make_tuple(p.bit_begin, p.bit_end); },
          "First bit of the plane and first bit after it, from the start of the stream.");
}

}  // namespace

void bind_live(py::module_& module) {
  bind_plane(module);
  py::class_<Decoder>(module, "Decoder", R"(Decodes a stream incrementally: push bytes, pull planes.

    for packet in connection:
        decoder.push(packet)
        for plane in decoder:
            show(plane.values, plane.mask)

A decoder takes less than 2 MB for any input.)")
      .def(py::init<>(), "Creates a decoder for a new stream.")
      .def(
          "push", [](Decoder& d, const py::buffer& data) { d.decoder.push(Bytes(data).span()); },
          py::arg("data"), "Appends bytes of the stream, cut anywhere. They are copied.")
      .def(
          "finish", [](Decoder& d) { d.decoder.finish(); },
          "No more bytes will come; what is pushed later is ignored.")
      .def("pull", &pull,
           "The next Plane, or None: push more, or `ended`. Raises Error with position.bit; call\n"
           "again to continue at the next plane where decoding can begin.")
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__", &next_plane, "As pull(), where None ends the loop; begin another one later.")
      .def_readonly("ended", &Decoder::ended, "True once pull() has met the end of the stream.")
      .def_readonly("warnings", &Decoder::warnings, "What was odd so far, a sentence each.");

  py::class_<fba::LiveEncoder>(module, "Encoder",
                               R"(Encodes a live stream: a frame in, a unit out.

    encoder = animeme.Encoder(rate=30, quant=2)
    send(encoder.write(values))

Without look-ahead; units can be separated: each begins with a start code.)")
      .def(py::init(&make_encoder), py::kw_only(), py::arg("rate") = 25, py::arg("quant") = 1,
           py::arg("intra_seconds") = 2.0, R"(Creates an encoder for a new stream.

rate: units a second: a number, a Fraction or "30000/1001".
quant: 0..31; 1: the standard's steps.
intra_seconds: seconds between units where receivers can join; 0: only where needed.)")
      .def(
          "write",
          [](fba::LiveEncoder& e, const py::object& values, const py::object& mask,
             std::uint32_t skip) {
            return unit_bytes(value_of(e.write(frame_of(values, mask), skip)));
          },
          py::arg("values"), py::arg("mask") = py::none(), py::arg("skip") = 0,
          R"(The bytes of one frame.

values: (68,), FAP units, FAP n at n - 1; rounded to integers.
mask: (68,), True if a FAP is sent, others keep their value; None: all low-level FAPs.
skip: number of frames skipped after this one.

Raises Error; the stream is then as if the frame had not been passed.)")
      .def(
          "finish", [](fba::LiveEncoder& e) { return unit_bytes(e.finish()); },
          "The bytes that end the stream.")
      .def_property_readonly("config", &config_of,
                             "bytes: the configuration of a decoder (DecoderSpecificInfo), as\n"
                             "containers and the first message of /face carry it.")
      .def_property_readonly("intra", &fba::LiveEncoder::intra,
                             "True: receivers can join at the last unit.")
      .def_property_readonly(
          "shown",
          [](const fba::LiveEncoder& e) { return row_of(e.reconstruction().value, kFaceRow); },
          "int32 (68,): the values of receivers after the last unit.");
}

}  // namespace animeme::python
