// Corpora: folders with recordings, or sentences that a program has.
#include <algorithm>

#include "dam/signal/fap_signal.h"
#include "dam/training/alignment.h"
#include "tools/bindings/python/python_internal.h"
#include "tools/formats/inspect/left_out.h"

namespace animeme::python {

namespace {

// FAPs by number, all others by name.
std::vector<std::string> control_names(const py::object& controls) {
  std::vector<std::string> names;
  if (controls.is_none()) return names;
  for (const py::handle& control : controls) {
    if (!py::isinstance<py::int_>(control)) {
      names.push_back(control.cast<std::string>());
      continue;
    }
    const int fap = control.cast<int>();
    if (fap < fap::kFirstLowLevel || fap > fap::kFapCount) {
      throw py::value_error("FAP " + std::to_string(fap) + " is no control: 3 to 68 are");
    }
    names.push_back(dam::fap_channel(fap));
  }
  return names;
}

std::shared_ptr<Corpus> read_corpus(const py::object& folder, const std::string& split,
                                    const std::string& split_column, const py::object& controls,
                                    const std::string& controls_folder, bool skip_missing,
                                    double lag) {
  dam::CorpusOptions options;
  options.split_value = split;
  options.split_column = split_column;
  options.controls = control_names(controls);
  options.controls_folder = controls_folder;
  options.skip_missing = skip_missing;
  auto corpus = std::make_shared<Corpus>();
  corpus->folder = path_of(folder);
  corpus->corpus = value_of(unlocked([&] { return dam::read_corpus(corpus->folder, options); }));
  for (const std::string& text : inspect::blanks_text(corpus->corpus.left_out)) warn(text);
  if (lag != 0) {
    for (dam::Utterance& sentence : corpus->corpus.utterances) {
      sentence.script = dam::shifted_script(sentence.script, lag);
    }
  }
  return corpus;
}

dam::Signal signal_of(const py::object& values, const py::object& names, const py::object& rate) {
  if (py::isinstance<Clip>(values)) {
    if (!names.is_none()) throw py::type_error("a clip has its own names");
    return value_of(dam::to_signal(sequence_of(values.cast<const Clip&>())));
  }
  using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
  const auto array = array_from<Doubles>(values);
  dam::Signal signal;
  signal.rate = rate_of(rate);
  signal.names = control_names(names);
  if (array.ndim() != 2 || std::size_t(array.shape(1)) != signal.names.size() ||
      signal.names.empty()) {
    throw py::value_error("values is not (frames, names), a column a name");
  }
  signal.values.assign(array.data(), array.data() + array.size());
  return signal;
}

std::unique_ptr<dam::Utterance> make_sentence(const std::string& id, const py::object& phones,
                                              const py::object& values, const py::object& names,
                                              const py::object& rate, const py::object& measured,
                                              const std::string& text) {
  auto sentence = std::make_unique<dam::Utterance>();
  sentence->id = id;
  sentence->text = text;
  sentence->script = script_of(phones);
  sentence->signal = signal_of(values, names, rate);
  if (measured.is_none()) return sentence;
  sentence->signal.measured = measured.cast<std::vector<bool>>();
  if (sentence->signal.measured.size() != sentence->signal.frames()) {
    throw py::value_error("measured is not (frames,)");
  }
  return sentence;
}

py::array_t<bool> measured_of(const dam::Utterance& sentence) {
  const dam::Signal& signal = sentence.signal;
  py::array_t<bool> flags(py::ssize_t(signal.frames()));
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    flags.mutable_at(i) = signal.measured.empty() || signal.measured[i];
  }
  return flags;
}

py::dict fields_of(const dam::Utterance& sentence) {
  py::dict fields;
  for (const auto& [column, value] : sentence.fields) fields[py::str(column)] = value;
  return fields;
}

const dam::Utterance& sentence_of(const Corpus& corpus, const py::object& key) {
  const auto& all = corpus.corpus.utterances;
  if (py::isinstance<py::str>(key)) {
    const auto id = key.cast<std::string>();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const dam::Utterance& u) { return u.id == id; });
    if (found == all.end()) throw py::key_error(id);
    return *found;
  }
  const auto count = py::ssize_t(all.size());
  const auto index = key.cast<py::ssize_t>();
  if (index < -count || index >= count) throw py::index_error("the corpus has no such sentence");
  return all[std::size_t(index < 0 ? index + count : index)];
}

