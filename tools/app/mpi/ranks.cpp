#include "tools/app/mpi/ranks.h"

#include <dlfcn.h>

#include <cstdlib>
#include <string>

#include "tools/formats/common/module.h"

namespace animeme::mpi {
namespace {

extern "C" void leave_ranks(int status, void* functions) {
  static_cast<const Functions*>(functions)->leave(status);
}

}  // namespace

Result<Ranks> Ranks::join() {
  std::string problem;
  // Modules that OpenMPI loads in its turn look for its names among those of all.
  void* module =
      tools::load_module("animeme_mpi.so", ANIMEME_MODULE_FOLDER, RTLD_NOW | RTLD_GLOBAL, problem);
  void* entry = module == nullptr ? nullptr : dlsym(module, "animeme_mpi_functions");
  if (entry == nullptr)
    return make_error(
        Code::unsupported,
        "MPI is not there (" + problem + "); install it (Debian: libopenmpi-dev) and build again");
  const Functions& functions = *reinterpret_cast<const Functions* (*)()>(entry)();
  int rank = 0, size = 1;
  functions.join(&rank, &size);
  // However the program ends, its status is known here only.
  ::on_exit(leave_ranks, const_cast<Functions*>(&functions));
  return Ranks(functions, rank, size);
}

void Ranks::send(std::span<const std::uint8_t> bytes, int to) const {
  functions_->send(bytes.data(), bytes.size(), to);
}

std::vector<std::uint8_t> Ranks::receive(int from) const {
  std::vector<std::uint8_t> bytes(functions_->size_from(from));
  functions_->receive(bytes.data(), bytes.size(), from);
  return bytes;
}

}  // namespace animeme::mpi
