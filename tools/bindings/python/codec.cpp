// Whole clips to streams and back.
#include "codec/decode/decoder.h"
#include "codec/decode/fill.h"
#include "codec/encode/encode.h"
#include "tools/bindings/python/python_internal.h"

namespace animeme::python {

namespace {

fba::EncodeOptions options_of(const Coding& coding) {
  fba::EncodeOptions options;
  if (coding.preset == "file") {
    options = fba::file_options();
  } else if (coding.preset == "live") {
    options = fba::live_options();
  } else if (coding.preset != "plain") {
    throw py::value_error("preset is \"file\", \"live\" or \"plain\", not \"" + coding.preset +
                          "\"");
  }
  options.fap_quant = coding.quant;
  options.max_rms = coding.max_rms;
  options.max_bits_per_second = coding.max_bits_per_second;
  if (coding.intra_seconds) options.intra_seconds = *coding.intra_seconds;
  return options;
}

py::bytes encode(const Clip& clip, const std::string& preset, int quant, double max_rms,
                 double max_bits_per_second, std::optional<double> intra_seconds,
                 const py::object& progress) {
  const Coding coding{preset, quant, max_rms, max_bits_per_second, intra_seconds};
  const std::vector<std::uint8_t> stream = coded(sequence_of(clip), coding, progress);
  return py::bytes(reinterpret_cast<const char*>(stream.data()), stream.size());
}

Clip decode(const py::buffer& stream) {
  const Bytes bytes(stream);
  const auto decoded = value_of(unlocked([&] { return fba::decode(bytes.span()); }));
  for (const std::string& sentence : decoded.warnings) warn(sentence);
  ClipRows rows(decoded.planes.size());
  const fba::FaceSettings none;
  for (const fba::Plane& plane : decoded.planes) {
    if (!fba::has_face(plane.object_mask)) continue;
    const auto rules = fba::group_rules(plane.face_settings ? *plane.face_settings : none);
    rows.add(plane.face, &rules);
  }
  return rows.clip(decoded.rate, {});
}

}  // namespace

std::vector<std::uint8_t> coded(const fap::Sequence& clip, const Coding& coding,
                                const py::object& progress) {
  fba::EncodeOptions options = options_of(coding);
  // The encoder has no way to cancel: an exception leaves it.
  struct Stopped {};
  Watch watch(progress);
  options.progress = [&watch](double share) {
    if (!watch.go_on(share, "coding")) throw Stopped();
  };
  auto stream = unlocked([&]() -> Result<std::vector<std::uint8_t>> {
    try {
      return fba::encode(clip, options);
    } catch (const Stopped&) {
      return make_error(Code::internal, "stopped");
    }
  });
  watch.rethrow();
  return value_of(std::move(stream));
}

void bind_codec(py::module_& module) {
  module.def("encode", &encode, py::arg("clip"), py::kw_only(), py::arg("preset") = "file",
             py::arg("quant") = 1, py::arg("max_rms") = 0.0, py::arg("max_bits_per_second") = 0.0,
             py::arg("intra_seconds") = py::none(), py::arg("progress") = py::none(),
             R"(Encodes a clip to an FBA stream (ISO/IEC 14496-2), verified by decoding it.

clip: a Clip with at least one frame.
preset: "file": the smallest stream with the same values; "live": receivers can join every 2 s;
    "plain": every FAP of the clip in every plane.
quant: 0..31; 1: the standard's steps, not visible; 0: lossless for values up to +-1860.
max_rms: above 0: the smallest size for this RMS error in FAP units (for angles in half
    quantiser steps); quant is ignored.
max_bits_per_second: above 0: the smallest error at this bit rate; quant is ignored.
intra_seconds: seconds between planes where decoding can begin; 0: one; None: as the preset says.
progress: called now and then with (share 0..1, "coding") where a limit makes it search.

FAPs that a frame lacks keep their last value. Other threads run meanwhile. Raises Error.)");
  module.def("decode", &decode, py::arg("stream"),
             R"(The face of a complete FBA stream as a Clip: mask is True if a value was coded.

stream: bytes or any object with a buffer; it is not copied.

Raises Error at the first fault, with position.bit; use Decoder to continue after it. Releases the
GIL.)");
}

}  // namespace animeme::python