void bind_sentence(py::module_& module) {
  py::class_<dam::Utterance>(module, "Sentence",
                             "A recorded sentence: timed phones and the motion of the face.")
      .def(py::init(&make_sentence), py::arg("id"), py::arg("phones"), py::arg("values"),
           py::arg("names") = py::none(), py::kw_only(), py::arg("rate") = 25,
           py::arg("measured") = py::none(), py::arg("text") = "", R"(Makes a sentence from arrays.

id: a name, unique in a corpus.
phones: tuples (start, end, label[, word]): seconds, ARPAbet without stress or "SIL", ascending.
values: (frames, names), each control in its own units (FAP units for FAPs), time 0 first; or a
    Clip, whose FAPs are the controls then.
names: of the columns: FAP numbers, or names such as "jawOpen".
rate: frames a second; that of a Clip is its own.
measured: (frames,), False if a value is estimated; training ignores it.
text: what was said.)")
      .def_readonly("id", &dam::Utterance::id, "Name, unique in a corpus.")
      .def_readonly("text", &dam::Utterance::text, "What was said; empty: unknown.")
      .def_property_readonly(
          "phones", [](const dam::Utterance& u) { return phones_of(u.script); },
          "list of Phone: start and end in seconds, label, word.")
      .def_property_readonly(
          "values", [](const dam::Utterance& u) { return array_of(u.signal); },
          "float64 (frames, names): measured values, in the units of each control.")
      .def_property_readonly(
          "names", [](const dam::Utterance& u) { return u.signal.names; },
          "Names of the columns; FAPs are called \"fap3_open_jaw\".")
      .def_property_readonly("measured", &measured_of,
                             "bool (frames,): False if a value is estimated.")
      .def_property_readonly(
          "rate", [](const dam::Utterance& u) { return u.signal.rate.frames_per_second(); },
          "Frames a second.")
      .def_property_readonly(
          "clip",
          [](const dam::Utterance& u) { return clip_of(value_of(dam::to_sequence(u.signal))); },
          "The motion as a Clip; raises Error if the controls are neither FAPs nor ARKit's.")
      .def_property_readonly("fields", &fields_of,
                             "All columns of its row in utterances.tsv, as text.");
}

}  // namespace

std::shared_ptr<const Corpus> corpus_of(const py::handle& given) {
  if (py::isinstance<Corpus>(given)) return given.cast<std::shared_ptr<Corpus>>();
  auto corpus = std::make_shared<Corpus>();
  for (const py::handle& sentence : given) {
    corpus->corpus.utterances.push_back(sentence.cast<const dam::Utterance&>());
  }
  return corpus;
}

void bind_corpus(py::module_& module) {
  bind_sentence(module);
  py::class_<Corpus, std::shared_ptr<Corpus>>(module, "Corpus",
                                              R"(Recorded sentences of a folder.

The folder has utterances.tsv (a column `id`), phonemes/ID.tsv (or .TextGrid) and fap/ID.csv (or
.fap). corpus[3] and corpus["id"] are a Sentence; iteration yields all.)")
      .def(py::init(&read_corpus), py::arg("folder"), py::arg("split") = "", py::kw_only(),
           py::arg("split_column") = "split", py::arg("controls") = py::none(),
           py::arg("controls_folder") = "fap", py::arg("skip_missing") = false,
           py::arg("lag") = 0.0, R"(Reads a folder. Releases the GIL.

split: only rows with this value in `split_column`, such as "train"; empty: all.
controls: FAP numbers or names of columns, in this order; None: all of the first file.
controls_folder: folder of the curves, for example "arkit" for ARKit's weights.
skip_missing: skip rows without curves; otherwise they are an error.
lag: delay of the motion relative to the sound, seconds; scripts are shifted by it.

Raises Error with position.file and line.)")
      .def("__len__", [](const Corpus& c) { return c.corpus.utterances.size(); })
      .def("__getitem__", &sentence_of, py::arg("key"), py::return_value_policy::reference_internal)
      .def(
          "__iter__",
          [](const Corpus& c) {
            return py::make_iterator(c.corpus.utterances.begin(), c.corpus.utterances.end());
          },
          py::keep_alive<0, 1>())
      .def_property_readonly(
          "ids",
          [](const Corpus& c) {
            std::vector<std::string> ids;
            for (const dam::Utterance& u : c.corpus.utterances) ids.push_back(u.id);
            return ids;
          },
          "Names of the sentences, in their order.")
      .def_property_readonly(
          "duration", [](const Corpus& c) { return c.corpus.duration(); }, "Seconds of motion.")
      .def_readonly("folder", &Corpus::folder, "Where it was read from.");
}

}  // namespace animeme::python
