// What people are known to do with eyes, lids, head and brows, and what dam/behaviour makes:
// the table of dam/behaviour/README.md.
//
//     build/release/bin/behaviour_table                  # ten minutes each of five seeds
//     build/release/bin/behaviour_table --minutes 2 --seeds 2
//
// The speech is that of a synthetic voice; gaze and blinks are measured in what is shown, at 500
// moments a second.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

#include "tests/bench/behaviour_measures.h"
#include "tools/speech/voice/pitch.h"
#include "tools/speech/voice/voice.h"

namespace {

using namespace animeme;  // NOLINT: a program

constexpr double kHertz = 500;

// A monologue with questions, exclamations and long sentences.
const char* const kTexts[] = {
    "Well, let me tell you what happened yesterday. I was on my way to the station, and it rained "
    "as if it would never stop.",
    "Have you ever waited for a train that simply did not come? Nobody knew why, nobody said a "
    "word, and the clock went on and on.",
    "After an hour, or perhaps it was more than an hour, somebody began to sing! First very "
    "quietly, then the whole platform joined in.",
    "You would not believe how good it sounded. There was an old man with a violin, two children, "
    "and a woman who knew all the verses.",
    "What would you have done? I put down my bag, I forgot about the rain, and I sang with them "
    "until the train arrived.",
    "The point is that nothing of this was planned. It happened because we had nothing better to "
    "do, and because somebody was brave enough to start."};

struct Line {
  dam::SpeechPlan plan;
  double seconds = 0;
};

std::vector<Line> lines() {
  std::vector<Line> made;
  for (const char* text : kTexts) {
    voice::VoiceOptions options;
    options.lead_silence = 0.1;
    options.tail_silence = 0.3;
    const auto speech = voice::speak_text(text, options);
    if (!speech) {
      std::fprintf(stderr, "%s\n", speech.error().describe().c_str());
      std::exit(1);
    }
    const dam::Prosody prosody = voice::measure_prosody(speech->audio);
    made.push_back({dam::plan_speech(speech->script, &prosody), speech->script.duration()});
  }
  return made;
}

dam::Behaviour made_with(std::uint64_t seed) {
  dam::BehaviourOptions options;
  options.rate = fap::Rate{std::uint32_t(kHertz), 1};
  options.seed = seed;
  return std::move(*dam::Behaviour::make(options));
}

/// Talks as a live head does: each line is told when it begins, with a pause before it.
bench::Shown talk(const std::vector<Line>& texts, std::uint64_t seed, double seconds) {
  bench::Shown shown;
  shown.hertz = kHertz;
  dam::Behaviour behaviour = made_with(seed);
  double next = 0.5;
  std::size_t line = seed;
  const Line* said = nullptr;
  double begun = 0;
  while (behaviour.time() < seconds) {
    if (behaviour.time() >= next) {
      said = &texts[line++ % texts.size()];
      begun = behaviour.time();
      next = begun + said->seconds + 0.3;
      behaviour.speak(said->plan);
      for (dam::SpeechPhrase phrase : said->plan.phrases) {
        phrase.start += begun;
        phrase.end += begun;
        shown.phrases.push_back(phrase);
      }
      for (dam::SpeechAccent accent : said->plan.accents) {
        accent.start += begun;
        accent.end += begun;
        shown.accents.push_back(accent);
      }
    }
    float semitones = NAN;
    if (said != nullptr) {
      const auto at = std::size_t((behaviour.time() - begun) / said->plan.step);
      if (at < said->plan.pitch.size() && said->plan.level[at] > 0.05f)
        semitones = said->plan.pitch[at];
    }
    shown.semitones.push_back(semitones);
    shown.moments.push_back(behaviour.next());
  }
  return shown;
}

bench::Shown wait(dam::Activity activity, std::uint64_t seed, double seconds) {
  bench::Shown shown;
  shown.hertz = kHertz;
  dam::Behaviour behaviour = made_with(seed);
  behaviour.set_activity(activity);
  while (behaviour.time() < seconds) shown.moments.push_back(behaviour.next());
  return shown;
}

/// All that is measured of one seed, or the means.
struct Measured {
  bench::SaccadesSeen saccades, listened_saccades;
  bench::ContactSeen talking, listening;
  bench::BlinksSeen blinks, idle_blinks;
  bench::HeadSeen head, listening_head;
  bench::BrowsSeen brows;
};

Measured measure(const std::vector<Line>& texts, std::uint64_t seed, double seconds) {
  const bench::Shown talking = talk(texts, seed, seconds);
  const bench::Shown listening = wait(dam::Activity::listening, seed, seconds);
  const bench::Shown idle = wait(dam::Activity::idle, seed, seconds);
  Measured m;
  m.saccades = bench::saccades_of(talking);
  m.listened_saccades = bench::saccades_of(listening);
  m.talking = bench::contact_of(talking);
  m.listening = bench::contact_of(listening);
  m.blinks = bench::blinks_of(talking);
  m.idle_blinks = bench::blinks_of(idle);
  m.head = bench::head_of(talking);
  m.listening_head = bench::head_of(listening);
  m.brows = bench::brows_of(talking);
  return m;
}

struct Row {
  const char* what;
  const char* published;
  std::function<double(const Measured&)> value;
  const char* unit = "";
};

const Row kRows[] = {
    {"saccades, talking: mean size", "6.4 (15.7 exp(-A/6.9) to 27.5)",
     [](const Measured& m) { return m.saccades.size.mean(); }, "degrees"},
    {"  share up to 5, 10, 20 degrees", "53 %",
     [](const Measured& m) { return 100 * m.saccades.size.share_to(5); }, "%"},
    {"", "78 %", [](const Measured& m) { return 100 * m.saccades.size.share_to(10); }, "%"},
    {"", "96 %", [](const Measured& m) { return 100 * m.saccades.size.share_to(20); }, "%"},
    {"  largest", "27.5",
     [](const Measured& m) {
       return *std::max_element(m.saccades.size.values.begin(), m.saccades.size.values.end());
     },
     "degrees"},
    {"  duration: at 0 degrees, and per degree", "21 to 25",
     [](const Measured& m) { return m.saccades.intercept; }, "ms"},
    {"", "2.2 to 2.4", [](const Measured& m) { return m.saccades.slope; }, "ms"},
    {"  peak velocity at 10 degrees", "280", [](const Measured& m) { return m.saccades.peak_10; },
     "degrees/s"},
    {"  directions: right", "15.5", [](const Measured& m) { return m.saccades.directions[0]; },
     "%"},
    {"  right up", "6.5", [](const Measured& m) { return m.saccades.directions[1]; }, "%"},
    {"  up", "17.7", [](const Measured& m) { return m.saccades.directions[2]; }, "%"},
    {"  left up", "7.4", [](const Measured& m) { return m.saccades.directions[3]; }, "%"},
    {"  left", "16.8", [](const Measured& m) { return m.saccades.directions[4]; }, "%"},
    {"  left down", "7.9", [](const Measured& m) { return m.saccades.directions[5]; }, "%"},
    {"  down", "20.4", [](const Measured& m) { return m.saccades.directions[6]; }, "%"},
    {"  right down", "7.8", [](const Measured& m) { return m.saccades.directions[7]; }, "%"},
    {"saccades, listening: mean size", "6.0",
     [](const Measured& m) { return m.listened_saccades.size.mean(); }, "degrees"},
    {"eye contact, talking: share", "40 to 77 %",
     [](const Measured& m) { return 100 * m.talking.share; }, "%"},
    {"  at the other", "3.1 (3.2)", [](const Measured& m) { return m.talking.at.mean(); }, "s"},
    {"  standard deviation", "3.2", [](const Measured& m) { return m.talking.at.deviation(); },
     "s"},
    {"  away", "0.93 (0.8)", [](const Measured& m) { return m.talking.away.mean(); }, "s"},
    {"  standard deviation", "0.8", [](const Measured& m) { return m.talking.away.deviation(); },
     "s"},
    {"eye contact, listening: share", "75 to 95 %",
     [](const Measured& m) { return 100 * m.listening.share; }, "%"},
    {"  at the other", "7.9 (1.6)", [](const Measured& m) { return m.listening.at.mean(); }, "s"},
    {"  away", "0.43 (0.24)", [](const Measured& m) { return m.listening.away.mean(); }, "s"},
    {"blinks, talking", "26 (15 to 30)", [](const Measured& m) { return m.blinks.a_minute; },
     "a minute"},
    {"blinks, idle", "17", [](const Measured& m) { return m.idle_blinks.a_minute; }, "a minute"},
    {"  variation of intervals, talking", "1",
     [](const Measured& m) { return m.blinks.interval.deviation() / m.blinks.interval.mean(); }},
    {"  variation of intervals, idle", "1",
     [](const Measured& m) {
       return m.idle_blinks.interval.deviation() / m.idle_blinks.interval.mean();
     }},
    {"  down", "60 to 120", [](const Measured& m) { return 1000 * m.blinks.down.mean(); }, "ms"},
    {"  up", "150 to 300", [](const Measured& m) { return 1000 * m.blinks.up.mean(); }, "ms"},
    {"  half", "some", [](const Measured& m) { return 100 * m.blinks.half; }, "%"},
    {"  double", "some", [](const Measured& m) { return 100 * m.blinks.doubled; }, "%"},
    {"  at ends of phrases, by chance", "more",
     [](const Measured& m) { return 100 * m.blinks.at_borders; }, "%"},
    {"", "", [](const Measured& m) { return 100 * m.blinks.by_chance; }, "%"},
    {"head, talking: deviation of pitch", "2 to 4 (3.3)",
     [](const Measured& m) { return m.head.deviation[0]; }, "degrees"},
    {"  yaw", "2 to 4 (0.9)", [](const Measured& m) { return m.head.deviation[1]; }, "degrees"},
    {"  roll", "1 to 2 (0.8)", [](const Measured& m) { return m.head.deviation[2]; }, "degrees"},
    {"  fastest", "100", [](const Measured& m) { return m.head.fastest; }, "degrees/s"},
    {"  power of velocity below 1.8 Hz", "most",
     [](const Measured& m) { return 100 * m.head.bands[0]; }, "%"},
    {"  1.8 to 3.7 Hz", "less", [](const Measured& m) { return 100 * m.head.bands[1]; }, "%"},
    {"  3.7 to 7 Hz", "little", [](const Measured& m) { return 100 * m.head.bands[2]; }, "%"},
    {"  correlation of pitch with F0 in a phrase", "0.3 to 0.9",
     [](const Measured& m) { return m.head.with_pitch; }},
    {"head, listening: deviation of pitch", "less",
     [](const Measured& m) { return m.listening_head.deviation[0]; }, "degrees"},
    {"  yaw", "less", [](const Measured& m) { return m.listening_head.deviation[1]; }, "degrees"},
    {"brows, talking: raises", "", [](const Measured& m) { return m.brows.a_minute; }, "a minute"},
    {"  last", "0.3 to 1", [](const Measured& m) { return m.brows.seconds.mean(); }, "s"},
    {"  accents with a raise", "", [](const Measured& m) { return 100 * m.brows.of_accents; }, "%"},
    {"  of these where F0 rises", "70 %", [](const Measured& m) { return 100 * m.brows.at_rise; },
     "%"},
};

}  // namespace

int main(int argc, char** argv) {
  double minutes = 10;
  int seeds = 5;
  CLI::App app{"What people do, and what dam/behaviour makes"};
  app.add_option("--minutes", minutes, "Of talking, listening and idling, each")
      ->check(CLI::Range(0.5, 600.0));
  app.add_option("--seeds", seeds, "1 to so many")->check(CLI::Range(1, 1000));
  CLI11_PARSE(app, argc, argv);
  const std::vector<Line> texts = lines();
  std::vector<Measured> all;
  for (int seed = 1; seed <= seeds; ++seed)
    all.push_back(measure(texts, std::uint64_t(seed), 60 * minutes));
  std::printf("| what | published | made: mean (least to most of %d seeds, %g minutes each) |\n",
              seeds, minutes);
  std::printf("|---|---|---|\n");
  for (const Row& row : kRows) {
    bench::Sample values;
    for (const Measured& one : all) values.values.push_back(row.value(one));
    const auto [least, most] = std::minmax_element(values.values.begin(), values.values.end());
    std::printf("| %s | %s | %.3g %s (%.3g to %.3g) |\n", row.what, row.published, values.mean(),
                row.unit, *least, *most);
  }
  return 0;
}
