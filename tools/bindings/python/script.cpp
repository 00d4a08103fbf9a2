// Scripts: which sound is spoken when.
#include "dam/script/script.h"

#include "tools/bindings/python/python_internal.h"
#include "tools/formats/files/files.h"
#include "tools/speech/talking/voice_file.h"

namespace animeme::python {

namespace {

py::list read_script(const py::object& file, const std::string& lang) {
  const std::string path = path_of(file);
  speech::ScriptInput input;
  input.language = lang;
  WarningLog heard;
  auto script = unlocked([&] { return speech::read_script(path, input, heard.log()); });
  heard.tell();
  return phones_of(value_of(std::move(script)));
}

void write_script(const py::object& phones, const py::object& file) {
  const std::string path = path_of(file);
  const std::string text = dam::write_script(script_of(phones), tools::extension_of(path));
  value_of(tools::write_file(path, text));
}

}  // namespace

void bind_script(py::module_& module) {
  module.def("read_script", &read_script, py::arg("path"), py::kw_only(), py::arg("lang") = "en",
             R"(Timed phones of a file of any format: a list of Phone, seconds, without gaps.

TextGrid, label files, subtitles, JSON of recognisers and speech services, media files with
tracks of words.

path: str or os.PathLike.
lang: language of words without phones.

Raises Error with position.file and line.)");
  module.def("write_script", &write_script, py::arg("phones"), py::arg("path"),
             R"(Writes a script in the format of the extension: .TextGrid, .tsv, .pho, .vtt or .srt.

phones: tuples (start, end, label[, word]): seconds, ARPAbet without stress or "SIL".
path: str or os.PathLike.

Raises Error.)");
}

}  // namespace animeme::python
