/// @file
/// The queue of lines to speak, between the reader, the voice and the head.
///
/// Three threads may use it: one pushes lines and commands, one synthesises them, one takes the
/// results. A command takes effect when it is pushed, even during synthesis.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fap/result.h"
#include "tools/speech/talking/line_command.h"
#include "tools/speech/talking/lines.h"
#include "tools/speech/talking/pieces.h"

namespace animeme::speech {

/// Thread safe.
class LineQueue : public LineSource {
 public:
  /// The members of LineMaker. `json`: push() takes pieces.
  LineQueue(std::size_t most_bytes, bool cut, bool json,
            std::shared_ptr<PieceStream> pieces = nullptr, bool one_line = false)
      : most_bytes_(most_bytes),
        cut_(cut),
        json_(json),
        one_line_(one_line),
        pieces_(std::move(pieces)) {}

  /// Adds a line of the input without surrounding blanks; ignores empty lines. Errors: those of
  /// read_line(), which are also warnings (take_warnings()).
  Result<void> push(std::string line, double arrived);
  /// The same for a line that is a piece, or a command, among lines of text. Needs a PieceStream.
  Result<void> push_piece(std::string line, double arrived);
  /// Sound of an utterance as samples, which is a line named `id`; `last`: the utterance ends.
  /// Needs a PieceStream. Errors: those of PieceStream::add_sound().
  Result<void> push_sound(const std::string& id, media::Pcm sound, bool last, double arrived);
  /// No more lines will come: the queue is spoken, then it ends. A pause ends, too. `at`: instant.
  void close(double at = 0);
  /// Whether the limit of 64 MB or 100000 lines is reached. push() still works.
  bool full();
  std::string last_id();      ///< of the line that was queued last; empty: none
  std::size_t waiting();      ///< lines and marks not yet returned by take()
  std::size_t bytes();        ///< of these, before synthesis; without pieces
  std::size_t piece_bytes();  ///< of the pieces among them, as they came

  /// A line to synthesise.
  struct Job {
    std::uint64_t line = 0;   ///< its number
    std::string payload;      ///< LineCommand::payload
    std::uint64_t piece = 0;  ///< in place of the payload: for PieceStream::make(); 0: none
    std::string language;     ///< LineCommand::language
    bool words = false;       ///< only PieceStream::words() are wanted
  };
  /// The next line to synthesise, in the order in which they will be spoken. Waits while four
  /// synthesised lines, or 10 s of speech, are queued before it. nullopt: leave() was called.
  std::optional<Job> next_job();
  /// The same without waiting.
  std::optional<Job> try_job();
  /// Whether a line is still in the queue, so that its speech is needed.
  bool wanted(std::uint64_t line);
  /// Stores the result of the voice, finished at `spoken`. Discarded if it is no longer needed.
  void made(std::uint64_t line, Result<SpokenLine> speech, double spoken);
  /// Ends next_job().
  void leave();

  std::optional<SpokenLine> take(bool only_joining) override;
  std::optional<double> improvable_since() override;
  std::vector<LineNews> take_news() override;
  bool ended() override;
  void abandon(const std::string& why) override;

  /// One sentence for every skipped or doubtful line since the last call.
  std::vector<std::string> take_warnings();

 private:
  struct Entry {
    std::uint64_t line = 0;
    std::string id, text, payload, language;
    double arrived = 0;
    bool mark = false;
    std::size_t bytes = 0;  // of what came
    bool is_piece = false;
    std::uint64_t piece = 0, utterance = 0;  // of the PieceStream
    bool stale = false;                      // to be made again; `speech` is there until then
    std::uint64_t whole = 0;                 // as SpokenLine
    bool first_part = true, last_part = true;
    std::optional<dam::Mood> mood;
    std::optional<SpokenLine> speech;  // nothing: not made
  };
  using Entries = std::list<Entry>;
  // A piece that was taken, of which more may become known.
  struct Gone {
    std::uint64_t line = 0, piece = 0, utterance = 0;
    std::string id;
    std::vector<dam::ScriptWord> told;
    bool stale = false;
  };

  Result<void> push(std::string line, double arrived, bool piece);
  void say(LineCommand command, double arrived, bool piece);
  bool add_piece(Entry& entry, const Result<PieceStream::Taken>& taken);
  void improve(std::uint64_t utterance);
  void forget(const Entry& entry);
  void keep_in_mind(const Entry& entry, const SpokenLine& line);
  void tell_words(std::uint64_t line, const Result<SpokenLine>& speech);
  void close_input(double at);
  void hold(bool pause, double at);
  void forget_all(LineNews::What what, const std::string& why, double at);
  Entries::iterator find(std::uint64_t line);
  std::optional<Job> look_for_job();
  void tell(LineNews::What what, const Entry& entry, const std::string& why, double at);

  const std::size_t most_bytes_;
  const bool cut_, json_, one_line_;
  const std::shared_ptr<PieceStream> pieces_;

  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  Entries entries_;
  std::deque<Gone> gone_;
  std::size_t bytes_ = 0, piece_bytes_ = 0;  // of payloads
  std::size_t made_ = 0;                     // entries with speech
  std::uint64_t number_ = 0;
  std::string last_id_;
  std::vector<LineNews> news_;
  std::vector<std::string> warnings_;
  bool closed_ = false, left_ = false, paused_ = false;
};

/// The speech of a job: LineMaker::make, make_in or pieces. A language that the maker does not have
/// is a doubt.
Result<SpokenLine> make_line(const LineMaker& maker, LineQueue::Job job, const Wanted& wanted);

}  // namespace animeme::speech
