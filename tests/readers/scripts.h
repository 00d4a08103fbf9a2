// The scripts of js/, run by node.
#pragma once

#include <string>

#include "tests/readers/readers_support.h"
#include "tests/support/folders.h"

/// Ends a test, visibly, when there is no node 18 or the npm packages are not there.
#define NEEDS_NPM(package)                                                                \
  if (!animeme::test::has_node())                                                         \
    GTEST_SKIP() << "node 18 or later is not installed (Debian packages nodejs and npm; " \
                    "tools/setup.sh tests installs them)";                                \
  if (!fs::exists(animeme::test::script("node_modules/" package)))                        \
  GTEST_SKIP() << "the npm package " package                                              \
                  " is not there (tools/setup.sh tests installs it "                      \
                  "into tests/readers/js/node_modules)"

namespace animeme::test {

inline std::string script(const std::string& name) {
  return std::string(test::kSourceFolder) + "/tests/readers/js/" + name;
}

inline bool has_node() {
  return std::system(
             "node -e 'process.exit(process.versions.node.split(\".\")[0] >= 18 ? 0 : 1)' "
             ">/dev/null 2>&1") == 0;
}

/// The JSON that `node js/<name> <arguments>` prints.
inline Json run_script(const std::string& name, const std::string& arguments) {
  return run_json("node '" + script(name) + "' " + arguments);
}

}  // namespace animeme::test
