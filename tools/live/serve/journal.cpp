#include "tools/live/serve/journal.h"

#include <cmath>
#include <utility>

#include "tools/formats/common/text.h"
#include "tools/live/serve/figures.h"

namespace animeme::serve {

void Journal::write(tools::Json entry) {
  if (log_) log_(entry);
}

void Journal::request(const std::string& method, const std::string& path, unsigned status,
                      double seconds) {
  const std::lock_guard lock(mutex_);
  ++requests_[status];
  write({{"kind", "request"},
         {"method", method},
         {"path", path.substr(0, 200)},
         {"status", status},
         {"ms", std::round(seconds * 1e4) / 10}});
}

void Journal::head(const std::string& name, const std::string& what) {
  const std::lock_guard lock(mutex_);
  write({{"kind", "head"}, {"head", name}, {"what", what}});
}

void Journal::line(const std::string& head, const speech::LineEvent& event) {
  using What = speech::LineEvent::What;
  const char* what = nullptr;
  if (event.what == What::queued) what = "queued";
  if (event.what == What::started) what = "started";
  if (event.what == What::done) what = "done";
  if (event.what == What::cancelled && event.line > 0) what = "cancelled";
  if (what == nullptr) return;
  const std::lock_guard lock(mutex_);
  done_ += event.what == What::done ? 1 : 0;
  cancelled_ += event.what == What::cancelled ? 1 : 0;
  tools::Json entry{{"kind", "line"}, {"head", head}, {"line", event.line},
                    {"id", event.id}, {"what", what}, {"at", std::round(event.time * 1e3) / 1e3}};
  if (!event.why.empty()) entry["why"] = event.why;
  write(std::move(entry));
}

void Journal::latency(const speech::LineTrace& trace) {
  if (trace.waited) return;
  const std::lock_guard lock(mutex_);
  if (trace.face_sent > 0) face_.add(trace.face_sent - trace.arrived);
  if (trace.sound_sent > 0) sound_.add(trace.sound_sent - trace.arrived);
}

std::string Journal::metrics() const {
  const std::lock_guard lock(mutex_);
  std::string text =
      "# HELP animeme_build_info The version of the program.\n# TYPE animeme_build_info gauge\n"
      "animeme_build_info{version=\"" ANIMEME_VERSION
      "\"} 1\n"
      "# HELP animeme_http_requests_total Requests that were answered, but for those of viewers.\n"
      "# TYPE animeme_http_requests_total counter\n";
  for (const auto& [status, count] : requests_) {
    text += tools::format("animeme_http_requests_total{status=\"%u\"} %lld\n", status,
                          static_cast<long long>(count));
  }
  text += tools::format(
      "# HELP animeme_lines_total Lines that have ended.\n# TYPE animeme_lines_total counter\n"
      "animeme_lines_total{end=\"done\"} %lld\nanimeme_lines_total{end=\"cancelled\"} %lld\n",
      static_cast<long long>(done_), static_cast<long long>(cancelled_));
  text += histogram("text_to_face_seconds", "From a line to the first plane that shows it.", face_);
  return text + histogram("text_to_sound_seconds", "From a line to the first packet of its sound.",
                          sound_);
}

}  // namespace animeme::serve
