#include "tools/characters/crossmap/capture.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "fap/rate_text.h"
#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"
#include "tools/formats/exchange/c3d.h"
#include "tools/formats/exchange/points.h"
#include "tools/formats/files/files.h"

namespace animeme::crossmap {
namespace {

using exchange::PointRecording;
using tools::Json;
using Names = std::vector<std::string>;
using Indices = std::vector<std::size_t>;

Error missing(const std::string& what) { return make_error(Code::not_found, what); }
Error refused(const std::string& what) { return make_error(Code::invalid_argument, what); }

Result<PointRecording> read_recording(const std::string& path,
                                      const exchange::PointTableOptions& options) {
  const Result<std::vector<std::uint8_t>> bytes = tools::read_file(path);
  if (!bytes) return bytes.error();
  Result<PointRecording> read =
      exchange::is_c3d(*bytes)
          ? exchange::read_c3d(*bytes)
          : exchange::read_point_table(
                {reinterpret_cast<const char*>(bytes->data()), bytes->size()}, options);
  if (!read) return std::move(read).error().in_file(path);
  read->track.name = path == "-" ? "points" : std::filesystem::path(path).stem().string();
  return read;
}

Result<exchange::PointTableOptions> table_options(const Project& project) {
  exchange::PointTableOptions out;
  if (!project.rate.empty()) {
    const Result<fap::Rate> rate = fap::parse_rate(project.rate);
    if (!rate || !rate->valid()) {
      return refused("rate: '" + project.rate + "' is not a frame rate; write 30 or 29.97");
    }
    out.rate = *rate;
  }
  if (!project.size.empty()) {
    out.size = exchange::parse_picture_size(project.size);
    if (!out.size) return refused("size: '" + project.size + "' is not a size; write 1280x720");
  }
  return out;
}

std::optional<std::size_t> find(const Names& names, const std::string& name) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) return std::nullopt;
  return std::size_t(at - names.begin());
}

Result<Indices> indices_of(const Names& names, const Names& wanted, const std::string& who) {
  Indices out;
  for (const std::string& name : wanted) {
    const auto at = find(names, name);
    if (!at) {
      std::string some;
      for (std::size_t i = 0; i < std::min<std::size_t>(names.size(), 8); ++i) {
        some += (i == 0 ? "" : ", ") + names[i];
      }
      return missing(who + ": there is no point '" + name + "'; there are " + some +
                     (names.size() > 8 ? " ..." : ""));
    }
    out.push_back(*at);
  }
  return out;
}

// The recordings with the points that all of them have, in the order of the first.
Result<void> bring_together(std::vector<PointRecording>& takes, const tools::Log& log) {
  Names common;
  for (const std::string& name : takes[0].track.names) {
    const bool everywhere = std::all_of(takes.begin(), takes.end(), [&](const auto& take) {
      return find(take.track.names, name).has_value();
    });
    if (everywhere) {
      common.push_back(name);
    } else {
      log.warn("the point " + name + " is not in all recordings and is left out");
    }
  }
  if (common.empty()) return missing("the recordings have no point in common");
  for (PointRecording& take : takes) {
    if (take.track.names == common) continue;
    take.track = dam::with_points(take.track, *indices_of(take.track.names, common, ""));
  }
  return {};
}

// Neutral shapes in JSON: {"neutral": {"61": [x, y, z], ...}, "fapu": {"MW": 38}}, also under names
// that tell the unit ("neutral_px").
struct NeutralFace {
  std::vector<double> shape;
  std::map<std::string, double> fapu;
};

Result<NeutralFace> read_neutral_json(const std::string& path, const std::string& text,
                                      const Names& names, std::size_t dimensions) {
  const Result<Json> json = Json::parse(text, {.sorted = true});
  const auto member = [&](std::string_view start) -> const Json* {
    if (!json) return nullptr;
    for (const auto& [key, value] : json->items()) {
      if (std::string_view(key).starts_with(start) && value.is_object()) return &value;
    }
    return nullptr;
  };
  const Json* places = member("neutral");
  if (places == nullptr) {
    return make_error(Code::syntax, "a neutral face in JSON has \"neutral\": {\"POINT\": [x, y]}")
        .in_file(path);
  }
  NeutralFace out;
  for (const std::string& name : names) {
    const Json* point = places->find(name);
    for (std::size_t k = 0; k < dimensions; ++k) {
      const bool there =
          point != nullptr && point->is_array() && point->size() > k && (*point)[k].is_number();
      out.shape.push_back(there ? (*point)[k].get<double>()
                                : std::numeric_limits<double>::quiet_NaN());
    }
  }
  if (const Json* fapu = member("fapu")) {
    for (const auto& [unit, value] : fapu->items()) {
      if (value.is_number()) out.fapu[unit] = value.get<double>();
    }
  }
  return out;
}

