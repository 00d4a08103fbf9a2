#include "tests/support/folders.h"

namespace animeme::test {

const char* const kSourceFolder = ANIMEME_SOURCE_DIR;
const char* const kBinaryFolder = ANIMEME_BINARY_DIR;

}  // namespace animeme::test
