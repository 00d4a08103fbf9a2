#include "tools/speech/voice/listen.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <span>

#include "dam/script/words.h"
#include "tools/speech/voice/align.h"
#include "tools/speech/voice/denoise.h"
#include "tools/speech/voice/guarded.h"
#include "tools/speech/voice/hearing.h"
#include "tools/speech/voice/speech_part.h"
#include "tools/speech/voice/word_search.h"

namespace animeme::voice {

namespace {

// A word with the phone of each of its frames.
struct WordPath {
  FoundWord word;                   // `belief` is that of judge_words()
  std::vector<std::size_t> phones;  // numbers in SoundModel::phones
};

constexpr double kEarliest = 0.3;       // of a block: no cut before
constexpr std::size_t kShortPause = 8;  // frames

// Chosen on every fourth of Debian's English recordings and every tenth training sentence of GRID
// that has sound (listen_table); the tables have others.
constexpr double kLean = 12;          // what a word that is sure adds to the log likelihood
constexpr double kBeliefPower = 0.3;  // the library is too sure of what it prefers
constexpr std::size_t kBorder = 2;    // frames by which phones of words may move
// The evidence that these are the words at all: how usual they are beside each other, and how far
// the phones without words agree. It grows with their number.
constexpr double kEvidenceWords = 8, kPrior = -1.5;
constexpr double kUsual = 20, kUsualFrom = -0.25;  // of the log probability of a frame
constexpr double kAgree = 12, kAgreeFrom = 0.58;   // of the votes for phones of the same shape

// Of the phones of a word.
std::vector<std::size_t> numbers_of(const HearingModel& model, const FoundWord& word) {
  std::vector<std::size_t> numbers;
  for (const std::string& phone : word.phones) {
    const auto& all = model.sound.phones;
    const auto at = std::find(all.begin(), all.end(), phone);
    if (at != all.end()) numbers.push_back(std::size_t(at - all.begin()));
  }
  return numbers;
}

// The phone of each frame of a word: the best path through its states.
std::vector<std::size_t> spread(const std::vector<std::size_t>& phones,
                                std::span<const std::vector<float>> scores) {
  const std::size_t length = scores.size(), states = phones.size() * kStatesPerPhone;
  std::vector<std::size_t> out(length);
  if (length < states) {
    for (std::size_t i = 0; i < length; ++i) out[i] = phones[i * phones.size() / length];
    return out;
  }
  constexpr double kNever = -1e30;
  std::vector<std::vector<bool>> moved(length, std::vector<bool>(states));
  std::vector<double> best(states, kNever), next(states);
  for (std::size_t i = 0; i < length; ++i) {
    for (std::size_t s = 0; s < states; ++s) {
      const double move = s > 0 ? best[s - 1] : (i == 0 ? 0 : kNever);
      moved[i][s] = move > best[s];
      const std::size_t state = phones[s / kStatesPerPhone] * kStatesPerPhone + s % kStatesPerPhone;
      next[s] = std::max(best[s], move) + double(scores[i][state]);
    }
    std::swap(best, next);
  }
  std::size_t s = states - 1;
  for (std::size_t i = length; i-- > 0;) {
    out[i] = phones[s / kStatesPerPhone];
    if (moved[i][s] && s > 0) --s;
  }
  return out;
}

// Where a path may be cut: in the middle of the longest pause in its later part, before frame
// `most`; there if it has none.
std::size_t cut_in_pause(const HearingModel& model, const Path& path, std::size_t most) {
  const std::size_t end = std::min(path.size(), most);
  std::size_t best = end, longest = kShortPause, run = 0;
  for (std::size_t i = 0; i < end; ++i) {
    run = model.labels[path[i]] == dam::kSilence ? run + 1 : 0;
    const std::size_t middle = i + 1 - run / 2;
    if (run <= longest || double(middle) < kEarliest * double(most)) continue;
    longest = run;
    best = middle;
  }
  return best;
}

// Where the phones of the words are, and how much each word is believed, 0..1: by the search, by
// the votes of the phones alone, and by whether the words of the piece make a sentence. Words of
// phones that the model lacks are left out.
std::vector<WordPath> judge_words(const HearingModel& model,
                                  std::span<const std::vector<float>> scores, const Votes& votes,
                                  std::vector<FoundWord> words) {
  std::vector<WordPath> paths;
  double agreed = 0, usual = 0, count = 0;
  for (FoundWord& word : words) {
    word.end = std::min(word.end, scores.size());
    const auto numbers = numbers_of(model, word);
    if (word.first >= word.end || numbers.empty()) continue;
    WordPath path;
    path.phones = spread(numbers, scores.subspan(word.first, word.end - word.first));
    double kin = 0;
    for (std::size_t i = 0; i < path.phones.size(); ++i) {
      for (std::size_t p = 0; p < model.labels.size(); ++p) {
        const bool same = model.classes[p] == model.classes[path.phones[i]];
        kin += same ? double(votes[word.first + i][p]) : 0;
      }
    }
    const auto frames = double(path.phones.size());
    agreed += kin;
    usual += word.language;
    count += frames;
    path.word = std::move(word);
    path.word.belief = std::pow(path.word.belief, kBeliefPower) * kin / frames;
    paths.push_back(std::move(path));
  }
  if (paths.empty()) return paths;
  const double each =
      kUsual * (usual / count - kUsualFrom) + kAgree * (agreed / count - kAgreeFrom);
  const double evidence = double(paths.size()) / kEvidenceWords * each + kPrior;
  // What is not believed leaves no trace: a lean of each frame adds up over a phone.
  const double trust = evidence > 0 ? 1 - std::exp(-evidence) : 0;
  for (WordPath& path : paths) path.word.belief *= trust;
  return paths;
}

// Adds to the scores of each frame what the words say of it.
void lean_on_words(const std::vector<WordPath>& words, std::vector<std::vector<float>>& scores) {
  const std::vector<std::vector<float>> plain = scores;
  for (const WordPath& path : words) {
    const auto gain = float(kLean * path.word.belief);
    for (std::size_t i = 0; i < path.phones.size(); ++i) {
      const std::size_t at = path.word.first + i, state = path.phones[i] * kStatesPerPhone;
      const std::size_t first = at > kBorder ? at - kBorder : 0;
      for (std::size_t k = first; k < std::min(at + kBorder + 1, scores.size()); ++k) {
        for (std::size_t s = state; s < state + kStatesPerPhone; ++s) {
          scores[k][s] = std::max(scores[k][s], plain[k][s] + gain);
        }
      }
    }
  }
}

constexpr double kSpeechAndEdges = 1.05;  // of the frames with speech, for the mean
constexpr double kLeastSeconds = 0.1;
constexpr double kLeastSpeech = 0.1;        // seconds; less is a click
constexpr double kUnsure = 0.1;             // of the whole: below, it may be no speech at all
constexpr double kGuessed = 0.6;            // clear voices have more
constexpr double kFull = 0.999;             // of full scale: a sample that may be cut off
constexpr double kMostFull = 0.01;          // of all samples
constexpr double kBelieved = 0.25;          // words that are named
constexpr std::size_t kBlockFrames = 2000;  // drawn at once
constexpr std::size_t kLookAhead = 100;     // frames beyond, which settle how a block ends

std::vector<Cepstrum> cepstra_of(CepstraReader& reader, const SpeechPart& part) {
  constexpr std::size_t kAtOnce = 16384;  // samples
  std::vector<std::int16_t> whole;
  std::vector<Cepstrum> frames;
  Trace trace{part.loud, 0};
  denoise(part.samples, part.snr, [&](std::span<const float> samples) {
    while (!samples.empty()) {
      const auto some = samples.first(std::min(kAtOnce, samples.size()));
      samples = samples.subspan(some.size());
      to_whole(some, trace, whole);
      if (whole.size() < kAtOnce) continue;
      reader.push(whole, frames);
      whole.clear();
    }
  });
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
          const Cepstrum& mean, const ListenOptions& options)
      : model_(&model),
        search_(words),
        frames_(frames),
        mean_(mean),
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
    Path agreed = agreed_path(*model_, votes, kLeastClosure);
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
    const Path agreed = agreed_path(*model_, votes, kLeastClosure);
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

// Silence before and behind the part. Returns the time of sample 0 of the recording on the clock of
// the paths, whose frames are whole.
double put_in_place(const HearingModel& model, const SpeechPart& part, std::size_t samples,
                    Drawn& drawn) {
  const auto silent = std::find(model.labels.begin(), model.labels.end(), dam::kSilence);
  const auto silence = std::uint8_t(silent - model.labels.begin());
  const std::size_t before = part.first / kSpeechBlock;
  const std::size_t all = (samples - part.first + kSpeechBlock - 1) / kSpeechBlock + before;
  const auto fill = [&](auto& values, const auto& value) {
    values.insert(values.begin(), before, value);
    if (values.size() < all) values.resize(all, value);
  };
  fill(drawn.agreed, silence);
  for (Path& path : drawn.readings) fill(path, silence);
  std::vector<float> vote(model.labels.size());
  vote[silence] = 1;
  fill(drawn.votes, vote);
  for (FoundWord& word : drawn.words) {
    word.first += before;
    word.end += before;
  }
  return -double(part.first % kSpeechBlock) / kAlignRate;
}

// Words that are believed, and their names for the phones in them.
void take_words(const std::vector<FoundWord>& words, double origin, double seconds,
                Recognition& heard) {
  for (const FoundWord& word : words) {
    if (word.belief < kBelieved) continue;
    heard.words.push_back({word.text, time_of(word.first) - origin,
                           std::min(time_of(word.end) - origin, seconds), word.belief});
  }
  auto word = heard.words.begin(), last = heard.words.end();
  std::vector<dam::Phone>& phones = heard.script.phones;
  for (std::size_t i = 0; i < phones.size(); ++i) {
    const double middle = 0.5 * (phones[i].start + phones[i].end);
    while (word != heard.words.end() && word->end <= middle) ++word;
    if (word == heard.words.end()) return;
    if (phones[i].label == dam::kSilence || word->start > middle) continue;
    phones[i].word = word->text;
    dam::link_phone(phones, i, word != last);
    last = word;
  }
}

void sum_up(Recognition& heard) {
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

bool is_clipped(std::span<const float> samples) {
  const auto full = std::count_if(samples.begin(), samples.end(),
                                  [](float one) { return std::abs(double(one)) >= kFull; });
  return double(full) > kMostFull * double(samples.size());
}

constexpr unsigned kMostListenWork = 16 * 3600;  // seconds; an hour of speech takes minutes

// In the child.
Result<Recognition> listen_here(const media::Pcm& audio, const ListenOptions& options) {
  auto model = load_hearing(options);
  if (!model) return model.error();
  auto reader = CepstraReader::open(options.model_path);
  if (!reader) return reader.error();
  SpeechPart part = find_speech(audio.samples);
  const std::size_t in_part = part.samples.size();
  const std::vector<Cepstrum> frames = cepstra_of(**reader, part);
  part.samples = {};  // an hour of them is 230 MB
  Recognition heard;
  if (frames.empty()) return make_error(Code::truncated, "there is nothing to hear");
  std::unique_ptr<WordSearch> words;
  if (options.words && speaks_english(options.language)) {
    auto opened =
        WordSearch::open({options.model_path, options.words_path, options.dictionary_path});
    if (!opened && opened.error().code != Code::not_found) return opened.error();
    if (opened) words = std::move(*opened);
  }
  Drawn drawn = Drawing(*model, words.get(), frames,
                        mean_of_speech(frames, part.speech, kSpeechAndEdges), options)
                    .draw();
  const double seconds = audio.duration();
  const double origin = put_in_place(*model, part, audio.samples.size(), drawn);
  heard.script =
      script_of_path(*model, drawn.agreed, 0, origin, seconds, &drawn.votes, &heard.confidences);
  for (const Path& path : drawn.readings) {
    heard.readings.push_back(script_of_path(*model, path, 0, origin, seconds));
  }
  take_words(drawn.words, origin, seconds, heard);
  sum_up(heard);
  if (is_clipped(std::span(audio.samples).subspan(part.first, in_part))) {
    heard.warnings.push_back("the sound is clipped in many places; record it at a lower level");
  }
  return heard;
}

void pack_script(const dam::Script& script, Packed& out) {
  out.put(script.phones.size());
  for (const dam::Phone& phone : script.phones) {
    out.put(phone.start);
    out.put(phone.end);
    out.put_text(phone.label);
    out.put_text(phone.word);
    out.put(phone.link);
  }
}

dam::Script unpack_script(Unpacked& in) {
  constexpr std::size_t kPhoneBytes =
      2 * sizeof(double) + 2 * sizeof(std::size_t) + sizeof(dam::WordLink);
  dam::Script script;
  script.phones.resize(in.get_count(kPhoneBytes));
  for (dam::Phone& phone : script.phones) {
    phone.start = in.get<double>();
    phone.end = in.get<double>();
    phone.label = in.get_text();
    phone.word = in.get_text();
    phone.link = in.get<dam::WordLink>();
  }
  return script;
}

std::string pack(const Recognition& heard) {
  Packed out;
  pack_script(heard.script, out);
  out.put(heard.confidences.size());
  for (const double one : heard.confidences) out.put(one);
  out.put(heard.confidence);
  out.put(heard.words.size());
  for (const RecognisedWord& word : heard.words) {
    out.put_text(word.text);
    out.put(word.start);
    out.put(word.end);
    out.put(word.confidence);
  }
  out.put(heard.readings.size());
  for (const dam::Script& reading : heard.readings) pack_script(reading, out);
  out.put(heard.warnings.size());
  for (const std::string& warning : heard.warnings) out.put_text(warning);
  return out.take();
}

Recognition unpack_recognition(std::string_view bytes) {
  Unpacked in(bytes);
  Recognition heard;
  heard.script = unpack_script(in);
  heard.confidences.resize(in.get_count(sizeof(double)));
  for (double& one : heard.confidences) one = in.get<double>();
  heard.confidence = in.get<double>();
  heard.words.resize(in.get_count(sizeof(std::size_t) + 3 * sizeof(double)));
  for (RecognisedWord& word : heard.words) {
    word.text = in.get_text();
    word.start = in.get<double>();
    word.end = in.get<double>();
    word.confidence = in.get<double>();
  }
  heard.readings.resize(in.get_count(sizeof(std::size_t)));
  for (dam::Script& reading : heard.readings) reading = unpack_script(in);
  heard.warnings.resize(in.get_count(sizeof(std::size_t)));
  for (std::string& warning : heard.warnings) warning = in.get_text();
  return heard;
}

}  // namespace

Result<Recognition> listen(const media::Pcm& audio, const ListenOptions& options) {
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
  const auto bytes = run_guarded(
      "pocketsphinx", kMostListenWork,
      [&](const Told& tell) -> Result<std::string> {
        ListenOptions here = options;
        if (options.progress) here.progress = tell;
        const Result<Recognition> heard = listen_here(audio, here);
        if (!heard) return heard.error();
        return pack(*heard);
      },
      options.progress);
  if (!bytes) return bytes.error();
  return unpack_recognition(*bytes);
}

}  // namespace animeme::voice
