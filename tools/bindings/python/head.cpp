// Heads and how FAPs move them.
#include <array>

#include "fap/head/rig.h"
#include "tools/bindings/python/python_internal.h"
#include "tools/formats/files/files.h"
#include "tools/view/gltf/glb.h"
#include "tools/view/studio/head_file.h"

namespace animeme::python {

namespace {

// All parts one behind the other: vertices, and triangles of them.
struct Head {
  head::Head head;
  head::Rig rig;
  std::vector<std::array<std::size_t, 2>> spans;  // of the vertices of each part
  py::array_t<std::uint32_t> triangles;
  std::vector<std::string> notes;

  std::size_t vertices() const { return spans.back()[1]; }
};

void place(const head::Transform& transform, std::span<const head::Vec3> points, float* out) {
  for (const head::Vec3& point : points) {
    const head::Vec3 at = transform(point);
    *out++ = at.x;
    *out++ = at.y;
    *out++ = at.z;
  }
}

// Vertices of a pose, in the order of the parts.
void write_pose(const Head& self, const head::Pose& pose, float* out) {
  for (int part = 0; part < head::kPartCount; ++part) {
    const auto i = std::size_t(part);
    const auto& moved = pose.positions[i];
    const auto& rest = self.rig.parts[i].positions;
    place(pose.transforms[i], moved.empty() ? rest : moved, out + 3 * self.spans[i][0]);
  }
}

std::unique_ptr<Head> make_head(const py::object& name, const py::object& points,
                                const py::object& gain, const py::object& shape_names) {
  studio::HeadChoice choice;
  choice.head = path_of(name);
  if (!points.is_none()) choice.points = path_of(points);
  choice.gain = py::str(gain);
  if (py::isinstance<py::dict>(shape_names)) {
    for (const auto& [shape, meaning] : shape_names.cast<py::dict>()) {
      choice.shape_names.push_back(std::string(py::str(shape)) + "=" +
                                   std::string(py::str(meaning)));
    }
  } else if (!shape_names.is_none()) {
    choice.shape_table = path_of(shape_names);
  }
  auto self = std::make_unique<Head>();
  auto loaded = unlocked([&] { return studio::load_head(choice); });
  if (!loaded) raise(loaded.error());
  self->head = std::move(loaded->head);
  self->notes = std::move(loaded->notes);
  unlocked([&] { self->rig = head::make_rig(self->head); });
  std::size_t vertices = 0;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (int part = 0; part < head::kPartCount; ++part) {
    const auto& shape = self->rig.parts[std::size_t(part)];
    const auto first = std::uint32_t(vertices);
    // Transparent triangles, which do not move, follow those of the mesh.
    const std::size_t solid = self->head.parts[std::size_t(part)].triangles.size();
    for (std::size_t i = 0; i < std::min(solid, shape.triangles.size()); ++i) {
      const head::Triangle& t = shape.triangles[i];
      triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    self->spans.push_back({vertices, vertices + shape.positions.size()});
    vertices += shape.positions.size();
  }
  self->triangles = py::array_t<std::uint32_t>({py::ssize_t(triangles.size()), py::ssize_t(3)});
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    std::copy(triangles[i].begin(), triangles[i].end(), self->triangles.mutable_data() + 3 * i);
  }
  self->triangles.attr("flags").attr("writeable") = false;
  return self;
}

py::array_t<float> frames_of(const Head& self, const fap::Sequence& clip,
                             const head::PoseOptions& options) {
  const auto frames = py::ssize_t(clip.frames.size());
  py::array_t<float> out({frames, py::ssize_t(self.vertices()), py::ssize_t(3)});
  float* to = out.mutable_data();
  unlocked([&] {
    head::Pose pose;
    for (const fap::Frame& frame : clip.frames) {
      head::pose(self.rig, frame, pose, options);
      write_pose(self, pose, to);
      to += 3 * self.vertices();
    }
  });
  return out;
}

// Values without a mask: FAPs at 0 count as not given.
fap::Frame thought_of(fap::Frame frame) {
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    if (frame.value[std::size_t(fap)] == 0) frame.mask.reset(std::size_t(fap));
  }
  return frame;
}

py::array_t<float> pose(const Head& self, const py::object& values, const py::object& mask,
                        bool contact, bool follow) {
  const head::PoseOptions options{contact, follow};
  if (py::isinstance<Clip>(values)) {
    if (!mask.is_none()) throw py::type_error("a clip has its own mask");
    return frames_of(self, shown(values.cast<const Clip&>(), true), options);
  }
  fap::Sequence one;
  one.frames.push_back(frame_of(values, mask));
  if (mask.is_none()) one.frames[0] = thought_of(one.frames[0]);
  return frames_of(self, one, options).squeeze();
}

py::array_t<float> rest_of(const Head& self) {
  py::array_t<float> out({py::ssize_t(self.vertices()), py::ssize_t(3)});
  for (std::size_t part = 0; part < self.spans.size(); ++part) {
    place({}, self.rig.parts[part].positions, out.mutable_data() + 3 * self.spans[part][0]);
  }
  return out;
}

py::array_t<float> colours_of(const Head& self) {
  py::array_t<float> out({py::ssize_t(self.vertices()), py::ssize_t(3)});
  std::fill_n(out.mutable_data(), out.size(), 1.0f);
  for (std::size_t part = 0; part < self.spans.size(); ++part) {
    const auto& colours = self.head.parts[part].colours;
    if (colours.size() != self.rig.parts[part].positions.size()) continue;
    place({}, colours, out.mutable_data() + 3 * self.spans[part][0]);
  }
  return out;
}

py::dict head_parts(const Head& self) {
  py::dict parts;
  for (std::size_t part = 0; part < self.spans.size(); ++part) {
    const auto [first, end] = self.spans[part];
    if (first == end) continue;
    const auto& name = head::kPartNames[part];
    parts[py::str(name.data(), name.size())] = py::slice(py::ssize_t(first), py::ssize_t(end), 1);
  }
  return parts;
}

void save_head(const Head& self, const Clip& clip, const py::object& file) {
  const std::string path = path_of(file);
  const fap::Sequence filled = shown(clip, false);
  value_of(unlocked([&]() -> Result<void> {
    const auto bytes = gltf::make_glb(self.head, self.rig, filled);
    if (!bytes) return bytes.error();
    return tools::write_file(path, *bytes);
  }));
}

}  // namespace

