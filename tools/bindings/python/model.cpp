// Trained models.
#include "dam/model/model.h"

#include "dam/model/builtin.h"
#include "tools/bindings/python/python_internal.h"
#include "tools/formats/files/files.h"

namespace animeme::python {

namespace {

Model load_model(const py::object& path) {
  const std::string file = path_of(path);
  auto model = unlocked([&] { return dam::load_model(file); });
  if (!model) raise(std::move(model).error().in_file(file));
  return {std::move(*model), {}};
}

Model builtin_model() { return {value_of(dam::builtin_model()), {}}; }

py::bytes model_bytes(const Model& model) {
  const std::vector<std::uint8_t> bytes = dam::write_model(model.model);
  return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

Model from_bytes(const py::buffer& data) {
  const Bytes bytes(data);
  return {value_of(dam::read_model(bytes.span())), {}};
}

void save_model(const Model& model, const py::object& path) {
  value_of(tools::write_file(path_of(path), dam::write_model(model.model)));
}

template <class Items, class Name>
std::vector<std::string> listed(const Items& items, Name name) {
  std::vector<std::string> names;
  for (const auto& item : items) names.push_back(item.*name);
  return names;
}

}  // namespace

void bind_model(py::module_& module) {
  py::class_<Model>(module, "Model", R"(The result of train(): how a character moves its mouth.

A model is immutable and may be used by several threads.)")
      .def_property_readonly(
          "method", [](const Model& m) { return std::string(dam::method_name(m.model.method)); },
          "\"dam\", \"dam-paper\", \"cohen-massaro\", \"mmm\", \"triphone\", \"viseme\" or "
          "\"mean\".")
      .def_property_readonly(
          "controls", [](const Model& m) { return listed(m.model.controls, &dam::Control::name); },
          "Names of its controls, \"fap3_open_jaw\" or \"jawOpen\", in the order of its values.")
      .def_property_readonly(
          "phones", [](const Model& m) { return listed(m.model.phones, &dam::PhoneModel::label); },
          "ARPAbet labels of the phones that it has learned.")
      .def_property_readonly(
          "rate", [](const Model& m) { return m.model.rate.frames_per_second(); },
          "Frames a second of the recordings.")
      .def_property_readonly(
          "attribution", [](const Model& m) { return m.model.attribution; },
          "The attribution required when the model is redistributed.")
      .def_property_readonly(
          "provenance", [](const Model& m) { return m.model.provenance; }, "How it was made.")
      .def_property_readonly(
          "training",
          [](const Model& m) {
            return m.training.empty() ? py::object(py::dict()) : loads(m.training);
          },
          "Report of train(), as the dict that `animeme train --json` prints; {} if it was read.")
      .def("to_bytes", &model_bytes, "The bytes of its file.")
      .def_static("from_bytes", &from_bytes, py::arg("data"),
                  "Reads a model from bytes, or any object with a buffer. Raises Error.")
      .def("save", &save_model, py::arg("path"), "Writes the model file (.dam) atomically.")
      .def(
          "__eq__",
          [](const Model& m, const py::object& other) {
            return py::isinstance<Model>(other) && m.model == other.cast<const Model&>().model;
          },
          py::arg("other"))
      .def(py::pickle(&model_bytes, [](const py::bytes& state) { return from_bytes(state); }));

  module.def("load_model", &load_model, py::arg("path"),
             "Reads a model file (.dam). Raises Error with position.file.");
  module.def("builtin_model", &builtin_model,
             "The model that comes with Animeme: the mouth of one British speaker, 25 frames a\n"
             "second. Keep its `attribution`.");
}

}  // namespace animeme::python
