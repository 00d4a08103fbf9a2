// Files of avatars for the tests of animate_file(), and what is in those that it writes.
#pragma once

#include <cstring>
#include <nlohmann/json.hpp>

#include "fap/arkit.h"
#include "tests/view/gltf/actor.h"
#include "tests/view/gltf/square.h"
#include "tools/formats/common/json.h"
#include "tools/view/gltf/animate_file.h"
#include "tools/view/gltf/glb.h"

namespace animeme::gltf {

using Bytes = std::vector<std::uint8_t>;

// A mouth that opens while head and eyes turn.
inline fap::Sequence talk(int frames = 5) {
  fap::Sequence clip{{25, 1}, {}, "x"};
  for (int i = 0; i < frames; ++i) {
    fap::ArkitFrame weights{};
    weights[std::size_t(*fap::find_arkit("jawOpen"))] = 0.15 * i;
    weights[std::size_t(*fap::find_arkit("eyeBlinkLeft"))] = 0.2 * i;
    fap::Frame frame = fap::arkit_to_fap(weights, fap::kAllArkit);
    frame.number = i;
    frame.set(48, -3000 * i);
    frame.set(49, 5000 * i);
    frame.set(50, 1000 * i);
    frame.set(23, 2000 * i);
    frame.set(24, 1500 * i);
    frame.set(25, 1000 * i);
    clip.frames.push_back(frame);
  }
  return clip;
}

inline Bytes whole(const Result<AnimatedFile>& file) {
  EXPECT_TRUE(file) << file.error().describe();
  if (!file) return {};
  Bytes out = file->front;
  out.insert(out.end(), file->middle.begin(), file->middle.end());
  out.insert(out.end(), file->back.begin(), file->back.end());
  return out;
}

inline std::uint32_t word(const Bytes& file, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, file.data() + at, 4);
  return value;
}

// The same for what reads it.
inline tools::Json to_read(const nlohmann::json& json) {
  return *tools::Json::parse(json.dump(), {.sorted = true});
}

struct Parts {
  std::string text;
  Bytes binary;
  nlohmann::json root;

  explicit Parts(const Bytes& file) {
    EXPECT_EQ(word(file, 8), file.size());
    const std::size_t size = word(file, 12);
    text.assign(file.begin() + 20, file.begin() + 20 + std::ptrdiff_t(size));
    root = nlohmann::json::parse(text);
    const std::size_t at = 20 + size;
    if (at + 8 > file.size()) return;
    EXPECT_EQ(word(file, at) % 4, 0u);
    EXPECT_EQ(at + 8 + word(file, at), file.size());
    binary.assign(file.begin() + std::ptrdiff_t(at) + 8, file.end());
  }

  std::vector<float> floats(std::size_t accessor) const {
    const nlohmann::json& entry = root["accessors"][accessor];
    const nlohmann::json& view = root["bufferViews"][entry["bufferView"].get<std::size_t>()];
    std::vector<float> values(view["byteLength"].get<std::size_t>() / 4);
    std::memcpy(values.data(), binary.data() + view["byteOffset"].get<std::size_t>(),
                values.size() * 4);
    return values;
  }
  /// Keys of a channel; none if it is not there.
  std::vector<float> keys(const nlohmann::json& animation, std::size_t node,
                          const char* path) const {
    for (const nlohmann::json& channel : animation["channels"]) {
      if (channel["target"]["node"] != node || channel["target"]["path"] != path) continue;
      return floats(animation["samplers"][channel["sampler"].get<std::size_t>()]["output"]);
    }
    return {};
  }
  std::size_t node(const std::string& name) const {
    for (std::size_t i = 0; i < root["nodes"].size(); ++i) {
      if (root["nodes"][i].value("name", "") == name) return i;
    }
    ADD_FAILURE() << name;
    return 0;
  }
};

// Everything that was there is there as it was; lists have more at their end.
inline void expect_kept(const nlohmann::json& before, const nlohmann::json& after,
                        const std::string& place) {
  if (place == "/buffers/0/byteLength") return;
  ASSERT_EQ(before.type(), after.type()) << place;
  if (before.is_object()) {
    for (const auto& [key, value] : before.items()) {
      ASSERT_TRUE(after.contains(key)) << place << "/" << key;
      expect_kept(value, after[key], place + "/" + key);
    }
    const bool may_grow = place.empty() || place.find("extensions") != std::string::npos;
    if (!may_grow) {
      EXPECT_EQ(before.size(), after.size()) << place;
    }
  } else if (before.is_array()) {
    ASSERT_GE(after.size(), before.size()) << place;
    for (std::size_t i = 0; i < before.size(); ++i) {
      expect_kept(before[i], after[i], place + "/" + std::to_string(i));
    }
    const bool may_grow = place == "/accessors" || place == "/bufferViews" ||
                          place == "/animations" || place == "/extensionsUsed";
    if (!may_grow) {
      EXPECT_EQ(before.size(), after.size()) << place;
    }
  } else {
    EXPECT_EQ(before, after) << place;
  }
}

inline void expect_kept(const Bytes& before, const Bytes& after) {
  const Parts was(before), is(after);
  expect_kept(was.root, is.root, "");
  ASSERT_GE(is.binary.size(), was.binary.size());
  EXPECT_TRUE(std::equal(was.binary.begin(), was.binary.end(), is.binary.begin()));
}

inline const Bytes& woman() {
  static const Bytes file = *make_glb(actor().head, actor().rig, talk(2), {.name = "old"});
  return file;
}

// Nodes in which nothing stands upright: neck and head are turned, a parent is scaled and mirrored.
struct Crooked : Square {
  std::vector<std::size_t> bones;  // neck, head, left eye, right eye

  Crooked() {
    for (const char* name : {"jawOpen", "tongueOut", "blink"}) {
      primitive["targets"].push_back(
          {{"POSITION",
            file.sparse(4, std::vector<std::uint8_t>{1}, std::vector<float>{0, -1, 0}, "VEC3")}});
      targets.push_back(name);
    }
    file.root["meshes"] = {{{"primitives", {primitive}},
                            {"weights", {0, 0.25, 0}},
                            {"extras", {{"targetNames", targets}}}}};
    file.root["meshes"][0]["extras"]["targetNames"][1] = "my own";
    file.add("nodes", {{"name", "face"}, {"mesh", 0}});
    file.add("nodes", {{"name", "body"},
                       {"children", {2}},
                       {"scale", {-2, 2, 2}},
                       {"rotation", {0.5, 0.5, 0.5, 0.5}}});
    file.add("nodes", {{"name", "Neck"}, {"children", {3}}, {"rotation", {0.6, 0, 0, 0.8}}});
    // 90 degrees about Z, three units up.
    file.add("nodes", {{"name", "Head"},
                       {"children", {4, 5}},
                       {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 3, 0, 1}}});
    file.add("nodes", {{"name", "LeftEye"}, {"rotation", {0, 0.6, 0, 0.8}}});
    file.add("nodes", {{"name", "RightEye"}});
    file.add("scenes", {{"nodes", {0, 1}}});
  }
  nlohmann::json targets = nlohmann::json::array();
};

}  // namespace animeme::gltf
