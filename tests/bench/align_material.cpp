#include "tests/bench/align_material.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "tests/support/files.h"
#include "tools/formats/media/audio.h"

namespace animeme::bench {

namespace {

constexpr double kShortest = 0.0305;  // three states of 10 ms

bool speaks(const dam::Phone& phone) { return phone.label != dam::kSilence; }

}  // namespace

std::size_t Sentence::first_sample() const {
  const auto one = std::find_if(labels.phones.begin(), labels.phones.end(), speaks);
  return one == labels.phones.end() ? 0 : std::size_t(one->start * 16000);
}

std::size_t Sentence::last_sample() const {
  const auto one = std::find_if(labels.phones.rbegin(), labels.phones.rend(), speaks);
  return one == labels.phones.rend() ? sound.size() : std::size_t(one->end * 16000);
}

Result<std::vector<Sentence>> read_sentences(const std::string& corpus, std::size_t every,
                                             std::size_t first) {
  const std::filesystem::path folder(corpus);
  std::istringstream table(test::slurp(folder / "utterances.tsv"));
  std::vector<Sentence> sentences;
  std::string line;
  std::getline(table, line);  // id and text come first
  for (std::size_t number = 0; std::getline(table, line);) {
    const std::size_t tab = line.find('\t');
    Sentence one{
        line.substr(0, tab), line.substr(tab + 1, line.find('\t', tab + 1) - tab - 1), {}, {}};
    const auto wav = folder / "audio" / (one.id + ".wav");
    if (!std::filesystem::exists(wav)) continue;
    if (number++ % every != first % every) continue;
    auto sound = media::read_audio(wav.string(), {16000, 3600, nullptr});
    if (!sound) return sound.error();
    one.sound = std::move(sound->samples);
    auto labels = dam::read_script(test::slurp(folder / "phonemes" / (one.id + ".tsv")));
    if (!labels) return labels.error().in_file(one.id);
    one.labels = std::move(*labels);
    sentences.push_back(std::move(one));
  }
  if (sentences.empty()) return make_error(Code::not_found, "no sentence with sound in " + corpus);
  return sentences;
}

void Score::add(const dam::Script& labels, const dam::Script& found) {
  ++sentences;
  std::size_t from = 0;
  const auto& phones_found = found.phones;
  for (const dam::Phone& phone : labels.phones) {
    for (std::size_t i = from; speaks(phone) && i < phones_found.size(); ++i) {
      if (phones_found[i].label != phone.label || phones_found[i].word != phone.word) continue;
      errors.push_back(1000 * (phones_found[i].start - phone.start));
      from = i + 1;
      break;
    }
  }
  const auto first = std::find_if(phones_found.begin(), phones_found.end(), speaks);
  const auto last = std::find_if(phones_found.rbegin(), phones_found.rend(), speaks).base();
  for (auto one = first; one < last; ++one) {
    if (speaks(*one)) {
      ++phones;
      shortest += one->duration() <= kShortest ? 1 : 0;
      continue;
    }
    double really = 0;
    for (const dam::Phone& label : labels.phones) {
      if (speaks(label)) continue;
      really += std::max(0.0, std::min(label.end, one->end) - std::max(label.start, one->start));
    }
    false_pause_seconds += one->duration() - really;
  }
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at = std::min(values.size() - 1, std::size_t(share * double(values.size())));
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(at), values.end());
  return values[at];
}

namespace {

std::vector<double> distances(const std::vector<double>& errors) {
  std::vector<double> out;
  for (const double error : errors) out.push_back(std::abs(error));
  return out;
}

}  // namespace

double Score::median() const { return percentile(distances(errors), 0.5); }
double Score::ninety() const { return percentile(distances(errors), 0.9); }
double Score::bias() const { return percentile(errors, 0.5); }

double Score::mean() const {
  double sum = 0;
  for (const double error : errors) sum += std::abs(error);
  return sum / double(std::max<std::size_t>(errors.size(), 1));
}

double Score::shortest_share() const {
  return double(shortest) / double(std::max<std::size_t>(phones, 1));
}

std::vector<std::vector<float>> voices_of(const std::vector<Sentence>& sentences) {
  std::vector<std::vector<float>> voices;
  for (const Sentence& one : sentences) {
    const auto begin = one.sound.begin();
    voices.emplace_back(begin + std::ptrdiff_t(one.first_sample()),
                        begin + std::ptrdiff_t(std::min(one.last_sample(), one.sound.size())));
  }
  return voices;
}

}  // namespace animeme::bench
