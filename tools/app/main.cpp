// The program `animeme`: one command for each task, see commands/.
#include <exception>
#include <new>

#include "tools/app/commands/line.h"
#include "tools/app/commands/terminal.h"
#include "tools/formats/common/exit_code.h"
#include "tools/formats/files/output_file.h"
#include "tools/formats/files/unfinished.h"

#ifdef __GLIBC__  // known from the headers above
#include <malloc.h>
#endif

namespace {

// Meshes, pictures and sums of some megabytes come and go: taken back by the system each time, they
// cost a tenth of the time of training, or of a picture, for pages that are new.
void keep_memory() {
#ifdef __GLIBC__
  ::mallopt(M_MMAP_THRESHOLD, 32 << 20);
  ::mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  using namespace animeme;
  keep_memory();
  std::ios::sync_with_stdio(false);
  tools::clean_up_on_signals();
  try {
    const int code = tools::run_line({argv, std::size_t(argc)});
    const Result<void> flushed = tools::flush_standard_output();
    return flushed || code != tools::kOk ? code : tools::report_error(flushed.error());
  } catch (const std::bad_alloc&) {
    return tools::report_error(
        make_error(Code::internal,
                   "there is not enough memory for this; close other programs, raise the limit "
                   "(ulimit -v), or work on a part"));
  } catch (const std::exception& error) {
    return tools::report_error(
        make_error(Code::internal, std::string("internal error: ") + error.what()));
  }
}
