#include "tools/app/commands/train_parts.h"

#include <cstdio>
#include <filesystem>

#include "dam/training/accumulate.h"
#include "tools/app/mpi/ranks.h"
#include "tools/formats/common/json.h"
#include "tools/formats/files/file_lock.h"
#include "tools/formats/inspect/left_out.h"
#include "tools/speech/talking/spoken.h"

namespace animeme::tools {

namespace {

// Sums without a sentence.
Result<dam::TrainingSums> start_sums(const PartSettings& parts, const dam::TrainOptions& train) {
  dam::Model base;
  if (!parts.dominance.empty()) {
    Result<dam::Model> read = speech::read_model(parts.dominance);
    if (!read) return read.error();
    base = std::move(*read);
  }
  Result<dam::TrainingSums> fresh =
      dam::TrainingSums::start(train, parts.dominance.empty() ? nullptr : &base);
  if (!fresh) return fresh.error().in_file(parts.dominance);
  return fresh;
}

// New sums, or those that are there already.
Result<dam::TrainingSums> open_sums(const PartSettings& parts, const dam::TrainOptions& train) {
  Result<dam::TrainingSums> fresh = start_sums(parts, train);
  if (!fresh) return fresh;
  std::error_code ignored;
  if (!std::filesystem::exists(parts.accumulate, ignored)) return fresh;
  Result<dam::TrainingSums> there = dam::load_training_sums(parts.accumulate);
  if (!there || parts.dominance.empty()) return there;  // which brings its own base
  if (auto same = there->check_same_base(*fresh); !same) {
    return same.error().in_file(parts.accumulate);
  }
  return there;
}

// Sums on their way to the disk.
class Accumulator {
 public:
  Accumulator(dam::TrainingSums sums, const PartSettings& parts)
      : sums_(std::move(sums)), parts_(parts) {}

  Result<void> add(const dam::Utterance& sentence, std::size_t row, std::size_t rows) {
    line_.update(double(row) / double(rows),
                 "sentence " + std::to_string(row + 1) + " of " + std::to_string(rows));
    Result<bool> added = sums_.add(sentence, &glitches_);
    if (!added) return added.error();
    ++(*added ? added_ : there_);
    return added_ >= saved_ + parts_.save_every ? save() : Result<void>();
  }

  bool unsaved() const { return added_ > saved_; }

  Result<void> save() {
    auto done = write_file(parts_.accumulate, dam::write_training_sums(sums_));
    if (done) saved_ = added_;
    return done;
  }

  void report(const dam::LeftOut& left_out, bool json) {
    line_.clear();
    for (const std::string& text : inspect::glitches_text(glitches_)) warn(text);
    if (json) {
      const Json out = {{"sums", parts_.accumulate},
                        {"added", added_},
                        {"already_there", there_},
                        {"skipped", left_out.skipped},
                        {"blanks", *Json::parse(inspect::blanks_json(left_out))},
                        {"glitches", *Json::parse(inspect::glitches_json(glitches_))},
                        {"utterances", sums_.sentences()},
                        {"frames", sums_.frames()},
                        {"controls", sums_.controls().size()}};
      std::printf("%s\n", pretty(out).c_str());
      return;
    }
    say(parts_.accumulate + ": " + std::to_string(added_) + " sentences added, " +
        std::to_string(there_) + " were there already; " + std::to_string(sums_.sentences()) +
        " sentences, " + std::to_string(sums_.frames()) + " frames");
  }

