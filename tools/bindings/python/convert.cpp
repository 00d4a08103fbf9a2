// Values of Python as those of the libraries, and back.
#include <limits>

#include "fap/rate_text.h"
#include "tools/bindings/python/python_internal.h"
#include "tools/formats/common/text.h"

namespace animeme::python {

namespace {

fap::Rate checked(const Result<fap::Rate>& rate, const py::handle& given) {
  if (rate && rate->valid()) return *rate;
  throw py::value_error("rate is no number of frames a second: " +
                        py::repr(given).cast<std::string>());
}

std::uint32_t part_of(const py::object& number, const py::handle& given) {
  const auto part = number.cast<std::int64_t>();
  if (part > 0 && part <= std::numeric_limits<std::uint32_t>::max()) return std::uint32_t(part);
  throw py::value_error("rate is out of bounds: " + py::repr(given).cast<std::string>());
}

}  // namespace

fap::Rate rate_of(const py::handle& rate) {
  if (py::isinstance<py::str>(rate))
    return checked(fap::parse_rate(rate.cast<std::string>()), rate);
  if (py::hasattr(rate, "denominator") && !py::isinstance<py::float_>(rate)) {
    return fap::make_rate(part_of(rate.attr("numerator"), rate),
                          part_of(rate.attr("denominator"), rate));
  }
  // As a person would write it: 29.97 and 30000 / 1001 are both the fraction.
  std::string text = tools::format("%.9f", rate.cast<double>());
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return checked(fap::parse_rate(text), rate);
}

py::object fraction_of(fap::Rate rate) {
  return py::module_::import("fractions").attr("Fraction")(rate.num, rate.den);
}

std::span<const std::uint8_t> Bytes::span() const {
  return {static_cast<const std::uint8_t*>(view_.buf), std::size_t(view_.len)};
}

std::string path_of(const py::object& path) {
  return py::module_::import("os").attr("fsencode")(path).cast<std::string>();
}

dam::Script script_of(const py::handle& phones) {
  dam::Script script;
  for (const py::handle& each : phones) {
    const auto fields = py::reinterpret_borrow<py::sequence>(each);
    if (!PySequence_Check(each.ptr()) || fields.size() < 3 || fields.size() > 4) {
      throw py::type_error("a phone is (start, end, label) or (start, end, label, word), not " +
                           py::repr(each).cast<std::string>());
    }
    script.phones.push_back({fields[0].cast<double>(), fields[1].cast<double>(),
                             fields[2].cast<std::string>(),
                             fields.size() < 4 ? std::string() : fields[3].cast<std::string>()});
  }
  value_of(dam::check_script(script));
  return script;
}

py::list phones_of(const dam::Script& script) {
  const py::object type = py::module_::import("animeme._types").attr("Phone");
  py::list list;
  for (const dam::Phone& phone : script.phones) {
    list.append(type(phone.start, phone.end, phone.label, phone.word));
  }
  return list;
}

py::array_t<double> array_of(const dam::Signal& signal) {
  py::array_t<double> array({signal.frames(), signal.names.size()});
  std::copy(signal.values.begin(), signal.values.end(), array.mutable_data());
  return array;
}

py::object loads(const std::string& json) {
  return py::module_::import("json").attr("loads")(json);
}

}  // namespace animeme::python
