#include "tools/app/late/sphinx_functions.h"
#include "tools/formats/common/module.h"

namespace animeme::voice {
namespace {

const Result<const SphinxFunctions*>& sphinx() {
  static const auto loaded = tools::load_functions<SphinxFunctions>(tools::kSphinxModule);
  return loaded;
}

}  // namespace

Result<std::unique_ptr<CepstraReader>> CepstraReader::open(const std::string& model_path) {
  if (!sphinx()) return sphinx().error();
  return (*sphinx())->open_cepstra(model_path);
}

Result<std::vector<double>> read_phone_pairs(const std::string& path,
                                             const std::vector<std::string>& phones) {
  if (!sphinx()) return sphinx().error();
  return (*sphinx())->read_phone_pairs(path, phones);
}

void denoise(const std::vector<float>& samples, double snr,
             const std::function<void(std::span<const float>)>& take) {
  return sphinx() ? (*sphinx())->denoise(samples, snr, take) : take(samples);
}

Result<std::unique_ptr<RateChange>> RateChange::open(int rate) {
  if (!sphinx()) return sphinx().error();
  return (*sphinx())->open_rate_change(rate);
}

Result<std::unique_ptr<WordSearch>> WordSearch::open(const WordFiles& files) {
  if (!sphinx()) return sphinx().error();
  return (*sphinx())->open_word_search(files);
}

}  // namespace animeme::voice
