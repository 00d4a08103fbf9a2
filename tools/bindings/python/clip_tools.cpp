// What can be made of a clip: complete frames, other rates, weights of shapes, texts, files.
#include <filesystem>

#include "fap/arkit.h"
#include "fap/resample.h"
#include "fap/tables.h"
#include "fap/text.h"
#include "fap/viseme.h"
#include "tools/bindings/python/python_internal.h"
#include "tools/formats/exchange/arkit.h"

namespace animeme::python {

namespace {

constexpr py::ssize_t kChannels = fap::kArkitChannelCount;

template <class Names>
py::tuple names_of(const Names& names) {
  py::tuple tuple(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    tuple[i] = py::str(names[i].data(), names[i].size());
  }
  return tuple;
}

Clip fill(const Clip& clip, bool interpolate, bool expand, bool complete, bool keep_high_level) {
  fap::FillOptions options;
  options.interpolate = interpolate;
  options.expand = expand;
  options.complete = complete;
  options.keep_high_level = keep_high_level;
  const fap::Sequence sequence = sequence_of(clip);
  return clip_of(value_of(unlocked([&] { return fap::fill(sequence, clip.rules, options); })));
}

Clip resample(const Clip& clip, const py::object& rate) {
  const fap::Rate to = rate_of(rate);
  const fap::Sequence filled = shown(clip, true);
  value_of(fap::check_resampling(filled.rate, to, std::int64_t(filled.frames.size())));
  return clip_of(unlocked([&] { return fap::resample(filled, to); }));
}

py::array_t<double> arkit(const Clip& clip, const py::object& progress) {
  const fap::Sequence filled = shown(clip, false);
  Watch watch(progress);
  fap::ArkitFitter fitter;
  std::vector<fap::ArkitFrame> frames;
  frames.reserve(filled.frames.size());
  unlocked([&] {
    for (const fap::Frame& frame : filled.frames) {
      frames.push_back(fitter.fit(frame));
      const double share = double(frames.size()) / double(filled.frames.size());
      if (frames.size() % 16 == 0 && !watch.go_on(share, "fitting")) return;
    }
  });
  watch.rethrow();
  py::array_t<double> weights({py::ssize_t(frames.size()), kChannels});
  for (std::size_t i = 0; i < frames.size(); ++i) {
    std::copy(frames[i].begin(), frames[i].end(), weights.mutable_data() + i * frames[i].size());
  }
  return weights;
}

Clip from_arkit(const py::array_t<double, py::array::c_style | py::array::forcecast>& weights,
                const py::object& names, const py::object& rate) {
  std::vector<std::size_t> columns;
  fap::ArkitChannels channels;
  const py::object list = names.is_none() ? py::object(names_of(fap::kArkitNames)) : names;
  for (const py::handle& name : list) {
    const auto channel = fap::find_arkit(name.cast<std::string>());
    if (!channel) throw py::key_error("ARKit has no shape called " + name.cast<std::string>());
    columns.push_back(std::size_t(*channel));
    channels.set(std::size_t(*channel));
  }
  if (weights.ndim() != 2 || std::size_t(weights.shape(1)) != columns.size()) {
    throw py::value_error("weights is not (frames, " + std::to_string(columns.size()) +
                          "), a column a name");
  }
  fap::Sequence clip{rate_of(rate), {}, {}};
  const double* value = weights.data();
  for (py::ssize_t i = 0; i < weights.shape(0); ++i) {
    fap::ArkitFrame frame{};
    for (const std::size_t column : columns) frame[column] = *value++;
    clip.frames.push_back(fap::arkit_to_fap(frame, channels));
    clip.frames.back().number = i;
  }
  return clip_of(clip);
}

py::array_t<double> visemes(const Clip& clip) {
  const fap::Sequence filled = shown(clip, true);
  fap::VisemeFitter fitter;
  std::vector<fap::VisemeWeights> rows;
  unlocked([&] {
    for (const fap::Frame& frame : filled.frames) rows.push_back(fitter.fit(frame));
  });
  py::array_t<double> weights({py::ssize_t(rows.size()), py::ssize_t(fap::kVisemeCount)});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::copy(rows[i].begin(), rows[i].end(), weights.mutable_data() + i * rows[i].size());
  }
  return weights;
}

void save_clip(const Clip& clip, const py::object& file, const std::string& preset, int quant,
               double max_rms, double max_bits_per_second, std::optional<double> intra_seconds,
               const py::object& audio) {
  Beside beside;
  if (!audio.is_none()) beside.sound_file = path_of(audio);
  const std::string path = path_of(file);
  fap::Sequence sequence = sequence_of(clip);
  if (sequence.name.empty()) sequence.name = std::filesystem::path(path).stem().string();
  save(sequence, path, {preset, quant, max_rms, max_bits_per_second, intra_seconds}, beside);
}

// All that a copy needs; group rules as bytes.
py::tuple state_of(const Clip& clip) {
  const auto* rules = reinterpret_cast<const char*>(clip.rules.data());
  return py::make_tuple(clip.values, clip.mask, fraction_of(clip.rate), clip.numbers, clip.viseme,
                        clip.expression, clip.name,
                        py::bytes(rules, clip.rules.size() * sizeof(fap::GroupRules)));
}

Clip restored(const py::tuple& state) {
  if (state.size() != 8) throw py::value_error("this is no state of a clip");
  const py::object made = py::type::of<Clip>()(
      state[0], state[1], state[2], py::arg("numbers") = state[3], py::arg("viseme") = state[4],
      py::arg("expression") = state[5], py::arg("name") = state[6]);
  Clip clip = made.cast<Clip>();
  const auto rules = state[7].cast<std::string>();
  for (std::size_t i = 0; i + sizeof(fap::GroupRules) <= rules.size();
       i += sizeof(fap::GroupRules)) {
    fap::GroupRules& row = clip.rules.emplace_back();
    for (std::size_t group = 0; group < row.size(); ++group) {
      const auto rule = std::uint8_t(rules[i + group]);
      row[group] = rule > 2 ? fap::GroupRule::unknown : fap::GroupRule(rule);
    }
  }
  if (clip.rules.size() != std::size_t(clip.numbers.size())) clip.rules.clear();
  return clip;
}

}  // namespace

