// The architecture as a test: reads all files of the tree and applies the rules of rules.h.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/structure/modules.h"
#include "tests/structure/rules.h"
#include "tests/structure/tree.h"

namespace animeme::test {
namespace include_rules_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Check = std::vector<std::string>(std::string_view, std::string_view);

std::vector<std::string> violations(Check check, const std::function<bool(std::string_view)>& of) {
  std::vector<std::string> all;
  for (const SourceFile& file : tree()) {
    if (!of(file.path)) continue;
    const std::vector<std::string> found = check(file.path, file.text);
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

TEST(Structure, TheTreeIsThere) {
  std::vector<std::string> paths;
  for (const SourceFile& file : tree()) paths.push_back(file.path);
  for (const char* known : {"CMakeLists.txt", "fap/frame.h", "fap/tables.cpp",
                            "codec/decode/access_unit.h", "tests/structure/rules.cpp"}) {
    EXPECT_THAT(paths, ::testing::Contains(known));
  }
}

TEST(Structure, IncludesKeepTheLayers) {
  EXPECT_THAT(violations(include_violations, is_code), IsEmpty());
}

TEST(Structure, HeadersHaveACommentAndAGuard) {
  EXPECT_THAT(violations(header_violations, is_code), IsEmpty());
}

TEST(Structure, NoFileNamesPathsOfOneMachine) {
  EXPECT_THAT(violations(path_violations, [](std::string_view) { return true; }), IsEmpty());
}

TEST(Structure, FoldersHaveAReadmeAndAModule) {
  std::vector<std::string> paths;
  for (const SourceFile& file : tree()) paths.push_back(file.path);
  EXPECT_THAT(folder_violations(paths), IsEmpty());
}

TEST(Structure, ReadmesArePages) {
  EXPECT_THAT(violations(page_violations, [](std::string_view) { return true; }), IsEmpty());
}

// The rules themselves: each one has to fire, or the tests above prove nothing.
TEST(StructureRules, FindsIncludes) {
  const auto found =
      includes_of("#include <vector>\n  #  include \"fap/text.h\" // x\n// #include\n");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].name, "vector");
  EXPECT_FALSE(found[0].quoted);
  EXPECT_EQ(found[1].name, "fap/text.h");
  EXPECT_EQ(found[1].line, 2);
  EXPECT_TRUE(found[1].quoted);
}

TEST(StructureRules, LayersFire) {
  const auto broken = [](const char* path, const std::string& include) {
    return !include_violations(path, "// x\n#include " + include + "\n").empty();
  };
  EXPECT_FALSE(broken("fap/text.cpp", "<vector>"));
  EXPECT_FALSE(broken("fap/text.cpp", "\"fap/frame.h\""));
  EXPECT_TRUE(broken("fap/text.cpp", "\"frame.h\""));
  EXPECT_TRUE(broken("fap/text.cpp", "\"codec/syntax/bits.h\""));
  EXPECT_TRUE(broken("fap/text.cpp", "<zlib.h>"));
  EXPECT_TRUE(broken("fap/text.cpp", "<unistd.h>"));
  EXPECT_TRUE(broken("fap/text.cpp", "\"fap/head/model.h\""));
  EXPECT_FALSE(broken("fap/head/rig.cpp", "\"fap/head/model.h\""));
  EXPECT_FALSE(broken("fap/head/rig.cpp", "\"fap/frame.h\""));
  EXPECT_TRUE(broken("fap/text.cpp", "<libxml/parser.h>"));
  EXPECT_TRUE(broken("fap/head/wrl.cpp", "<libxml/parser.h>"));
  EXPECT_TRUE(broken("tools/app/main.cpp", "<libxml/parser.h>"));
  EXPECT_TRUE(broken("fap/xml/detail/document.h", "<libxml/parser.h>"));
  EXPECT_FALSE(broken("fap/xml/detail/document.cpp", "<libxml/parser.h>"));
  EXPECT_FALSE(broken("fap/xml/fdp.h", "\"fap/head/rig.h\""));
  EXPECT_TRUE(broken("fap/head/own_head.cpp", "\"fap/xml/fdp.h\""));
  EXPECT_FALSE(broken("codec/syntax/bits.cpp", "\"fap/frame.h\""));
  EXPECT_TRUE(broken("codec/syntax/bits.cpp", "\"codec/decode/decoder.h\""));
  EXPECT_FALSE(broken("codec/text/epf.cpp", "\"codec/syntax/bits.h\""));
  EXPECT_TRUE(broken("codec/syntax/bits.cpp", "\"dam/signal/signal.h\""));
  EXPECT_TRUE(broken("codec/syntax/bits.cpp", "<Eigen/Dense>"));
  EXPECT_FALSE(broken("dam/maths/linear_algebra.cpp", "<Eigen/Dense>"));
  EXPECT_FALSE(broken("dam/maths/solve_internal.h", "<Eigen/Dense>"));
  EXPECT_FALSE(broken("dam/maths/detail/solve.h", "<Eigen/Dense>"));
  EXPECT_TRUE(broken("dam/training/train.cpp", "<Eigen/Dense>"));
  EXPECT_TRUE(broken("dam/training/train.h", "<Eigen/Dense>"));
  EXPECT_TRUE(broken("dam/training/train.h", "\"dam/maths/matrix.h\""));
  EXPECT_TRUE(broken("dam/training/train.cpp", "\"codec/syntax/bits.h\""));
  EXPECT_TRUE(broken("dam/training/train.cpp", "\"tools/formats/media/pcm.h\""));
  EXPECT_FALSE(broken("dam/training/train.cpp", "\"dam/kinds/animeme/fit.h\""));
  EXPECT_TRUE(broken("dam/kinds/animeme/fit.cpp", "\"dam/kinds/table/table.h\""));
  EXPECT_FALSE(broken("tools/formats/media/mux.cpp", "<libavformat/avformat.h>"));
  EXPECT_TRUE(broken("tools/formats/media/mux.h", "<libavformat/avformat.h>"));
  EXPECT_TRUE(broken("tools/app/main.cpp", "<libavformat/avformat.h>"));
  EXPECT_TRUE(broken("tools/app/main.cpp", "<libswscale/swscale.h>"));
  EXPECT_TRUE(broken("tools/live/web/web.h", "<libwebsockets.h>"));
  EXPECT_FALSE(broken("tools/live/web/detail/service.h", "<libwebsockets.h>"));
  EXPECT_FALSE(broken("tools/speech/voice/speak.cpp", "<espeak-ng/speak_lib.h>"));
  EXPECT_TRUE(broken("tools/formats/media/speak.cpp", "<espeak-ng/speak_lib.h>"));
  EXPECT_TRUE(broken("tools/app/main.cpp", "<pocketsphinx.h>"));
  EXPECT_TRUE(broken("tools/app/main.cpp", "<Eigen/Core>"));
  EXPECT_FALSE(broken("tools/app/commands/parse_line.cpp", "<CLI/CLI.hpp>"));
  EXPECT_TRUE(broken("tools/app/commands/info.cpp", "<CLI/CLI.hpp>"));
  EXPECT_TRUE(broken("tools/view/studio/film.cpp", "<CLI/CLI.hpp>"));
  EXPECT_FALSE(broken("tools/app/main.cpp", "\"tools/app/commands/command.h\""));
  EXPECT_TRUE(broken("tools/app/check/suite.cpp", "\"tools/app/commands/command.h\""));
  EXPECT_TRUE(broken("tools/formats/media/mux.cpp", "<CLI/CLI.hpp>"));
  EXPECT_TRUE(broken("codec/text/epf.cpp", "<nlohmann/json.hpp>"));
  EXPECT_TRUE(broken("tools/app/main.cpp", "\"tests/support/shared.h\""));
  EXPECT_FALSE(broken("tools/formats/exchange/arkit.h", "\"dam/script/script.h\""));
  EXPECT_FALSE(broken("tools/formats/common/json.cpp", "<nlohmann/json.hpp>"));
  EXPECT_TRUE(broken("tools/formats/exchange/json.cpp", "<nlohmann/json.hpp>"));
  EXPECT_TRUE(broken("tools/formats/exchange/arkit.h", "<nlohmann/json.hpp>"));
  EXPECT_TRUE(broken("tools/formats/exchange/arkit.cpp", "\"tools/formats/media/container.h\""));
  EXPECT_TRUE(broken("tools/formats/exchange/arkit.cpp", "\"tools/app/commands/common.h\""));
  EXPECT_TRUE(broken("tools/formats/media/mux.cpp", "\"tools/formats/exchange/motion.h\""));
  EXPECT_TRUE(broken("tools/formats/exchange/arkit.cpp", "<CLI/CLI.hpp>"));
  EXPECT_FALSE(broken("conformance/run.cpp", "\"codec/decode/decoder.h\""));
  EXPECT_TRUE(broken("conformance/run.cpp", "\"dam/training/train.h\""));
  EXPECT_FALSE(broken("tests/codec/x_test.cpp", "\"dam/training/train.h\""));
  EXPECT_TRUE(broken("tools/unheard_of/x.cpp", "\"fap/frame.h\""));
}

TEST(StructureRules, NoRowGoesRoundInCircles) {
  // "a/b.h" for the first folder of each row; a row may be that of a file.
  std::vector<std::string> headers;
  for (const Module& module : kModules) {
    std::string first(module.folders.substr(0, module.folders.find(' ')));
    if (first.ends_with("/*")) first.back() = 'x';
    headers.push_back(first.ends_with(".h") ? first : first + "/x.h");
  }
  for (std::size_t i = 0; i < headers.size(); ++i) {
    EXPECT_TRUE(may_include(headers[i], headers[i]));
    for (std::size_t j = i + 1; j < headers.size(); ++j) {
      EXPECT_FALSE(may_include(headers[i], headers[j])) << headers[i] << ' ' << headers[j];
    }
  }
}

TEST(StructureRules, FoldersAndPagesFire) {
  const std::vector<std::string> tidy = {"fap/README.md", "fap/text.h", "tests/data/a.js"};
  EXPECT_THAT(folder_violations(tidy), IsEmpty());
  EXPECT_THAT(folder_violations({"fap/text.h", "fap/text.cpp"}),
              ElementsAre("fap: has no README.md"));
  EXPECT_THAT(folder_violations({"tools/view/viewer/js/a.js"}), ::testing::SizeIs(1));
  EXPECT_THAT(folder_violations({"tools/unheard_of/README.md", "tools/unheard_of/a.cpp"}),
              ElementsAre(HasSubstr("has no row")));
  std::string page = "# fap\n\n| a | b |\n\n```\ncode\n```\n";
  for (int line = 1; line < 60; ++line) page += "Prose.\n";
  EXPECT_THAT(page_violations("fap/README.md", page), IsEmpty());
  EXPECT_THAT(page_violations("fap/README.md", page + "More.\n"), ::testing::SizeIs(1));
  EXPECT_THAT(page_violations("fap/semantics.md", page + "More.\n"), IsEmpty());
}

TEST(StructureRules, HeadersFire) {
  EXPECT_THAT(header_violations("fap/x.h", "/// @file\n/// Text.\n#pragma once\n"), IsEmpty());
  EXPECT_THAT(header_violations("fap/x.h", "// Text.\n#pragma once\n"),
              ElementsAre(HasSubstr("@file")));
  EXPECT_THAT(header_violations("fap/x.h", "/// @file\n#pragma once\n"),
              ElementsAre(HasSubstr("@file")));
  for (const char* internal : {"fap/detail/x.h", "fap/x_internal.h", "tests/support/x.h"}) {
    EXPECT_THAT(header_violations(internal, "// Text.\n#pragma once\n"), IsEmpty());
    EXPECT_THAT(header_violations(internal, "\n#pragma once\n"), ::testing::SizeIs(1));
  }
  EXPECT_THAT(header_violations("fap/x.h", "#pragma once\n"), ::testing::SizeIs(2));
  EXPECT_THAT(header_violations("fap/x.h", "/// @file\n/// Text.\n#ifndef X\n"),
              ElementsAre(HasSubstr("#pragma once")));
  EXPECT_THAT(header_violations("fap/x.cpp", ""), IsEmpty());
}

TEST(StructureRules, PathsFire) {
  EXPECT_THAT(path_violations("fap/x.h", "// a\n// see /work/x\n"),
              ElementsAre(HasSubstr("fap/x.h:2: ")));
  EXPECT_THAT(path_violations("fap/x.cpp", "open(\"../shared/a\")"), ::testing::SizeIs(1));
  EXPECT_THAT(path_violations("fap/x.cpp", "artwork/work/x a../shared"), IsEmpty());
  EXPECT_THAT(path_violations("tests/support/shared.h", "../shared"), IsEmpty());
}

}  // namespace include_rules_test
}  // namespace animeme::test
