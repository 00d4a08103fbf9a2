#include "tools/live/sessions/patient_source.h"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace animeme::live {

namespace {

constexpr double kFirstDelay = 0.1, kLongestDelay = 1, kGrowth = 1.5;  // seconds

bool is_empty_file(const std::string& path) {
  std::error_code failed;
  return std::filesystem::file_size(path, failed) == 0 && !failed;
}

}  // namespace

Result<void> PatientSource::try_now() {
  auto opened = open_();
  if (!opened) {
    if (!passing_(opened.error())) return opened.error();
    problem_ = opened.error();
    delay_ = std::clamp(kGrowth * delay_, kFirstDelay, kLongestDelay);
    next_try_ = clock_.now() + delay_;
    return {};
  }
  source_ = std::move(*opened);
  problem_.reset();
  restart_ = heard_;
  return {};
}

Result<media::LiveEvent> PatientSource::next(double seconds) {
  const double end = clock_.now() + std::max(0.0, seconds);
  while (!source_) {
    if (clock_.now() >= next_try_) {
      if (auto ok = try_now(); !ok) return ok.error();
      continue;
    }
    clock_.sleep_until(std::min(end, next_try_));
    if (clock_.now() >= end) return media::LiveEvent(media::LiveIdle{});
  }
  if (std::exchange(restart_, false)) return media::LiveEvent(media::LiveRestart{});
  Result<media::LiveEvent> event = source_->next(std::max(0.0, end - clock_.now()));
  if (event) {
    if (std::holds_alternative<media::LiveUnit>(*event)) {
      heard_ = true;
      delay_ = 0;  // it works
    }
    return event;
  }
  if (!passing_(event.error())) return event;
  problem_ = event.error();
  before_ += source_->stats();
  source_.reset();
  delay_ = std::clamp(kGrowth * delay_, kFirstDelay, kLongestDelay);
  next_try_ = clock_.now() + delay_;
  return media::LiveEvent(media::LiveIdle{});
}

media::ReceiveStats PatientSource::stats() const {
  media::ReceiveStats sum = before_;
  if (source_) sum += source_->stats();
  return sum;
}

Result<std::unique_ptr<PatientSource>> open_patiently(const std::string& where,
                                                      const SourceOptions& options) {
  const bool description = where.ends_with(".sdp") && where.find("://") == std::string::npos;
  const bool web = where.starts_with("ws://") || where.starts_with("http://");
  const auto passing = [=](const Error& error) {
    if (description) return error.code == Code::not_found || is_empty_file(where);
    return web && error.code == Code::io;
  };
  auto source =
      std::make_unique<PatientSource>([=] { return open_source(where, options); }, passing);
  if (auto ok = source->try_now(); !ok) return ok.error();
  return source;
}

}  // namespace animeme::live
