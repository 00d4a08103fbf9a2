// A jaw that moves is active.
#include <animeme/inspect/activity.h>

int main() {
  animeme::fap::Sequence clip;
  clip.frames.resize(2);
  clip.frames[0].set(3, 0);
  clip.frames[1].set(3, 100);
  return animeme::inspect::measure_activity(clip).empty() ? 1 : 0;
}
