// How libFuzzer changes glTF: values of the JSON are replaced, copied, doubled and taken out, so
// that what comes is JSON again; bytes of the buffer, and now and then of the whole, as it always
// does.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostNodes = 3000;
constexpr int kMostDepth = 50;

const Json& some_value(std::minstd_rand& random) {
  static const std::vector<Json> values = {0,
                                           1,
                                           2,
                                           3,
                                           4,
                                           5,
                                           6,
                                           8,
                                           9,
                                           16,
                                           24,
                                           36,
                                           255,
                                           256,
                                           1000,
                                           65535,
                                           65536,
                                           4294967295u,
                                           -1,
                                           0.5,
                                           -0.5,
                                           1e-30,
                                           1e30,
                                           1e300,
                                           3.0,
                                           5120,
                                           5121,
                                           5122,
                                           5123,
                                           5125,
                                           5126,
                                           10497,
                                           33071,
                                           33648,
                                           true,
                                           false,
                                           nullptr,
                                           "",
                                           "VEC2",
                                           "VEC3",
                                           "VEC4",
                                           "MAT4",
                                           "SCALAR",
                                           "MASK",
                                           "BLEND",
                                           "head",
                                           "eye_L",
                                           "EyeRight",
                                           "Teeth",
                                           "tongue",
                                           "jaw",
                                           "Neck",
                                           "jawOpen",
                                           "eyeBlinkLeft",
                                           "eyeBlinkRight",
                                           "viseme_PP",
                                           "viseme_aa",
                                           "mouthSmile",
                                           "browInnerUp",
                                           "head_LOD0",
                                           "head_LOD1",
                                           "hair",
                                           Json::array(),
                                           Json::object(),
                                           {0},
                                           {1, 2},
                                           {0, 0, 0},
                                           {1, 0, 0, 0}};
  return values[random() % values.size()];
}

const char* some_key(std::minstd_rand& random) {
  static const std::vector<const char*> keys = {
      "normalized", "byteOffset", "byteStride",  "sparse",      "skin",     "matrix",
      "rotation",   "scale",      "translation", "children",    "mesh",     "mode",
      "targets",    "material",   "COLOR_0",     "TEXCOORD_0",  "JOINTS_0", "WEIGHTS_0",
      "JOINTS_1",   "WEIGHTS_1",  "alphaMode",   "alphaCutoff", "texCoord", "sampler",
      "name",       "extras",     "extensions",  "indices",     "count",    "inverseBindMatrices"};
  return keys[random() % keys.size()];
}

void collect(Json& value, int depth, std::vector<Json*>& out) {
  if (out.size() >= kMostNodes || depth > kMostDepth) return;
  out.push_back(&value);
  if (!value.is_structured()) return;
  for (Json& entry : value) collect(entry, depth + 1, out);
}

void change(Json& root, std::minstd_rand& random) {
  std::vector<Json*> all;
  collect(root, 0, all);
  Json& value = *all[random() % all.size()];
  switch (random() % 8) {
    case 0:
    case 1:
      value = some_value(random);
      break;
    case 2:
      value = Json(*all[random() % all.size()]);  // a copy, as it may be a part of it
      break;
    case 3:
      if (value.is_number_integer())
        value = value.get<std::int64_t>() % 100000 + (random() % 2 ? 1 : -1);
      break;
    case 4:
      if (value.is_structured() && !value.empty()) {
        auto entry = value.begin();
        std::advance(entry, std::ptrdiff_t(random() % value.size()));
        value.erase(entry);
      }
      break;
    case 5:
      if (value.is_array() && !value.empty()) value.push_back(Json(value[random() % value.size()]));
      break;
    case 6:
      if (value.is_object()) value[some_key(random)] = some_value(random);
      break;
    default:
      if (value.is_array() && value.size() > 1) {
        std::swap(value[random() % value.size()], value[random() % value.size()]);
      }
  }
}

int depth_of(const std::uint8_t* text, std::size_t size) {
  int depth = 0, most = 0;
  for (std::size_t i = 0; i < size; ++i) {
    depth += text[i] == '[' || text[i] == '{' ? 1 : text[i] == ']' || text[i] == '}' ? -1 : 0;
    most = std::max(most, depth);
  }
  return most;
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  std::minstd_rand random(seed + 1);
  const auto* end = static_cast<const std::uint8_t*>(std::memchr(data, 0, size));
  const std::size_t text = end == nullptr ? size : std::size_t(end - data);
  const unsigned choice = random() % 16;
  if (choice == 0) return LLVMFuzzerMutate(data, size, most);
  if (choice < 4 && text + 1 < size) {
    return text + 1 + LLVMFuzzerMutate(data + text + 1, size - text - 1, most - text - 1);
  }
  if (depth_of(data, text) > kMostDepth) return LLVMFuzzerMutate(data, size, most);
  Json root = Json::parse(data, data + text, nullptr, false);
  if (root.is_discarded()) return LLVMFuzzerMutate(data, size, most);
  for (unsigned i = random() % 3 + 1; i > 0; --i) change(root, random);
  const std::string changed = root.dump(-1, ' ', false, Json::error_handler_t::replace);
  const std::size_t rest = size - text;
  if (changed.size() + rest > most) return LLVMFuzzerMutate(data, size, most);
  std::memmove(data + changed.size(), data + text, rest);
  std::memcpy(data, changed.data(), changed.size());
  return changed.size() + rest;
}
