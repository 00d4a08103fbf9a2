#include "tools/formats/files/cost.h"

#include <sys/resource.h>

#include <atomic>
#include <utility>

namespace animeme::tools {

namespace {

std::atomic<double> foreign_seconds = 0;

double seconds_used() {
  double sum = foreign_seconds;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used{};
    ::getrusage(who, &used);
    sum += double(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * double(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
  }
  return sum;
}

struct Account {
  std::array<Cost, kSteps> costs{};
  Step now = Step::other;
  double since = seconds_used();
  // What went by belongs to the step so far.
  Step change_to(Step next) {
    const double used = seconds_used();
    costs[std::size_t(now)].cpu_seconds += used - since;
    since = used;
    return std::exchange(now, next);
  }
};

Account& account() {
  static thread_local Account one;
  return one;
}

}  // namespace

AtStep::AtStep(Step step) : step_(step), before_(account().change_to(step)) {}

AtStep::~AtStep() { account().change_to(before_); }

void AtStep::made(std::uint64_t bytes) { account().costs[std::size_t(step_)].bytes += bytes; }

void add_cpu_seconds(double seconds) { foreign_seconds = foreign_seconds + seconds; }

std::array<Cost, kSteps> take_costs() {
  account().change_to(account().now);
  return std::exchange(account().costs, {});
}

}  // namespace animeme::tools
