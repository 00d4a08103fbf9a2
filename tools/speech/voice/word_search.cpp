#include "tools/speech/voice/word_search.h"

#include <pocketsphinx.h>

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <optional>
#include <sstream>
#include <utility>

#include "tools/speech/voice/sphinx.h"

namespace animeme::voice {

namespace {

struct FreeSearch {
  void operator()(cmd_ln_t* config) const { cmd_ln_free_r(config); }
  void operator()(ps_decoder_t* decoder) const { ps_free(decoder); }
};
using SearchConfig = std::unique_ptr<cmd_ln_t, FreeSearch>;
using SearchDecoder = std::unique_ptr<ps_decoder_t, FreeSearch>;

// Scores of the library are multiples of 1024 times the logarithm to 1.0001; those of the language
// model 6.5 times what they are (-lw).
constexpr double kScoreStep = 1024 * 1e-4 / 6.5;

// "<sil>", "[NOISE]", "++UH++" are no words.
bool is_word(const std::string& name) {
  return !name.empty() && name[0] != '<' && name[0] != '[' && name[0] != '+';
}

struct Opened {
  std::string files;  // a name for them all
  SearchConfig config;
  SearchDecoder decoder;
};

void keep(Opened opened);

class Search : public WordSearch {
 public:
  explicit Search(Opened opened) : open_(std::move(opened)) {}
  ~Search() override { keep(std::move(open_)); }

  std::vector<FoundWord> search(std::span<const Cepstrum> frames, const Cepstrum& mean) override {
    std::vector<FoundWord> words;
    if (frames.empty()) return words;
    std::vector<Cepstrum> centred(frames.begin(), frames.end());
    std::vector<mfcc_t*> rows;
    for (Cepstrum& frame : centred) {
      for (std::size_t i = 0; i < kCepstra; ++i) frame[i] -= mean[i];
      rows.push_back(frame.data());
    }
    if (ps_start_utt(open_.decoder.get()) < 0) return words;
    ps_process_cep(open_.decoder.get(), rows.data(), int(rows.size()), FALSE, TRUE);
    ps_end_utt(open_.decoder.get());
    int score = 0;
    if (ps_get_hyp(open_.decoder.get(), &score) == nullptr) return words;
    for (ps_seg_t* one = ps_seg_iter(open_.decoder.get()); one != nullptr; one = ps_seg_next(one)) {
      if (auto word = read(one); !word.phones.empty()) words.push_back(std::move(word));
    }
    return words;
  }

 private:
  FoundWord read(ps_seg_t* segment) {
    FoundWord word;
    word.text = ps_seg_word(segment);
    if (!is_word(word.text)) return word;
    int first = 0, last = 0;
    ps_seg_frames(segment, &first, &last);
    word.first = std::size_t(std::max(first, 0));
    word.end = std::size_t(std::max(last + 1, first + 1));
    std::int32_t heard = 0, language = 0, back = 0;
    const std::int32_t chance = ps_seg_prob(segment, &heard, &language, &back);
    word.belief = std::min(logmath_exp(ps_get_logmath(open_.decoder.get()), chance), 1.0);
    word.language = double(language) * kScoreStep;
    if (char* phones = ps_lookup_word(open_.decoder.get(), word.text.c_str()); phones != nullptr) {
      std::istringstream in(phones);
      for (std::string phone; in >> phone;) word.phones.push_back(phone);
      ckd_free(phones);
    }
    if (const std::size_t variant = word.text.find('('); variant != std::string::npos) {
      word.text.resize(variant);
    }
    return word;
  }

  Opened open_;
};

// Unused searches are kept: opening one takes longer than a sentence.
std::mutex idle_mutex;
std::optional<Opened>& idle() {
  static std::optional<Opened> one;
  return one;
}

void keep(Opened opened) {
  const auto quiet = quiet_sphinx();  // the one that waited is closed
  const std::lock_guard lock(idle_mutex);
  idle() = std::move(opened);
}

std::optional<Opened> take_idle(const std::string& files) {
  const std::lock_guard lock(idle_mutex);
  if (!idle() || idle()->files != files) return std::nullopt;
  return std::exchange(idle(), std::nullopt);
}

static_assert(sizeof(mfcc_t) == sizeof(float), "a library with fixed-point numbers");

}  // namespace

Result<std::unique_ptr<WordSearch>> WordSearch::open(const WordFiles& files) {
  for (const std::string& path : {files.words_path, files.dictionary_path}) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) {
      return make_error(Code::not_found,
                        "there are no words here; install the Debian package pocketsphinx-en-us "
                        "or set the path")
          .in_file(path);
    }
  }
  const std::string name =
      files.model_path + '\n' + files.words_path + '\n' + files.dictionary_path;
  if (auto waiting = take_idle(name)) {
    return std::unique_ptr<WordSearch>(std::make_unique<Search>(std::move(*waiting)));
  }
  const auto lock = quiet_sphinx();
  // The frames are centred by us. One quick search, and the best path through what it leaves: the
  // library's second search (fwdflat) and more states a frame cost twice the time and find 6 words
  // of 100 more.
  SearchConfig config(cmd_ln_init(nullptr, ps_args(), TRUE, "-hmm", files.model_path.c_str(), "-lm",
                                  files.words_path.c_str(), "-dict", files.dictionary_path.c_str(),
                                  "-cmn", "none", "-remove_silence", "no", "-remove_noise", "no",
                                  "-dither", "no", "-fwdflat", "no", "-maxhmmpf", "1000", "-maxwpf",
                                  "5", "-ds", "2", nullptr));
  SearchDecoder decoder(config ? ps_init(config.get()) : nullptr);
  if (!decoder) {
    return make_error(Code::syntax, "the language model of words cannot be used")
        .in_file(files.words_path);
  }
  return std::unique_ptr<WordSearch>(
      std::make_unique<Search>(Opened{name, std::move(config), std::move(decoder)}));
}

}  // namespace animeme::voice
