#include "tools/voice/recogniser.h"

#include <pocketsphinx.h>
#include <sphinxbase/err.h>
#include <sphinxbase/fsg_model.h>

#include <filesystem>
#include <memory>
#include <mutex>

#include "dam/script/phones.h"

namespace animeme::voice {
namespace {

// A frame is 10 ms and speaks for the middle of its window of 25.6 ms. One division, so that
// the times are short decimal numbers.
double frame_time(int frame) { return frame == 0 ? 0.0 : double(frame * 100 + 128) / 10000.0; }

constexpr const char* kSil = "<sil>";
constexpr const char* kBeams[] = {"1e-48", "1e-80"};

struct Free {
  void operator()(cmd_ln_t* config) const { cmd_ln_free_r(config); }
  void operator()(ps_decoder_t* decoder) const { ps_free(decoder); }
  void operator()(fsg_model_t* model) const { fsg_model_free(model); }
};
using Config = std::unique_ptr<cmd_ln_t, Free>;
using Decoder = std::unique_ptr<ps_decoder_t, Free>;
using Grammar = std::unique_ptr<fsg_model_t, Free>;

void ignore_message(void*, err_lvl_t, const char*, ...) {}

Decoder make_decoder(const std::string& model, const char* beam) {
  // No best-path search (it gives impossible durations), no removal of silence or noise (frame
  // numbers would skip it), no dither (results would vary).
  Config config(cmd_ln_init(nullptr, ps_args(), TRUE, "-hmm", model.c_str(), "-samprate", "16000",
                            "-fsgusefiller", "no", "-fsgusealtpron", "no", "-bestpath", "no",
                            "-remove_silence", "no", "-remove_noise", "no", "-dither", "no", "-lw",
                            "1", "-wip", "1", "-beam", beam, "-wbeam", beam, "-pbeam", beam,
                            nullptr));
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
int count_states(const std::vector<SpokenWord>& words) {
  std::size_t count = 2;  // before and after the first optional silence
  for (const SpokenWord& word : words) {
    for (const Labels& variant : word.variants) count += variant.size() - 1;
    count += 2;  // after the word, after the silence behind it
  }
  return int(count);
}

// start -<sil>- { word: one branch a variant } -<sil>- { word } ... ; every silence can be skipped.
Grammar make_grammar(ps_decoder_t* decoder, const std::vector<SpokenWord>& words) {
  Grammar grammar(fsg_model_init("text", ps_get_logmath(decoder), 1.0f, count_states(words)));
  if (!grammar) return nullptr;
  fsg_model_t* fsg = grammar.get();
  const int silence = fsg_model_word_add(fsg, kSil);
  int next = 1;
  const auto optional_silence = [&](int from) {
    const int to = next++;
    fsg_model_trans_add(fsg, from, to, 0, silence);
    fsg_model_null_trans_add(fsg, from, to, 0);
    return to;
  };
  int state = optional_silence(0);
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
    state = optional_silence(end);
  }
  fsg->start_state = 0;
  fsg->final_state = state;
  glist_free(fsg_model_null_trans_closure(fsg, nullptr));
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
    segments.push_back({frame_time(first), silent ? std::string(dam::kSilence) : name, kNoWord});
  }
  return segments;
}

std::vector<Segment> search(const std::vector<std::int16_t>& samples,
                            const std::vector<SpokenWord>& words, const std::string& model,
                            const char* beam) {
  const Decoder decoder = make_decoder(model, beam);
  if (!decoder) return {};
  const Grammar grammar = make_grammar(decoder.get(), words);
  if (!grammar || ps_set_fsg(decoder.get(), "text", grammar.get()) < 0 ||
      ps_set_search(decoder.get(), "text") < 0) {
    return {};
  }
  if (ps_start_utt(decoder.get()) < 0) return {};
  ps_process_raw(decoder.get(), samples.data(), samples.size(), FALSE, TRUE);
  ps_end_utt(decoder.get());
  int score = 0;
  if (ps_get_hyp(decoder.get(), &score) == nullptr) return {};
  return read_segments(decoder.get());
}

// Which variant of which word made the phones: dynamic programming over word borders, where
// from[i][k] is the border after word i - 1 from which word i reached position k.
bool assign_words(std::vector<Segment>& segments, const std::vector<SpokenWord>& words) {
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
  std::size_t end = sounds.size();
  if (from[words.size()][end] == kNoWord) return false;  // the search did not reach the end
  for (std::size_t w = words.size(); w > 0; --w) {
    const std::size_t begin = from[w][end];
    for (std::size_t i = begin; i < end; ++i) segments[sounds[i]].word = w - 1;
    end = begin;
  }
  return true;
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
  static std::mutex mutex;  // the library's message handlers are global
  const std::lock_guard lock(mutex);
  err_set_logfp(nullptr);                     // the configuration goes there,
  err_set_callback(ignore_message, nullptr);  // all else here
  for (const char* beam : kBeams) {
    auto segments = search(samples, words, options.model_path, beam);
    if (!segments.empty() && assign_words(segments, words)) return segments;
  }
  return std::vector<Segment>();
}

}  // namespace animeme::voice
