// A file that is not there is an error.
#include <animeme/files/files.h>

int main() { return animeme::tools::read_file("no such folder/no such file") ? 1 : 0; }
