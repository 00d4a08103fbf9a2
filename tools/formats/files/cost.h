/// @file
/// What steps of the work cost, counted where they are done: seconds of processors, and bytes made.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace animeme::tools {

/// The steps from a text to a film; `other` is what is none of them.
enum class Step : std::uint8_t { other, voice, alignment, speaking, coding, muxing, rendering };
inline constexpr std::size_t kSteps = 7;  ///< number of them
inline constexpr std::array<const char*, kSteps> kStepNames = {
    "other", "voice", "alignment", "speaking", "coding", "muxing", "rendering"};  ///< for people

/// Of one step.
struct Cost {
  double cpu_seconds =
      0;  ///< of this process with all its threads, and of children that have ended
  std::uint64_t bytes = 0;  ///< that it made: sound, coded planes, files
};

/// From here to its end, this thread is at a step; a step within a step counts for itself alone.
class AtStep {
 public:
  explicit AtStep(Step step);  ///< begins
  AtStep(const AtStep&) = delete;
  ~AtStep();
  void made(std::uint64_t bytes);  ///< adds bytes to the step

 private:
  Step step_, before_;
};

/// Seconds of processes that the system does not count as ours.
void add_cpu_seconds(double seconds);

/// What this thread's steps have cost since the last call.
std::array<Cost, kSteps> take_costs();

}  // namespace animeme::tools
