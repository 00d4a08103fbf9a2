/// @file
/// A source that waits until it is available and reconnects.
///
///     auto source = open_patiently("talk.sdp", options);       // the file may appear later
///     auto steady = media::make_steady(std::move(*source));    // one continuous clock
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "tools/formats/media/live/pacer.h"
#include "tools/live/sessions/address.h"

namespace animeme::live {

/// Retries opening after 0.1 s, then after 1.5 times as long each time, up to a second. The caller
/// decides when to stop: meanwhile next() returns LiveIdle. A broken connection is reopened in the
/// same way, followed by a LiveRestart.
class PatientSource : public media::LiveSource {
 public:
  /// Opens the source.
  using Open = std::function<Result<std::unique_ptr<media::LiveSource>>()>;
  /// Is this error temporary, until the sender is available?
  using Passing = std::function<bool(const Error&)>;

  /// Opens nothing before the first next(). `clock` must outlive this.
  PatientSource(Open open, Passing passing, media::Clock& clock = media::steady_clock())
      : open_(std::move(open)), passing_(std::move(passing)), clock_(clock) {}

  /// Errors: those of opening and of the source that are not temporary.
  Result<media::LiveEvent> next(double seconds) override;
  media::ReceiveStats stats() const override;

  /// Tries to open once now. Errors: those that are not temporary; otherwise waiting_for() has the
  /// reason.
  Result<void> try_now();
  /// The reason for waiting: what is missing, or why a connection broke; nullopt: connected.
  const std::optional<Error>& waiting_for() const { return problem_; }

 private:
  Open open_;
  Passing passing_;
  media::Clock& clock_;
  std::unique_ptr<media::LiveSource> source_;
  media::ReceiveStats before_;  // of connections that broke
  std::optional<Error> problem_;
  double delay_ = 0, next_try_ = 0;
  bool heard_ = false, restart_ = false;
};

/// A source for `where`, as open_source(), that waits for a missing (or empty) session description
/// and for a web server that does not answer. Errors: all others of open_source().
Result<std::unique_ptr<PatientSource>> open_patiently(const std::string& where,
                                                      const SourceOptions& options);

}  // namespace animeme::live
