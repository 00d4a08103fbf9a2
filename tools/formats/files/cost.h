/// @file
/// Accounting of CPU time and bytes for each step of the work.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace animeme::tools {

/// The steps from a text to a video; `other` is everything else.
enum class Step : std::uint8_t { other, voice, alignment, speaking, coding, muxing, rendering };
inline constexpr std::size_t kSteps = 7;  ///< number of them
inline constexpr std::array<const char*, kSteps> kStepNames = {
    "other", "voice", "alignment", "speaking", "coding", "muxing", "rendering"};  ///< for output

/// Cost of one step.
struct Cost {
  double cpu_seconds = 0;   ///< of all threads of this process and of finished children
  std::uint64_t bytes = 0;  ///< of output: sound, coded planes, files
};

/// During its lifetime, this thread's cost counts for a step; nested steps count separately.
class AtStep {
 public:
  explicit AtStep(Step step);  ///< begins
  AtStep(const AtStep&) = delete;
  ~AtStep();
  void made(std::uint64_t bytes);  ///< adds bytes to the step

 private:
  Step step_, before_;
};

/// Adds CPU seconds of processes that the system does not attribute to this one.
void add_cpu_seconds(double seconds);

/// Costs of this thread's steps since the last call.
std::array<Cost, kSteps> take_costs();

}  // namespace animeme::tools
