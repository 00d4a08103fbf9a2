#include "tools/speech/voice/sound_model.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <numbers>
#include <string_view>

#include "fap/detail/whole_file.h"

namespace animeme::voice {

namespace {

constexpr std::int32_t kByteOrder = 0x11223344;
constexpr std::size_t kMostPhones = 200, kMostDensities = 1024, kMostModelBytes = 200'000'000;
constexpr std::size_t kMostSenones = 100'000;
constexpr float kSmallestVariance = 1e-4f;
// sendump has weights as multiples of 1024 times the logarithm to this base, with its sign changed.
const double kWeightStep = 1024 * std::log(1.0001);

// Bytes that are read one after the other; past the end there are zeros, and it is not good().
class ModelBytes {
 public:
  explicit ModelBytes(std::span<const std::uint8_t> data)
      : data_(reinterpret_cast<const char*>(data.data()), data.size()) {}

  std::int32_t number() {
    std::int32_t value = 0;
    const auto part = take(sizeof value);
    if (!part.empty()) std::memcpy(&value, part.data(), sizeof value);
    return value;
  }
  std::vector<float> floats(std::size_t count) {
    const auto part = take(count * sizeof(float));
    std::vector<float> values(part.size() / sizeof(float));
    if (!part.empty()) std::memcpy(values.data(), part.data(), part.size());
    for (const float value : values) good_ = good_ && std::isfinite(value);
    return values;
  }
  std::string_view take(std::size_t count) {
    if (count > data_.size()) {
      good_ = false;
      return {};
    }
    const auto part = data_.substr(0, count);
    data_.remove_prefix(count);
    return part;
  }
  // Up to `mark`, which is passed over.
  std::string_view until(std::string_view mark) {
    const std::size_t end = data_.find(mark);
    if (end == std::string_view::npos) {
      good_ = false;
      return {};
    }
    const auto part = take(end);
    take(mark.size());
    return part;
  }
  bool good() const { return good_; }

