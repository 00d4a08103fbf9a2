#include "tools/speech/voice/listen.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <span>

#include "tools/speech/voice/align.h"
#include "tools/speech/voice/denoise.h"
#include "tools/speech/voice/guided.h"
#include "tools/speech/voice/hearing.h"
#include "tools/speech/voice/word_search.h"

namespace animeme::voice {

namespace {

constexpr double kLeastSeconds = 0.1;
constexpr double kLeastSpeech = 0.1;        // seconds; less is a click
constexpr double kUnsure = 0.25;            // of the whole: below, it may be no speech at all
constexpr double kGuessed = 0.5;            // clear voices of any language have 0.55 and more
constexpr double kFull = 0.999;             // of full scale: a sample that may be cut off
constexpr double kMostFull = 0.01;          // of all samples
constexpr double kBelieved = 0.25;          // words that are named
constexpr std::size_t kBlockFrames = 2000;  // drawn at once
constexpr std::size_t kLookAhead = 100;     // frames beyond, which settle how a block ends

std::vector<Cepstrum> cepstra_of(CepstraReader& reader, const std::vector<float>& samples) {
  std::vector<std::int16_t> whole;
  Trace trace{loudness_of(samples), 0};
  to_whole(samples, trace, whole);
  std::vector<Cepstrum> frames;
  reader.push(whole, frames);
  reader.finish(frames);
  return frames;
}

// All paths of the sound, block by block.
struct Drawn {
  std::vector<Path> readings;
  Path agreed;
  Votes votes;                   // of the frames of `agreed`
  std::vector<FoundWord> words;  // with their beliefs
};

class Drawing {
 public:
  Drawing(const HearingModel& model, WordSearch* words, std::span<const Cepstrum> frames,
          const ListenOptions& options)
      : model_(&model),
        search_(words),
        frames_(frames),
        mean_(mean_of_loud(frames)),
        options_(&options),
        free_(model.sound, model.pairs, model.weights),
        guided_(free_) {
    all_.readings.resize(options.readings);
  }

  Drawn draw() {
    std::vector<float> scores(model_->sound.states());
    for (std::size_t frame = 0; frame < frames_.size(); ++frame) {
      score_states(model_->sound, features_of(frames_, frame, mean_), scores);
      free_.push(scores);
      waiting_.push_back(scores);
      const bool last = frame + 1 == frames_.size();
      if (!last && free_.frames() < begun_ + kBlockFrames + kLookAhead) continue;
      if (search_ != nullptr) {
        draw_block_with_words(last);
      } else {
        draw_block(free_, last ? free_.frames() - begun_ : kBlockFrames);
      }
      if (options_->progress) options_->progress(double(begun_) / double(frames_.size()));
    }
    while (begun_ < frames_.size()) draw_block_with_words(true);
    return std::move(all_);
  }

 private:
  void draw_block(const PhonePaths& paths, std::size_t size) {
    std::vector<Path> drawn;
    for (std::size_t i = 0; i < options_->readings; ++i) drawn.push_back(paths.draw(begun_, i));
    Votes votes = count_votes(drawn, model_->labels.size());
    Path agreed = agreed_path(*model_, votes);
    const auto append = [&](auto& to, const auto& from) {
      to.insert(to.end(), from.begin(), from.begin() + std::ptrdiff_t(size));
    };
    for (std::size_t i = 0; i < options_->readings; ++i) append(all_.readings[i], drawn[i]);
    append(all_.agreed, agreed);
    append(all_.votes, votes);
    waiting_.erase(waiting_.begin(), waiting_.begin() + std::ptrdiff_t(size));
    begun_ += size;
    free_.forget(begun_);
  }

  void draw_block_with_words(bool last) {
    std::vector<Path> drawn;
    for (std::size_t i = 0; i < options_->readings; ++i) drawn.push_back(free_.draw(begun_, i));
    const Votes votes = count_votes(drawn, model_->labels.size());
    const Path agreed = agreed_path(*model_, votes);
    const std::size_t size = last && agreed.size() <= kBlockFrames
                                 ? agreed.size()
                                 : cut_in_pause(*model_, agreed, kBlockFrames);
    const std::vector<std::vector<float>> scores(waiting_.begin(),
                                                 waiting_.begin() + std::ptrdiff_t(size));
    auto words =
        judge_words(*model_, scores, votes, search_->search(frames_.subspan(begun_, size), mean_));
    auto guided = scores;
    lean_on_words(words, guided);
    for (const auto& frame : guided) guided_.push(frame);
    PhonePaths ahead = guided_;
    for (std::size_t i = size; i < std::min(size + kLookAhead, waiting_.size()); ++i) {
      ahead.push(waiting_[i]);
    }
    for (WordPath& path : words) {
      path.word.first += begun_;
      path.word.end += begun_;
      all_.words.push_back(std::move(path.word));
    }
    draw_block(ahead, size);
    guided_.forget(begun_);
  }

