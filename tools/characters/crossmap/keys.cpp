#include "tools/characters/crossmap/keys.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "tools/formats/common/text.h"
#include "tools/formats/exchange/detail/table.h"
#include "tools/formats/exchange/points.h"
#include "tools/formats/files/files.h"

namespace animeme::crossmap {
namespace {

constexpr double kNearNeutral = 0.05;

double size_of(const double* shape, std::size_t size) {
  double sum = 0;
  for (std::size_t k = 0; k < size; ++k) sum += shape[k] * shape[k];
  return std::sqrt(sum / double(size));
}

// A name that is a field of a table and part of a file name.
std::string plain_name(std::string name) {
  for (char& c : name) {
    if (c == ',' || c == ';' || c == '"' || c == '/' || c == '\\' || c == '\t' || c < ' ') c = '_';
  }
  return name;
}

void add(Keys& keys, const Capture& capture, std::size_t track, std::size_t frame, double share,
         const std::string& name) {
  const dam::PointTrack& take = capture.tracks[track];
  const auto shape = take.frame(frame);
  keys.shapes.values.insert(keys.shapes.values.end(), shape.begin(), shape.end());
  keys.shapes.names.push_back(name.empty() ? tools::format("key%02zu", keys.shapes.names.size() + 1)
                                           : plain_name(name));
  keys.sources.push_back({take.name, take.rate.seconds(double(frame)), share});
}

Result<Keys> found_keys(const Project& project, const Capture& capture, const tools::Log& log) {
  const auto found = dam::find_key_frames(capture.tracks, capture.fit.weights, project.search);
  if (!found) return found.error();
  double largest = 0;
  const auto size = [&](const dam::KeyFrame& key) {
    const auto shape = capture.tracks[key.track].frame(key.frame);
    return size_of(shape.data(), shape.size());
  };
  for (const dam::KeyFrame& key : found->keys) largest = std::max(largest, size(key));
  Keys out;
  out.compared = found->compared;
  for (const dam::KeyFrame& key : found->keys) {
    if (size(key) > kNearNeutral * largest) add(out, capture, key.track, key.frame, key.share, "");
  }
  if (out.shapes.names.empty()) {
    return make_error(Code::not_found, "nothing moves in the recordings, so there is no key shape");
  }
  log.info(std::to_string(out.shapes.names.size()) + " key shapes, by affinity propagation of " +
           std::to_string(found->compared) + " frames" +
           (found->keys.size() > out.shapes.names.size() ? ", without the face at rest" : ""));
  if (!found->converged) {
    log.warn(
        "affinity propagation did not come to rest; another number of key shapes or more "
        "damping may");
  }
  if (project.search.count > 0 && found->keys.size() != project.search.count) {
    log.warn("there is no preference that gives " + std::to_string(project.search.count) +
             " key shapes; the nearest number is " + std::to_string(found->keys.size()));
  }
  return out;
}

Result<Keys> named_keys(const Project& project, const Capture& capture) {
  Keys out;
  std::set<std::string> taken;
  for (const NamedKey& key : project.named) {
    std::size_t track = 0;
    if (!key.input.empty()) {
      const std::string stem = std::filesystem::path(key.input).stem().string();
      while (track < capture.tracks.size() && capture.tracks[track].name != stem) ++track;
    }
    if (track == capture.tracks.size()) {
      return make_error(Code::not_found, "key shape " + key.name + ": '" + key.input +
                                             "' is not one of the recordings");
    }
    const dam::PointTrack& take = capture.tracks[track];
    const double frame = std::floor(key.seconds * take.rate.frames_per_second() + 1e-6);
    const bool there = frame >= 0 && frame < double(take.frames());
    if (!there) {
      return make_error(Code::not_found,
                        tools::format("key shape %s: %s has no frame at %g s, it is %.2f s long",
                                      key.name.c_str(), take.name.c_str(), key.seconds,
                                      take.rate.seconds(double(take.frames()))));
    }
    for (std::size_t p = 0; p < take.names.size(); ++p) {
      if (take.seen(std::size_t(frame), p)) continue;
      return make_error(Code::not_found,
                        "key shape " + key.name + ": the point " + take.names[p] +
                            " is missing in that frame; choose a neighbouring one");
    }
    add(out, capture, track, std::size_t(frame), 0, key.name);
    if (!taken.insert(out.shapes.names.back()).second) {
      return make_error(Code::invalid_argument,
                        "two key shapes are called " + out.shapes.names.back());
    }
  }
  return out;
}

Result<Keys> read_keys_file(const std::string& path, const Capture& capture) {
  const Result<std::string> text = tools::read_text_file(path, tools::kMostWritten);
  if (!text) return text.error();
  exchange::PointTableOptions options;
  options.rate = fap::Rate{1, 1};
  auto read = exchange::read_point_table(*text, options);
  if (!read) return std::move(read).error().in_file(path);
  const dam::PointTrack& first = capture.tracks[0];
  if (read->track.dimensions != first.dimensions) {
    return make_error(Code::invalid_argument,
                      "the key shapes have points of another dimension than the recordings")
        .in_file(path);
  }
  std::vector<std::size_t> points;
  for (const std::string& name : first.names) {
    const auto at = std::find(read->track.names.begin(), read->track.names.end(), name);
    if (at == read->track.names.end()) {
      return make_error(Code::not_found, "the key shapes lack the point " + name).in_file(path);
    }
    points.push_back(std::size_t(at - read->track.names.begin()));
  }
  Keys out;
  out.shapes.values = dam::with_points(read->track, points).values;
  const auto lines = dam::table_lines(*text);
  const auto header = dam::split_fields(lines[0].text, ',');
  const auto key = dam::find_column(header, "key"), input = dam::find_column(header, "input");
  const auto at = dam::find_column(header, "at_s"), share = dam::find_column(header, "share");
  if (!key) {
    return error_at_line(Code::not_found, "there is no column \"key\" with the names", 1)
        .in_file(path);
  }
  std::set<std::string> taken;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto fields = dam::split_fields(lines[i].text, ',');
    out.shapes.names.push_back(plain_name(std::string(dam::trimmed(fields[*key]))));
    if (!taken.insert(out.shapes.names.back()).second) {
      return error_at_line(Code::syntax, "two key shapes are called " + out.shapes.names.back(),
                           std::int64_t(lines[i].number))
          .in_file(path);
    }
    KeySource& source = out.sources.emplace_back();
    if (input) source.input = std::string(fields[*input]);
    if (at) source.seconds = dam::parse_number(fields[*at]).value_or(0);
    if (share) source.share = dam::parse_number(fields[*share]).value_or(0);
  }
  return out;
}

}  // namespace