// "0-0.4s", "1.2s".
std::optional<std::pair<double, double>> parse_seconds(std::string text) {
  if (!text.ends_with('s')) return std::nullopt;
  text.pop_back();
  double first = 0, last = 0;
  int used = 0;
  if (std::sscanf(text.c_str(), "%lf-%lf%n", &first, &last, &used) == 2 &&
      std::size_t(used) == text.size() && first >= 0 && last >= first) {
    return std::pair{first, last};
  }
  if (std::sscanf(text.c_str(), "%lf%n", &first, &used) == 1 && std::size_t(used) == text.size() &&
      first >= 0) {
    return std::pair{first, first};
  }
  return std::nullopt;
}

Result<NeutralFace> neutral_face(const Project& project, const std::vector<dam::PointTrack>& tracks,
                                 const Indices& used, const tools::Log& log) {
  const dam::PointTrack& first = tracks[0];
  if (project.neutral.empty()) {
    std::vector<dam::PointTrack> some;
    for (const dam::PointTrack& track : tracks) some.push_back(dam::with_points(track, used));
    const auto rest = dam::resting_shape(some);
    if (!rest) return rest.error();
    NeutralFace out;
    out.shape.assign(first.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < used.size(); ++i) {
      for (std::size_t k = 0; k < first.dimensions; ++k) {
        out.shape[used[i] * first.dimensions + k] = (*rest)[i * first.dimensions + k];
      }
    }
    log.info("neutral shape: the stillest 0.2 seconds of the recordings (change with --neutral)");
    return out;
  }
  if (const auto seconds = parse_seconds(project.neutral)) {
    const double rate = first.rate.frames_per_second();
    const auto begin = std::size_t(std::min(std::floor(seconds->first * rate + 1e-6), 1e9));
    const auto end = std::size_t(std::min(std::floor(seconds->second * rate + 1e-6), 1e9));
    if (begin >= first.frames()) {
      return refused("neutral: " + first.name + " has no frame at " + project.neutral);
    }
    return NeutralFace{dam::median_shape(first, begin, end), {}};
  }
  if (tools::extension_of(project.neutral) == ".json") {
    const Result<std::string> text = tools::read_text_file(project.neutral, tools::kMostWritten);
    if (!text) return text.error();
    return read_neutral_json(project.neutral, *text, first.names, first.dimensions);
  }
  if (!std::filesystem::exists(project.neutral)) {
    return refused("neutral: '" + project.neutral +
                   "' is neither a file nor a part of the first recording, such as 0-0.4s");
  }
  auto options = table_options(project);
  if (!options) return options.error();
  if (!options->rate) options->rate = first.rate;
  Result<PointRecording> take = read_recording(project.neutral, *options);
  if (!take) return take.error();
  if (take->track.dimensions != first.dimensions) {
    return refused(project.neutral + " has points of another dimension than the recordings");
  }
  const auto median = dam::median_shape(take->track, 0, take->track.frames() - 1);
  NeutralFace out;
  for (const std::string& name : first.names) {
    const auto at = find(take->track.names, name);
    for (std::size_t k = 0; k < first.dimensions; ++k) {
      out.shape.push_back(at ? median[*at * first.dimensions + k]
                             : std::numeric_limits<double>::quiet_NaN());
    }
  }
  return out;
}

Result<dam::FaceOptions> face_options(const Project& project, const NeutralFace& neutral,
                                      const std::string& unit) {
  dam::FaceOptions out;
  if (!project.axes.empty()) {
    out.axes = dam::parse_axes(project.axes);
    if (!out.axes) {
      return refused("axes: '" + project.axes +
                     "' is not understood; write where x, y and z point to, seen by the person: "
                     "\"left up forward\", \"left down back\" (a camera)");
    }
  }
  std::map<std::string, double> units = neutral.fapu;
  for (const auto& [name, value] : project.fapu) units[name] = value;
  for (const auto& [name, value] : units) {
    double* place = name == "MW"      ? &out.fapu.mw
                    : name == "MNS"   ? &out.fapu.mns
                    : name == "ES"    ? &out.fapu.es
                    : name == "ENS"   ? &out.fapu.ens
                    : name == "IRISD" ? &out.fapu.irisd
                                      : nullptr;
    if (place == nullptr) {
      return refused("'" + name + "' is no FAP unit; they are MW, MNS, ES, ENS and IRISD");
    }
    if (!(value > 0)) return refused("the FAP unit " + name + " has to be above 0");
    *place = value;
  }
  if (unit == "mm") out.centimetres = 0.1;
  if (unit == "cm") out.centimetres = 1;
  if (unit == "m") out.centimetres = 100;
  if (unit == "in") out.centimetres = 2.54;
  if (!project.unit.empty() && out.centimetres == 0) {
    return refused("unit: '" + project.unit + "' is not one of mm, cm, m and in");
  }
  return out;
}