 private:
  std::string_view data_;
  bool good_ = true;
};

struct ModelFile {
  std::string path;
  std::vector<std::uint8_t> data;
  Error damaged(const std::string& what) const {
    return make_error(Code::syntax, what + "; install the Debian package pocketsphinx-en-us again")
        .in_file(path);
  }
};

Result<ModelFile> open_model_file(const std::string& folder, const char* name) {
  const std::string path = (std::filesystem::path(folder) / name).string();
  auto data = fap::detail::read_whole(path, {kMostModelBytes});
  if (data) return ModelFile{path, std::move(*data)};
  if (data.error().code != Code::not_found) return data.error().in_file(path);
  return make_error(Code::not_found, "no acoustic model at " + folder + " (" + name +
                                         " is missing); install the Debian package "
                                         "pocketsphinx-en-us or set the path");
}

bool skip_s3_head(ModelBytes& in) {
  return in.until("\n").substr(0, 2) == "s3" && !in.until("endhdr\n").empty() &&
         in.number() == kByteOrder;
}

// Phones, their number, and the number of all states; those without context come first.
Result<std::size_t> read_phones(const ModelFile& file, SoundModel& model) {
  ModelBytes in(file.data);
  if (in.take(4) != "BMDF") return file.damaged("this is not a binary model definition");
  in.number();  // version
  in.take(std::size_t(std::max(in.number(), 0)));
  std::int32_t head[10];  // phones, triphones, states each, their senones, all senones, ...
  for (std::int32_t& one : head) one = in.number();
  const bool fits = in.good() && head[0] > 0 && head[0] <= std::int32_t(kMostPhones) &&
                    head[2] == std::int32_t(kStatesPerPhone) &&
                    head[3] == head[0] * std::int32_t(kStatesPerPhone) && head[4] >= head[3] &&
                    head[4] <= std::int32_t(kMostSenones);
  if (!fits) return file.damaged("these are not three states a phone");
  for (std::int32_t i = 0; i < head[0]; ++i) {
    model.phones.emplace_back(in.until(std::string_view("\0", 1)));
  }
  if (!in.good()) return file.damaged("the names of the phones are cut off");
  return std::size_t(head[4]);
}

Result<std::vector<float>> read_gaussians(const ModelFile& file, SoundModel& model) {
  ModelBytes in(file.data);
  if (!skip_s3_head(in)) return file.damaged("this is not a table of Gaussians");
  const std::int32_t books = in.number(), streams = in.number(), densities = in.number();
  bool fits = books == std::int32_t(model.phones.size()) && streams == std::int32_t(kStreams) &&
              densities > 0 && densities <= std::int32_t(kMostDensities);
  for (std::size_t i = 0; i < kStreams; ++i) fits = in.number() == std::int32_t(kCepstra) && fits;
  if (!fits || !in.good()) {
    return make_error(Code::unsupported,
                      "a model that shares its Gaussians within a phone, in three streams of 13, "
                      "is wanted (ptm)")
        .in_file(file.path);
  }
  model.densities = std::size_t(densities);
  const std::size_t count = model.phones.size() * kStreams * kCepstra * model.densities;
  if (in.number() != std::int32_t(count)) return file.damaged("its size is wrong");
  const auto values = in.floats(count);
  if (!in.good()) return file.damaged("it is truncated or has no numbers");
  // Density last, so that all of them are computed side by side.
  std::vector<float> turned(count);
  for (std::size_t book = 0; book < model.phones.size() * kStreams; ++book) {
    for (std::size_t density = 0; density < model.densities; ++density) {
      for (std::size_t i = 0; i < kCepstra; ++i) {
        turned[(book * kCepstra + i) * model.densities + density] =
            values[(book * model.densities + density) * kCepstra + i];
      }
    }
  }
  return turned;
}

void set_constants(SoundModel& model, std::vector<float> variances) {
  const std::size_t books = model.phones.size() * kStreams;
  model.constants.assign(books * model.densities, 0);
  for (std::size_t book = 0; book < books; ++book) {
    for (std::size_t i = 0; i < kCepstra; ++i) {
      for (std::size_t d = 0; d < model.densities; ++d) {
        float& variance = variances[(book * kCepstra + i) * model.densities + d];
        variance = std::max(variance, kSmallestVariance);
        model.constants[book * model.densities + d] -=
            0.5f * std::log(2 * std::numbers::pi_v<float> * variance);
        variance = 0.5f / variance;
      }
    }
  }
  model.precisions = std::move(variances);
}

Result<void> read_weights(const ModelFile& file, std::size_t senones, SoundModel& model) {
  ModelBytes in(file.data);
  while (true) {  // lines of text, each behind its length
    const std::int32_t length = in.number();
    if (!in.good() || length < 0) return file.damaged("its head does not end");
    if (length == 0) break;
    const auto line = in.take(std::size_t(length));
    if (line.starts_with("cluster_count ") && !line.starts_with("cluster_count 0")) {
      return make_error(Code::unsupported, "weights in clusters are not read").in_file(file.path);
    }
  }
  const std::int32_t rows = in.number(), columns = in.number();
  if (rows != std::int32_t(model.densities) || columns < std::int32_t(senones) ||
      columns > std::int32_t(kMostSenones)) {
    return file.damaged("its weights are of another model");
  }
  model.weights.assign(model.states() * kStreams * model.densities, 0);
  for (std::size_t stream = 0; stream < kStreams; ++stream) {
    for (std::size_t density = 0; density < model.densities; ++density) {
      const auto row = in.take(std::size_t(columns));
      if (!in.good()) return file.damaged("it is cut off");
      for (std::size_t state = 0; state < model.states(); ++state) {
        const std::size_t phone = state / kStatesPerPhone, part = state % kStatesPerPhone;
        model.weights[((phone * kStreams + stream) * kStatesPerPhone + part) * model.densities +
                      density] =
            float(std::exp(-double(static_cast<unsigned char>(row[state])) * kWeightStep));
      }
    }
  }
  return {};
}

Result<void> read_transitions(const ModelFile& file, SoundModel& model) {
  ModelBytes in(file.data);
  if (!skip_s3_head(in)) return file.damaged("this is not a table of transitions");
  constexpr std::size_t kFrom = kStatesPerPhone, kTo = kStatesPerPhone + 1;
  const bool fits = in.number() == std::int32_t(model.phones.size()) &&
                    in.number() == std::int32_t(kFrom) && in.number() == std::int32_t(kTo);
  const std::size_t count = model.phones.size() * kFrom * kTo;
  if (!fits || in.number() != std::int32_t(count)) return file.damaged("its size is wrong");
  const auto values = in.floats(count);
  if (!in.good()) return file.damaged("it is truncated or has no numbers");
  for (std::size_t phone = 0; phone < model.phones.size(); ++phone) {
    for (std::size_t from = 0; from < kFrom; ++from) {
      const float* row = &values[(phone * kFrom + from) * kTo];
      float sum = 0;
      for (std::size_t to = 0; to < kTo; ++to) sum += std::max(row[to], 0.0f);
      model.stay.push_back(sum > 0 ? std::clamp(row[from] / sum, 0.01f, 0.99f) : 0.5f);
    }
  }
  return {};
}

}  // namespace

Result<SoundModel> read_sound_model(const std::string& folder) {
  SoundModel model;
  std::size_t senones = 0;
  for (const char* name : {"mdef", "means", "variances", "sendump", "transition_matrices"}) {
    auto file = open_model_file(folder, name);
    if (!file) return file.error();
    const std::string_view which = name;
    if (which == "mdef") {
      const auto count = read_phones(*file, model);
      if (!count) return count.error();
      senones = *count;
    } else if (which == "means" || which == "variances") {
      auto values = read_gaussians(*file, model);
      if (!values) return values.error();
      if (which == "means") {
        model.means = std::move(*values);
      } else if (values->size() != model.means.size()) {
        return file->damaged("it has another size than the means");
      } else {
        set_constants(model, std::move(*values));
      }
    } else {
      const auto done =
          which == "sendump" ? read_weights(*file, senones, model) : read_transitions(*file, model);
      if (!done) return done.error();
    }
  }
  return model;
}

}  // namespace animeme::voice
