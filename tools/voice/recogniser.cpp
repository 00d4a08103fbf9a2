#include "tools/voice/recogniser.h"

#include <pocketsphinx.h>
#include <sphinxbase/fsg_model.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <span>

#include "dam/script/phones.h"
#include "tools/voice/sphinx.h"

namespace animeme::voice {
namespace {

// A frame is 10 ms and speaks for the middle of its window of 25.6 ms. A phone begins half way
// between the middle of its first frame and that of the frame before: 12.8 - 5 ms. One division,
// so that the times are short decimal numbers.
double frame_time(int frame) { return frame == 0 ? 0.0 : double(frame * 100 + 78) / 10000.0; }

constexpr const char* kSil = "<sil>";
constexpr const char* kBeams[] = {"1e-48", "1e-80"};

constexpr std::size_t kHop = 160;  // samples a frame
// How likely a pause behind a word is thought before the sound is heard. In noise closures and weak
// sounds are much like silence for the model, which is far too sure of every frame: so few that a
// real pause, of a hundred frames or of ten, wins all the same.
constexpr double kPauseProbability = 1e-20;
constexpr double kAnyPhone = 0.01;  // of the free search: as likely as each other
// What is longer is aligned in pieces, which end in pauses: the search costs as much as there are
// states times frames, and a path that is lost is found again behind the next pause.
constexpr double kWhole = 60, kPiece = 40;               // seconds
constexpr double kMostPhones = 25;                       // a second: more nobody says
constexpr double kEarliestCut = 0.4, kLatestCut = 0.95;  // of a piece

struct Free {
  void operator()(cmd_ln_t* config) const { cmd_ln_free_r(config); }
  void operator()(ps_decoder_t* decoder) const { ps_free(decoder); }
  void operator()(fsg_model_t* model) const { fsg_model_free(model); }
};
using Config = std::unique_ptr<cmd_ln_t, Free>;
using Decoder = std::unique_ptr<ps_decoder_t, Free>;
using Grammar = std::unique_ptr<fsg_model_t, Free>;

Decoder make_decoder(const std::string& model, const char* beam) {
  // No best-path search (it gives impossible durations), no removal of silence or noise (frame
  // numbers would skip it), no dither (results would vary). All senones are scored, so that a score
  // is the distance to the best of them all.
  Config config(cmd_ln_init(nullptr, ps_args(), TRUE, "-hmm", model.c_str(), "-samprate", "16000",
                            "-fsgusefiller", "no", "-fsgusealtpron", "no", "-bestpath", "no",
                            "-remove_silence", "no", "-remove_noise", "no", "-dither", "no",
                            "-compallsen", "yes", "-lw", "1", "-wip", "1", "-beam", beam, "-wbeam",
                            beam, "-pbeam", beam, nullptr));
  if (!config) return nullptr;
  Decoder decoder(ps_init(config.get()));
  if (!decoder) return nullptr;
  for (const dam::PhoneInfo& phone : dam::phones()) {  // each phone is a word
    const std::string label(phone.label);
    if (label == dam::kSilence || label == "AX") continue;
    if (ps_add_word(decoder.get(), label.c_str(), label.c_str(), FALSE) < 0) return nullptr;
  }
  return decoder;
}

// The search loops over all states in every frame: the number must be exact.
int count_states(std::span<const SpokenWord> words) {
  std::size_t count = 2;  // before and after the first optional silence
  for (const SpokenWord& word : words) {
    for (const Labels& variant : word.variants) count += variant.size() - 1;
    count += 2;  // after the word, after the silence behind it
  }
  return int(count);
}

// start -<sil>- { word: one branch a variant } -<sil>- { word } ... ; every silence can be skipped.
// With an open end, the sound may stop behind any word.
Grammar make_grammar(ps_decoder_t* decoder, std::span<const SpokenWord> words, bool open_end) {
  Grammar grammar(fsg_model_init("text", ps_get_logmath(decoder), 1.0f, count_states(words)));
  if (!grammar) return nullptr;
  fsg_model_t* fsg = grammar.get();
  const int silence = fsg_model_word_add(fsg, kSil);
  int next = 1;
  const int pause = int(logmath_log(ps_get_logmath(decoder), kPauseProbability));
  const auto optional_silence = [&](int from, bool inside) {
    const int to = next++;
    fsg_model_trans_add(fsg, from, to, inside ? pause : 0, silence);
    fsg_model_null_trans_add(fsg, from, to, 0);
    return to;
  };
  std::vector<int> ends;
  int state = optional_silence(0, false);
  for (const SpokenWord& word : words) {
    const int end = next++;
    for (const Labels& variant : word.variants) {
      int from = state;
      for (std::size_t i = 0; i < variant.size(); ++i) {
        const int to = i + 1 == variant.size() ? end : next++;
        fsg_model_trans_add(fsg, from, to, 0, fsg_model_word_add(fsg, variant[i].c_str()));
        from = to;
      }
    }
    state = optional_silence(end, &word != &words.back());
    ends.push_back(state);
  }
  if (open_end) {
    for (const int end : ends) {
      if (end != state) fsg_model_null_trans_add(fsg, end, state, 0);
    }
  }
  fsg->start_state = 0;
  fsg->final_state = state;
  glist_free(fsg_model_null_trans_closure(fsg, nullptr));
  return grammar;
}

// Any phone after any phone: what the sound is when nobody says what it is.
Grammar make_loop(ps_decoder_t* decoder) {
  Grammar grammar(fsg_model_init("loop", ps_get_logmath(decoder), 1.0f, 1));
  if (!grammar) return nullptr;
  const int chance = int(logmath_log(ps_get_logmath(decoder), kAnyPhone));
  for (const dam::PhoneInfo& phone : dam::phones()) {
    const std::string label(phone.label);
    if (label == "AX") continue;
    const char* word = label == dam::kSilence ? kSil : label.c_str();
    fsg_model_trans_add(grammar.get(), 0, 0, chance, fsg_model_word_add(grammar.get(), word));
  }
  grammar->start_state = 0;
  grammar->final_state = 0;
  return grammar;
}

std::vector<Segment> read_segments(ps_decoder_t* decoder) {
  std::vector<Segment> segments;
  for (ps_seg_t* seg = ps_seg_iter(decoder); seg != nullptr; seg = ps_seg_next(seg)) {
    int first = 0, last = 0;
    ps_seg_frames(seg, &first, &last);
    const std::string name = ps_seg_word(seg);
    if (name.empty() || (name[0] == '(' && name != kSil)) continue;  // an empty transition
    const bool silent = name == kSil;
    std::int32_t heard = 0, grammar = 0, back = 0;
    ps_seg_prob(seg, &heard, &grammar, &back);
    segments.push_back({frame_time(first), silent ? std::string(dam::kSilence) : name, kNoWord,
                        double(heard) / double(std::max(last - first + 1, 1)),
                        std::size_t(std::max(last - first + 1, 1))});
  }
  return segments;
}

std::vector<Segment> search(ps_decoder_t* decoder, std::span<const std::int16_t> samples,
                            const Grammar& grammar) {
  if (!grammar || ps_set_fsg(decoder, "text", grammar.get()) < 0 ||
      ps_set_search(decoder, "text") < 0) {
    return {};
  }
  if (ps_start_utt(decoder) < 0) return {};
  ps_process_raw(decoder, samples.data(), samples.size(), FALSE, TRUE);
  ps_end_utt(decoder);
  int score = 0;
  if (ps_get_hyp(decoder, &score) == nullptr) return {};
  return read_segments(decoder);
}

// Which variant of which word made the phones: dynamic programming over word borders, where
// from[i][k] is the border after word i - 1 from which word i reached position k.
bool assign_words(std::vector<Segment>& segments, std::span<const SpokenWord> words,
                  bool open_end) {
  std::vector<std::size_t> sounds;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (segments[i].label != dam::kSilence) sounds.push_back(i);
  }
  const std::size_t size = sounds.size() + 1;
  std::vector<std::vector<std::size_t>> from(words.size() + 1,
                                             std::vector<std::size_t>(size, kNoWord));
  from[0][0] = 0;
  const auto fits = [&](const Labels& labels, std::size_t at) {
    if (at + labels.size() > sounds.size()) return false;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (segments[sounds[at + i]].label != labels[i]) return false;
    }
    return true;
  };
  for (std::size_t w = 0; w < words.size(); ++w) {
    for (std::size_t at = 0; at < size; ++at) {
      if (from[w][at] == kNoWord) continue;
      for (const Labels& labels : words[w].variants) {
        if (fits(labels, at)) from[w + 1][at + labels.size()] = at;
      }
    }
  }
  std::size_t end = sounds.size(), last = words.size();
  while (open_end && last > 0 && from[last][end] == kNoWord) --last;
  if (from[last][end] == kNoWord) return false;  // the search did not reach the end
  for (std::size_t w = last; w > 0; --w) {
    const std::size_t begin = from[w][end];
    for (std::size_t i = begin; i < end; ++i) segments[sounds[i]].word = w - 1;
    end = begin;
  }
  return true;
}

