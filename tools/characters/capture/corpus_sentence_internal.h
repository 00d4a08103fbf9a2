// A recording on its way into a corpus, and the steps that need nothing but it. Internal.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dam/script/script.h"
#include "dam/signal/signal.h"
#include "tools/characters/capture/build_corpus.h"
#include "tools/characters/capture/cut.h"
#include "tools/formats/media/pcm.h"

namespace animeme::tools {

constexpr double kSlackOfScript = 0.5;  // seconds that a script may differ, as dam/corpus has it

struct Sentence {
  Take take;
  SentenceReport report;
  Capture capture;
  double shift = 0;  // seconds of the first picture on the clock of the sound
  std::optional<media::Pcm> sound;
  dam::Script script;
  dam::Signal signal;
};

/// Its timed phones, from its file or by the aligner. Errors: those of reading and aligning,
/// not_found (no sound to align with), out_of_range (longer than the capture).
Result<void> get_script(const CorpusPlan& plan, Sentence& sentence);

/// One of the sentences that a recording is cut into; `number` from 0. What is to be said of the
/// recording stays with the first.
Sentence part_of(const Sentence& sentence, Stretch stretch, std::size_t number);

/// A folder in the corpus; "" is the corpus. Errors: io.
Result<void> make_folder(const std::string& output, const char* folder);

/// Everything but what trackers gave. Fills in the folds and CorpusReport::sentences. Errors: io.
Result<void> write_corpus(const CorpusPlan& plan, std::vector<Sentence>& sentences,
                          const std::optional<fap::RestingFace>& rest, CorpusReport& report);

}  // namespace animeme::tools