Result<Keys> load_keys(const Project& project, const Capture& capture, const tools::Log& log) {
  if (!project.keys.empty()) {
    const std::filesystem::path path = project.keys;
    return read_keys_file(
        std::filesystem::is_directory(path) ? (path / "keys.csv").string() : path.string(),
        capture);
  }
  if (!project.named.empty()) return named_keys(project, capture);
  return found_keys(project, capture, log);
}

std::string write_keys(const Keys& keys, const Capture& capture) {
  const dam::PointTrack& take = capture.tracks[0];
  std::string out = "key,input,at_s,share";
  for (const std::string& name : take.names) {
    for (std::size_t k = 0; k < take.dimensions; ++k) {
      out += "," + plain_name(name) + "_" + "xyz"[k];
    }
  }
  out += "\n";
  for (std::size_t i = 0; i < keys.shapes.names.size(); ++i) {
    const KeySource& source = keys.sources[i];
    out += tools::format("%s,%s,%.4f,%.4f", keys.shapes.names[i].c_str(),
                         plain_name(source.input).c_str(), source.seconds, source.share);
    for (std::size_t k = 0; k < take.size(); ++k) {
      out += tools::format(",%.9g", keys.shapes.values[i * take.size() + k]);
    }
    out += "\n";
  }
  return out;
}

}  // namespace animeme::crossmap
