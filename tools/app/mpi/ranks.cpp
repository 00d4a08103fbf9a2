#include "tools/app/mpi/ranks.h"

#include "tools/formats/common/module.h"

namespace animeme::mpi {
namespace {

extern "C" void leave_ranks(int status, void* functions) {
  static_cast<const Functions*>(functions)->leave(status);
}

}  // namespace

Result<Ranks> Ranks::join() {
  // Modules that OpenMPI loads in its turn look for its names among those of all.
  const auto loaded = tools::load_functions<Functions>(tools::kMpiModule, RTLD_NOW | RTLD_GLOBAL);
  if (!loaded) return loaded.error();
  const Functions& functions = **loaded;
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
