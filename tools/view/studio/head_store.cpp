#include "tools/view/studio/head_store.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <type_traits>

#include "fap/head/people.h"
#include "fap/head/rig.h"
#include "tools/formats/files/private_folder.h"
#include "tools/view/studio/head_build.h"
#include "tools/view/studio/head_sound_internal.h"

namespace animeme::studio {
namespace {

constexpr std::size_t kSumSize = sizeof(std::uint64_t);
constexpr std::uint64_t kMostBytes = std::uint64_t(32) << 20;  // a head has 5 MB
constexpr std::size_t kLeastTarget = 24;                       // bytes of an empty one

// FNV-1a by words of eight bytes: it finds what a disk lost, not what somebody made.
std::uint64_t sum_of(std::string_view bytes) {
  std::uint64_t sum = 0xCBF29CE484222325u;
  for (std::size_t i = 0; i < bytes.size(); i += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, std::min(sizeof word, bytes.size() - i));
    sum = (sum ^ word) * 0x100000001B3u;
  }
  return sum;
}

// In the byte order and layout of this machine: the file is local.
struct Writer {
  std::string bytes;

  template <class T>
  void operator()(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class T>
  void list(const T* first, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    (*this)(std::uint64_t(count));
    if (count > 0) bytes.append(reinterpret_cast<const char*>(first), count * sizeof(T));
  }
  void operator()(const std::string& text) { list(text.data(), text.size()); }
  template <class T>
  void operator()(const std::vector<T>& values) {
    list(values.data(), values.size());
  }
  void operator()(const std::vector<head::Target>& targets) {
    (*this)(std::uint64_t(targets.size()));
  }
};

// Bytes that run out give zeros and empty lists, and `whole` is false.
struct Reader {
  std::string_view bytes;
  bool whole = true;

  void take(void* to, std::size_t size) {
    whole = whole && size <= bytes.size();
    if (!whole) return;
    std::memcpy(to, bytes.data(), size);
    bytes.remove_prefix(size);
  }
  template <class T>
  void operator()(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    take(&value, sizeof value);
  }
  // The byte of a bool may be of any value.
  void operator()(bool& value) {
    std::uint8_t byte = 0;
    take(&byte, sizeof byte);
    whole = whole && byte <= 1;
    value = byte == 1;
  }
  std::size_t count(std::size_t size) {
    std::uint64_t count = 0;
    (*this)(count);
    whole = whole && count <= bytes.size() / size;
    return whole ? std::size_t(count) : 0;
  }
  void operator()(std::string& text) {
    text.resize(count(1));
    take(text.data(), text.size());
  }
  template <class T>
  void operator()(std::vector<T>& values) {
    values.resize(count(sizeof(T)));
    if (!values.empty()) take(values.data(), values.size() * sizeof(T));
  }
  void operator()(std::vector<head::Target>& targets) { targets.resize(count(kLeastTarget)); }
};

// Each field once, for both directions.
template <class Archive, class Head>
void all_fields(Archive& archive, Head& head) {
  archive(head.name);
  archive(head.centimetres);
  for (auto& mesh : head.parts) {
    archive(mesh.positions);
    archive(mesh.triangles);
    archive(mesh.colours);
    archive(mesh.occlusion);
    archive(mesh.surface);
    archive(mesh.grain);
  }
  archive(head.eyes);
  archive(head.feature_points);
  archive(head.fapu);
  archive(head.jaw_axis);
  archive(head.neck_pivot);
  archive(head.seams.lips);
  for (auto& pairs : head.seams.lids) archive(pairs);
  for (auto& weights : head.seams.lid_weights) archive(weights);
  archive(head.seams.jaw_weights);
  archive(head.seams.freedom);
  archive(head.seams.neck_weights);
  archive(head.lash_anchors);
  archive(head.mouth_gain);
  archive(head.eased);
  archive(head.targets);
  for (auto& target : head.targets) {
    archive(target.control);
    archive(target.part);
    archive(target.vertices);
    archive(target.deltas);
    archive(target.low);
    archive(target.high);
  }
}

}  // namespace

std::string store_head(const head::Head& head) {
  Writer writer;
  writer(std::string(kHeadBuild));
  all_fields(writer, head);
  writer(sum_of(writer.bytes));
  return std::move(writer.bytes);
}

std::optional<head::Head> restore_head(std::string_view bytes) {
  if (bytes.size() < kSumSize || bytes.size() > kMostBytes) return std::nullopt;
  std::uint64_t sum = 0;
  std::memcpy(&sum, bytes.data() + bytes.size() - kSumSize, kSumSize);
  Reader reader{bytes.substr(0, bytes.size() - kSumSize)};
  std::string build;
  reader(build);
  if (build != kHeadBuild || sum != sum_of(bytes.substr(0, bytes.size() - kSumSize))) {
    return std::nullopt;
  }
  std::optional<head::Head> head(std::in_place);
  all_fields(reader, *head);
  if (!reader.whole || !reader.bytes.empty() || !is_sound(*head)) head.reset();
  return head;
}

std::string cache_folder() {
  const auto named = [](const char* variable) {
    const char* const value = std::getenv(variable);
    return std::filesystem::path(value == nullptr ? "" : value);
  };
  // What is not absolute does not count, says the specification of XDG's base folders.
  if (const auto cache = named("XDG_CACHE_HOME"); cache.is_absolute()) return cache / "animeme";
  if (const auto home = named("HOME"); home.is_absolute()) return home / ".cache" / "animeme";
  return "";
}

Result<head::Head> ready_head(std::string_view name, const std::string& folder) {
  const Result<head::HeadParameters> parameters = head::parse_head(name);
  if (!parameters) return parameters.error();
  std::string file = "head-" + parameters->name + ".bin";
  std::replace_if(
      file.begin(), file.end(), [](char c) { return c == ':' || c == '=' || c == '#'; }, '_');
  const std::filesystem::path path = std::filesystem::path(folder) / file;
  if (!folder.empty()) {
    if (const auto bytes = tools::read_private_file(path, kMostBytes)) {
      const std::string_view view(reinterpret_cast<const char*>(bytes->data()), bytes->size());
      auto head = restore_head(view);
      if (head && head->name == parameters->name) return std::move(*head);
    }
  }
  Result<head::Head> head = head::make_head(*parameters);
  if (!head) return head;
  head->targets = head::make_rig(*head).targets;
  head->eased = true;
  if (folder.empty()) return head;
  (void)tools::write_private_file(path, store_head(*head));
  return head;
}

}  // namespace animeme::studio
