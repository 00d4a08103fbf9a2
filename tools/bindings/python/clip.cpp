// The class Clip: arrays of what is coded of a face.
#include "fap/tables.h"
#include "tools/bindings/python/python_internal.h"

namespace animeme::python {

namespace {

using Ints = py::array_t<std::int32_t>;

// A mask of (frames, 68), or one of 68 for all frames.
py::array_t<bool> mask_rows(const py::object& given, std::size_t frames) {
  const auto array =
      array_from<py::array_t<bool, py::array::c_style | py::array::forcecast>>(given);
  const bool one = array.ndim() == 1 && std::size_t(array.shape(0)) == kFapColumns;
  const bool all = array.ndim() == 2 && std::size_t(array.shape(0)) == frames &&
                   std::size_t(array.shape(1)) == kFapColumns;
  if (!one && !all) throw py::value_error("mask is neither (frames, 68) nor (68,)");
  py::array_t<bool> mask({frames, kFapColumns});
  for (std::size_t i = 0; i < frames; ++i) {
    std::copy_n(array.data() + (one ? 0 : i * kFapColumns), kFapColumns,
                mask.mutable_data() + i * kFapColumns);
  }
  return mask;
}

Ints part_rows(const py::object& given, std::size_t frames, std::size_t columns, const char* name) {
  std::vector<std::int32_t> rows(frames * columns);
  if (!given.is_none()) rows = whole_rows(given, columns, name);
  if (rows.size() != frames * columns) {
    throw py::value_error(std::string(name) + " has another number of frames than values");
  }
  return array_of<std::int32_t>(std::move(rows), {py::ssize_t(frames), py::ssize_t(columns)});
}

py::array_t<std::int64_t> numbers_of(const py::object& given, std::size_t frames) {
  if (given.is_none()) {
    py::array_t<std::int64_t> numbers(frames);
    for (std::size_t i = 0; i < frames; ++i) numbers.mutable_at(i) = std::int64_t(i);
    return numbers;
  }
  const auto array =
      array_from<py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>>(given);
  if (array.ndim() != 1 || std::size_t(array.size()) != frames) {
    throw py::value_error("numbers is not (frames,)");
  }
  for (std::size_t i = 0; i < frames; ++i) {
    if (array.at(i) < 0 || (i > 0 && array.at(i) <= array.at(i - 1))) {
      throw py::value_error("the numbers of frames have to ascend from 0 or more");
    }
  }
  return py::array_t<std::int64_t>(py::module_::import("numpy").attr("array")(array));
}

std::unique_ptr<Clip> make_clip(const py::object& values, const py::object& mask,
                                const py::object& rate, const py::object& numbers,
                                const py::object& viseme, const py::object& expression,
                                const std::string& name) {
  auto clip = std::make_unique<Clip>();
  clip->rate = rate_of(rate);
  clip->name = name;
  std::vector<std::int32_t> rows = whole_rows(values, kFapColumns, "values");
  const std::size_t frames = rows.size() / kFapColumns;
  clip->values = array_of<std::int32_t>(std::move(rows), {py::ssize_t(frames), kFapColumns});
  clip->numbers = numbers_of(numbers, frames);
  clip->viseme = part_rows(viseme, frames, kVisemeColumns, "viseme");
  clip->expression = part_rows(expression, frames, kExpressionColumns, "expression");
  if (!mask.is_none()) {
    clip->mask = mask_rows(mask, frames);
    return clip;
  }
  clip->mask = py::array_t<bool>({frames, kFapColumns});
  for (std::size_t i = 0; i < frames * kFapColumns; ++i) {
    const std::size_t fap = i % kFapColumns;
    clip->mask.mutable_data()[i] = fap == 0   ? !viseme.is_none()
                                   : fap == 1 ? !expression.is_none()
                                              : true;
  }
  return clip;
}

// What `clip.values = x` does: the array stays, its content changes, rounded as that of a new clip.
auto filled(Ints Clip::*member, const char* name) {
  return [member, name](Clip& clip, const py::object& given) {
    Ints& array = clip.*member;
    const py::object shape = array.attr("shape");
    const py::object all = py::module_::import("numpy").attr("broadcast_to")(given, shape);
    const auto rows = whole_rows(all, std::size_t(array.shape(1)), name);
    std::copy(rows.begin(), rows.end(), array.mutable_data());
  };
}

void fill_mask(Clip& clip, const py::object& given) {
  const py::object mask = clip.mask;
  mask[py::ellipsis()] = given;
}

// The index of a FAP's column in `values` and `mask`.
py::ssize_t column_of(const std::string& name) {
  const auto fap = fap::find_fap(name);
  if (!fap) throw py::key_error("no FAP is called " + name);
  return *fap - 1;
}

py::object item_of(const Clip& clip, const py::object& key) {
  if (py::isinstance<py::str>(key)) {
    return clip.values[py::make_tuple(py::ellipsis(), column_of(key.cast<std::string>()))];
  }
  if (!py::isinstance<py::slice>(key)) {
    throw py::type_error("a clip is indexed by a slice of frames or by the name of a FAP");
  }
  std::size_t start = 0, stop = 0, step = 0, count = 0;
  if (!key.cast<py::slice>().compute(clip.values.shape(0), &start, &stop, &step, &count)) {
    throw py::error_already_set();
  }
  if (step != 1) throw py::value_error("frames are taken one by one; resample() leaves some out");
  const auto copy = [&key](const py::object& array) { return array[key].attr("copy")(); };
  Clip part{clip.rate,          clip.name,         copy(clip.values),     copy(clip.mask),
            copy(clip.numbers), copy(clip.viseme), copy(clip.expression), {}};
  for (std::size_t i = count; i-- > 0;) part.numbers.mutable_at(i) -= part.numbers.at(0);
  if (!clip.rules.empty()) {
    part.rules.assign(clip.rules.begin() + std::ptrdiff_t(start),
                      clip.rules.begin() + std::ptrdiff_t(start + count));
  }
  return py::cast(std::move(part));
}

// What `clip["open_jaw"] = x` does. In-place arithmetic (`clip["open_jaw"] *= 2`) hands the column
// itself back: it has its values already, and what was absent stays absent.
void set_item(Clip& clip, const std::string& name, const py::object& given) {
  const py::ssize_t column = column_of(name);
  if (column < 2) throw py::key_error("FAP 1 and 2 are set by clip.viseme and clip.expression");
  const auto numpy = py::module_::import("numpy");
  const py::object place = clip.values[py::make_tuple(py::ellipsis(), column)];
  if (py::isinstance<py::array>(given)) {
    const auto array = given.cast<py::array>();
    const bool own = array.ndim() == 1 && array.data() == place.cast<py::array>().data() &&
                     array.dtype().is(place.cast<py::array>().dtype()) &&
                     array.strides(0) == place.cast<py::array>().strides(0);
    if (own) return;
  }
  const py::object all = numpy.attr("broadcast_to")(given, py::make_tuple(clip.values.shape(0)));
  const auto rows = whole_rows(all.attr("reshape")(-1, 1), 1, name.c_str());
  auto values = clip.values.mutable_unchecked<2>();
  auto mask = clip.mask.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < values.shape(0); ++i) {
    values(i, column) = rows[std::size_t(i)];
    mask(i, column) = true;
  }
}

py::array_t<double> clip_times(const Clip& clip) {
  py::array_t<double> times(clip.numbers.size());
  for (py::ssize_t i = 0; i < times.size(); ++i) {
    times.mutable_at(i) = clip.rate.seconds(double(clip.numbers.at(i)));
  }
  return times;
}

// A view, whose shape is its own: what is done to it cannot be done to the clip's array.
template <class Member>
auto view_of(Member member) {
  return [member](const Clip& clip) -> py::object { return (clip.*member)[py::ellipsis()]; };
}

std::string repr_of(const Clip& clip) {
  const fap::Sequence sequence = sequence_of(clip);
  fap::Mask any;
  for (const fap::Frame& frame : sequence.frames) any |= frame.mask;
  return "<animeme.Clip: " + std::to_string(sequence.frames.size()) + " frames, " +
         std::to_string(any.count()) + " FAPs, " +
         py::str(py::float_(clip.rate.frames_per_second())).cast<std::string>() +
         " frames a second>";
}

bool equal(const Clip& a, const py::object& b) {
  if (!py::isinstance<Clip>(b)) return false;
  const auto one = sequence_of(a), other = sequence_of(b.cast<const Clip&>());
  return one.rate == other.rate && one.frames == other.frames;
}

}  // namespace