Result<std::vector<dam::FacePoint>> mapped_points(const Project& project, const Names& names) {
  std::optional<fap::LandmarkLayout> layout;
  if (project.layout == "68") layout = fap::LandmarkLayout::ibug68;
  if (project.layout == "mediapipe") layout = fap::LandmarkLayout::mediapipe;
  if (!layout && !project.layout.empty()) {
    return refused("layout: '" + project.layout + "' is neither 68 nor mediapipe");
  }
  if (project.face.empty()) return dam::face_points(names, layout);
  std::vector<dam::FacePoint> out;
  for (const auto& pair : project.face) {
    const std::string &id = pair.first, &name = pair.second;
    const Names ids = {id};
    if (dam::face_points(ids).empty()) {
      return refused("face: '" + id +
                     "' is not a feature point, such as 8.3 (left corner of the lips)");
    }
    const auto at = find(names, name);
    if (!at) return missing("face: there is no point '" + name + "' in the recordings");
    const auto same =
        std::find_if(out.begin(), out.end(), [&](const auto& p) { return p.id == id; });
    if (same != out.end()) {
      same->points.push_back(*at);
    } else {
      out.push_back({id, {*at}});
    }
  }
  return out;
}

// The regions that feature points tell; a point of none of them is one of "others".
std::vector<dam::Region> usual_regions(const std::vector<dam::FacePoint>& points,
                                       std::size_t count) {
  const std::pair<const char*, std::set<std::string>> kinds[] = {
      {"upper lip", {"2.2", "2.6", "2.7", "8.1", "8.5", "8.6", "8.9", "8.10"}},
      {"lower lip", {"2.3", "2.8", "2.9", "8.2", "8.7", "8.8"}},
      {"corners", {"2.4", "2.5", "8.3", "8.4"}},
      {"jaw", {"2.1", "2.10", "2.11", "2.12", "2.13", "2.14"}},
      {"tongue", {"6.1", "6.2", "6.3", "6.4"}}};
  std::vector<dam::Region> out;
  std::set<std::size_t> taken;
  for (const auto& [name, ids] : kinds) {
    dam::Region region{name, {}};
    for (const dam::FacePoint& point : points) {
      if (!ids.contains(point.id)) continue;
      for (const std::size_t at : point.points) {
        if (taken.insert(at).second) region.points.push_back(at);
      }
    }
    if (!region.points.empty()) out.push_back(std::move(region));
  }
  dam::Region others{out.empty() ? "all" : "others", {}};
  for (std::size_t i = 0; i < count; ++i) {
    if (!taken.contains(i)) others.points.push_back(i);
  }
  if (!others.points.empty()) out.push_back(std::move(others));
  return out;
}

Result<void> add_regions(const Project& project, const Names& names,
                         const std::vector<dam::FacePoint>& points, Capture& out) {
  out.fit = project.fit;
  if (project.regions.empty()) {
    out.regions = usual_regions(points, names.size());
  } else {
    out.fit.weights.assign(names.size(), 1.0);
    for (const NamedRegion& region : project.regions) {
      const auto at = indices_of(names, region.points, "region " + region.name);
      if (!at) return at.error();
      for (const std::size_t i : *at) out.fit.weights[i] = region.weight;
      out.regions.push_back({region.name, *at});
    }
  }
  if (project.contacts.empty()) {
    out.fit.contacts = dam::lip_contacts(points);
  } else {
    for (const auto& [a, b] : project.contacts) {
      const auto at = indices_of(names, {a, b}, "contacts");
      if (!at) return at.error();
      out.fit.contacts.emplace_back((*at)[0], (*at)[1]);
    }
  }
  return {};
}

// Feature points as far as all their captured points are among `kept`, by the numbers there.
std::vector<dam::FacePoint> kept_points(const std::vector<dam::FacePoint>& points,
                                        const Indices& kept) {
  std::vector<dam::FacePoint> out;
  for (const dam::FacePoint& point : points) {
    dam::FacePoint moved{point.id, {}};
    for (const std::size_t at : point.points) {
      const auto place = std::find(kept.begin(), kept.end(), at);
      if (place != kept.end()) moved.points.push_back(std::size_t(place - kept.begin()));
    }
    if (moved.points.size() == point.points.size()) out.push_back(std::move(moved));
  }
  return out;
}

// Which points are fitted, and which hold the head.
struct Roles {
  std::vector<dam::FacePoint> mapped;
  Indices fitted, head;
};

