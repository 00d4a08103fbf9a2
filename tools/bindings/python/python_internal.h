// What the bindings share: errors, arrays, clips, and the way to long calls and back.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dam/corpus/corpus.h"
#include "dam/model/model.h"
#include "dam/script/script.h"
#include "dam/signal/signal.h"
#include "fap/fill.h"
#include "fap/frame.h"
#include "fap/result.h"
#include "tools/formats/files/log.h"
#include "tools/formats/media/pcm.h"
#include "tools/formats/media/text_track.h"

namespace animeme::python {

namespace py = pybind11;

// ---- raise.cpp: failures become exceptions, and long calls let others work ----

/// Raises animeme.Error.
[[noreturn]] void raise(const Error& error);
/// Warns with animeme.InputWarning; throws where the user made warnings errors.
void warn(const std::string& sentence);
/// Collects what a library has to say while the interpreter belongs to others.
struct WarningLog {
  std::vector<std::string> sentences;             ///< for warn()
  tools::Log log();                               ///< puts them there
  void tell(const std::string& file = {}) const;  ///< warns of all
};

/// The value, or animeme.Error.
template <class T>
T value_of(Result<T> result) {
  if (!result) raise(result.error());
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

/// Runs what touches nothing of Python while other threads have the interpreter.
template <class Work>
auto unlocked(Work work) {
  const py::gil_scoped_release release;
  return work();
}

/// Watches a long call: tells `callable(share, stage)` how far it is and looks for Ctrl-C. What
/// either of them raises waits until the call has ended.
class Watch {
 public:
  explicit Watch(py::object callable) : callable_(std::move(callable)) {}
  /// From within the call, without the interpreter; false: stop.
  bool go_on(double share, const char* stage);
  /// Behind the call: throws what was raised in it.
  void rethrow() const;

 private:
  py::object callable_;
  std::exception_ptr raised_;
};

// ---- convert.cpp: values of Python as those of the libraries, and back ----

/// The array over a vector, which it keeps: nothing is copied.
template <class T, class Element>
py::array_t<T> array_of(std::vector<Element>&& values, std::vector<py::ssize_t> shape) {
  static_assert(sizeof(T) == sizeof(Element));
  auto kept = std::make_unique<std::vector<Element>>(std::move(values));
  const auto* data = reinterpret_cast<const T*>(kept->data());
  py::capsule owner(kept.get(), [](void* p) { delete static_cast<std::vector<Element>*>(p); });
  kept.release();
  return py::array_t<T>(std::move(shape), data, owner);
}

/// An int, a float, a Fraction or "30000/1001" as a rate. Raises ValueError.
fap::Rate rate_of(const py::handle& rate);
py::object fraction_of(fap::Rate rate);

/// Bytes of any object with a buffer, one behind the other in memory; they live as long as this.
/// Raises TypeError, ValueError, BufferError.
class Bytes {
 public:
  explicit Bytes(const py::buffer& buffer) {
    // Rows that lie apart, or on top of each other, are not as many bytes as they say.
    if (PyObject_GetBuffer(buffer.ptr(), &view_, PyBUF_SIMPLE) != 0) throw py::error_already_set();
  }
  Bytes(const Bytes&) = delete;
  ~Bytes() { PyBuffer_Release(&view_); }
  std::span<const std::uint8_t> span() const;

 private:
  Py_buffer view_ = {};
};

/// An array of this kind. Raises what NumPy does (py::array_t::ensure() forgets it).
template <class Array>
Array array_from(const py::handle& given) {
  return Array(py::reinterpret_borrow<py::object>(given));
}

/// A path of str or os.PathLike.
std::string path_of(const py::object& path);

/// Tuples (start, end, label[, word]) as a script, checked. Raises Error.
dam::Script script_of(const py::handle& phones);
/// A list of animeme.Phone.
py::list phones_of(const dam::Script& script);

/// Values of a signal as an array (frames, names).
py::array_t<double> array_of(const dam::Signal& signal);

// ---- clip.cpp, clip_rows.cpp ----

/// Columns of the arrays of a clip.
inline constexpr std::size_t kFapColumns = fap::kFapCount, kVisemeColumns = 4,
                             kExpressionColumns = 6;

/// A clip as arrays. All have as many rows as there are frames, for as long as it lives.
struct Clip {
  fap::Rate rate;
  std::string name;
  py::array_t<std::int32_t> values;
  py::array_t<bool> mask;
  py::array_t<std::int64_t> numbers;
  py::array_t<std::int32_t> viseme;
  py::array_t<std::int32_t> expression;
  std::vector<fap::GroupRules> rules;  ///< of each frame; empty: not known
};

fap::Sequence sequence_of(const Clip& clip);
Clip clip_of(const fap::Sequence& sequence, std::vector<fap::GroupRules> rules = {});
/// From frames one by one, so that no sequence is needed.
class ClipRows {
 public:
  explicit ClipRows(std::size_t frames);
  void add(const fap::Frame& frame, const fap::GroupRules* rules = nullptr);
  Clip clip(fap::Rate rate, std::string name);  ///< takes them

 private:
  std::vector<std::int32_t> values_, viseme_, expression_;
  std::vector<std::uint8_t> mask_;
  std::vector<std::int64_t> numbers_;
  std::vector<fap::GroupRules> rules_;
};
/// One row of 68 values, with a mask, or None: all low-level FAPs. Raises ValueError.
fap::Frame frame_of(const py::handle& values, const py::handle& mask);
/// Rows of an array of any number type that is (frames, columns), rounded. Raises ValueError.
std::vector<std::int32_t> whole_rows(const py::handle& given, std::size_t columns,
                                     const char* name);
/// The clip as players show it, complete; FAP 1 and 2 as low-level FAPs unless they are kept.
fap::Sequence shown(const Clip& clip, bool keep_high_level);

// ---- codec.cpp, exchange.cpp ----

/// How a clip is coded, as Python has it.
struct Coding {
  std::string preset = "file";
  int quant = 1;
  double max_rms = 0;
  double max_bits_per_second = 0;
  std::optional<double> intra_seconds;
};
/// Codes it while others have the interpreter. Raises Error.
std::vector<std::uint8_t> coded(const fap::Sequence& clip, const Coding& coding,
                                const py::object& progress);

/// What goes into a file beside a clip.
struct Beside {
  const media::Pcm* sound = nullptr;
  std::string sound_file;
  std::vector<media::TextTrack> texts;
};
/// Writes a clip as the name of the file says. Raises Error.
void save(const fap::Sequence& clip, const std::string& path, const Coding& coding,
          const Beside& beside);

// ---- model.cpp, corpus.cpp ----

/// A model, and the summary of its training as JSON; empty: it was read.
struct Model {
  dam::Model model;
  std::string training;
};

/// A corpus: sentences, where they are from, and what was left out.
struct Corpus {
  std::string folder;
  dam::Corpus corpus;
};
/// The sentences of a Corpus, or of a list of Sentence. Shared, so that nothing is copied for a
/// Corpus. Raises TypeError.
std::shared_ptr<const Corpus> corpus_of(const py::handle& given);

/// Text of JSON as objects of Python.
py::object loads(const std::string& json);

// ---- each subject adds its classes and functions ----

void bind_clip(py::module_& module);
void bind_clip_tools(py::module_& module);
void bind_codec(py::module_& module);
void bind_corpus(py::module_& module);
void bind_evaluate(py::module_& module);
void bind_exchange(py::module_& module);
void bind_head(py::module_& module);
void bind_live(py::module_& module);
void bind_model(py::module_& module);
void bind_script(py::module_& module);
void bind_speak(py::module_& module);
void bind_voice(py::module_& module);
void bind_train(py::module_& module);

}  // namespace animeme::python
