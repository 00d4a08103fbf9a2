// animeme_mpi.so: all of the program that is linked with MPI.
#include <mpi.h>

#include <algorithm>

#include "tools/app/mpi/ranks.h"
#include "tools/formats/common/module.h"

namespace {

constexpr std::uint64_t kMost = 1u << 30;  // bytes of a message: its size is an int

void join(int* rank, int* size) {
  MPI_Init(nullptr, nullptr);
  MPI_Comm_rank(MPI_COMM_WORLD, rank);
  MPI_Comm_size(MPI_COMM_WORLD, size);
}

void leave(int status) {
  if (status != 0) MPI_Abort(MPI_COMM_WORLD, status);
  MPI_Finalize();
}

void send(const std::uint8_t* bytes, std::uint64_t size, int to) {
  MPI_Send(&size, 1, MPI_UINT64_T, to, 0, MPI_COMM_WORLD);
  for (std::uint64_t at = 0; at < size; at += kMost)
    MPI_Send(bytes + at, int(std::min(kMost, size - at)), MPI_BYTE, to, 0, MPI_COMM_WORLD);
}

std::uint64_t size_from(int from) {
  std::uint64_t size = 0;
  MPI_Recv(&size, 1, MPI_UINT64_T, from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return size;
}

void receive(std::uint8_t* bytes, std::uint64_t size, int from) {
  for (std::uint64_t at = 0; at < size; at += kMost)
    MPI_Recv(bytes + at, int(std::min(kMost, size - at)), MPI_BYTE, from, 0, MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
}

constexpr animeme::mpi::Functions kTable = {join, leave, send, size_from, receive};

}  // namespace

ANIMEME_MODULE(kTable);
