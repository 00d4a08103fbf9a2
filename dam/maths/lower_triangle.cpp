#include "dam/maths/lower_triangle.h"

#include <cstdint>
#include <cstdlib>
#include <new>

#if __has_include(<sys/mman.h>)
#include <sys/mman.h>
#endif

namespace animeme::dam {
namespace {

#ifdef MADV_HUGEPAGE
// A wish: pages of 2 MB where the system has them, so that the memory comes in a thirtieth of the
// time.
void wish_for_large_pages(void* memory, std::size_t bytes) {
  constexpr std::uintptr_t kPage = std::uintptr_t(1) << 21;
  const auto begin = (reinterpret_cast<std::uintptr_t>(memory) + kPage - 1) & ~(kPage - 1);
  const auto end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) & ~(kPage - 1);
  if (begin < end) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}
#else
void wish_for_large_pages(void*, std::size_t) {}
#endif

}  // namespace

double* LowerTriangle::zeros(std::size_t count) {
  // Large blocks come from the system as zeros; nobody writes them once more.
  void* memory = std::calloc(count + 1, sizeof(double));
  if (memory == nullptr) throw std::bad_alloc();
  wish_for_large_pages(memory, count * sizeof(double));
  return static_cast<double*>(memory);
}

void LowerTriangle::Free::operator()(double* values) const { std::free(values); }

}  // namespace animeme::dam
