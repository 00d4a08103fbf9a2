// Failures as exceptions of Python, warnings, and Ctrl-C in long calls.
#include "tools/bindings/python/python_internal.h"
#include "tools/formats/common/code_name.h"

namespace animeme::python {

namespace {

py::object type_named(const char* name) { return py::module_::import("animeme._types").attr(name); }

// A path may hold any bytes; what is no UTF-8 must not hide the error itself.
py::object readable(const std::string& text) {
  return py::reinterpret_steal<py::object>(
      PyUnicode_DecodeUTF8(text.data(), py::ssize_t(text.size()), "backslashreplace"));
}

py::object known(bool is, std::int64_t number) {
  return is ? py::object(py::int_(number)) : py::object(py::none());
}

}  // namespace

void raise(const Error& error) {
  const Position& at = error.where;
  const py::object position = type_named("Position")(
      at.file.empty() ? py::object(py::none()) : readable(at.file), known(at.line > 0, at.line),
      known(at.column > 0, at.column), known(at.bit >= 0, at.bit));
  const py::object type = type_named("Error");
  const py::object raised = type(readable(error.describe()), tools::code_name(error.code),
                                 readable(error.message), position);
  PyErr_SetObject(type.ptr(), raised.ptr());
  throw py::error_already_set();
}

void warn(const std::string& sentence) {
  const py::object text = readable(sentence);
  // Level 1 is the line that called: functions of C have no frame of their own.
  py::module_::import("warnings").attr("warn")(text, type_named("InputWarning"), 1);
}

tools::Log WarningLog::log() {
  tools::Log log;
  log.warn = [this](const std::string& sentence) { sentences.push_back(sentence); };
  return log;
}

void WarningLog::tell(const std::string& file) const {
  for (const std::string& sentence : sentences) {
    warn(file.empty() ? sentence : file + ": " + sentence);
  }
}

bool Watch::go_on(double share, const char* stage) {
  const py::gil_scoped_acquire acquire;
  if (raised_) return false;
  try {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!callable_.is_none()) callable_(share, stage);
  } catch (...) {
    raised_ = std::current_exception();
    return false;
  }
  return true;
}

void Watch::rethrow() const {
  if (raised_) std::rethrow_exception(raised_);
}

}  // namespace animeme::python