// Takes off what the free search is worth in the same frames.
void compare(std::vector<Segment>& segments, const std::vector<Segment>& free) {
  std::vector<double> best;
  for (const Segment& one : free) best.insert(best.end(), one.frames, one.score);
  std::size_t at = 0;
  for (Segment& one : segments) {
    double sum = 0;
    for (std::size_t i = at; i < at + one.frames && i < best.size(); ++i) sum += best[i];
    one.score -= sum / double(one.frames);
    at += one.frames;
  }
}

std::vector<Segment> align_whole(ps_decoder_t* decoder, std::span<const std::int16_t> samples,
                                 std::span<const SpokenWord> words, bool open_end = false) {
  auto segments = search(decoder, samples, make_grammar(decoder, words, open_end));
  if (segments.empty() || !assign_words(segments, words, open_end)) return {};
  compare(segments, search(decoder, samples, make_loop(decoder)));
  return segments;
}

// As many words as can be said in so many seconds.
std::size_t words_within(std::span<const SpokenWord> words, double seconds) {
  double phones = 0;
  std::size_t count = 0;
  while (count < words.size() && phones < seconds * kMostPhones) {
    phones += double(words[count++].variants[0].size());
  }
  return count;
}

// The segment to stop before: the longest pause that is neither early nor at the very end, where
// the path still leans on words that were not heard whole; without one a word that begins there.
std::size_t cut_of(const std::vector<Segment>& segments, double seconds) {
  std::size_t best = 0;
  double longest = 0;
  for (std::size_t i = 1; i < segments.size(); ++i) {
    const Segment& one = segments[i];
    if (one.start < kEarliestCut * seconds || one.start > kLatestCut * seconds) continue;
    const double end = i + 1 < segments.size() ? segments[i + 1].start : seconds;
    const bool pause = one.word == kNoWord && i + 1 < segments.size();
    const double length = pause ? end - one.start : 0;
    if (length > longest || (best == 0 && one.word != segments[i - 1].word)) {
      best = i;
      longest = length;
    }
  }
  return best;
}