Result<Roles> roles_of(const Project& project, const Names& names) {
  auto mapped = mapped_points(project, names);
  if (!mapped) return mapped.error();
  Roles out{std::move(*mapped), {}, {}};
  if (project.head.empty()) {
    out.head = dam::head_points(out.mapped);
    if (out.head.size() < 3) out.head.clear();
  } else if (project.head != Names{"none"}) {
    auto head = indices_of(names, project.head, "head");
    if (!head) return head.error();
    out.head = *head;
  }
  if (!project.points.empty()) {
    auto fitted = indices_of(names, project.points, "points");
    if (!fitted) return fitted.error();
    out.fitted = *fitted;
    return out;
  }
  std::optional<fap::LandmarkLayout> layout;
  if (project.layout == "68") layout = fap::LandmarkLayout::ibug68;
  if (project.layout == "mediapipe") layout = fap::LandmarkLayout::mediapipe;
  if (names.size() >= 60) out.fitted = dam::mouth_points(names, out.mapped, layout);
  if (!out.fitted.empty()) return out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::find(out.head.begin(), out.head.end(), i) == out.head.end()) out.fitted.push_back(i);
  }
  if (out.fitted.empty()) return missing("all points belong to the head; name those that move");
  return out;
}

// Fitted points and those of the head, and further ones of the face that are seen as a rule.
Indices used_points(const Roles& roles, const std::vector<dam::PointTrack>& tracks) {
  std::set<std::size_t> used(roles.fitted.begin(), roles.fitted.end());
  used.insert(roles.head.begin(), roles.head.end());
  for (const dam::FacePoint& point : roles.mapped) {
    for (const std::size_t at : point.points) {
      const bool often = std::all_of(tracks.begin(), tracks.end(), [&](const auto& track) {
        std::size_t seen = 0;
        for (std::size_t i = 0; i < track.frames(); ++i) seen += track.seen(i, at) ? 1 : 0;
        return 2 * seen >= track.frames();
      });
      if (often) used.insert(at);
    }
  }
  return {used.begin(), used.end()};
}

}  // namespace

Result<Capture> load_capture(const Project& project, const tools::Log& log) {
  const auto options = table_options(project);
  if (!options) return options.error();
  if (project.inputs.empty()) return refused("there is no recording to map");
  std::vector<PointRecording> takes;
  for (const std::string& path : project.inputs) {
    Result<PointRecording> take = read_recording(path, *options);
    if (!take) return take.error();
    for (const std::string& warning : take->warnings) log.warn(path + ": " + warning);
    takes.push_back(std::move(*take));
  }
  Capture out;
  out.unit = !project.unit.empty() ? project.unit : takes[0].unit;
  if (auto ok = bring_together(takes, log); !ok) return ok.error();
  for (PointRecording& take : takes) out.tracks.push_back(std::move(take.track));
  if (auto ok = dam::check_tracks(out.tracks); !ok) return ok.error();
  const Names names = out.tracks[0].names;
  const auto roles = roles_of(project, names);
  if (!roles) return roles.error();
  const auto neutral = neutral_face(project, out.tracks, used_points(*roles, out.tracks), log);
  if (!neutral) return neutral.error();

  const Indices& kept = roles->fitted;
  const std::size_t dimensions = out.tracks[0].dimensions;
  for (dam::PointTrack& track : out.tracks) {
    if (!roles->head.empty()) {
      const auto lost = dam::hold_head_still(track, roles->head, neutral->shape);
      if (!lost) return lost.error();
      if (*lost > 0) {
        log.warn(track.name + ": the head is not seen in " + std::to_string(*lost) + " frames");
      }
    }
    dam::subtract(track, neutral->shape);
    track = dam::with_points(track, kept);
  }
  for (const std::size_t at : kept) {
    for (std::size_t k = 0; k < dimensions; ++k) {
      out.neutral.push_back(neutral->shape[at * dimensions + k]);
      if (std::isfinite(out.neutral.back())) continue;
      return missing(
          "the point " + names[at] +
          " is not seen in the neutral shape; leave it out by naming the others (points)");
    }
  }
  const auto known = face_options(project, *neutral, out.unit);
  if (!known) return known.error();
  const auto mapped = kept_points(roles->mapped, kept);
  if (auto ok = add_regions(project, out.tracks[0].names, mapped, out); !ok) return ok.error();

  // Which way the face looks and how large it is, all points tell; what moves, those that are kept.
  auto whole = dam::make_face(names, dimensions, neutral->shape, roles->mapped, *known);
  if (!whole) {
    out.no_face = whole.error();
    return out;
  }
  for (const std::string& note : whole->notes) log.info(note);
  dam::FaceOptions same{whole->axes, whole->fapu, 0};
  auto face = dam::make_face(out.tracks[0].names, dimensions, out.neutral, mapped, same);
  if (face) {
    out.face = std::move(*face);
  } else {
    out.no_face = face.error();
  }
  return out;
}

}  // namespace animeme::crossmap
