// A face that follows a voice while it speaks: samples in, frames out.
#include <algorithm>

#include "tools/bindings/python/python_internal.h"
#include "tools/speech/talking/voice_driven_face.h"

namespace animeme::python {

namespace {

std::unique_ptr<speech::VoiceDrivenFace> make_voice(const Model& model, int sample_rate,
                                                    const std::string& lang, const py::object& rate,
                                                    double delay, double style, double sharpness,
                                                    std::optional<double> articulation,
                                                    bool closure, bool symmetric) {
  const speech::VoiceDrivenFaceOptions options{{.rate = rate_of(rate),
                                                .closure = closure,
                                                .style = style,
                                                .sharpness = sharpness,
                                                .articulation = articulation,
                                                .symmetric_rest = symmetric},
                                               lang,
                                               delay};
  return value_of(
      unlocked([&] { return speech::VoiceDrivenFace::open(model.model, sample_rate, options); }));
}

// One channel: whole numbers of 16 bits, or others with full scale +-1.
std::vector<float> samples_of(const py::object& samples_like) {
  const auto given = py::array::ensure(samples_like);
  if (!given) throw py::type_error("samples must be an array");
  if (given.ndim() != 1) throw py::value_error("samples must be one channel: an array (n,)");
  if (py::isinstance<py::array_t<std::int16_t>>(given)) {
    const auto whole = py::array_t<std::int16_t, py::array::c_style>(given);
    std::vector<float> samples(std::size_t(whole.size()));
    std::transform(whole.data(), whole.data() + whole.size(), samples.begin(),
                   [](std::int16_t sample) { return float(sample) / 32768; });
    return samples;
  }
  if (given.dtype().kind() != 'f') throw py::type_error("samples must be int16 or floats");
  const auto floats = py::array_t<float, py::array::c_style | py::array::forcecast>(given);
  return {floats.data(), floats.data() + floats.size()};
}

}  // namespace

void bind_voice(py::module_& module) {
  py::class_<speech::VoiceDrivenFace>(module, "VoiceStream",
                                      R"(Follows a live voice by its sound: samples in, frames out.

    for block in microphone:
        show(stream.push(block))

A frame is returned when `delay` more seconds of sound have arrived. While the sound is ambiguous,
the face moves less.)")
      .def(py::init(&make_voice), py::arg("model"), py::arg("sample_rate"), py::kw_only(),
           py::arg("lang") = "en", py::arg("rate") = 25, py::arg("delay") = 0.25,
           py::arg("style") = 1.0, py::arg("sharpness") = 1.0, py::arg("articulation") = py::none(),
           py::arg("closure") = true, py::arg("symmetric") = true, py::keep_alive<1, 2>(),
           R"(A stream that begins with its first sample, at time 0.

model: who speaks.
sample_rate: samples a second, 4000..384000.
lang: language of the voice.
rate: frames a second.
delay: seconds of sound beyond a frame, 0.08..2.
style, sharpness, articulation, closure, symmetric: as for Model.speak().

Raises Error.)")
      .def(
          "push",
          [](speech::VoiceDrivenFace& face, const py::object& samples) {
            const std::vector<float> some = samples_of(samples);
            return array_of(value_of(unlocked([&] {
              face.push(some);
              return face.pull();
            })));
          },
          py::arg("samples"),
          R"(Adds samples; returns the frames that became due: float64 (frames, controls), often none.

samples: (n,) int16, or floats with full scale +-1; one channel.

Frames do not depend on how the samples are split. Raises Error. Releases the GIL.)")
      .def(
          "finish",
          [](speech::VoiceDrivenFace& face) {
            return array_of(value_of(unlocked([&] { return face.finish(); })));
          },
          "Ends the voice; returns the remaining frames, float64 (frames, controls).");
}

}  // namespace animeme::python
