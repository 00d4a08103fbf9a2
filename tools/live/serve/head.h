/// @file
/// One head of many: a LiveSpeaker, its lines and its path on the server, on its own clock.
///
/// A head without viewers and lines sleeps: its clock stops and nothing is generated. A viewer or a
/// line wakes it; its times continue where they stopped.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "dam/model/model.h"
#include "tools/formats/media/live/expected_loss.h"
#include "tools/formats/media/live/pacer.h"
#include "tools/live/serve/clock_loop.h"
#include "tools/live/serve/head_lines.h"
#include "tools/live/serve/journal.h"
#include "tools/live/serve/settings.h"
#include "tools/live/web/web_server.h"
#include "tools/speech/talking/live_speaker.h"

namespace animeme::serve {

/// The services that a head needs; they must outlive the head.
struct HeadRoom {
  Voices& voices;              ///< synthesise its lines
  speech::LineMaker voice;     ///< of the head
  bool slow_voice = false;     ///< which may take long
  web::WebServer& server;      ///< serves it
  ClockLoop& loop;             ///< runs its steps
  media::Clock& clock;         ///< that of the loop
  Journal& journal;            ///< is told of its lines
  double most_seconds = 1800;  ///< of speech that may wait, see HeadLines
};

/// Statistics of a head.
struct HeadFigures {
  std::int64_t planes = 0;   ///< planes made
  std::int64_t packets = 0;  ///< audio packets made
  double late_50 = 0;        ///< seconds that planes were late: median
  double late_99 = 0;        ///< ... 99th percentile
  std::int64_t viewers = 0;  ///< now
  std::int64_t dropped = 0;  ///< messages dropped for slow viewers
  std::size_t lines = 0;     ///< queued lines
  std::int64_t spoken = 0;   ///< lines that were begun
  bool asleep = false;       ///< whether it sleeps
  double idle = 0;           ///< seconds that it has slept
  std::string warning;       ///< the last one; empty: none
};

/// Thread safe.
class Head : public Beat {
 public:
  /// At `name` of the server: /heads/NAME/. `model` and `over`, the performance of
  /// HeadSettings::over (null: none), are shared. Errors: those of
  /// LiveSpeaker::open() and WebSink::start().
  static Result<std::shared_ptr<Head>> open(const std::string& name, const HeadSettings& settings,
                                            std::shared_ptr<const dam::Model> model,
                                            std::shared_ptr<const dam::Performance> over,
                                            const HeadRoom& room);
  ~Head() override;

  HeadSettings settings() const;  ///< as they were given
  /// Other settings, which differ by with_live_parts() alone; `voice`: of the lines that follow.
  void update(const HeadSettings& settings, speech::LineMaker voice, bool slow_voice);
  /// As HeadLines::push().
  Result<std::vector<std::string>> say(std::vector<std::string> lines);
  /// As HeadLines::push_sound().
  Result<void> say_sound(const std::string& id, media::Pcm sound, bool last);
  /// Cancels what it says and was to say, with events. Call ClockLoop::remove() first, so that no
  /// step runs.
  void hush(const std::string& why);
  /// Ends it, after hush(), and informs its viewers: that it has gone, or, `comes_back`, that it is
  /// made anew. Call ClockLoop::remove() first.
  void finish(bool comes_back = false);
  bool silent() const;  ///< nothing is said, and nothing waits to be said
  double seconds_waiting() const { return lines_->seconds(); }         ///< of speech, about
  std::size_t lines_waiting() const { return lines_->waiting(); }      ///< lines and their parts
  std::size_t bytes_waiting() const { return lines_->bytes(); }        ///< of text
  std::size_t sound_waiting() const { return lines_->piece_bytes(); }  ///< bytes of pieces
  HeadFigures figures() const;                                         ///< now
  double step() override;
  /// Every plane so far is added to `meter`.
  void add_lateness(media::LatenessMeter& meter) const;

 private:
  Head(const std::string& name, const HeadSettings& settings,
       std::shared_ptr<const dam::Model> model, const HeadRoom& room)
      : name_(name),
        model_(std::move(model)),
        clock_(room.clock),
        journal_(room.journal),
        settings_(settings),
        pacer_(room.clock) {}
  bool wanted(const media::SendStats& sent) const;
  Result<void> send_due(const media::SendStats& sent);
  Result<void> tell_events();
  void note_latencies();

  const std::string name_;
  const std::shared_ptr<const dam::Model> model_;
  media::Clock& clock_;
  Journal& journal_;
  std::shared_ptr<HeadLines> lines_;

  mutable std::mutex mutex_;  // for what follows
  HeadSettings settings_;
  std::unique_ptr<speech::LiveSpeaker> speaker_;
  std::unique_ptr<web::WebSink> sink_;
  media::Pacer pacer_;
  bool asleep_ = true;
  double resume_ = 0;  // presentation time at which it sleeps
  double wanted_ = 0;  // instant at which it was last
  media::ExpectedLoss expected_;
  media::LatenessMeter late_;
  double noted_ = 0;  // instant at which the last line began whose latency was noted
  std::string failure_;
};

}  // namespace animeme::serve
