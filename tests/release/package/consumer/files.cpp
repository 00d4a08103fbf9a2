// A file that is not there is an error with its name.
#include <animeme/files/files.h>

int main() {
  const auto none = animeme::tools::read_file("no such file");
  return !none && none.error().where.file == "no such file" ? 0 : 1;
}
