// How much a clip moves.
#include <animeme/inspect/activity.h>

int main() {
  animeme::fap::Sequence clip{{25, 1}, {}, "clip"};
  clip.frames.resize(2);
  clip.frames[1].number = 1;
  for (int i = 0; i < 2; ++i) clip.frames[i].set(3, 10 * i);
  const auto all = animeme::inspect::measure_activity(clip);
  return all.size() == 1 && all[0].max == 10 ? 0 : 1;
}