void bind_head(py::module_& module) {
  py::class_<Head>(module, "Head", R"(A head that FAPs move: a built-in one, or one from a file.

Lengths are cm, +X to the person's left, +Y up, +Z forward; the origin is between the eyes at the
depth of the ears. The vertices of all parts are consecutive, see `parts`.)")
      .def(py::init(&make_head), py::arg("name") = "woman", py::kw_only(),
           py::arg("points") = py::none(), py::arg("gain") = 1, py::arg("shape_names") = py::none(),
           R"(Makes or reads a head.

name: "woman", "man", "child", or a file: .glb .gltf .vrm .obj .fdp .xmt, or a folder with
neutral.obj and one .obj for each shape.
points: for heads without shapes: a file with the feature points.
gain: factor for the lip opening, or "auto".
shape_names: what morph targets with other names mean: {"Mund_auf": "jawOpen"}, a viseme
("viseme_PP"), a FAP ("open_jaw"), or "-" to leave it at rest; or a file with such a table.

Raises Error with position.file.)")
      .def("pose", &pose, py::arg("values"), py::arg("mask") = py::none(), py::kw_only(),
           py::arg("contact") = true, py::arg("follow") = true,
           R"(The vertices of the head moved by FAPs: float32 (n, 3), cm.

values: (68,), FAP units, FAP n at n - 1; or a Clip, and the result is (frames, n, 3).
mask: (68,), True if a FAP is present; None: those that are not 0.
contact: lips and lids stop where they touch; False: points follow their FAPs exactly.
follow: upper lids follow the gaze if FAP 19 and 20 are absent.

Releases the GIL.)")
      .def("save", &save_head, py::arg("clip"), py::arg("path"),
           R"(Writes the head with its motion as glTF (.glb), for Blender, Unreal, Unity, three.js.

clip: the motion, one key per frame.
path: str or os.PathLike.)")
      .def_property_readonly("vertices", &rest_of, "float32 (n, 3): the head at rest, cm.")
      .def_property_readonly(
          "triangles", [](const Head& h) { return h.triangles; },
          "uint32 (m, 3): vertices of each triangle, counter-clockwise seen "
          "from outside.")
      .def_property_readonly("colours", &colours_of,
                             "float32 (n, 3): colours of the vertices, linear RGB 0..1; 1 if\n"
                             "the head has textures instead.")
      .def_property_readonly("parts", &head_parts,
                             "Slices of the vertices by part: \"skin\", \"left_eye\" ...")
      .def_property_readonly(
          "name", [](const Head& h) { return h.head.name; }, "Display name.")
      .def_readonly("notes", &Head::notes, "What was guessed or is missing, a sentence each.");
}

}  // namespace animeme::python