  const HearingModel* model_;
  WordSearch* search_;
  std::span<const Cepstrum> frames_;
  Cepstrum mean_;
  const ListenOptions* options_;
  PhonePaths free_, guided_;                // without words, with them
  std::deque<std::vector<float>> waiting_;  // scores from frame begun_ on
  std::size_t begun_ = 0;
  Drawn all_;
};

// Words that are believed, and their names for the phones in them.
void take_words(const std::vector<FoundWord>& words, double seconds, Heard& heard) {
  for (const FoundWord& word : words) {
    if (word.belief < kBelieved) continue;
    heard.words.push_back(
        {word.text, time_of(word.first), std::min(time_of(word.end), seconds), word.belief});
  }
  auto word = heard.words.begin();
  for (dam::Phone& phone : heard.script.phones) {
    const double middle = 0.5 * (phone.start + phone.end);
    while (word != heard.words.end() && word->end <= middle) ++word;
    if (word == heard.words.end()) return;
    if (phone.label != dam::kSilence && word->start <= middle) phone.word = word->text;
  }
}

void sum_up(Heard& heard) {
  double seconds = 0, sum = 0;
  for (std::size_t i = 0; i < heard.script.phones.size(); ++i) {
    const dam::Phone& phone = heard.script.phones[i];
    if (phone.label == dam::kSilence) continue;
    seconds += phone.duration();
    sum += phone.duration() * heard.confidences[i];
  }
  if (seconds < kLeastSpeech) {
    heard.warnings.push_back("no speech was recognised; the face stays still");
    return;
  }
  heard.confidence = sum / seconds;
  if (heard.confidence < kUnsure) {
    heard.warnings.push_back("this may not be speech: the hypotheses hardly agree");
  } else if (heard.confidence < kGuessed) {
    heard.warnings.push_back(
        "recognition is uncertain; use a clearer recording, or give a transcript");
  }
}

bool is_clipped(const std::vector<float>& samples) {
  const auto full = std::count_if(samples.begin(), samples.end(),
                                  [](float one) { return std::abs(double(one)) >= kFull; });
  return double(full) > kMostFull * double(samples.size());
}

}  // namespace

Result<Heard> listen(const media::Pcm& audio, const ListenOptions& options) {
  if (audio.sample_rate != kAlignRate) {
    return make_error(Code::invalid_argument, "the audio must be at 16000 Hz; resample it first");
  }
  const double seconds = audio.duration();
  if (seconds < kLeastSeconds) {
    return make_error(Code::truncated, "less than 0.1 s of sound: nothing to recognise");
  }
  if (seconds > kMostListenSeconds) {
    return make_error(Code::out_of_range, "more than four hours of sound; split it");
  }
  auto model = load_hearing(options);
  if (!model) return model.error();
  auto reader = CepstraReader::open(options.model_path);
  if (!reader) return reader.error();
  const std::vector<Cepstrum> frames = cepstra_of(**reader, denoised(audio.samples));
  Heard heard;
  if (frames.empty()) return make_error(Code::truncated, "there is nothing to hear");
  std::unique_ptr<WordSearch> words;
  if (options.words && speaks_english(options.language)) {
    auto opened =
        WordSearch::open({options.model_path, options.words_path, options.dictionary_path});
    if (!opened && opened.error().code != Code::not_found) return opened.error();
    if (opened) words = std::move(*opened);
  }
  const Drawn drawn = Drawing(*model, words.get(), frames, options).draw();
  heard.script =
      script_of_path(*model, drawn.agreed, 0, 0, seconds, &drawn.votes, &heard.confidences);
  for (const Path& path : drawn.readings) {
    heard.readings.push_back(script_of_path(*model, path, 0, 0, seconds));
  }
  take_words(drawn.words, seconds, heard);
  sum_up(heard);
  if (is_clipped(audio.samples)) {
    heard.warnings.push_back("the sound is clipped in many places; record it at a lower level");
  }
  return heard;
}

}  // namespace animeme::voice
