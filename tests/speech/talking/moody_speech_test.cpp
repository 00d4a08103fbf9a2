// What moods leave to speech, in sentences of synthetic voices as they are sent: with idle motion
// and a tongue, in whole units.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "dam/model/builtin.h"
#include "dam/script/phones.h"
#include "dam/signal/closure.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/idle_motion.h"
#include "dam/speaking/moods.h"
#include "dam/speaking/synthesise.h"
#include "fap/players.h"
#include "fap/text.h"
#include "tools/speech/voice/voice.h"

namespace animeme::speech {
namespace moody_speech_test {

struct Sentence {
  const char* language;
  const char* text;
};

constexpr Sentence kSentences[] = {
    {"en", "Move the blue boots from the roof to my room before lunch, Poppy."},
    {"en", "Five brave women of Vermont fed a whole zoo with soup and food!"},
    {"en-gb", "Whose shampoo is this? Mum threw two of them into the pool in June."},
    {"de", "Du und Uwe wolltet im Juni zum Fluss, um Möwen und Füchse zu filmen."},
    {"fr", "Vous avez vu beaucoup de loups fous pousser une voiture bleue?"},
    {"es", "Un búho viejo fuma puros en un baúl bajo la luna de plomo."},
    {"pt-br", "Vovó Bruna trouxe muitas uvas e um bolo fofo para o batismo."}};

/// Both lips of a coded frame.
double gap_of(const fap::Frame& frame) { return -double(frame.value[4] + frame.value[5]); }

struct Counts {
  int closures = 0, contacts = 0, round = 0;
};

/// A clip in a mood against the same in none.
void compare(const fap::Sequence& plain, const fap::Sequence& moody, const dam::Script& script,
             const dam::Model& model, const std::string& what, Counts& counts) {
  ASSERT_EQ(plain.frames.size(), moody.frames.size());
  const double rate = plain.rate.frames_per_second();
  const auto frames = std::ptrdiff_t(plain.frames.size());
  const auto at = [&](double seconds) {
    return std::size_t(std::clamp<std::ptrdiff_t>(std::lround(seconds * rate), 0, frames - 1));
  };
  for (const dam::Phone& phone : script.phones) {
    const std::size_t first = at(phone.start - 0.06), last = at(phone.end + 0.06);
    if (dam::is_bilabial(phone.label)) {
      double before = 1e9, after = 1e9;
      for (std::size_t i = first; i <= last; ++i) {
        before = std::min(before, gap_of(plain.frames[i]));
        after = std::min(after, gap_of(moody.frames[i]));
      }
      if (before > model.closure_gap + 1) continue;  // between two frames
      EXPECT_LE(after, model.closure_gap + 2) << what << ", " << phone.label << phone.start;
      ++counts.closures;
    }
    if (dam::is_labiodental(phone.label)) {
      for (std::size_t i = at(phone.start); i <= at(phone.end); ++i)
        for (const std::size_t fap : {4, 5, 52})
          EXPECT_NEAR(moody.frames[i].value[fap], plain.frames[i].value[fap], 1)
              << what << ", " << phone.label << phone.start << ", FAP " << fap;
      ++counts.contacts;
    }
    if (phone.label == "UW") {
      const std::size_t middle = at(0.5 * (phone.start + phone.end));
      for (const std::size_t fap : {6, 7}) {
        const double narrow = plain.frames[middle].value[fap];
        if (narrow > -5) continue;
        EXPECT_LE(moody.frames[middle].value[fap], 0.6 * narrow + 1) << what << phone.start;
        ++counts.round;
      }
      for (const std::size_t fap : {16, 17})
        EXPECT_GE(moody.frames[middle].value[fap], 0.6 * plain.frames[middle].value[fap] - 1)
            << what << phone.start;
    }
  }
}

TEST(MoodySpeech, KeepsContactsAndRoundingInEveryMood) {
  const auto model = dam::builtin_model();
  ASSERT_TRUE(model);
  Counts counts;
  std::uint64_t seed = 100;
  for (const Sentence& sentence : kSentences) {
    for (const int speed : {130, 230}) {
      voice::VoiceOptions voice;
      voice.language = sentence.language;
      voice.words_per_minute = speed;
      const auto spoken = voice::speak_text(sentence.text, voice);
      if (!spoken) GTEST_SKIP() << spoken.error().describe();
      dam::SynthesisOptions options;
      options.articulation = std::nullopt;
      options.tongue = true;
      auto signal = dam::synthesise(*model, spoken->script, options);
      ASSERT_TRUE(signal) << signal.error().describe();
      ASSERT_TRUE(dam::add_idle_motion(*signal, spoken->script, {.seed = ++seed}));
      const fap::Sequence plain = *dam::to_sequence(*signal);
      for (const std::string& name : dam::mood_names()) {
        dam::Signal moody = *signal;
        ASSERT_TRUE(dam::add_moods(moody, spoken->script, dam::MoodTrack(dam::Mood{name, 1})));
        const std::string what = name + ": " + sentence.text;
        const fap::Sequence clip = *dam::to_sequence(moody);
        compare(plain, clip, spoken->script, *model, what, counts);
        // Gaze, lids, tongue and moods play in Greta and Xface.
        const auto problems = fap::player_problems(fap::write_text(clip, {.whole_rate = true}));
        EXPECT_TRUE(problems.empty()) << what << ": " << problems.front();
      }
    }
  }
  EXPECT_GT(counts.closures, 500);
  EXPECT_GT(counts.contacts, 300);
  EXPECT_GT(counts.round, 300);
}

}  // namespace moody_speech_test
}  // namespace animeme::speech
