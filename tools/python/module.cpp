// The module: all that `import animeme` gives, subject by subject.
#include "tools/python/python_internal.h"

PYBIND11_MODULE(_animeme, module) {
  using namespace animeme::python;
  module.attr("__version__") = ANIMEME_VERSION;
  // A file of stubs has the types of arguments; signatures name them as Python does.
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
  bind_head(module);
}