 private:
  dam::TrainingSums sums_;
  const PartSettings& parts_;
  std::vector<dam::Glitch> glitches_;
  std::size_t added_ = 0, there_ = 0, saved_ = 0;
  ProgressLine line_{"accumulating"};
};

// The model of all sums; `files`: where they were, for the summary and for errors.
Result<int> solve(dam::TrainingSums sums, const std::vector<std::string>& files,
                  const std::string& output, const CorpusSettings& corpus, dam::TrainOptions train,
                  bool json) {
  train.provenance = "animeme " ANIMEME_VERSION ", method dam, " +
                     std::to_string(sums.sentences()) + " utterances, from sums";
  dam::TrainSummary summary;
  Result<dam::Model> model = dam::train_from_sums(std::move(sums), train, &summary);
  if (!model) return model.error().in_file(files.empty() ? corpus.folder : files[0]);
  if (auto done = set_limits(corpus, *model); !done) return done.error();
  for (const std::string& text : summary.warnings) warn(text);
  if (auto written = write_file(output, dam::write_model(*model)); !written) {
    return written.error();
  }
  tell_training(output, *model, summary, {0, files}, json);
  return kOk;
}

// Adds up the sums of all processes by pairs, pairs of pairs and so on: rank 0 has all of them.
Result<void> reduce(const mpi::Ranks& ranks, dam::TrainingSums& sums) {
  for (int step = 1; step < ranks.size(); step *= 2) {
    if (ranks.rank() % (2 * step) != 0) {
      ranks.send(dam::write_training_sums(sums), ranks.rank() - step);
      return {};
    }
    if (ranks.rank() + step >= ranks.size()) continue;
    const auto other = dam::read_training_sums(ranks.receive(ranks.rank() + step));
    if (!other) return other.error();
    if (auto ok = sums.merge(*other); !ok) return ok;
  }
  return {};
}

}  // namespace

void tell_training(const std::string& output, const dam::Model& model,
                   const dam::TrainSummary& summary, const inspect::TrainingData& data, bool json) {
  if (json) {
    std::printf("%s\n", inspect::training_json(output, model, summary, data).c_str());
  } else {
    say(inspect::training_text(output, model, summary, data));
    if (const std::string ties = inspect::ties_text(summary); !ties.empty()) say_more(ties);
  }
}

Result<int> accumulate(const PartSettings& parts, const CorpusSettings& corpus,
                       const dam::TrainOptions& train, bool json) {
  const Result<FileLock> lock = FileLock::take(parts.accumulate);
  if (!lock) return lock.error();
  Result<dam::TrainingSums> sums = open_sums(parts, train);
  if (!sums) return sums.error();
  Accumulator accumulator(std::move(*sums), parts);
  const Result<dam::LeftOut> left_out =
      visit_corpus(corpus, [&](const dam::Utterance& sentence, std::size_t row, std::size_t rows) {
        return accumulator.add(sentence, row, rows);
      });
  // What came before a bad sentence is kept: after the repair the same command goes on.
  std::error_code ignored;
  const bool save = accumulator.unsaved() || !std::filesystem::exists(parts.accumulate, ignored);
  const Result<void> saved = save ? accumulator.save() : Result<void>();
  if (!left_out) return left_out.error().in_file(corpus.folder);
  if (!saved) return saved.error();
  accumulator.report(*left_out, json);
  return kOk;
}

Result<int> merge(const PartSettings& parts, const std::string& output,
                  const CorpusSettings& corpus, dam::TrainOptions train, bool json) {
  const std::vector<std::filesystem::path> paths(parts.merge.begin(), parts.merge.end());
  Result<dam::TrainingSums> sums = dam::merge_training_sums(paths);
  if (!sums) return sums.error();
  return solve(std::move(*sums), parts.merge, output, corpus, std::move(train), json);
}

Result<int> train_over_mpi(const PartSettings& parts, const std::string& output,
                           CorpusSettings corpus, dam::TrainOptions train, bool json) {
  const Result<mpi::Ranks> ranks = mpi::Ranks::join();
  if (!ranks) return ranks.error();
  corpus.shard = ranks->rank() + 1;
  corpus.shards = ranks->size();
  Result<dam::TrainingSums> sums = start_sums(parts, train);
  if (!sums) return sums.error();
  std::vector<dam::Glitch> glitches;
  const Result<dam::LeftOut> left_out = visit_corpus(
      corpus, [&](const dam::Utterance& sentence, std::size_t, std::size_t) -> Result<void> {
        const Result<bool> added = sums->add(sentence, &glitches);
        if (!added) return added.error();
        return {};
      });
  if (!left_out) return left_out.error().in_file(corpus.folder);
  for (const std::string& text : inspect::glitches_text(glitches)) warn(text);
  if (auto done = reduce(*ranks, *sums); !done) return done.error();
  if (ranks->rank() != 0) return kOk;
  return solve(std::move(*sums), {}, output, corpus, std::move(train), json);
}

}  // namespace animeme::tools
