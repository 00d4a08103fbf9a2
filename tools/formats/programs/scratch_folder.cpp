#include "tools/formats/programs/scratch_folder.h"

#include <unistd.h>

namespace animeme::tools {

namespace fs = std::filesystem;

Result<std::unique_ptr<ScratchFolder>> ScratchFolder::make() {
  std::error_code error;
  const fs::path base = fs::temp_directory_path(error);
  std::string pattern = ((error ? fs::path("/tmp") : base) / "animeme-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) {
    return make_error(Code::io, "no folder for temporary files can be made; set TMPDIR");
  }
  return std::make_unique<ScratchFolder>(fs::path(pattern));
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace animeme::tools
