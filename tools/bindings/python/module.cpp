// The module: all that `import animeme` gives, subject by subject.
#include "tools/bindings/python/python_internal.h"

PYBIND11_MODULE(_animeme, module) {
  using namespace animeme::python;
  // Classes and functions say where they are from: the package, not the file beside it.
  const py::object name = module.attr("__name__");
  module.attr("__name__") = "animeme";
  module.attr("__version__") = ANIMEME_VERSION;
  // What lists and the like hold is looked at late; pybind11 would call that a RuntimeError.
  py::register_local_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(thrown);
    } catch (const py::cast_error&) {
      PyErr_SetString(PyExc_TypeError, "an argument holds something of a wrong type");
    }
  });
  bind_clip(module);
  bind_codec(module);
  bind_live(module);
  bind_exchange(module);
  bind_script(module);
  bind_corpus(module);
  bind_model(module);
  bind_train(module);
  bind_evaluate(module);
  bind_speak(module);
  bind_voice(module);
  bind_head(module);
  module.attr("__name__") = name;
}
