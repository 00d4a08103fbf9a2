/// @file
/// Processes started by mpirun.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fap/result.h"

namespace animeme::mpi {

/// The MPI functions of the module. On an error MPI itself ends all processes.
struct Functions {
  void (*join)(int* rank, int* size);  ///< once per process
  void (*leave)(int status);           ///< once; a status other than 0 ends all processes with it
  /// To another process.
  void (*send)(const std::uint8_t* bytes, std::uint64_t size, int to);
  std::uint64_t (*size_from)(int from);  ///< of the next message
  /// Receives a message of the size returned by size_from().
  void (*receive)(std::uint8_t* bytes, std::uint64_t size, int from);
};

/// This process among the others. Leaves MPI when the program ends; with a non-zero exit code all
/// processes end.
class Ranks {
 public:
  /// Loads MPI. Without mpirun there is one process. Call once. Errors: unsupported (built without
  /// MPI, or it cannot be loaded).
  static Result<Ranks> join();

  int rank() const { return rank_; }  ///< from 0
  int size() const { return size_; }  ///< number of processes

  /// Blocks until everything has been sent.
  void send(std::span<const std::uint8_t> bytes, int to) const;
  std::vector<std::uint8_t> receive(int from) const;  ///< receives what `from` sent

 private:
  Ranks(const Functions& functions, int rank, int size)
      : functions_(&functions), rank_(rank), size_(size) {}
  const Functions* functions_;
  int rank_, size_;
};

}  // namespace animeme::mpi
