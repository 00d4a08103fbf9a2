// Heads as glTF, each with something that the others have not.
#include <cstdio>
#include <functional>

#include "tests/fuzz/seeds.h"
#include "tests/support/gltf_writer.h"
#include "tests/support/picture_writer.h"

namespace animeme::fuzz {
namespace {

using nlohmann::json;
using test::GltfWriter;
using Floats = std::vector<float>;

// A face of nine vertices.
struct Face : GltfWriter {
  json primitive;
  json node = {{"name", "head"}};
  json mesh = {{"name", "face"}};

  Face() {
    Floats places;
    std::vector<std::uint8_t> corners;
    for (int i = 0; i < 9; ++i) {
      places.insert(places.end(), {float(i % 3), float(i / 3), i == 4 ? 1.0f : 0.0f});
    }
    for (const int a : {0, 1, 3, 4}) {
      for (const int step : {0, 1, 4, 0, 4, 3}) corners.push_back(std::uint8_t(a + step));
    }
    primitive["attributes"]["POSITION"] = accessor(places, "VEC3");
    primitive["indices"] = accessor(corners, "SCALAR");
  }

  void add_shape(const std::string& name, int vertex = 4) {
    primitive["targets"].push_back(
        {{"POSITION",
          sparse<std::uint8_t>(9, {std::uint8_t(vertex)}, Floats{0, -0.2f, 0.1f}, "VEC3")}});
    mesh["extras"]["targetNames"].push_back(name);
  }
  void add_uvs(const char* set = "TEXCOORD_0") {
    Floats uvs;
    for (int i = 0; i < 9; ++i) uvs.insert(uvs.end(), {float(i % 3) / 2, 1 - float(i / 3) / 2});
    primitive["attributes"][set] = accessor(uvs, "VEC2");
  }
  // With a picture of 4 x 4 texels in a buffer view.
  json& add_picture(const Bytes& picture) {
    const int image = add("images", {{"bufferView", view(picture)}});
    const int texture = add("textures", {{"source", image}});
    primitive["material"] = add(
        "materials",
        {{"name", "skin"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
    return root["materials"].back();
  }
  void add_skin() {
    primitive["attributes"]["JOINTS_0"] = accessor(std::vector<std::uint8_t>(36, 1), "VEC4");
    Floats weights;
    for (int i = 0; i < 9; ++i) weights.insert(weights.end(), {0.5f, 0.5f, 0, 0});
    primitive["attributes"]["WEIGHTS_0"] = accessor(weights, "VEC4");
    add("nodes", {{"name", "Neck"}, {"children", {1, 2, 3, 4}}, {"translation", {0, -2, 0}}});
    add("nodes", {{"name", "Head"}, {"translation", {0, 1, 0}}});
    add("nodes", {{"name", "LeftEye"}, {"translation", {1, 2, 0}}});
    add("nodes", {{"name", "RightEye"}, {"translation", {-1, 2, 0}}});
    add("nodes", {{"name", "jaw"}, {"translation", {0, 1, 0}}});
    node["skin"] = add("skins", {{"joints", {0, 1, 2, 3, 4}}});
  }
  void finish() {
    if (!mesh.contains("primitives")) mesh["primitives"] = {primitive};
    node["mesh"] = add("meshes", mesh);
    add("scenes", {{"nodes", {add("nodes", node)}}});
  }
  // As the target takes it: JSON, a zero byte, the buffer.
  Bytes sealed() {
    finish();
    root["buffers"] = {{{"byteLength", binary.size()}}};
    const std::string text = root.dump();
    Bytes file(text.begin(), text.end());
    file.push_back(0);
    file.insert(file.end(), binary.begin(), binary.end());
    return file;
  }
};

}  // namespace

void make_gltf(Folder folder) {
  int number = 0;
  const auto make = [&](const std::string& name, const std::function<void(Face&)>& change) {
    Face face;
    change(face);
    char prefix[8];
    std::snprintf(prefix, sizeof prefix, "%02d_", number++);
    folder.add(prefix + name, face.sealed());
  };
  const std::vector<std::pair<std::string, std::vector<std::string>>> sets = {
      {"arkit",
       {"jawOpen", "eyeBlinkLeft", "eyeBlinkRight", "mouthSmileLeft", "mouthSmileRight",
        "browInnerUp"}},
      {"arkit_mouth",
       {"jawOpen", "mouthClose", "mouthFunnel", "mouthPucker", "mouthLeft", "mouthRight",
        "mouthRollLower"}},
      {"arkit_spelt",
       {"blendShape1.eye_blink_L", "A14_Eye_Blink_Right", "JAW OPEN", "mouthsmile",
        "browInnerUp_L"}},
      {"oculus", {"viseme_PP", "viseme_aa", "v_E", "vrc.v_oh", "viseme_sil"}},
      {"both", {"jawOpen", "viseme_PP", "viseme_aa", "eyesClosed", "mouthOpen", "smile"}},
      {"vroid",
       {"Face.M_F00_000_00_Fcl_MTH_A", "Face.M_F00_000_00_Fcl_EYE_Close", "Fcl_BRW_Angry"}},
      {"mmd", {"\u3042", "\u3044", "\u307e\u3070\u305f\u304d"}},
      {"gaze", {"lookUp", "lookDown", "look_left", "eyeLookInLeft", "eyeLookOutRight"}},
      {"unknown", {"", "target", "Basis", "jawOpen"}}};
  for (const auto& [name, shapes] : sets) {
    make("shapes_" + name, [&shapes = shapes](Face& face) {
      for (std::size_t i = 0; i < shapes.size(); ++i) face.add_shape(shapes[i], int(i) % 9);
    });
  }
  make("names_of_accessors", [](Face& face) {
    face.add_shape("x");
    face.mesh.erase("extras");
    face.root["accessors"].back()["name"] = "jawOpen";
  });
  make("names_of_primitive", [](Face& face) {
    face.add_shape("x");
    face.mesh.erase("extras");
    face.primitive["extras"]["targetNames"] = {"jawOpen"};
  });
  make("dense_shape", [](Face& face) {
    face.primitive["targets"] = {{{"POSITION", face.primitive["attributes"]["POSITION"]}}};
    face.mesh["extras"]["targetNames"] = {"jawOpen"};
  });
  make("quantised", [](Face& face) {
    face.primitive["attributes"]["POSITION"] = face.accessor(
        std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, 0, 32767, -32768}, "VEC3", true);
    face.primitive["indices"] = face.accessor(std::vector<std::uint16_t>{0, 1, 2}, "SCALAR");
    face.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  });
  make("strided", [](Face& face) {
    const int view = face.view(std::vector<std::int8_t>(36, 5));
    face.root["bufferViews"][std::size_t(view)]["byteStride"] = 4;
    face.primitive["attributes"]["POSITION"] =
        face.add("accessors",
                 {{"bufferView", view}, {"componentType", 5120}, {"count", 9}, {"type", "VEC3"}});
  });
  for (const int mode : {0, 4, 5, 6}) {
    make("mode_" + std::to_string(mode), [&](Face& face) { face.primitive["mode"] = mode; });
  }
  make("no_indices", [](Face& face) { face.primitive.erase("indices"); });
  make("wide_indices", [](Face& face) {
    face.primitive["indices"] =
        face.accessor(std::vector<std::uint32_t>{0, 1, 3, 1, 4, 3, 8, 7, 4}, "SCALAR");
  });
  make("sparse_on_dense", [](Face& face) {
    json& all = face.root["accessors"][0];
    const int where = face.view(std::vector<std::uint16_t>{2, 5});
    const int what = face.view(Floats{9, 9, 9, 8, 8, 8});
    all["sparse"] = {{"count", 2},
                     {"indices", {{"bufferView", where}, {"componentType", 5123}}},
                     {"values", {{"bufferView", what}}}};
  });
  make("colours_bytes", [](Face& face) {
    face.primitive["attributes"]["COLOR_0"] = face.accessor(texels(9, 1, 4), "VEC4", true);
  });
  make("colours_floats", [](Face& face) {
    face.primitive["attributes"]["COLOR_0"] = face.accessor(Floats(27, 0.4f), "VEC3");
  });
  make("factor", [](Face& face) {
    face.primitive["material"] = face.add(
        "materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.4, 0.3, 1}}}}});
  });
  make("old_factor", [](Face& face) {
    face.primitive["material"] = face.add(
        "materials",
        {{"extensions",
          {{"KHR_materials_pbrSpecularGlossiness", {{"diffuseFactor", {0.5, 0.4, 0.3, 0.2}}}}}},
         {"alphaMode", "BLEND"}});
  });
  make("glass", [](Face& face) {
    face.primitive["material"] =
        face.add("materials",
                 {{"name", "glass"},
                  {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}});
  });
  const Bytes rgba = texels(4, 4, 4), rgb = texels(4, 4, 3);
  const std::vector<std::pair<std::string, Bytes>> pictures = {
      {"png", test::png_as(rgba, 4, 4, {})},
      {"webp", test::webp_as(rgba, 4, 4, -1)},
      {"jpeg", test::jpeg_as(rgb, 4, 4, {.quality = 20})}};
  for (const auto& [name, picture] : pictures) {
    make("texture_" + name, [&picture = picture](Face& face) {
      face.add_uvs();
      face.add_picture(picture);
    });
  }
  const Bytes& png = pictures[0].second;
  for (const int wrap : {33071, 33648, 10497}) {
    make("wrap_" + std::to_string(wrap), [&](Face& face) {
      face.add_uvs();
      face.add_picture(png);
      face.root["textures"][0]["sampler"] =
          face.add("samplers", {{"wrapS", wrap}, {"wrapT", wrap}});
    });
  }
  make("transform", [&](Face& face) {
    face.add_uvs("TEXCOORD_1");
    face.add_picture(
        png)["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
        {"offset", {0.5, 0.1}}, {"scale", {2, -3}}, {"rotation", 0.7}, {"texCoord", 1}};
  });
  for (const char* mode : {"MASK", "BLEND", "OPAQUE"}) {
    make(std::string("alpha_") + mode, [&](Face& face) {
      face.add_uvs();
      json& material = face.add_picture(png);
      material["alphaMode"] = mode;
      material["alphaCutoff"] = 0.4;
    });
  }
  make("texture_webp_beside", [&](Face& face) {
    face.add_uvs();
    face.add_picture(png);
    const int webp = face.add(
        "images", {{"bufferView", face.view(pictures[1].second)}, {"mimeType", "image/webp"}});
    face.root["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = webp;
    face.root["extensionsUsed"] = {"EXT_texture_webp"};
  });
  make("texture_of_uri", [&](Face& face) {
    face.add_uvs();
    face.add_picture(png);
    face.root["images"][0] = {{"uri", GltfWriter::data_uri(png, "image/png")}};
  });
  make("texture_shared", [&](Face& face) {
    face.add_uvs();
    face.add_picture(png);
    face.mesh["primitives"] = {face.primitive};
    face.root["images"].push_back(face.root["images"][0]);
    face.root["textures"].push_back({{"source", 1}});
    face.root["materials"].push_back(face.root["materials"][0]);
    face.root["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 1;
    face.primitive["material"] = 1;
    face.mesh["primitives"].push_back(face.primitive);
  });
  make("texture_missing", [&](Face& face) {
    face.add_uvs();
    face.add_picture(png);
    face.root["images"][0] = {{"uri", "face.png"}, {"name", "face"}};
  });
  make("texture_and_shapes", [&](Face& face) {
    face.add_uvs();
    face.add_picture(png);
    for (int i = 0; i < 4; ++i) face.add_shape(sets[0].second[std::size_t(i)], i);
    face.primitive["attributes"]["COLOR_0"] = face.accessor(texels(9, 1, 4), "VEC4", true);
  });
  make("skin", [](Face& face) { face.add_skin(); });
  make("skin_bound", [](Face& face) {
    face.add_skin();
    Floats inverse;
    for (int i = 0; i < 80; ++i) inverse.push_back(i % 16 % 5 == 0 ? 1 : 0);
    face.root["skins"][0]["inverseBindMatrices"] = face.accessor(inverse, "MAT4");
    face.add_shape("jawOpen");
  });
  make("skin_wide", [](Face& face) {
    face.add_skin();
    face.primitive["attributes"]["JOINTS_1"] =
        face.accessor(std::vector<std::uint16_t>(36, 2), "VEC4");
    face.primitive["attributes"]["WEIGHTS_1"] = face.accessor(texels(9, 1, 4), "VEC4", true);
  });
  make("skin_and_texture", [&](Face& face) {
    face.add_skin();
    face.add_uvs();
    face.add_picture(png);
    for (const char* name : {"jawOpen", "eyeBlinkLeft", "eyeBlinkRight", "viseme_aa"})
      face.add_shape(name);
  });
  make("matrix",
       [](Face& face) { face.node["matrix"] = {0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 2, 3, 1}; });
  make("turned", [](Face& face) {
    face.node["rotation"] = {0.5, 0.5, 0.5, 0.5};
    face.node["scale"] = {-1, 2, 1};
    face.node["translation"] = {1, 2, 3};
  });
  make("tree", [](Face& face) {
    face.add("nodes", {{"name", "mixamorig:Neck"}, {"children", {1}}});
    face.add("nodes", {{"name", "mixamorig:Head"}, {"children", {2, 3}}});
    face.add("nodes", {{"name", "Left_Eye"}, {"mesh", 0}});
    face.add("nodes", {{"name", "teeth"}, {"mesh", 0}});
  });
  make("levels", [](Face& face) {
    for (const char* name : {"head_LOD0", "head_LOD1", "head_LOD2"})
      face.add("nodes", {{"name", name}, {"mesh", 0}});
  });
  make("circle", [](Face& face) {
    face.add("nodes", {{"children", {1}}});
    face.add("nodes", {{"children", {0}}});
  });
  make("parts", [](Face& face) {
    int mesh = 1;
    for (const char* name : {"EyeLeft", "EyeRight", "Teeth_upper", "lower teeth", "Tongue", "Hair",
                             "Body", "eyelashes", "brow"}) {
      face.add("nodes", {{"name", name}, {"mesh", 0}, {"translation", {0.1 * mesh, 1, 0}}});
      face.root["scenes"][0]["nodes"].push_back(face.root["nodes"].size() - 1);
      ++mesh;
    }
    for (const char* name : {"jawOpen", "eyeBlinkLeft", "eyeBlinkRight"}) face.add_shape(name);
  });
  make("vrm0", [](Face& face) {
    face.add_shape("Face_A", 1);
    face.add_shape("Face_Blink", 2);
    face.root["extensions"]["VRM"] = {
        {"humanoid",
         {{"humanBones", {{{"bone", "head"}, {"node", 0}}, {{"bone", "leftEye"}, {"node", 0}}}}}},
        {"blendShapeMaster",
         {{"blendShapeGroups",
           {{{"presetName", "a"}, {"binds", {{{"mesh", 0}, {"index", 0}, {"weight", 100}}}}},
            {{"presetName", "blink"},
             {"binds", {{{"mesh", 0}, {"index", 1}, {"weight", 100}}}}}}}}}};
    face.root["extensionsUsed"] = {"VRM"};
  });
  make("vrm1", [](Face& face) {
    face.add_shape("Face_A", 1);
    face.add_shape("Face_B", 3);
    face.root["extensions"]["VRMC_vrm"] = {
        {"humanoid", {{"humanBones", {{"head", {{"node", 0}}}, {"jaw", {{"node", 0}}}}}}},
        {"expressions",
         {{"preset",
           {{"aa", {{"morphTargetBinds", {{{"node", 0}, {"index", 0}, {"weight", 1}}}}}},
            {"blinkLeft",
             {{"morphTargetBinds", {{{"node", 0}, {"index", 1}, {"weight", 1}}}}}}}}}}};
  });
  for (const char* extension : {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                "KHR_materials_unlit", "MADE_UP"}) {
    make(std::string("requires_") + extension,
         [&](Face& face) { face.root["extensionsRequired"] = {extension}; });
  }
  make("compressed", [](Face& face) {
    face.primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
    face.root["accessors"][0].erase("bufferView");
  });
  make("fallback", [](Face& face) {
    face.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0}};
    face.root["bufferViews"][0]["byteLength"] = 99999;
  });
  make("claims", [](Face& face) { face.root["accessors"][0]["count"] = 4'000'000'000u; });
  make("zeros", [](Face& face) {
    face.primitive["attributes"]["POSITION"] =
        face.add("accessors", {{"componentType", 5126}, {"count", 9}, {"type", "VEC3"}});
  });
  make("other_types", [](Face& face) {
    face.primitive["attributes"]["POSITION"] = face.primitive["indices"];
    face.primitive["attributes"]["TEXCOORD_0"] = "0";
    face.node["mesh"] = -1;
  });
  make("floats_for_wholes", [](Face& face) { face.root["accessors"][1]["count"] = 24.0; });
  make("two_scenes", [](Face& face) {
    face.add("scenes", {{"nodes", {0}}});
    face.add("nodes", {{"name", "hidden"}, {"mesh", 0}});
  });
  make("materials", [&](Face& face) {
    face.add_uvs();
    json& material = face.add_picture(png);
    for (const char* name : {"normalTexture", "occlusionTexture", "emissiveTexture"}) {
      material[name] = {{"index", 0}, {"scale", 0.5}, {"strength", 0.5}};
    }
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 0}};
    material["emissiveFactor"] = {1, 0.5, 0};
    material["doubleSided"] = true;
    material["extensions"] = {
        {"KHR_materials_specular", {{"specularFactor", 0.5}}},
        {"KHR_materials_emissive_strength", {{"emissiveStrength", 3}}},
        {"VRMC_materials_mtoon",
         {{"shadeColorFactor", {0.5, 0, 0}}, {"shadeMultiplyTexture", {{"index", 0}}}}}};
    face.root["extensions"]["VRM"]["materialProperties"] = {
        {{"shader", "VRM/MToon"},
         {"floatProperties", {{"_ShadeToony", 0.9}, {"_ShadeShift", 0.1}}},
         {"vectorProperties", {{"_ShadeColor", {1, 0.5, 0.5, 1}}}},
         {"textureProperties", {{"_ShadeTexture", 0}}}}};
    face.primitive["attributes"]["NORMAL"] = face.primitive["attributes"]["POSITION"];
  });
  // As they are on disk.
  Face glb, gltf, cut;
  glb.add_shape("jawOpen");
  glb.finish();
  folder.add("whole.glb", glb.glb());
  gltf.finish();
  folder.add("whole.gltf", gltf.gltf(GltfWriter::data_uri(gltf.binary)));
  folder.add("beside.gltf", gltf.gltf("a%20b.bin"));
  cut.finish();
  Bytes half = cut.glb();
  half.resize(half.size() / 2);
  folder.add("cut.glb", half);
}

}  // namespace animeme::fuzz
