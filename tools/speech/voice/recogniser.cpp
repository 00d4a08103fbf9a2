#include "tools/speech/voice/recogniser.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "dam/script/phones.h"
#include "dam/script/script_text_internal.h"
#include "tools/speech/voice/guarded.h"
#include "tools/speech/voice/place_words.h"
#include "tools/speech/voice/wrong_texts.h"

namespace animeme::voice {
namespace {

// A frame is 10 ms and speaks for the middle of its window of 25.6 ms, so that a phone should begin
// half way between the middle of its first frame and that of the frame before: 12.8 - 5 = 7.8 ms.
// Labels disagree about that by 14 ms; in the middle of eight sets (tools/speech/voice/engines.md,
// section 1) lie 5.
double frame_time(std::size_t frame) { return frame == 0 ? 0.0 : double(frame * 2 + 1) / 200.0; }

// Words that English says with less than their sounds. Of other languages: all short ones.
constexpr std::string_view kWeakWords[] = {
    "a",     "am",    "an",   "and",  "are",   "as",   "at",   "be",  "but",  "by",
    "can",   "could", "do",   "does", "for",   "from", "had",  "has", "have", "he",
    "her",   "him",   "his",  "i",    "i'm",   "if",   "in",   "is",  "it",   "it's",
    "its",   "just",  "me",   "must", "my",    "nor",  "not",  "of",  "on",   "or",
    "our",   "shall", "she",  "so",   "some",  "than", "that", "the", "them", "then",
    "there", "they",  "this", "to",   "up",    "us",   "was",  "we",  "were", "what",
    "when",  "who",   "will", "with", "would", "you",  "your"};
constexpr std::size_t kShortPhones = 3;

bool is_weak(const SpokenWord& word, bool english) {
  if (!english) return word.variants.empty() || word.variants[0].size() <= kShortPhones;
  return std::binary_search(std::begin(kWeakWords), std::end(kWeakWords),
                            dam::lower_case(word.text));
}

std::vector<WordModel> models_of(const SoundModel& model, const std::vector<SpokenWord>& words,
                                 bool english) {
  std::map<std::string, std::uint8_t> numbers;
  for (std::size_t i = 0; i < model.phones.size(); ++i) {
    numbers[model.phones[i]] = std::uint8_t(i);
  }
  std::vector<WordModel> models;
  for (const SpokenWord& word : words) {
    WordModel one;
    one.weak = is_weak(word, english);
    for (const Labels& labels : word.variants) {
      std::vector<std::uint8_t> phones;
      for (const std::string& label : labels) {
        const auto found = numbers.find(label);
        if (found != numbers.end()) phones.push_back(found->second);
      }
      if (&labels - word.variants.data() == std::ptrdiff_t(word.complete)) {
        one.complete = one.variants.size();
      }
      if (phones.empty()) continue;
      const auto gaps = float(std::count(labels.begin(), labels.end(), dam::kSilence));
      one.words = one.variants.empty() ? gaps + 1 : std::min(one.words, gaps + 1);
      one.variants.push_back(std::move(phones));
    }
    models.push_back(std::move(one));
  }
  return models;
}

std::string label_of(const SoundModel& model, std::size_t phone) {
  const dam::PhoneInfo* info = dam::find_phone(model.phones[phone]);
  return std::string(info != nullptr ? info->label : dam::kSilence);  // noises are silence
}

void append(const SoundModel& model, const PlacedPart& placed, const std::vector<WordModel>& models,
            std::vector<Segment>& segments) {
  const PathPart& part = placed.part;
  const double score = double(part.score) / double(part.frames);
  if (part.kind == PartKind::pause) {
    segments.push_back(
        {frame_time(part.first), std::string(dam::kSilence), kNoWord, score, part.frames, false});
  } else if (part.kind == PartKind::phone) {
    const std::size_t phone = models[part.word].variants[part.variant][part.index];
    segments.push_back(
        {frame_time(part.first), label_of(model, phone), part.word, score, part.frames, false});
  } else {
    const std::size_t begun = segments.size();
    for (std::size_t i = 0; i < placed.heard.size(); ++i) {
      std::string label = label_of(model, placed.heard[i]);
      if (segments.size() > begun && segments.back().label == label) {
        ++segments.back().frames;
      } else {
        segments.push_back({frame_time(part.first + i), std::move(label), part.word, 0, 1, true});
      }
    }
  }
}

// From times of the part to those of the recording; before and behind the part is silence.
void move_to(const SpeechPart& part, std::vector<Segment>& segments) {
  if (segments.empty()) return;
  const double first = double(part.first) / kAlignRate;
  const double last = first + double(part.samples.size()) / kAlignRate;
  for (Segment& segment : segments) segment.start += first;
  const auto silence = [](double start) {
    return Segment{start, std::string(dam::kSilence), kNoWord, 0, 1, false};
  };
  if (segments.front().label == dam::kSilence) {
    segments.front().start = 0;
  } else if (first > 0) {
    segments.insert(segments.begin(), silence(0));
  }
  if (segments.back().label != dam::kSilence) segments.push_back(silence(last));
}

constexpr std::string_view kAlignLibrary = "pocketsphinx";
constexpr unsigned kMostAlignSeconds = 4 * 3600;  // of work; an hour of speech takes minutes

// In the child.
Result<std::vector<double>> explained_here(const SpeechPart& part,
                                           const std::vector<SpokenWord>& words,
                                           const AlignOptions& options) {
  const auto model = read_sound_model(options.model_path);
  if (!model) return model.error();
  const auto reader = CepstraReader::open(options.model_path);
  if (!reader) return reader.error();
  const bool english = is_english(options.language);
  const auto models = models_of(*model, words, english);
  const MeasuredSound sound = measure_sound(**reader, part);
  std::vector<double> explained;
  for (std::size_t i = 0; i < kWrongTexts; ++i) {
    explained.push_back(
        place_words(*model, sound, wrong_text(*model, models, i), !english).explained);
  }
  return explained;
}

Result<Recognised> recognise_here(const SpeechPart& part, const std::vector<SpokenWord>& words,
                                  const AlignOptions& options) {
  const auto model = read_sound_model(options.model_path);
  if (!model) return model.error();
  const auto reader = CepstraReader::open(options.model_path);
  if (!reader) return reader.error();
  const bool english = is_english(options.language);
  const auto models = models_of(*model, words, english);
  const auto placed = place_words(*model, measure_sound(**reader, part), models, !english);
  Recognised result{{}, placed.explained};
  for (const PlacedPart& one : placed.parts) append(*model, one, models, result.segments);
  move_to(part, result.segments);
  return result;
}

std::string pack(const Recognised& recognised) {
  Packed out;
  out.put(recognised.explained);
  out.put(recognised.segments.size());
  for (const Segment& segment : recognised.segments) {
    out.put(segment.start);
    out.put_text(segment.label);
    out.put(segment.word);
    out.put(segment.score);
    out.put(segment.frames);
    out.put(segment.foreign);
  }
  return out.take();
}

Recognised unpack_recognised(std::string_view bytes) {
  constexpr std::size_t kSegmentBytes = 2 * sizeof(double) + 3 * sizeof(std::size_t) + 1;
  Unpacked in(bytes);
  Recognised recognised;
  recognised.explained = in.get<double>();
  recognised.segments.resize(in.get_count(kSegmentBytes));
  for (Segment& segment : recognised.segments) {
    segment.start = in.get<double>();
    segment.label = in.get_text();
    segment.word = in.get<std::size_t>();
    segment.score = in.get<double>();
    segment.frames = in.get<std::size_t>();
    segment.foreign = in.get<bool>();
  }
  return recognised;
}

}  // namespace

Result<void> check_recogniser(const AlignOptions& options) {
  // In no folder, where nothing is opened: is there a recogniser at all?
  const auto reader = CepstraReader::open("/dev/null");
  if (!reader && reader.error().code != Code::not_found) return reader.error();
  for (const char* file :
       {"feat.params", "mdef", "means", "variances", "sendump", "transition_matrices"}) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(std::filesystem::path(options.model_path) / file,
                                          ignored)) {
      return make_error(Code::not_found, "no acoustic model at " + options.model_path + " (" +
                                             file +
                                             " is missing); install the Debian package "
                                             "pocketsphinx-en-us or set the path");
    }
  }
  return {};
}

Result<std::vector<double>> explained_by_wrong_texts(const SpeechPart& part,
                                                     const std::vector<SpokenWord>& words,
                                                     const AlignOptions& options) {
  const auto bytes =
      run_guarded(kAlignLibrary, kMostAlignSeconds, [&](const Told&) -> Result<std::string> {
        const auto explained = explained_here(part, words, options);
        if (!explained) return explained.error();
        Packed out;
        out.put(explained->size());
        for (const double one : *explained) out.put(one);
        return out.take();
      });
  if (!bytes) return bytes.error();
  Unpacked in(*bytes);
  std::vector<double> explained(in.get_count(sizeof(double)));
  for (double& one : explained) one = in.get<double>();
  return explained;
}

Result<Recognised> recognise(const SpeechPart& part, const std::vector<SpokenWord>& words,
                             const AlignOptions& options) {
  const auto bytes =
      run_guarded(kAlignLibrary, kMostAlignSeconds, [&](const Told&) -> Result<std::string> {
        const auto recognised = recognise_here(part, words, options);
        if (!recognised) return recognised.error();
        return pack(*recognised);
      });
  if (!bytes) return bytes.error();
  return unpack_recognised(*bytes);
}

}  // namespace animeme::voice
