#include "tests/bench/align_languages.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "dam/maths/random.h"
#include "tests/bench/align_material.h"
#include "tests/bench/recorded_lists.h"
#include "tests/support/files.h"
#include "tools/formats/media/audio.h"
#include "tools/speech/voice/align.h"
#include "tools/speech/voice/parted_words.h"
#include "tools/speech/voice/voice.h"

namespace animeme::bench {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLeastLine = 40, kMostLines = 60;  // bytes; sentences
constexpr const char* kUnsaid = "[]<>(){}0123456789;";   // not said, or read in several ways

struct LabelledWord {
  std::string text;
  std::vector<double> starts;  // of its phones, seconds
};

Result<std::vector<float>> sound_of(const fs::path& path) {
  auto sound = media::read_audio(path.string(), {16000, 3600, nullptr});
  if (!sound) return sound.error();
  return std::move(sound->samples);
}

// Lines of start, end, phone, word; whose word is 0 are silence.
std::vector<LabelledWord> read_labels(const fs::path& path) {
  std::istringstream in(test::slurp(path));
  std::vector<LabelledWord> words;
  std::string line, before;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    double start = 0, end = 0;
    std::string phone, word;
    fields >> start >> end >> phone >> word;
    if (word != "0" && !word.empty()) {
      if (word != before) words.push_back({word, {}});
      words.back().starts.push_back(start);
    }
    before = word;
  }
  return words;
}

// The starts of the phones of each word, in the order of the text; none of those not said.
std::vector<std::vector<double>> found_starts(const voice::Alignment& found) {
  std::vector<std::vector<double>> starts;
  for (const voice::AlignedWord& word : found.words) {
    starts.emplace_back();
    for (const dam::Phone& phone : found.script.phones) {
      if (phone.word.empty() || phone.start < word.start - 1e-6 || phone.start >= word.end - 1e-6)
        continue;
      starts.back().push_back(phone.start);
    }
  }
  return starts;
}

double share_within(const std::vector<double>& errors, double limit) {
  const auto near = std::count_if(errors.begin(), errors.end(),
                                  [&](double error) { return std::abs(error) <= limit; });
  return 100 * double(near) / double(std::max<std::size_t>(errors.size(), 1));
}

double median_distance(std::vector<double> errors) {
  for (double& error : errors) error = std::abs(error);
  return percentile(std::move(errors), 0.5);
}

// How far alignments are from labels.
struct Distances {
  std::size_t sentences = 0, refused = 0, other = 0;  // of other words than the labels have
  std::size_t all = 0, unsaid = 0;
  std::vector<double> words, phones;  // ms, found minus label
};

void add(const std::vector<LabelledWord>& labels, const Result<voice::Alignment>& found,
         Distances& sum) {
  ++sum.sentences;
  if (!found || found->words.size() != labels.size()) {
    ++(found ? sum.other : sum.refused);
    return;
  }
  const auto starts = found_starts(*found);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    sum.all += labels[i].starts.size();
    sum.unsaid += found->words[i].said ? 0 : 1;
    if (starts[i].empty() || labels[i].starts.empty()) continue;
    sum.words.push_back(1000 * (starts[i][0] - labels[i].starts[0]));
    if (starts[i].size() != labels[i].starts.size()) continue;
    for (std::size_t k = 0; k < starts[i].size(); ++k) {
      sum.phones.push_back(1000 * (starts[i][k] - labels[i].starts[k]));
    }
  }
}

void print_distances(const std::string& language, const Distances& sum) {
  std::printf(
      "| language | sentences | refused | of other words | phones compared | median ms | within 20 "
      "%% | 50 %% | bias | words | median ms | within 50 %% | taken for left out |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n"
      "| %s | %zu | %zu | %zu | %zu of %zu | %.1f | %.0f | %.0f | %+.1f | %zu | %.1f | %.0f | %zu "
      "|\n",
      language.c_str(), sum.sentences, sum.refused, sum.other, sum.phones.size(), sum.all,
      median_distance(sum.phones), share_within(sum.phones, 20), share_within(sum.phones, 50),
      percentile(sum.phones, 0.5), sum.words.size(), median_distance(sum.words),
      share_within(sum.words, 50), sum.unsaid);
}

// What alignments make of one kind of text.
struct Kind {
  std::size_t recordings = 0, refused = 0;
  std::size_t words = 0, out = 0, doubted = 0;  // said words; taken for left out, doubted
  std::size_t inserted = 0;                     // stretches that no text lacks
  std::size_t noticed = 0, neighbour = 0;       // the word, or the one beside it
};

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

// `missing`: number of a word of the text that is not said. `lacking`: of the word before which
// the text lacks one. Else kNobody.
constexpr std::size_t kNobody = ~std::size_t(0);

void count(const Result<voice::Alignment>& found, std::size_t missing, std::size_t lacking,
           Kind& kind) {
  ++kind.recordings;
  if (!found) {
    ++kind.refused;
    return;
  }
  bool noticed = false, beside = false;
  for (std::size_t i = 0; i < found->words.size(); ++i) {
    const voice::AlignedWord& word = found->words[i];
    const bool doubted = word.said && word.known && word.confidence < voice::kDoubtful;
    const bool told = !word.said || doubted;
    if (i == missing) {
      noticed = told;
      continue;
    }
    ++kind.words;
    kind.out += word.said ? 0 : 1;
    kind.doubted += doubted ? 1 : 0;
    beside = beside || (told && missing != kNobody && (i + 1 == missing || i == missing + 1));
  }
  for (const voice::Insertion& one : found->inserted) {
    const bool right = lacking != kNobody && one.before == lacking;
    const bool near =
        lacking != kNobody && (one.before + 1 == lacking || one.before == lacking + 1);
    noticed = noticed || right;
    beside = beside || near;
    kind.inserted += right || near ? 0 : 1;
  }
  kind.noticed += noticed ? 1 : 0;
  kind.neighbour += !noticed && beside ? 1 : 0;
}