std::vector<Segment> align_in_pieces(ps_decoder_t* decoder, std::span<const std::int16_t> samples,
                                     std::span<const SpokenWord> words) {
  std::vector<Segment> all;
  std::size_t at = 0, word = 0;
  const auto add = [&](Segment segment) {
    segment.start += double(at) / double(kAlignRate);
    if (segment.word != kNoWord) segment.word += word;
    all.push_back(std::move(segment));
  };
  while (true) {
    const double left = double(samples.size() - at) / double(kAlignRate);
    if (left <= kWhole) {
      const auto rest = align_whole(decoder, samples.subspan(at), words.subspan(word));
      for (const Segment& segment : rest) add(segment);
      return rest.empty() ? rest : all;
    }
    const auto some = words.subspan(word, words_within(words.subspan(word), kPiece));
    const auto piece = align_whole(
        decoder, samples.subspan(at, std::size_t(kPiece * double(kAlignRate))), some, true);
    const std::size_t cut = cut_of(piece, kPiece);
    if (cut == 0) return {};
    std::size_t next = word;
    for (std::size_t i = 0; i < cut; ++i) {
      if (piece[i].word != kNoWord) next = word + piece[i].word + 1;
      add(piece[i]);
    }
    const bool pause = piece[cut].word == kNoWord;
    if (pause) add(piece[cut]);  // both pieces have a part of it
    const double end = pause ? 0.5 * (piece[cut].start + piece[cut + 1].start) : piece[cut].start;
    at += std::size_t(end * double(kAlignRate)) / kHop * kHop;
    word = next;
    if (word == words.size()) {  // nothing is left to be said
      if (!pause) add({0, std::string(dam::kSilence), kNoWord, 0, 1});
      return all;
    }
  }
}

}  // namespace

// Incomplete models end the whole program inside the library, so look before.
Result<void> check_recogniser(const AlignOptions& options) {
  const std::string& path = options.model_path;
  for (const char* file : {"mdef", "means", "variances", "transition_matrices", "feat.params"}) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(std::filesystem::path(path) / file, ignored)) {
      return make_error(Code::not_found, "no acoustic model at " + path + " (" + file +
                                             " is missing); install the Debian package "
                                             "pocketsphinx-en-us or set the path");
    }
  }
  return {};
}

Result<std::vector<Segment>> recognise(const std::vector<std::int16_t>& samples,
                                       const std::vector<SpokenWord>& words,
                                       const AlignOptions& options) {
  if (auto good = check_recogniser(options); !good) return good.error();
  const auto lock = quiet_sphinx();
  const bool whole = double(samples.size()) <= kWhole * double(kAlignRate);
  for (const char* beam : kBeams) {
    const Decoder decoder = make_decoder(options.model_path, beam);
    if (!decoder) continue;
    auto segments = whole ? align_whole(decoder.get(), samples, words)
                          : align_in_pieces(decoder.get(), samples, words);
    if (!segments.empty()) return segments;
  }
  return std::vector<Segment>();
}

}  // namespace animeme::voice
