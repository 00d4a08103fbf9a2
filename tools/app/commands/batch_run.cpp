#include "tools/app/commands/batch_run.h"

#include <algorithm>
#include <chrono>
#include <span>
#include <thread>

#include "tools/app/commands/interrupt.h"
#include "tools/app/commands/line.h"
#include "tools/app/commands/terminal.h"
#include "tools/formats/common/text.h"
#include "tools/speech/talking/spoken.h"
#include "tools/speech/voice/voice.h"
#include "tools/view/studio/head_file.h"

namespace animeme::tools {

namespace {

class ShownBatch {
 public:
  explicit ShownBatch(const char* what) : what_(what) {}
  void at(const batch::Standing& now) {
    if (now.wanted == 0) return;
    // Rows that are only checked are fast, and say nothing about the time that remains.
    const double rate = double(now.done) / std::max(seconds(), 1e-3);
    line_.update(
        double(now.done) / double(now.wanted),
        format("%llu of %llu, %.1f %s a second, %s left", static_cast<unsigned long long>(now.done),
               static_cast<unsigned long long>(now.wanted), rate, what_,
               clock_text(double(now.wanted - now.done) / std::max(rate, 1e-9)).c_str()));
  }
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }
  void clear() { line_.clear(); }

 private:
  const char* what_;
  ProgressLine line_{"batch"};
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace

void prepare_batch(batch::Settings& settings, unsigned jobs) {
  settings.jobs = jobs != 0 ? jobs : std::max(1U, std::thread::hardware_concurrency());
  settings.shared.version = ANIMEME_VERSION;
  // In workers alone: there the first row begins to keep them.
  settings.shared.run = [](std::span<const char* const> line) {
    voice::keep_voices();
    return run_line(line);
  };
}

Result<batch::Ending> run_batch_shown(const batch::Settings& settings, const char* what,
                                      double& seconds) {
  // Read once, for all workers; what is wrong with them the rows tell.
  for (const auto& [column, value] : settings.defaults) {
    if (column == "model") static_cast<void>(speech::read_model(value));
    if (column == "head") static_cast<void>(studio::load_head({.head = value}, {}));
  }
  static_cast<void>(speech::read_model({}));
  const Interrupt interrupt;
  ShownBatch shown(what);
  batch::Watch watch;
  watch.at = [&](const batch::Standing& now) { shown.at(now); };
  watch.failed = [&](const std::string& line) {
    shown.clear();
    warn(line);
  };
  watch.stop = [] { return Interrupt::requested(); };
  Result<batch::Ending> ending = batch::run_batch(settings, watch);
  shown.clear();
  seconds = shown.seconds();
  return ending;
}

std::string clock_text(double seconds) {
  const auto whole = static_cast<long long>(std::max(seconds, 0.0) + 0.5);
  return whole < 3600 ? format("%lld:%02lld", whole / 60, whole % 60)
                      : format("%lld:%02lld:%02lld", whole / 3600, whole / 60 % 60, whole % 60);
}

double cpu_seconds(const batch::Standing& standing) {
  double sum = 0;
  for (const Cost& one : standing.costs) sum += one.cpu_seconds;
  return sum;
}

Json steps_json(const batch::Standing& standing) {
  Json steps = Json::object();
  for (std::size_t i = 0; i < kSteps; ++i) {
    steps[kStepNames[i]] = {{"cpu_seconds", standing.costs[i].cpu_seconds},
                            {"bytes", standing.costs[i].bytes}};
  }
  return steps;
}

}  // namespace animeme::tools
