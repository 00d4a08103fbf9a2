/// @file
/// A source that waits for what is not there yet, and comes back when its connection broke.
///
///     auto source = open_patiently("talk.sdp", options);       // the file may come later
///     auto steady = media::make_steady(std::move(*source));    // one clock for all that comes
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "tools/formats/media/live/pacer.h"
#include "tools/live/sessions/address.h"

namespace animeme::live {

/// Tries to open again and again, after 0.1 s at first, then after half as long again each time, up
/// to a second. How long that goes on is the caller's to say: next() has LiveIdle meanwhile. A
/// connection that broke is opened again the same way; LiveRestart stands behind it.
class PatientSource : public media::LiveSource {
 public:
  /// Opens the source.
  using Open = std::function<Result<std::unique_ptr<media::LiveSource>>()>;
  /// Is this error one that goes away when the sender comes?
  using Passing = std::function<bool(const Error&)>;

  /// Nothing is opened before the first next(). `clock` has to live longer.
  PatientSource(Open open, Passing passing, media::Clock& clock = media::steady_clock())
      : open_(std::move(open)), passing_(std::move(passing)), clock_(clock) {}

  /// Errors: those of opening and of the source that do not pass.
  Result<media::LiveEvent> next(double seconds) override;
  media::ReceiveStats stats() const override;

  /// Opens now, once. Errors: those that do not pass; with others waiting_for() says what is
  /// missing.
  Result<void> try_now();
  /// Why there is nothing: what is not there yet, or why a connection broke. Nothing: it is there.
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

/// A source for `where`, as open_source(). A session description that is not there yet (or empty)
/// and a web server that does not answer are waited for. Errors: all others of open_source().
Result<std::unique_ptr<PatientSource>> open_patiently(const std::string& where,
                                                      const SourceOptions& options);

}  // namespace animeme::live
