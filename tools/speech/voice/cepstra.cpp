#include "tools/speech/voice/cepstra.h"

#include <pocketsphinx.h>
#include <sphinxbase/fe.h>
#include <sphinxbase/logmath.h>
#include <sphinxbase/ngram_model.h>

#include <array>
#include <filesystem>

#include "tools/speech/voice/sphinx.h"

namespace animeme::voice {

namespace {

constexpr std::size_t kFramesAtOnce = 100;

struct FreeSphinx {
  void operator()(cmd_ln_t* config) const { cmd_ln_free_r(config); }
  void operator()(fe_t* reader) const { fe_free(reader); }
  void operator()(logmath_t* maths) const { logmath_free(maths); }
  void operator()(ngram_model_t* model) const { ngram_model_free(model); }
};

class FrontEnd : public CepstraReader {
 public:
  FrontEnd(std::unique_ptr<cmd_ln_t, FreeSphinx> config, std::unique_ptr<fe_t, FreeSphinx> reader)
      : config_(std::move(config)), reader_(std::move(reader)) {
    fe_start_utt(reader_.get());
  }

  void push(std::span<const std::int16_t> samples, std::vector<Cepstrum>& frames) override {
    const std::int16_t* at = samples.data();
    std::size_t left = samples.size();
    std::array<Cepstrum, kFramesAtOnce> block;
    std::array<mfcc_t*, kFramesAtOnce> rows;
    for (std::size_t i = 0; i < kFramesAtOnce; ++i) rows[i] = block[i].data();
    while (left > 0) {
      std::int32_t count = kFramesAtOnce;
      const std::size_t before = left;
      if (fe_process_frames(reader_.get(), &at, &left, rows.data(), &count, nullptr) < 0) return;
      frames.insert(frames.end(), block.begin(), block.begin() + count);
      if (count == 0 && left == before) return;
    }
  }

  void finish(std::vector<Cepstrum>& frames) override {
    Cepstrum last{};
    std::int32_t count = 0;
    fe_end_utt(reader_.get(), last.data(), &count);
    if (count > 0) frames.push_back(last);
    fe_start_utt(reader_.get());
  }

 private:
  std::unique_ptr<cmd_ln_t, FreeSphinx> config_;
  std::unique_ptr<fe_t, FreeSphinx> reader_;
};

static_assert(sizeof(mfcc_t) == sizeof(float), "a library with fixed-point numbers");

}  // namespace

Result<std::unique_ptr<CepstraReader>> CepstraReader::open(const std::string& model_path) {
  const std::string features = (std::filesystem::path(model_path) / "feat.params").string();
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(features, ignored)) {
    return make_error(Code::not_found, "no acoustic model at " + model_path +
                                           " (feat.params is missing); install the Debian package "
                                           "pocketsphinx-en-us or set the path");
  }
  const auto lock = quiet_sphinx();
  std::unique_ptr<cmd_ln_t, FreeSphinx> config(
      cmd_ln_parse_file_r(nullptr, ps_args(), features.c_str(), FALSE));
  if (config) {
    cmd_ln_set_float_r(config.get(), "-samprate", 16000);
    cmd_ln_set_boolean_r(config.get(), "-remove_silence", FALSE);
    cmd_ln_set_boolean_r(config.get(), "-dither", FALSE);
    cmd_ln_set_boolean_r(config.get(), "-remove_noise", FALSE);  // denoise.h loses less
  }
  std::unique_ptr<fe_t, FreeSphinx> reader(config ? fe_init_auto_r(config.get()) : nullptr);
  if (!reader || fe_get_output_size(reader.get()) != int(kCepstra)) {
    return make_error(Code::unsupported, "a model of 13 cepstra at 16 kHz is wanted")
        .in_file(features);
  }
  std::unique_ptr<CepstraReader> made =
      std::make_unique<FrontEnd>(std::move(config), std::move(reader));
  return made;
}

Result<std::vector<double>> read_phone_pairs(const std::string& path,
                                             const std::vector<std::string>& phones) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    return make_error(Code::not_found,
                      "there is no phone model here; install the Debian package "
                      "pocketsphinx-en-us or set the path")
        .in_file(path);
  }
  const auto lock = quiet_sphinx();
  const std::unique_ptr<logmath_t, FreeSphinx> maths(logmath_init(1.0001, 0, FALSE));
  const std::unique_ptr<ngram_model_t, FreeSphinx> model(
      ngram_model_read(nullptr, path.c_str(), NGRAM_AUTO, maths.get()));
  if (!model) {
    return make_error(Code::syntax, "this is not a phone model").in_file(path);
  }
  std::vector<double> pairs;
  for (const std::string& before : phones) {
    double sum = 0;
    for (const std::string& after : phones) {
      std::int32_t used = 0;
      const std::int32_t score =
          ngram_ng_score(model.get(), ngram_wid(model.get(), after.c_str()),
                         std::array{ngram_wid(model.get(), before.c_str())}.data(), 1, &used);
      pairs.push_back(std::max(logmath_exp(maths.get(), score), 1e-6));
      sum += pairs.back();
    }
    for (std::size_t i = pairs.size() - phones.size(); i < pairs.size(); ++i) pairs[i] /= sum;
  }
  return pairs;
}

}  // namespace animeme::voice
