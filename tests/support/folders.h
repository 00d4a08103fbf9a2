/// @file
/// Where the sources lie, and what was built of them.
///
/// Set in one small file apart (folders.cpp): all others compile to the same in every folder, so a
/// compiler cache that has seen another clone knows them again.
#pragma once

namespace animeme::test {

extern const char* const kSourceFolder;  ///< top of the tree
extern const char* const kBinaryFolder;  ///< top of the build

}  // namespace animeme::test
