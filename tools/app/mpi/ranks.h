/// @file
/// Processes that mpirun has started together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fap/result.h"

namespace animeme::mpi {

/// What the module has of MPI. MPI itself ends all processes where it fails.
struct Functions {
  void (*join)(int* rank, int* size);  ///< once a process
  void (*leave)(int status);           ///< once; a status other than 0 ends all processes with it
  /// To another process.
  void (*send)(const std::uint8_t* bytes, std::uint64_t size, int to);
  std::uint64_t (*size_from)(int from);  ///< of what comes next
  /// What was sent, with the size that size_from() gave.
  void (*receive)(std::uint8_t* bytes, std::uint64_t size, int from);
};

/// This process among the others. It leaves them when the program ends: well, or, with an exit code
/// other than 0, so that all end with that.
class Ranks {
 public:
  /// Loads MPI. Without mpirun there is one process. Once a program. Errors: unsupported (the
  /// program was built without MPI, or it does not load).
  static Result<Ranks> join();

  int rank() const { return rank_; }  ///< from 0
  int size() const { return size_; }  ///< how many there are

  /// Waits until all of it has left, or arrived.
  void send(std::span<const std::uint8_t> bytes, int to) const;
  std::vector<std::uint8_t> receive(int from) const;  ///< what send() of that one sent

 private:
  Ranks(const Functions& functions, int rank, int size)
      : functions_(&functions), rank_(rank), size_(size) {}
  const Functions* functions_;
  int rank_, size_;
};

}  // namespace animeme::mpi
