#include "tools/live/serve/figures.h"

#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "tools/formats/common/text.h"
#include "tools/live/serve/server.h"

namespace animeme::serve {
namespace {

using tools::Json;

double milliseconds(double seconds) { return std::round(seconds * 1e4) / 10; }

/// Bytes of this process that are in memory.
double resident() {
  std::ifstream file("/proc/self/statm");
  double all = 0, pages = 0;
  file >> all >> pages;
  return pages * double(::sysconf(_SC_PAGESIZE));
}

double cpu_seconds() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& time) {
    return double(time.tv_sec) + 1e-6 * double(time.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// Sums over all heads.
struct Sums {
  std::size_t heads = 0, awake = 0;
  std::int64_t planes = 0, lines = 0, dropped = 0;
  void add(const HeadFigures& figures) {
    ++heads;
    awake += figures.asleep ? 0 : 1;
    planes += figures.planes;
    lines += std::int64_t(figures.lines);
    dropped += figures.dropped;
  }
};

}  // namespace

std::string histogram(const std::string& name, const std::string& help,
                      const media::LatenessMeter& meter) {
  constexpr double kBorders[] = {0.001, 0.002, 0.003, 0.005, 0.007, 0.01, 0.015,
                                 0.02,  0.03,  0.05,  0.1,   0.2,   0.5,  1};
  const std::string full = "animeme_" + name;
  std::string text = "# HELP " + full + " " + help + "\n# TYPE " + full + " histogram\n";
  for (const double border : kBorders) {
    text += tools::format("%s_bucket{le=\"%g\"} %lld\n", full.c_str(), border,
                          static_cast<long long>(meter.count_below(border)));
  }
  const auto count = static_cast<long long>(meter.count());
  text += tools::format("%s_bucket{le=\"+Inf\"} %lld\n", full.c_str(), count);
  return text + tools::format("%s_sum %.6f\n%s_count %lld\n", full.c_str(), meter.sum(),
                              full.c_str(), count);
}

Json head_json(const HeadFigures& figures) {
  Json json{{"planes", figures.planes},
            {"packets", figures.packets},
            {"late_50_ms", milliseconds(figures.late_50)},
            {"late_99_ms", milliseconds(figures.late_99)},
            {"viewers", figures.viewers},
            {"dropped", figures.dropped},
            {"lines_waiting", figures.lines},
            {"lines_spoken", figures.spoken},
            {"asleep", figures.asleep}};
  if (!figures.warning.empty()) json["warning"] = figures.warning;
  return json;
}

Json HeadServer::figures() const {
  Json heads = Json::array();
  Sums sums;
  media::LatenessMeter late;
  for (const auto& [name, head] : all()) {
    const HeadFigures figures = head->figures();
    sums.add(figures);
    head->add_lateness(late);
    Json json{{"name", name}};
    json.update(head_json(figures));
    heads.push_back(std::move(json));
  }
  return {{"count", sums.heads},
          {"awake", sums.awake},
          {"most", options()->most_heads},
          {"viewers", server_->viewers()},
          {"planes", sums.planes},
          {"late_50_ms", milliseconds(late.percentile(0.5))},
          {"late_99_ms", milliseconds(late.percentile(0.99))},
          {"late_worst_ms", milliseconds(late.worst())},
          {"cpu_seconds", std::round(cpu_seconds() * 1e3) / 1e3},
          {"memory_mb", std::round(resident() / 1e5) / 10},
          {"heads", heads}};
}

std::string HeadServer::metrics() const {
  Sums sums;
  media::LatenessMeter late;
  for (const auto& [name, head] : all()) {
    sums.add(head->figures());
    head->add_lateness(late);
  }
  {
    const std::lock_guard lock(mutex_);
    late.add(gone_late_);
    sums.planes += gone_planes_;
  }
  std::string text;
  const auto add = [&text](const char* name, const char* type, const char* help, double value) {
    text += tools::format("# HELP animeme_%s %s\n# TYPE animeme_%s %s\nanimeme_%s %.10g\n", name,
                          help, name, type, name, value);
  };
  add("heads", "gauge", "Heads that there are.", double(sums.heads));
  add("heads_awake", "gauge", "Heads that talk or are watched.", double(sums.awake));
  add("viewers", "gauge", "Viewers of all heads.", server_->viewers());
  add("lines_waiting", "gauge", "Lines that wait to be spoken.", double(sums.lines));
  add("planes_total", "counter", "Planes that were made.", double(sums.planes));
  add("dropped_total", "counter", "Messages that slow viewers of the present heads did not get.",
      double(sums.dropped));
  add("cpu_seconds_total", "counter", "Time of processors, without voices.", cpu_seconds());
  add("resident_bytes", "gauge", "Memory of the process.", resident());
  text += histogram("late_seconds", "How late planes were sent.", late);
  text += journal_.metrics();
  return text;
}

}  // namespace animeme::serve