void bind_clip_tools(py::module_& module) {
  module.attr("FAP_NAMES") = [] {
    py::tuple names(fap::kFapCount);
    for (const fap::FapInfo& fap : fap::kFaps) {
      names[std::size_t(fap.number - 1)] = py::str(fap.name.data(), fap.name.size());
    }
    return names;
  }();
  module.attr("ARKIT_NAMES") = names_of(fap::kArkitNames);
  module.attr("VISEME_NAMES") = [] {
    py::tuple names(fap::kVisemes.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
      names[i] = py::str(fap::kVisemes[i].morph.data(), fap::kVisemes[i].morph.size());
    }
    return names;
  }();

  auto clip = py::reinterpret_borrow<py::class_<Clip>>(module.attr("Clip"));
  clip.def(
          "fill", &fill, py::kw_only(), py::arg("interpolate") = false, py::arg("expand") = true,
          py::arg("complete") = false, py::arg("keep_high_level") = false,
          R"(The clip with every FAP filled in as by a receiver: no gaps, the same mask in each frame.

interpolate: interpolate skipped frames; otherwise they repeat the previous one.
expand: convert FAP 1 and 2 to low-level FAPs.
complete: low-level FAPs that are never sent are present, at 0.
keep_high_level: keep FAP 1 and 2 besides low-level FAPs.)")
      .def("resample", &resample, py::arg("rate"),
           R"(The complete clip at another rate, interpolated linearly.

rate: frames a second: a number, a Fraction or "30000/1001".)")
      .def("arkit", &arkit, py::kw_only(), py::arg("progress") = py::none(),
           R"(The clip as ARKit's weights: float64 (frames, 61), columns ARKIT_NAMES.

52 shapes 0..1, then 9 angles of head and eyes in radians; 0.1 ms a frame. Releases the GIL.
progress: called from time to time with (share 0..1, "fitting").)")
      .def_static("from_arkit", &from_arkit, py::arg("weights"), py::arg("names") = py::none(),
                  py::arg("rate") = 60,
                  R"(Makes a clip from ARKit's weights.

weights: (frames, names): shapes 0..1, angles in radians.
names: of the columns, in the spelling of ARKit or Live Link Face; None: ARKIT_NAMES.
rate: frames a second.)")
      .def(
          "visemes", &visemes,
          "The clip as viseme weights: float64 (frames, 15), columns VISEME_NAMES, 0..1, with the\n"
          "sum 1.")
      .def(
          "to_text", [](const Clip& c) { return fap::write_text(sequence_of(c)); },
          "The clip as FAP text (.fap, version 2.1), with unchanged values and masks.")
      .def("save", &save_clip, py::arg("path"), py::kw_only(), py::arg("preset") = "file",
           py::arg("quant") = 1, py::arg("max_rms") = 0.0, py::arg("max_bits_per_second") = 0.0,
           py::arg("intra_seconds") = py::none(), py::arg("audio") = py::none(),
           R"(Writes the clip in the format given by the file name, atomically.

.fba stream; .fap text; .mp4 .mkv .ts .m3u8 .mpd containers; .csv curves of FAPs;
.livelink.csv and .json ARKit's weights; .visemes.json .visemes.csv; .tsv .dat .xml .rhubarb.json
mouth shapes of Rhubarb; .talkinghead.json.

path: str or os.PathLike.
preset, quant, max_rms, max_bits_per_second, intra_seconds: as for encode(), for streams and
    containers; receivers can join every 5 s, or as given by intra_seconds.
audio: a sound file to go into a container.

Raises Error. Other threads run meanwhile.)")
      .def(py::pickle(&state_of, &restored));
}

}  // namespace animeme::python