void bind_clip(py::module_& module) {
  py::class_<Clip>(module, "Clip", R"(A clip of a face: its coded values, frame by frame.

Rows of the arrays are frames. Their content may be changed, but not their shape. FAP n is column
n - 1. A FAP whose mask is False is absent: it keeps the value that a receiver shows, which is
not the same as 0. len(clip) is the number of frames; clip[10:20] is a part that begins at
time 0 (of clip.fill() if FAPs are absent that were present before); clip["open_jaw"] is the column of
a FAP, a view: clip["open_jaw"] *= 2 changes the clip. clip["open_jaw"] = x (a number or one for each
frame, rounded as values are) also sets the mask of that FAP in every frame.)")
      .def(py::init(&make_clip), py::arg("values"), py::arg("mask") = py::none(),
           py::arg("rate") = 25, py::kw_only(), py::arg("numbers") = py::none(),
           py::arg("viseme") = py::none(), py::arg("expression") = py::none(), py::arg("name") = "",
           R"(Makes a clip from arrays, which are copied.

values: (frames, 68), FAP units: 1/1024 of the FAP's unit or 1e-5 rad; rounded to integers.
    Columns 0 and 1 are not used, see viseme and expression.
mask: (frames, 68) or (68,), True if a FAP is present; None: all low-level FAPs, FAP 1
    with viseme and FAP 2 with expression.
rate: frames a second: a number, a Fraction or "30000/1001"; 29.97 is the NTSC rate.
numbers: (frames,), ascending frame numbers at the rate, gaps are skipped frames; None: 0, 1, 2 ...
viseme: (frames, 4): select1, select2 0..14, blend 0..63, def 0 or 1.
expression: (frames, 6): select1 0..6, intensity1 0..63, select2, intensity2, init_face, def.
name: free text.)")
      .def_property("values", view_of(&Clip::values), filled(&Clip::values, "values"),
                    "int32 (frames, 68): FAP n in column n - 1, FAP units; 0 if absent.")
      .def_property("mask", view_of(&Clip::mask), &fill_mask,
                    "bool (frames, 68): True if the frame has the FAP.")
      .def_property("viseme", view_of(&Clip::viseme), filled(&Clip::viseme, "viseme"),
                    "int32 (frames, 4): FAP 1 where mask[:, 0]: select1, select2, blend, def.")
      .def_property(
          "expression", view_of(&Clip::expression), filled(&Clip::expression, "expression"),
          "int32 (frames, 6): FAP 2 where mask[:, 1]: select1, intensity1, select2, intensity2,\n"
          "init_face, def.")
      .def_property_readonly(
          "numbers", [](const Clip& c) { return c.numbers.attr("copy")(); },
          "int64 (frames,): frame numbers at the rate, ascending; gaps are skipped frames.")
      .def_property_readonly("times", &clip_times,
                             "float64 (frames,): presentation time of each frame, seconds.")
      .def_property_readonly(
          "rate", [](const Clip& c) { return c.rate.frames_per_second(); },
          "Frames a second, as a float.")
      .def_property_readonly(
          "exact_rate", [](const Clip& c) { return fraction_of(c.rate); },
          "Frames a second, as a fractions.Fraction.")
      .def_property_readonly(
          "duration",
          [](const Clip& c) {
            const auto n = c.numbers.size();
            return n == 0 ? 0.0 : c.rate.seconds(double(c.numbers.at(n - 1) + 1));
          },
          "Seconds from time 0 to the end of the last frame.")
      .def_readwrite("name", &Clip::name, "Free text for people.")
      .def("__len__", [](const Clip& c) { return c.numbers.size(); })
      .def("__getitem__", &item_of, py::arg("key"))
      .def("__setitem__", &set_item, py::arg("name"), py::arg("values"))
      .def("__eq__", &equal, py::arg("other"))
      .def("__repr__", &repr_of);
  bind_clip_tools(module);
}

}  // namespace animeme::python
