// Between frames of the library and rows of arrays.
#include <cmath>

#include "tools/bindings/python/python_internal.h"

namespace animeme::python {

namespace {

std::int32_t whole(double value, const char* name) {
  const double rounded = std::round(value);  // halves away from zero, as everywhere
  if (!(std::abs(rounded) <= 2147483647.0)) {
    throw py::value_error(std::string(name) + " has a value that is no number of 32 bits");
  }
  return std::int32_t(rounded);
}

}  // namespace

std::vector<std::int32_t> whole_rows(const py::handle& given, std::size_t columns,
                                     const char* name) {
  using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
  const auto array = array_from<Doubles>(given);
  if (array.ndim() != 2 || std::size_t(array.shape(1)) != columns) {
    throw py::value_error(std::string(name) + " is not (frames, " + std::to_string(columns) + ")");
  }
  std::vector<std::int32_t> rows(std::size_t(array.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = whole(array.data()[i], name);
  return rows;
}

ClipRows::ClipRows(std::size_t frames) {
  values_.reserve(frames * kFapColumns);
  mask_.reserve(frames * kFapColumns);
  viseme_.reserve(frames * kVisemeColumns);
  expression_.reserve(frames * kExpressionColumns);
  numbers_.reserve(frames);
}

void ClipRows::add(const fap::Frame& frame, const fap::GroupRules* rules) {
  numbers_.push_back(frame.number);
  values_.insert(values_.end(), frame.value.begin() + 1, frame.value.end());
  // Those of FAP 1 and 2 are parts, which stand beside.
  values_[values_.size() - kFapColumns] = values_[values_.size() - kFapColumns + 1] = 0;
  for (std::size_t fap = 1; fap <= kFapColumns; ++fap) mask_.push_back(frame.mask[fap] ? 1 : 0);
  const fap::Viseme& v = frame.viseme;
  viseme_.insert(viseme_.end(), {v.select1, v.select2, v.blend, v.def ? 1 : 0});
  const fap::Expression& e = frame.expression;
  expression_.insert(expression_.end(), {e.select1, e.intensity1, e.select2, e.intensity2,
                                         e.init_face ? 1 : 0, e.def ? 1 : 0});
  if (rules != nullptr) rules_.push_back(*rules);
}

Clip ClipRows::clip(fap::Rate rate, std::string name) {
  const auto frames = py::ssize_t(numbers_.size());
  Clip clip{rate,
            std::move(name),
            array_of<std::int32_t>(std::move(values_), {frames, kFapColumns}),
            array_of<bool>(std::move(mask_), {frames, kFapColumns}),
            array_of<std::int64_t>(std::move(numbers_), {frames}),
            array_of<std::int32_t>(std::move(viseme_), {frames, kVisemeColumns}),
            array_of<std::int32_t>(std::move(expression_), {frames, kExpressionColumns}),
            std::move(rules_)};
  if (clip.rules.size() != std::size_t(frames)) clip.rules.clear();
  return clip;
}

Clip clip_of(const fap::Sequence& sequence, std::vector<fap::GroupRules> rules) {
  ClipRows rows(sequence.frames.size());
  const bool known = rules.size() == sequence.frames.size();
  for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
    rows.add(sequence.frames[i], known ? &rules[i] : nullptr);
  }
  return rows.clip(sequence.rate, sequence.name);
}

fap::Sequence sequence_of(const Clip& clip) {
  fap::Sequence sequence{clip.rate, std::vector<fap::Frame>(std::size_t(clip.numbers.size())),
                         clip.name};
  // Who goes behind the views can spoil the arrays, and nothing else.
  const auto frames = sequence.frames.size();
  if (std::size_t(clip.values.size()) != frames * kFapColumns ||
      std::size_t(clip.mask.size()) != frames * kFapColumns ||
      std::size_t(clip.viseme.size()) != frames * kVisemeColumns ||
      std::size_t(clip.expression.size()) != frames * kExpressionColumns) {
    throw py::value_error("the arrays of the clip have been resized");
  }
  const std::int32_t* values = clip.values.data();
  const bool* mask = clip.mask.data();
  for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
    fap::Frame& frame = sequence.frames[i];
    frame.number = clip.numbers.data()[i];
    for (std::size_t fap = 1; fap <= kFapColumns; ++fap, ++values, ++mask) {
      if (!*mask) continue;
      frame.mask.set(fap);
      if (fap >= fap::kFirstLowLevel) frame.value[fap] = *values;
    }
    const std::int32_t* v = clip.viseme.data() + i * kVisemeColumns;
    if (frame.mask[1]) frame.viseme = {v[0], v[1], v[2], v[3] != 0};
    const std::int32_t* e = clip.expression.data() + i * kExpressionColumns;
    if (frame.mask[2]) frame.expression = {e[0], e[1], e[2], e[3], e[4] != 0, e[5] != 0};
  }
  return sequence;
}

fap::Frame frame_of(const py::handle& values, const py::handle& mask) {
  using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
  using Flags = py::array_t<bool, py::array::c_style | py::array::forcecast>;
  const auto row = array_from<Doubles>(values);
  const auto flags = mask.is_none() ? Flags(py::ssize_t(kFapColumns)) : array_from<Flags>(mask);
  if (row.ndim() != 1 || std::size_t(row.size()) != kFapColumns) {
    throw py::value_error("values is not (68,)");
  }
  if (flags.ndim() != 1 || std::size_t(flags.size()) != kFapColumns) {
    throw py::value_error("mask is not (68,)");
  }
  fap::Frame frame;
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    if (mask.is_none() || flags.at(fap - 1)) frame.set(fap, whole(row.at(fap - 1), "values"));
  }
  return frame;
}

}  // namespace animeme::python