void print(const char* what, const Kind& kind) {
  std::printf("| %s | %zu | %zu | %zu | %zu | %zu | %zu | %zu | %zu |\n", what, kind.recordings,
              kind.refused, kind.noticed, kind.neighbour, kind.words, kind.out, kind.doubted,
              kind.inserted);
}

}  // namespace

Result<void> score_labelled(const std::string& folder, const LanguageRows& rows) {
  std::istringstream table(test::slurp(fs::path(folder) / "utterances.tsv"));
  voice::AlignOptions options;
  options.language = rows.language;
  Distances sum;
  std::size_t number = 0;
  std::string line;
  std::getline(table, line);
  while (std::getline(table, line)) {
    const std::size_t tab = line.find('\t');
    const std::string id = line.substr(0, tab), text = line.substr(tab + 1);
    const auto wav = fs::path(folder) / "audio" / (id + ".wav");
    if (!fs::exists(wav) || number++ % rows.every != rows.from) continue;
    const auto sound = sound_of(wav);
    if (!sound) return sound.error();
    const auto labels = read_labels(fs::path(folder) / "phonemes" / (id + ".tsv"));
    const auto found = voice::align({16000, *sound}, text, options);
    add(labels, found, sum);
  }
  if (sum.sentences == 0) return make_error(Code::not_found, "no sentence with sound in " + folder);
  print_distances(rows.language, sum);
  return {};
}

Result<void> score_spoken(const std::string& list, const LanguageRows& rows) {
  std::istringstream in(test::slurp(list));
  voice::AlignOptions options;
  options.language = rows.language;
  voice::VoiceOptions speaking;
  speaking.language = rows.language;
  Distances sum;
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    if (line.size() < kLeastLine || line.find_first_of(kUnsaid) != std::string::npos ||
        number++ % rows.every != rows.from) {
      continue;
    }
    const std::size_t colon = line.find(": ");
    const std::string text = colon == std::string::npos ? line : line.substr(colon + 2);
    const auto said = voice::speak_text(text, speaking);
    if (!said) return said.error();
    const auto wav = fs::temp_directory_path() / "align_table.wav";
    if (auto written = media::write_wav(wav.string(), said->audio); !written) {
      return written.error();
    }
    const auto sound = sound_of(wav);
    fs::remove(wav);
    if (!sound) return sound.error();
    std::vector<LabelledWord> labels;
    for (std::size_t i = 0; i < said->script.phones.size(); ++i) {
      const dam::Phone& phone = said->script.phones[i];
      if (phone.word.empty()) continue;
      if (i == 0 || said->script.phones[i - 1].word != phone.word) {
        labels.push_back({phone.word, {}});
      }
      labels.back().starts.push_back(phone.start);
    }
    add(labels, voice::align({16000, *sound}, text, options), sum);
    if (sum.sentences == kMostLines) break;
  }
  if (sum.sentences == 0) return make_error(Code::not_found, "no sentence in " + list);
  print_distances(rows.language, sum);
  return {};
}

Result<void> score_recorded(const std::string& folder, const std::string& list,
                            const LanguageRows& rows) {
  auto lines = recorded_lines(folder, list);
  std::vector<Recorded> chosen;
  for (std::size_t i = rows.from; i < lines.size(); i += rows.every) chosen.push_back(lines[i]);
  if (chosen.empty()) return make_error(Code::not_found, "no recording in " + folder);
  voice::AlignOptions options;
  options.language = rows.language;
  std::vector<std::vector<std::string>> texts;
  for (const Recorded& one : chosen) {
    auto words = voice::parted_words(one.text, rows.language);
    if (!words) return words.error();
    std::vector<std::string>& text = texts.emplace_back();
    for (text::Token& word : *words) text.push_back(std::move(word.text));
  }
  Kind right, wrong, more, less;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const auto sound = sound_of(chosen[i].file);
    if (!sound) return sound.error();
    const media::Pcm audio{16000, *sound};
    const auto align = [&](const std::vector<std::string>& words) {
      return voice::align(audio, joined(words), options);
    };
    dam::Random random(i + 1);
    const auto& text = texts[i];
    const auto& strange = texts[(i + chosen.size() / 2) % chosen.size()];
    count(align(text), kNobody, kNobody, right);
    count(align(strange), kNobody, kNobody, wrong);
    const std::size_t at = random.below(text.size());
    auto longer = text;
    longer.insert(longer.begin() + std::ptrdiff_t(at), strange[random.below(strange.size())]);
    count(align(longer), at, kNobody, more);
    auto shorter = text;
    shorter.erase(shorter.begin() + std::ptrdiff_t(at));
    count(align(shorter), kNobody, at, less);
  }
  std::printf(
      "| %s | recordings | refused | noticed | neighbour named | words said | taken for left out | "
      "doubted | speech in vain |\n|---|---|---|---|---|---|---|---|---|\n",
      rows.language.c_str());
  print("right text", right);
  print("text of another", wrong);
  print("a word too many in the text", more);
  print("a word missing in the text", less);
  return {};
}

}  // namespace animeme::bench
