// The command check, end to end: this codec passes its suite, and decoders that are wrong in a
// known way, made here as small shell scripts, get the right verdict.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "fap/tables.h"
#include "tests/support/folders.h"
#include "tests/support/program.h"

namespace animeme {
namespace check_test {

namespace fs = std::filesystem;
using nlohmann::json;
using test::slurp;
using test::spill;
using test::TempDir;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;

const std::string kSuite = std::string(test::kSourceFolder) + "/conformance";
const std::string kCases = std::string(test::kBinaryFolder) + "/conformance/cases";

test::ProgramResult check(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "check");
  return test::animeme(std::move(arguments));
}

// A decoder: a shell script that is given the stream, the file for the face and one for the body.
// All of them cheat: by the sum of a stream they find the case that it is from, and the expected
// values that lie beside it.
std::string decoder(const TempDir& dir, const std::string& name, const std::string& script) {
  // A file for each sum, so that a run of the script starts one program and no more.
  static const TempDir index;
  [[maybe_unused]] static const std::string made = test::run(
      "cd " + test::quoted(kCases) + " && sha256sum */*.fba | while read -r sum file; do " +
      "[ -e " + test::quoted(index / "") + "$sum ] || echo \"$file\" >" + test::quoted(index / "") +
      "$sum; done");
  const std::string path = dir / name;
  spill(path, "#!/bin/sh\nsum=$(sha256sum <\"$1\")\nread -r name <" + test::quoted(index / "") +
                  "${sum%% *}\ncase=" + test::quoted(kCases) +
                  "/$name\nexpected=${case%.fba}.dec.fap\n" + script + "\n");
  ::chmod(path.c_str(), 0700);
  return "'" + path + "' {in} {out} {bap}";
}
const std::string kRightFace = "[ ! -f \"$expected\" ] || cp \"$expected\" \"$2\"";

struct Checked {
  test::ProgramResult program;
  std::map<std::string, json> result;  // by case
  std::string verdict(const std::string& name) const {
    return result.count(name) == 0 ? "no such case" : result.at(name)["verdict"].get<std::string>();
  }
  std::string detail(const std::string& name) const {
    return result.count(name) == 0 ? "" : result.at(name)["detail"].get<std::string>();
  }
};

Checked run(const std::string& command, const std::string& filter,
            std::vector<std::string> more = {}, const std::string& place = kCases) {
  std::vector<std::string> arguments = {place, "--json", "-"};
  if (!command.empty()) arguments.insert(arguments.end(), {"--decoder", command});
  if (!filter.empty()) arguments.insert(arguments.end(), {"--filter", filter});
  arguments.insert(arguments.end(), more.begin(), more.end());
  Checked out;
  out.program = check(arguments);
  const json parsed = json::parse(out.program.out, nullptr, false);
  EXPECT_FALSE(parsed.is_discarded()) << out.program.out << out.program.err;
  if (parsed.is_discarded()) return out;
  for (const json& one : parsed["results"]) out.result[one["name"]] = one;
  return out;
}

// Copies one case with its data, to be changed.
fs::path copy_case(const TempDir& dir, const std::string& name) {
  fs::create_directories(dir.path() / "suite");
  fs::copy(fs::path(kCases) / name, dir.path() / "suite" / name, fs::copy_options::recursive);
  return dir.path() / "suite" / name;
}

TEST(Check, ThisCodecIsRightInAllCases) {
  const auto result = check({kSuite});
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  int cases = 0, parameters = 0;
  for (const auto& entry : fs::directory_iterator(kCases)) {
    ++cases;
    parameters += fs::exists(entry.path() / (entry.path().filename().string() + ".epf"));
  }
  ASSERT_GE(cases, 200);
  const std::string n = std::to_string(cases), p = std::to_string(parameters);
  EXPECT_THAT(result.out, EndsWith(n + " of " + n + " cases right (" + n + " exact); " + p +
                                   " of " + p + " streams re-encoded byte for byte\n"));
  EXPECT_THAT(result.out, HasSubstr("mask type of each face group"));
}

TEST(Check, FindsADefectOfThisCodec) {
  // There is none at hand, so the expectation is changed; a bare folder has no sums.
  const TempDir dir;
  const fs::path one = copy_case(dir, "quant_07");
  fs::remove(one / "case.json");
  EXPECT_EQ(check({(dir.path() / "suite").string()}).exit_code, 0);
  const std::string epf = slurp(one / "quant_07.epf");
  std::string changed = epf;
  changed.replace(changed.find("GDR 0"), 5, "GDR 1");
  spill(one / "quant_07.epf", changed);
  Checked result = run("", "", {}, (dir.path() / "suite").string());
  EXPECT_EQ(result.program.exit_code, 1);
  EXPECT_EQ(result.verdict("quant_07"), "encoder");
  EXPECT_THAT(result.detail("quant_07"), HasSubstr("differs from byte"));
  EXPECT_EQ(run("", "", {"--no-encode"}, (dir.path() / "suite").string()).program.exit_code, 0);

  spill(one / "quant_07.epf", epf);
  std::string text = slurp(one / "quant_07.dec.fap");
  text[text.size() - 2] = text[text.size() - 2] == '0' ? '1' : '0';
  spill(one / "quant_07.dec.fap", text);
  result = run("", "", {}, (dir.path() / "suite").string());
  EXPECT_EQ(result.program.exit_code, 1);
  EXPECT_EQ(result.verdict("quant_07"), "wrong");
  EXPECT_EQ(result.result["quant_07"]["first_difference"]["parameter"],
            "FAP 66 " + std::string(fap::info(66).name));
}

TEST(Check, AForeignDecoderThatIsRight) {
  const TempDir dir;
  const std::string right = decoder(dir, "my decoder", kRightFace + R"(
bap=${case%.fba}.dec.bap
[ ! -f "$bap" ] || cp "$bap" "$3")");
  // The reference texts carry whole frame rates only.
  const Checked result = run(right, "object.*");
  EXPECT_EQ(result.program.exit_code, 0) << result.program.err;
  EXPECT_GE(result.result.size(), 190u);
  for (const auto& [name, one] : result.result) {
    if (name.starts_with("rate_") || name == "no_rate_sent") continue;
    EXPECT_EQ(one["verdict"], "exact") << name << one["detail"];
  }
  EXPECT_EQ(result.verdict("rate_24_0_1"), "values");
  EXPECT_THAT(result.detail("rate_24_0_1"), HasSubstr("another frame rate"));
}

TEST(Check, ReadsStandardOutputWithoutOut) {
  const TempDir dir;
  decoder(dir, "cat", "cat \"$expected\"");
  EXPECT_EQ(run(dir / "cat" + std::string(" {in}"), "quant_0*").verdict("quant_03"), "exact");
}

TEST(Check, ConstantOutputIsWrong) {
  const TempDir dir;
  const Checked result = run(decoder(dir, "constant", R"(
awk '$1 == "2.1" {print; next} NF == 68 && !values {print; values = 1; next}
     {printf "%s", $1; for (i = 2; i <= NF; ++i) printf " 0"; print ""; values = 0}' "$expected" >"$2")"),
                             "quant_0[1-9]");
  EXPECT_EQ(result.program.exit_code, 1);
  ASSERT_EQ(result.result.size(), 9u);
  for (const auto& [name, one] : result.result) EXPECT_EQ(one["verdict"], "wrong") << name;
  const json& first = result.result.at("quant_01")["first_difference"];
  EXPECT_EQ(first["got"], 0);
  EXPECT_NE(first["expected"], 0);
  EXPECT_EQ(first["frame"], 0);
  EXPECT_THAT(first["parameter"].get<std::string>(), testing::StartsWith("FAP "));
  EXPECT_THAT(result.detail("quant_01"), AllOf(HasSubstr("frame 0, FAP "), HasSubstr("got 0")));
}

TEST(Check, AFrameTooFewOrTooManyIsWrong) {
  const TempDir dir;
  const Checked few =
      run(decoder(dir, "few", "sed '$d' \"$expected\" | sed '$d' >\"$2\""), "quant_07");
  EXPECT_EQ(few.verdict("quant_07"), "wrong");
  EXPECT_THAT(few.detail("quant_07"), HasSubstr("in place of"));
  const Checked many = run(decoder(dir, "many", R"(
cp "$expected" "$2"
tail -n 2 "$expected" | awk 'NR == 2 {$1 += 1; $2 += 9} {print}' >>"$2")"),
                           "quant_07");
  EXPECT_EQ(many.verdict("quant_07"), "wrong");
  EXPECT_THAT(many.detail("quant_07"), HasSubstr("behind the last one"));
}

TEST(Check, ExitCodesSignalsAndTimeAreToldApart) {
  const TempDir dir;
  const Checked error =
      run(decoder(dir, "refuses", "echo first >&2; echo no such profile >&2; exit 7"), "quant_07");
  EXPECT_EQ(error.program.exit_code, 1);
  EXPECT_EQ(error.verdict("quant_07"), "error");
  EXPECT_EQ(error.detail("quant_07"), "exit code 7: no such profile");
  EXPECT_EQ(error.result.at("quant_07")["exit_code"], 7);

  const Checked crash = run(decoder(dir, "crashes", "kill -SEGV $$"), "quant_07");
  EXPECT_EQ(crash.verdict("quant_07"), "crash");
  EXPECT_EQ(crash.result.at("quant_07")["signal"], 11);
  EXPECT_THAT(crash.detail("quant_07"), HasSubstr("signal 11"));

  const Checked hang =
      run(decoder(dir, "hangs", "sleep 1000"), "quant_0[67]", {"--timeout", "0.2", "--jobs", "2"});
  EXPECT_EQ(hang.program.exit_code, 1);
  EXPECT_EQ(hang.verdict("quant_06"), "timeout");
  EXPECT_EQ(hang.verdict("quant_07"), "timeout");

  EXPECT_EQ(run(decoder(dir, "silent", "exit 0"), "quant_07").verdict("quant_07"), "error");
  const Checked noise = run(decoder(dir, "noise", "echo '<html>' >\"$2\""), "quant_07");
  EXPECT_EQ(noise.verdict("quant_07"), "error");
  EXPECT_THAT(noise.detail("quant_07"), HasSubstr("cannot be read"));
}

TEST(Check, ACrashInOneCaseDoesNotEndTheRun) {
  const TempDir dir;
  const Checked result = run(
      decoder(dir, "sometimes", "case $case in *quant_05*) kill -ABRT $$;; esac\n" + kRightFace),
      "quant_0[0-9]");
  EXPECT_EQ(result.program.exit_code, 1);
  ASSERT_EQ(result.result.size(), 10u);
  for (const auto& [name, one] : result.result) {
    EXPECT_EQ(one["verdict"], name == "quant_05" ? "crash" : "exact") << name;
  }
}

// Where the standard does not say what is right, another decoder may be.
TEST(Check, UnsettledCasesDoNotFailAnotherDecoder) {
  const TempDir dir;
  const std::string wrong =
      decoder(dir, "other", "case $case in *range_kept_*) exit 7;; esac\n" + kRightFace);
  const Checked result = run(wrong, "range_kept_*");
  EXPECT_EQ(result.program.exit_code, 0) << result.program.err;
  std::size_t unsettled = 0;
  for (const auto& [name, one] : result.result) {
    if (one["right"]) continue;
    EXPECT_EQ(one["counts"], false) << name;
    EXPECT_EQ(one["certainty"], "?") << name;
    ++unsettled;
  }
  EXPECT_GT(unsettled, 0u);
  EXPECT_EQ(run(wrong, "range_kept_*", {"--count", "all"}).program.exit_code, 1);
  const std::string crashes =
      decoder(dir, "crashes", "case $case in *range_kept_*) kill -ABRT $$;; esac\n" + kRightFace);
  EXPECT_EQ(run(crashes, "range_kept_*").program.exit_code, 1);
  const std::string settled =
      decoder(dir, "settled", "case $case in *quant_05*) exit 7;; esac\n" + kRightFace);
  EXPECT_EQ(run(settled, "quant_0[0-9]").program.exit_code, 1);
}

// As the public codec does whatever the mask type: an uncoded side takes the value of the other.
TEST(Check, CopiedSidesAreRightValues) {
  std::string pairs;
  for (const fap::FapInfo& info : fap::kFaps) {
    if (info.mirror != 0) {
      pairs += "mirror[" + std::to_string(info.number) + "]=" + std::to_string(info.mirror) + ";";
    }
  }
  const TempDir dir;
  const std::string copies = decoder(dir, "copies", R"(
awk 'BEGIN {)" + pairs + R"(}
$1 == "2.1" {print; next}
NF == 68 && !values {split($0, mask, " "); values = 1; next}
{
  at = 2; delete value
  for (f = 3; f <= 68; ++f) if (mask[f] == 1) {value[f] = $at; ++at}
  for (f = 3; f <= 68; ++f) if (mask[f] == 1 && mirror[f] && mask[mirror[f]] != 1) value[mirror[f]] = value[f]
  line = "0 0"; numbers = $1
  for (f = 3; f <= 68; ++f) if (f in value) {line = line " 1"; numbers = numbers " " value[f]} else line = line " 0"
  print line; print numbers; values = 0
}' "$expected" >"$2")");
  const Checked result = run(copies, "mask_left_sides");
  EXPECT_EQ(result.program.exit_code, 0);
  EXPECT_EQ(result.verdict("mask_left_sides"), "values");
  EXPECT_EQ(result.detail("mask_left_sides"), "more parameters than were coded");
}

TEST(Check, OtherFrameNumbersAreRightValues) {
  const TempDir dir;
  const Checked result = run(decoder(dir, "counts", R"(
awk '$1 == "2.1" {print; next} NF == 68 && !values {print; values = 1; next}
     {$1 = n++; print; values = 0}' "$expected" >"$2")"),
                             "skip_every_kind");
  EXPECT_EQ(result.verdict("skip_every_kind"), "values");
  EXPECT_EQ(result.detail("skip_every_kind"), "other frame numbers");
}

TEST(Check, ABodyAloneIsSkippedWithoutBap) {
  const TempDir dir;
  decoder(dir, "face", kRightFace);
  const Checked result = run(dir / "face" + std::string(" {in} {out}"), "both_in_each_plane",
                             {"--filter", "body_time"});
  EXPECT_EQ(result.program.exit_code, 0);
  EXPECT_EQ(result.verdict("body_time"), "skipped");
  EXPECT_EQ(result.verdict("both_in_each_plane"), "exact");
}

TEST(Check, DamagedStreams) {
  const TempDir dir;
  const std::string name = "bad_marker_in_masks";
  const auto verdict = [&](const std::string& program, const std::string& script) {
    return run(decoder(dir, program, "base=${case%.fba}\n" + script), name).verdict(name);
  };
  // Three planes before the damage, each of two lines behind the header.
  const std::string head = "head -n 7 $base.intact.fap >\"$2\"";
  EXPECT_EQ(verdict("resumes", "cp $base.intact.fap \"$2\"; exit 1"), "exact");
  EXPECT_EQ(verdict("blind", "cp $base.ignored.fap \"$2\""), "ignored");
  EXPECT_EQ(verdict("stops", head), "stopped");
  EXPECT_EQ(verdict("refuses", "echo bad marker >&2; exit 1"), "stopped");
  EXPECT_EQ(verdict("nothing", "exit 0"), "wrong");
  const std::string one_more =
      "; tail -n 2 $base.intact.fap | awk 'NR == 2 {$1 = 3; $NF = 77777} {print}' >>\"$2\"";
  EXPECT_EQ(verdict("garbage", head + one_more), "wrong");
  EXPECT_EQ(verdict("crashes", "kill -SEGV $$"), "crash");
}

// Users put {in} into shells, and cases come from strangers.
TEST(Check, NamesOfAForeignSuiteReachNoShell) {
  const TempDir dir;
  const std::string evil = "$(touch evil)";
  const fs::path one = copy_case(dir, "quant_07");
  fs::rename(one / "quant_07.fba", one / (evil + ".fba"));
  std::string text = slurp(one / "case.json");
  text.replace(text.find("quant_07.fba"), 12, evil + ".fba");
  spill(one / "case.json", text);
  const std::string place = (dir.path() / "suite").string();
  decoder(dir, "shell", "eval \"echo $1\"; " + kRightFace);
  const Checked result = run("'" + (dir / "shell") + "' {in} {out}", "", {}, place);
  EXPECT_EQ(result.verdict("quant_07"), "exact") << result.program.err;
  EXPECT_FALSE(fs::exists("evil") || fs::exists(dir / "evil"));
  for (const char* name : {"..", "../quant_07", "a/b", "a\\\\b", "-rf", "", "a\\u001b[31mb"}) {
    std::string other = text;
    const std::size_t at = other.find("\"quant_07\"");
    ASSERT_NE(at, std::string::npos);
    other.replace(at, 10, std::string("\"") + name + "\"");
    spill(one / "case.json", other);
    const auto refused = check({place});
    EXPECT_EQ(refused.exit_code, 3) << name;
    EXPECT_THAT(refused.err, HasSubstr("no name of a file"));
  }
}

TEST(Check, ChangedFilesAreReported) {
  const TempDir dir;
  const std::string place = (dir.path() / "suite").string();
  const fs::path one = copy_case(dir, "quant_07");
  copy_case(dir, "quant_08");
  EXPECT_EQ(check({place}).exit_code, 0);
  std::string stream = slurp(one / "quant_07.fba");
  stream[20] = char(stream[20] ^ 1);
  spill(one / "quant_07.fba", stream);
  Checked result = run("", "", {}, place);
  EXPECT_EQ(result.program.exit_code, 3);
  EXPECT_EQ(result.verdict("quant_07"), "bad_data");
  EXPECT_THAT(result.detail("quant_07"), AllOf(HasSubstr("quant_07.fba"), HasSubstr("SHA-256")));
  EXPECT_EQ(result.verdict("quant_08"), "exact");
  EXPECT_THAT(result.program.err, HasSubstr("1 cases differ from the published ones"));

  fs::remove(one / "quant_07.fba");
  result = run("", "", {}, place);
  EXPECT_EQ(result.program.exit_code, 3);
  EXPECT_EQ(result.detail("quant_07"), "quant_07.fba is missing");
}

TEST(Check, ReadsBareFoldersAndArchives) {
  const TempDir dir;
  fs::create_directory(dir.path() / "bare");
  for (const char* name : {"quant_07", "body_time", "bad_dct_face"}) {
    for (const auto& entry : fs::directory_iterator(fs::path(kCases) / name)) {
      if (entry.path().filename() == "case.json") continue;
      fs::copy(entry.path(), dir.path() / "bare" / entry.path().filename());
    }
  }
  const auto bare = check({dir / "bare"});
  EXPECT_EQ(bare.exit_code, 0) << bare.err;
  EXPECT_THAT(bare.out, HasSubstr("3 of 3 cases right (3 exact); 2 of 2 streams"));
  const auto archive = check({kSuite + "/generated.tar.xz", "--filter", "quant_[0-3][0-9]"});
  EXPECT_EQ(archive.exit_code, 0) << archive.err;
  EXPECT_THAT(archive.out, HasSubstr("32 of 32 cases right (32 exact)"));
}

TEST(Check, BadPlacesAndUsage) {
  const TempDir dir;
  EXPECT_EQ(check({"/nowhere"}).exit_code, 3);
  EXPECT_EQ(check({dir.path().string()}).exit_code, 3);
  spill(dir / "x.tar.xz", "no archive");
  EXPECT_EQ(check({dir / "x.tar.xz"}).exit_code, 3);
  fs::remove(dir / "x.tar.xz");
  spill(dir / "case.json", "{}");
  const auto broken = check({dir.path().string()});
  EXPECT_EQ(broken.exit_code, 3);
  EXPECT_THAT(broken.err, HasSubstr("case.json"));

  EXPECT_EQ(check({kCases, "--filter", "no such thing"}).exit_code, 2);
  EXPECT_EQ(check({kCases, "--timeout", "0"}).exit_code, 2);
  for (const auto& [command, word] : std::map<std::string, std::string>{
           {"cp", "{in}"},
           {"/no/such/program {in} {out}", "cannot find an executable program"},
           {"no-such-program-anywhere {in}", "cannot find an executable program"},
           {"cp '{in} {out}", "not closed"},
           {"  ", "names no program"}}) {
    const auto result = check({kCases, "--decoder", command});
    EXPECT_EQ(result.exit_code, 2) << command;
    EXPECT_THAT(result.err, HasSubstr(word)) << command;
    EXPECT_TRUE(result.out.empty());
  }
}

TEST(Check, CommandsAreSplitLikeAShellDoes) {
  const TempDir dir;
  decoder(dir, "a b's", "printf '%s|' \"$@\" >&2; exit 1");
  const std::string program = "\"" + (dir / "a b's") + "\"";
  const Checked result =
      run(program + R"( {in} 'one "1"' "t\"w\\o" th\ ree '' x={out}y $HOME)", "quant_07");
  const std::string& said = result.detail("quant_07");
  EXPECT_THAT(said, HasSubstr(R"(/0.fba|one "1"|t"w\o|th ree||x=/)"));
  EXPECT_THAT(said, EndsWith("fapy|$HOME|"));
}

// Enough of XML to see that elements nest, attributes are quoted, and no bare & or < is left.
std::string xml_defect(const std::string& text) {
  std::vector<std::string> open;
  std::size_t i = 0;
  while (i < text.size()) {
    const unsigned char c = static_cast<unsigned char>(text[i]);
    if (c != '\n' && (c < 0x20 || c >= 0x7F)) return "byte " + std::to_string(c);
    if (text[i] != '<') {
      if (text[i] == '&' || text[i] == '>') return "bare character";
      ++i;
      continue;
    }
    const std::size_t end = text.find('>', i);
    if (end == std::string::npos) return "element without end";
    std::string tag = text.substr(i + 1, end - i - 1);
    i = end + 1;
    if (tag.starts_with("?")) continue;
    const bool closing = tag.starts_with("/"), empty = tag.ends_with("/");
    const std::string name =
        tag.substr(closing ? 1 : 0, tag.find_first_of(" /", 1) - (closing ? 1 : 0));
    std::size_t quote = tag.find('"');
    while (quote != std::string::npos) {
      const std::size_t close = tag.find('"', quote + 1);
      if (close == std::string::npos || tag[quote - 1] != '=') return "attribute in " + tag;
      const std::string value = tag.substr(quote + 1, close - quote - 1);
      if (value.find('<') != std::string::npos) return "< in " + tag;
      for (std::size_t k = value.find('&'); k != std::string::npos; k = value.find('&', k + 1)) {
        const std::string entity = value.substr(k, value.find(';', k) - k + 1);
        if (entity != "&amp;" && entity != "&lt;" && entity != "&gt;" && entity != "&quot;" &&
            entity != "&apos;") {
          return "entity " + entity;
        }
      }
      quote = tag.find('"', close + 1);
    }
    if (closing) {
      if (open.empty() || open.back() != name) return "closing " + name;
      open.pop_back();
    } else if (!empty) {
      open.push_back(name);
    }
  }
  return open.empty() ? "" : "open " + open.back();
}

TEST(Check, JunitIsWellFormedWhateverADecoderSays) {
  EXPECT_EQ(xml_defect("<a b=\"x\"><c/></a>"), "");
  EXPECT_NE(xml_defect("<a b=\"x\"><c></a>"), "");
  EXPECT_NE(xml_defect("<a b=\"&\"/>"), "");
  const TempDir dir;
  const std::string evil =
      decoder(dir, "evil",
              "printf '<b>&amp; \"%s\" \\001\\377\\303\\050 '\"'\"']]>\\n' \"$0\" >&2; exit 3");
  const Checked result = run(evil, "quant_0[0-3]", {"--junit", dir / "r.xml"});
  EXPECT_EQ(result.program.exit_code, 1);
  const std::string xml = slurp(dir / "r.xml");
  EXPECT_EQ(xml_defect(xml), "") << xml;
  EXPECT_THAT(xml, AllOf(HasSubstr("tests=\"4\""), HasSubstr("errors=\"4\""),
                         HasSubstr("name=\"quant_02\""), HasSubstr("type=\"error\""),
                         HasSubstr("&lt;b&gt;&amp;amp;")));
  EXPECT_EQ(check({kCases, "--filter", "quant_0*", "--junit", dir / "ok.xml"}).exit_code, 0);
  const std::string ok = slurp(dir / "ok.xml");
  EXPECT_EQ(xml_defect(ok), "");
  EXPECT_THAT(ok, AllOf(HasSubstr("failures=\"0\""), HasSubstr("errors=\"0\"")));
}

TEST(Check, JsonHasFeaturesAndVerdicts) {
  const auto result = check({kCases, "--json", "-", "--filter", "range_flags.*"});
  ASSERT_EQ(result.exit_code, 0);
  const json all = json::parse(result.out);
  EXPECT_EQ(all["decoder"], "animeme");
  EXPECT_EQ(all["cases"], all["right"]);
  EXPECT_EQ(all["cases"], all["results"].size());
  EXPECT_EQ(all["verdicts"]["exact"], all["cases"]);
  EXPECT_GT(all["features"]["range_flags.1010"]["cases"], 1);
  EXPECT_EQ(all["features"]["header.sequence"]["cases"], 4);
  EXPECT_EQ(all["features"]["damage.dct"]["cases"], 0);
}

TEST(Check, TheReadmeHasTheCoverageTable) {
  const auto result = check({kSuite, "--coverage"});
  ASSERT_EQ(result.exit_code, 0);
  const std::string readme = slurp(kSuite + "/README.md");
  const std::string table = result.out.substr(0, result.out.rfind('\n', result.out.size() - 2) + 1);
  EXPECT_THAT(readme, HasSubstr(table)) << "put the table into conformance/README.md";
}

}  // namespace check_test
}  // namespace animeme
