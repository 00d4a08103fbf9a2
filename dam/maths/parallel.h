// Independent tasks on several threads. Results never depend on how many there are: a task writes
// only to its own place, and whoever reduces the places does so in their order.
#pragma once

#include <cstddef>
#include <functional>

namespace animeme::dam {

/// Runs task(0) .. task(count - 1), each once, on up to `threads` threads (0: as the machine has).
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& task);

}  // namespace animeme::dam
