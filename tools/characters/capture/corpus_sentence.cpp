#include <filesystem>

#include "tools/characters/capture/corpus_report.h"
#include "tools/characters/capture/corpus_sentence_internal.h"
#include "tools/characters/capture/corpus_signal.h"
#include "tools/characters/capture/folds.h"
#include "tools/formats/common/text.h"
#include "tools/formats/exchange/curves.h"
#include "tools/formats/exchange/face_file.h"
#include "tools/formats/files/files.h"
#include "tools/formats/media/audio.h"
#include "tools/speech/talking/voice_file.h"
#include "tools/speech/voice/align.h"

namespace animeme::tools {

namespace {

namespace fs = std::filesystem;

Result<void> align(const CorpusPlan& plan, Sentence& sentence) {
  sentence.report.text = *sentence.take.text;
  sentence.report.script = "aligned";
  if (!sentence.sound) {
    return make_error(Code::not_found,
                      "there is no sound to align its text with; name a folder of sounds "
                      "(--audio), or give a script (TextGrid)");
  }
  voice::AlignOptions options;
  options.language = plan.language;
  const double sure = options.least_confidence;
  options.least_confidence = 0;  // a doubt, which --strict leaves out
  auto alignment = voice::align(*sentence.sound, *sentence.take.text, options);
  if (!alignment) return alignment.error();
  if (!alignment->approximate && alignment->confidence < sure) {
    sentence.report.doubts.push_back(
        format("the text hardly fits the sound (confidence %.2f)", alignment->confidence));
  }
  for (const std::string& text : alignment->warnings) {
    (alignment->approximate ? sentence.report.doubts : sentence.report.warnings).push_back(text);
  }
  sentence.script = std::move(alignment->script);
  return {};
}

Result<void> read_script(const CorpusPlan& plan, Sentence& sentence) {
  sentence.report.script = "given";
  auto script = speech::read_script(sentence.take.script, {plan.script_reading, plan.language});
  if (!script) return script.error();
  sentence.script = std::move(*script);
  sentence.report.text =
      sentence.take.text ? *sentence.take.text : words_of_script(sentence.script);
  const double seconds = sentence.signal.rate.seconds(double(sentence.signal.frames()));
  if (sentence.script.duration() > seconds + kSlackOfScript) {
    return make_error(Code::out_of_range, format("its script lasts %.2f s, its capture %.2f s",
                                                 sentence.script.duration(), seconds))
        .in_file(sentence.take.script);
  }
  extend_with_silence(sentence.script, seconds);
  return {};
}

}  // namespace

Result<void> get_script(const CorpusPlan& plan, Sentence& sentence) {
  return sentence.take.script.empty() ? align(plan, sentence) : read_script(plan, sentence);
}

Sentence part_of(const Sentence& sentence, Stretch stretch, std::size_t number) {
  const fap::Rate rate = sentence.signal.rate;
  Sentence part;
  part.take = sentence.take;
  part.take.id += format("_%03zu", number + 1);
  part.report = sentence.report;
  part.report.id = part.take.id;
  if (number > 0) part.report.warnings.clear();
  if (sentence.sound) part.sound = part_of(*sentence.sound, rate, stretch);
  part.script = part_of(sentence.script, rate, stretch);
  part.signal = part_of(sentence.signal, stretch);
  part.report.text = words_of_script(part.script);
  return part;
}

Result<void> make_folder(const std::string& output, const char* folder) {
  std::error_code error;
  fs::create_directories(fs::path(output) / folder, error);
  if (!error) return {};
  return make_error(Code::io, "the folder cannot be made: " + error.message()).in_file(output);
}

Result<void> write_corpus(const CorpusPlan& plan, std::vector<Sentence>& sentences,
                          const std::optional<fap::RestingFace>& rest, CorpusReport& report) {
  const auto path = [&](const char* folder, const std::string& name) {
    return (fs::path(plan.output) / folder / name).string();
  };
  std::vector<std::string> ids, texts;
  for (const Sentence& sentence : sentences) {
    ids.push_back(sentence.take.id);
    texts.push_back(sentence.report.text);
  }
  for (const char* folder : {"fap", "phonemes"}) {
    if (auto ok = make_folder(plan.output, folder); !ok) return ok;
  }
  const std::vector<int> folds = split_into_folds(ids, texts, plan.folds);
  std::vector<std::pair<std::string, std::string>> files;
  for (std::size_t i = 0; i < sentences.size(); ++i) {
    Sentence& sentence = sentences[i];
    const std::string& id = sentence.take.id;
    sentence.report.fold = folds[i] + 1;
    files = {{path("fap", id + ".csv"), exchange::write_curves(sentence.signal)},
             {path("phonemes", id + ".tsv"), dam::write_script_tsv(sentence.script)}};
    for (const auto& [name, text] : files) {
      if (auto ok = write_file(name, text); !ok) return ok;
    }
    if (sentence.sound) {
      if (auto ok = make_folder(plan.output, "audio"); !ok) return ok;
      if (auto ok = media::write_wav(path("audio", id + ".wav"), *sentence.sound); !ok) return ok;
    }
    report.sentences.push_back(std::move(sentence.report));
  }
  files.clear();
  if (rest) files.emplace_back(path("", "neutral.face"), exchange::write_face_file(*rest));
  files.emplace_back(path("", "report.txt"), report_text(report));
  files.emplace_back(path("", "report.json"), report_json(report).dump(1) + "\n");
  files.emplace_back(path("", "utterances.tsv"),
                     utterance_table(report.sentences, hold_words_out(texts), plan.folds));
  for (const auto& [name, text] : files) {
    if (auto ok = write_file(name, text); !ok) return ok;
  }
  return {};
}

}  // namespace animeme::tools
