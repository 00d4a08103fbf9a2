// encode, decode, info, compare and stats as a user runs them: every reference stream through the
// program, bodies, streams without a face, and what goes wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "fap/text.h"
#include "tests/app/program/commands.h"
#include "tests/support/folders.h"
#include "tests/support/random_clip.h"
#include "tests/support/reference_streams.h"

namespace animeme {
namespace codec_commands_test {

using test::animeme;
using test::Json;
using test::json_of;
using test::spill;
using test::succeeds;
using test::TempDir;
using test::with;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::string reference(const std::string& name, const char* extension) {
  for (const auto& path : test::reference_streams()) {
    if (path.filename() == name) return with(path, extension).string();
  }
  ADD_FAILURE() << "no reference stream " << name;
  return {};
}

// Exit code 3, one sentence, nothing written.
std::string fails(const TempDir& dir, const std::vector<std::string>& arguments) {
  const auto before = dir.files();
  const auto result = animeme(arguments);
  EXPECT_EQ(result.exit_code, 3) << result.out << result.err;
  EXPECT_TRUE(result.err.starts_with("animeme: error: ")) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(dir.files(), testing::UnorderedElementsAreArray(before));
  return result.err;
}

// --- all reference streams (test_codec and the command check have the generated ones, too)

std::filesystem::path case_file(const std::filesystem::path& stream) {
  return std::filesystem::path(test::kSourceFolder) / "conformance" / "cases" / stream.filename() /
         "case.json";
}

std::vector<std::filesystem::path> streams_of_the_reference_encoder() {
  std::vector<std::filesystem::path> streams;
  for (const auto& stream : test::reference_streams()) {
    const std::string text = test::slurp(case_file(stream));
    if (text.find("coded by the reference encoder") != std::string::npos) streams.push_back(stream);
  }
  return streams;
}

class ReferenceStreamThroughTheProgram : public testing::TestWithParam<std::filesystem::path> {
 protected:
  std::string file(const char* extension) const { return with(GetParam(), extension).string(); }
  bool has(const char* extension) const { return std::filesystem::exists(file(extension)); }
};

TEST_P(ReferenceStreamThroughTheProgram, IsWrittenByteForByte) {
  if (!has(".epf")) GTEST_SKIP() << "this stream comes without encoder parameters";
  const TempDir dir;
  std::vector<std::string> arguments = {"encode", "--epf", file(".epf"), "-o", dir / "a.fba"};
  const auto add = [&](std::initializer_list<std::string> more) {
    arguments.insert(arguments.end(), more);
  };
  if (has(".src.fap")) add({file(".src.fap")});
  if (has(".src.bap")) add({"--bap", file(".src.bap")});
  const auto json = nlohmann::json::parse(test::slurp(case_file(GetParam())));
  add({"--plane-start-codes", json["encode"]["plane_start_codes"].get<std::string>()});
  if (json["encode"]["old_codes"].get<bool>()) add({"--old-codes"});
  succeeds(arguments);
  EXPECT_TRUE(test::slurp(dir / "a.fba") == test::slurp(file(".fba")));
}

TEST_P(ReferenceStreamThroughTheProgram, IsDecodedValueForValue) {
  const TempDir dir;
  std::vector<std::string> arguments = {"decode", file(".fba")};
  const auto add = [&](std::initializer_list<std::string> more) {
    arguments.insert(arguments.end(), more);
  };
  if (has(".dec.fap")) add({"--coded", "-o", dir / "a.fap"});
  if (has(".dec.bap")) add({"--bap", dir / "a.bap"});
  succeeds(arguments);
  if (has(".dec.fap")) {
    const auto got = fap::read_text(test::slurp(dir / "a.fap"));
    const auto expected = fap::read_text(test::slurp(file(".dec.fap")));
    ASSERT_TRUE(got && expected);
    EXPECT_FALSE(expected->frames.empty());
    EXPECT_TRUE(got->frames == expected->frames);  // the rate is a whole number in the latter
  }
  if (has(".dec.bap")) {
    const auto expected = test::read_bap(test::slurp(file(".dec.bap")));
    EXPECT_FALSE(expected.empty());
    EXPECT_TRUE(test::read_bap(test::slurp(dir / "a.bap")) == expected);
  }
}

// All bits are accounted for, and the models explain those of the values: what is left over is at
// most a few bits for each of the at most four segments of a plane, never negative beyond rounding.
TEST_P(ReferenceStreamThroughTheProgram, HasBitsThatAddUp) {
  const Json stats = json_of({"stats", file(".fba")});
  const double framing = stats["framing"]["bits"];
  const double headers = stats["headers"]["bits"];
  const double values = stats["values"]["bits"];
  const double ideal = stats["values"]["ideal_bits"];
  EXPECT_EQ(framing + headers + values, double(std::filesystem::file_size(file(".fba"))) * 8);
  EXPECT_GT(values, ideal * 0.999);
  const double planes = stats["planes"];
  const bool made_to_stuff = GetParam().filename().string().starts_with("stuffing_");
  if (!made_to_stuff) {
    EXPECT_LT(values - ideal, 16 * planes + 0.01 * values);
  }
  double by_parameter = 0;
  for (const char* kind : {"faps", "baps"}) {
    for (const Json& one : stats[kind]) by_parameter += one["ideal_bits_per_s"].get<double>();
  }
  EXPECT_NEAR(by_parameter * stats["seconds"].get<double>(), ideal, 1e-6 * ideal + 1e-6);
  EXPECT_GE(stats["peak_kbit_per_s"].get<double>(), 0.999 * stats["kbit_per_s"].get<double>());
}

INSTANTIATE_TEST_SUITE_P(Streams, ReferenceStreamThroughTheProgram,
                         testing::ValuesIn(streams_of_the_reference_encoder()),
                         [](const auto& one) { return one.param.filename().string(); });

// --- bodies

TEST(BodyCommands, DecodedTextIsComparedWithItsStream) {
  const TempDir dir;
  const std::string stream = reference("face_and_body", ".fba");
  succeeds({"decode", stream, "--exact", "-o", dir / "a.fap", "--bap", dir / "a.bap"});
  EXPECT_EQ(animeme({"compare", dir / "a.fap", stream}).exit_code, 0);
  EXPECT_EQ(animeme({"compare", dir / "a.bap", stream}).exit_code, 0);
  EXPECT_EQ(animeme({"compare", stream, stream}).exit_code, 0);
  EXPECT_EQ(animeme({"info", "-"}, test::slurp(dir / "a.bap")).exit_code, 0);
  // -o alone leaves the body out and says so; without a body --bap is an error.
  const auto result = animeme({"decode", stream, "--exact", "-o", dir / "b.fap"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("30 body frames too, --bap writes them"));
  EXPECT_EQ(test::slurp(dir / "b.fap"), test::slurp(dir / "a.fap"));
  // What is missing is told, what there is written.
  const auto faces = animeme(
      {"decode", reference("visemes_all", ".fba"), "-o", dir / "c.fap", "--bap", dir / "c.bap"});
  EXPECT_EQ(faces.exit_code, 0);
  EXPECT_THAT(faces.err, HasSubstr("visemes_all.fba has no body: " + (dir / "c.bap") + " is not"));
  EXPECT_THAT(dir.files(), testing::UnorderedElementsAre("a.bap", "a.fap", "b.fap", "c.fap"));
  EXPECT_THAT(fails(dir, {"decode", reference("visemes_all", ".fba"), "--bap", dir / "c.bap"}),
              HasSubstr("there is no body here: name a FAP text with -o"));
}

TEST(BodyCommands, CompareTellsBapsApart) {
  const TempDir dir;
  const std::string source = reference("face_and_body", ".src.bap");
  const std::string stream = reference("face_and_body", ".fba");
  const Json json = json_of({"compare", source, stream}, 1);
  EXPECT_FALSE(json["equal"]);
  EXPECT_FALSE(json["face_compared"]);
  const Json& body = json["body"];
  EXPECT_EQ(body["frames_both"], 30);
  EXPECT_EQ(body["mask_differences"], 0);
  EXPECT_GT(body["rms_steps"].get<double>(), 0.1);
  EXPECT_LE(body["max_steps"].get<double>(), 0.5);
  // BAP 4 by hand: the values of the two files.
  const auto a = test::read_bap(test::slurp(source));
  const auto b = test::read_bap(test::slurp(reference("face_and_body", ".dec.bap")));
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    squares += std::pow(double(a[i].value[4]) - b[i].value[4], 2);
  }
  const double rms = std::sqrt(squares / double(a.size()));
  EXPECT_EQ(body["baps"][0]["bap"], 4);
  EXPECT_NEAR(body["baps"][0]["rms"].get<double>(), rms, 1e-9);
  EXPECT_NEAR(body["baps"][0]["rms_steps"].get<double>(), rms / 170, 1e-9);
  EXPECT_EQ(animeme({"compare", source, stream, "--max-rms", "0.5"}).exit_code, 0);
  EXPECT_EQ(animeme({"compare", source, stream, "--max-rms", "0.1"}).exit_code, 1);
  EXPECT_THAT(animeme({"compare", source, stream}).out,
              AllOf(HasSubstr("body frames: 30 and 30"), HasSubstr("\n BAP ")));
}

TEST(BodyCommands, AStreamThatLostItsBodyIsNotEqual) {
  const TempDir dir;
  const std::string stream = reference("face_and_body", ".fba");
  succeeds({"decode", stream, "-o", dir / "a.fap"});
  succeeds({"encode", dir / "a.fap", "-o", dir / "face.fba"});
  EXPECT_EQ(animeme({"compare", dir / "a.fap", dir / "face.fba"}).exit_code, 0);
  const Json json = json_of({"compare", stream, dir / "face.fba"}, 1);
  EXPECT_FALSE(json["equal"]);
  EXPECT_EQ(json["value_differences"], 0);
  EXPECT_EQ(json["body"]["frames_b"], 0);
}

TEST(BodyCommands, AreCodedWithoutAnEpfToo) {
  const TempDir dir;
  const std::string fap = reference("face_and_body", ".src.fap");
  const std::string bap = reference("face_and_body", ".src.bap");
  succeeds({"encode", fap, "--bap", bap, "-o", dir / "both.fba"});
  succeeds({"encode", "--bap", bap, "--intra-period", "10", "-o", dir / "body.fba"});
  for (const std::string& text : {fap, bap}) {
    EXPECT_EQ(animeme({"compare", text, dir / "both.fba", "--max-rms", "0.5"}).exit_code, 0);
  }
  EXPECT_EQ(animeme({"compare", bap, dir / "body.fba", "--max-rms", "0.5"}).exit_code, 0);
  EXPECT_EQ(json_of({"info", dir / "body.fba"})["intra_planes"], 3);
  EXPECT_EQ(json_of({"info", dir / "body.fba"})["clip"]["frames"], 0);
  // A stream is coded anew with both halves, and its values survive.
  succeeds({"encode", dir / "both.fba", "-o", dir / "again.fba"});
  EXPECT_EQ(animeme({"compare", dir / "both.fba", dir / "again.fba"}).exit_code, 0);
  EXPECT_EQ(json_of({"info", dir / "again.fba"})["body_planes"], 30);
}

TEST(BodyCommands, InfoOfText) {
  const Json json = json_of({"info", reference("face_and_body", ".src.bap")});
  EXPECT_EQ(json["kind"], "bap");
  EXPECT_EQ(json["frames"], 30);
  EXPECT_EQ(json["rate"], "25");
  EXPECT_EQ(json["baps"][0]["bap"], 4);
  const auto frames = test::read_bap(test::slurp(reference("face_and_body", ".src.bap")));
  int low = frames[0].value[4];
  for (const auto& frame : frames) low = std::min(low, int(frame.value[4]));
  EXPECT_EQ(json["baps"][0]["min"], low);
}

TEST(BodyCommands, InfoOfAStream) {
  const Json json = json_of({"info", reference("face_and_body", ".fba"), "--planes"});
  EXPECT_EQ(json["fap_quant"], 1);
  EXPECT_EQ(json["bap_quant"], 1);
  EXPECT_EQ(json["body_planes"], 30);
  EXPECT_EQ(json["body"]["frames"], 30);
  const Json& first = json["plane_list"][0];
  EXPECT_EQ(first["type"], "I");
  EXPECT_EQ(first["bit"], 32);
  EXPECT_EQ(first["bap_mask_types"].size(), 24u);
  EXPECT_EQ(first["mask_types"], Json::array({3, 3, 3, 3, 3, 3, 3, 3, 3, 3}));
  EXPECT_EQ(first["bap_i_max"].size(), json["body"]["baps"].size());
  EXPECT_EQ(first["bap_i_max"][0], 1860);
  EXPECT_EQ(first["rate"], "25");
  EXPECT_FALSE(json["plane_list"][1].contains("bap_quant"));
  EXPECT_EQ(json["plane_list"].size(), 30u);
}

TEST(InfoPlanes, AreOneAlignedLineEach) {
  const std::string stream = reference("face_and_body", ".fba");
  const Json json = json_of({"info", stream, "--planes"});
  std::istringstream lines(animeme({"info", stream, "--planes"}).out);
  std::string line;
  while (std::getline(lines, line) && line.find("seconds        bit") == std::string::npos) {
  }
  ASSERT_TRUE(line.starts_with("  number")) << line;
  const std::size_t type_at = line.find("type");
  for (const Json& plane : json["plane_list"]) {
    ASSERT_TRUE(std::getline(lines, line));
    std::istringstream row(line);
    long long number = 0, bit = 0, bits = 0;
    double seconds = 0;
    std::string type, parts;
    row >> number >> seconds >> bit >> bits >> type >> parts;
    EXPECT_EQ(number, plane["number"]);
    EXPECT_NEAR(seconds, plane["seconds"].get<double>(), 6e-4);
    EXPECT_EQ(bit, plane["bit"]);
    EXPECT_EQ(bits, plane["bits"]);
    EXPECT_EQ(type, plane["type"]);
    EXPECT_EQ(parts, "both");
    EXPECT_EQ(line.substr(type_at, 1), type);
  }
  EXPECT_FALSE(std::getline(lines, line)) << line;
}

TEST(InfoPlanes, SayWhatTheHeadersSay) {
  const TempDir dir;
  // The EPF of a stream with every optional field.
  spill(
      dir / "a.fap", "2.1 x 25 1\n1" + [] {
        std::string zeros;
        for (int i = 0; i < 67; ++i) zeros += " 0";
        return zeros;
      }() + "\n0 3 4 20 1\n");
  spill(
      dir / "a.epf",
      "FBM 1\nFFR 0\nISI 1\nFRR 24 0 1\nTC 1 2 1 3\nSKN 17\nFMT 1 1 0 0 0 0 0 0 0 0 0 0\nFQU 2\n");
  succeeds({"encode", dir / "a.fap", "--epf", dir / "a.epf", "--plane-start-codes", "all", "-o",
            dir / "a.fba"});
  EXPECT_THAT(animeme({"info", dir / "a.fba", "--planes"}).out,
              HasSubstr("  start code  rate 23.976  time 01:02:03  skip 17  viseme_def  "
                        "FAP 1 types 1000000000 quant 2 ranges as before\n"));
  const Json plane = json_of({"info", dir / "a.fba", "--planes"})["plane_list"][0];
  EXPECT_EQ(plane["time_code"], "01:02:03");
  EXPECT_EQ(plane["skip"], 17);
  EXPECT_EQ(plane["viseme_def"], true);
  EXPECT_EQ(plane["start_code"], true);
}

// --- no face

TEST(NoFace, BodyAloneIsDecodedAndEncoded) {
  const TempDir dir;
  const std::string stream = reference("body_only_all", ".fba");
  succeeds({"decode", stream, "--bap", dir / "a.bap"});
  EXPECT_THAT(dir.files(), ElementsAre("a.bap"));
  // What was decoded codes to the same bytes: quantising again changes nothing.
  succeeds({"encode", "--bap", dir / "a.bap", "--epf", reference("body_only_all", ".epf"), "-o",
            dir / "a.fba"});
  EXPECT_EQ(test::slurp(dir / "a.fba"), test::slurp(stream));
  EXPECT_EQ(animeme({"decode", stream, "--bap", "-"}).out, test::slurp(dir / "a.bap"));
}

TEST(NoFace, IsSaidClearly) {
  const TempDir dir;
  const std::string stream = reference("body_only_all", ".fba");
  EXPECT_THAT(fails(dir, {"decode", stream, "-o", dir / "a.fap"}),
              HasSubstr("codes a body but no face: write it with --bap"));
  const auto both = animeme({"decode", stream, "-o", dir / "a.fap", "--bap", dir / "a.bap"});
  EXPECT_EQ(both.exit_code, 0);
  EXPECT_THAT(both.err, HasSubstr("has no face: " + (dir / "a.fap") + " is not written"));
  EXPECT_THAT(dir.files(), ElementsAre("a.bap"));
  std::filesystem::remove(dir / "a.bap");
  spill(dir / "face.fap", test::slurp(test::data_dir() / "fap" / "plain.fap"));
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"plot", stream, "-o", dir / "a.svg"},
                                             {"mux", stream, "none.wav", "-o", dir / "a.mp4"},
                                             {"compare", dir / "face.fap", stream},
                                             {"compare", stream, dir / "face.fap"}}) {
    EXPECT_THAT(fails(dir, arguments), HasSubstr("codes a body but no face")) << arguments[0];
  }
  EXPECT_THAT(fails(dir, {"encode", reference("body_only_all", ".src.bap"), "-o", dir / "a.fba"}),
              HasSubstr("this is BAP text without a face: give it after --bap"));
  EXPECT_THAT(animeme({"stats", stream}).out, HasSubstr("20 of a body, no face"));
  EXPECT_EQ(json_of({"info", stream})["clip"]["frames"], 0);
}

// --- what goes wrong

TEST(CodecErrors, MissingHalves) {
  const TempDir dir;
  const std::string fap = reference("face_and_body", ".src.fap");
  const std::string bap = reference("face_and_body", ".src.bap");
  const std::string epf = reference("face_and_body", ".epf");
  const std::string out = dir / "a.fba";
  EXPECT_THAT(fails(dir, {"encode", fap, "--epf", epf, "-o", out}),
              AllOf(HasSubstr(epf), HasSubstr("codes a body: name a BAP text with --bap")));
  EXPECT_THAT(fails(dir, {"encode", "--bap", bap, "--epf", epf, "-o", out}),
              AllOf(HasSubstr(epf), HasSubstr("codes a face: name a FAP text")));
  EXPECT_THAT(fails(dir, {"encode", fap, "--bap", fap, "--epf", epf, "-o", out}),
              AllOf(HasSubstr(fap), HasSubstr("there is no body here: --bap needs BAP text")));
  EXPECT_THAT(fails(dir, {"encode", bap, "--epf", epf, "-o", out}),
              AllOf(HasSubstr(bap), HasSubstr("without a face: give it after --bap")));
  EXPECT_THAT(fails(dir, {"encode", fap, "--bap", "/nowhere.bap", "--epf", epf, "-o", out}),
              HasSubstr("/nowhere.bap"));
  EXPECT_THAT(fails(dir, {"compare", fap, bap}), HasSubstr("no face"));
  // The other way round everything is there.
  succeeds({"encode", fap, "--bap", bap, "--epf", epf, "-o", out});
}

TEST(CodecErrors, FramesThatAreNotThere) {
  const TempDir dir;
  const auto one_frame = [](const char* version, int flags, const char* values) {
    std::string mask = "1";
    for (int i = 1; i < flags; ++i) mask += " 0";
    return std::string(version) + " x 25 1\n" + mask + "\n" + values + "\n";
  };
  spill(dir / "a.fap", one_frame("2.1", 68, "5 0 0 0 0"));
  spill(dir / "a.bap", one_frame("3.1", 186, "7 0"));
  spill(dir / "a.epf",
        "FBM 3\nFFR 5\nBFR 7\nISI 1\nFRR 25 0 0\nFMT 1 1 0 0 0 0 0 0 0 0 0 0\nFQU 1\n");
  const std::vector<std::string> arguments = {"encode", dir / "a.fap", "--bap", dir / "a.bap",
                                              "--epf",  dir / "a.epf", "-o",    dir / "a.fba"};
  succeeds(arguments);  // numbers are those of the texts, wherever they start
  std::filesystem::remove(dir / "a.fba");
  spill(dir / "a.epf", "FBM 3\nFFR 0\nBFR 7\nISI 1\n");
  EXPECT_THAT(fails(dir, arguments),
              HasSubstr("asks for face frame 0, which the FAP file does not have"));
  spill(dir / "a.epf", "FBM 3\nFFR 5\nBFR 0\nISI 1\n");
  EXPECT_THAT(fails(dir, arguments),
              HasSubstr("asks for body frame 0, which the BAP file does not have"));
  spill(dir / "a.epf", "FBM 3\nFFR 5\nISI 1\nCDM 1\n");
  EXPECT_THAT(fails(dir, arguments), AllOf(HasSubstr("a.epf:4:"), HasSubstr("CDM 1")));
  spill(dir / "a.bap", "3.1 x 25 1\n0 0 1\n");
  spill(dir / "a.epf", "FBM 3\nFFR 5\nBFR 7\nISI 1\n");
  EXPECT_THAT(fails(dir, arguments), HasSubstr("a.bap:2:6: the mask has only 3 of 186 values"));
}

TEST(CodecErrors, BothFilesOrNone) {
  const TempDir dir;
  const std::string stream = reference("face_and_body", ".fba");
  std::filesystem::create_directory(dir / "folder");
  for (const std::string& bad : {dir / "no/such/folder/a", dir / "folder"}) {
    fails(dir, {"decode", stream, "-o", dir / "a.fap", "--bap", bad});
    fails(dir, {"decode", stream, "-o", bad, "--bap", dir / "a.bap"});
  }
  spill(dir / "a.fap", "precious");
  EXPECT_EQ(animeme({"decode", stream, "-o", dir / "a.fap", "--bap", dir / "folder"}).exit_code, 3);
  EXPECT_EQ(test::slurp(dir / "a.fap"), "precious");
}

TEST(CodecErrors, UsageIsExitCode2) {
  const TempDir dir;
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"encode", "-o", dir / "a.fba"},
           {"encode", "--epf", "a.epf", "-o", dir / "a.fba"},
           {"decode", "a.fba"},
           {"decode", "a.fba", "-o", dir / "a", "--bap", dir / "a"},
           {"decode", "a.fba", "--bap", dir / "a", "--fill"},
           {"stats"}}) {
    const auto result = animeme(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_THAT(result.err, Not(IsEmpty()));
  }
  EXPECT_THAT(dir.files(), IsEmpty());
}

// --- stats

TEST(Stats, BitsOfAHandWrittenStream) {
  // codec/bitstream.md, section 18, A: an I plane of 80 bits with 62 of header, a P plane of 25
  // with 4.
  const TempDir dir;
  const std::string hex = "000001bab19001b492492402aa9927f094bf000001b1";
  std::string bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    bytes += char(std::stoi(hex.substr(i, 2), nullptr, 16));
  }
  spill(dir / "a.fba", bytes);
  const Json stats = json_of({"stats", dir / "a.fba"});
  EXPECT_EQ(stats["planes"], 2);
  EXPECT_EQ(stats["intra_bits"]["largest"], 80);
  EXPECT_EQ(stats["predictive_bits"]["mean"], 25.0);
  EXPECT_EQ(stats["headers"]["bits"], 66);
  EXPECT_EQ(stats["values"]["bits"], 39);
  EXPECT_EQ(stats["framing"]["bits"], 71);
  EXPECT_NEAR(stats["kbit_per_s"].get<double>(), 176 / 0.08 * 1e-3, 1e-9);
  // Flat models: 15, 15 and 64 symbols, then 29, 29 and 127, and viseme_def twice.
  EXPECT_NEAR(stats["values"]["ideal_bits"].get<double>(),
              std::log2(15.0 * 15 * 64) + 1 + std::log2(29.0 * 29 * 127) + 1, 1e-9);
  EXPECT_NEAR(stats["faps"][0]["ideal_bits_per_s"].get<double>(),
              stats["values"]["ideal_bits"].get<double>() / 0.08, 1e-6);
}

TEST(Stats, PeakIsTheCostliestSecond) {
  const TempDir dir;
  // Two seconds at rest, one of random motion, two at rest.
  fap::Sequence clip{{25, 1}, {}, "x"};
  test::Random random(5);
  for (int i = 0; i < 125; ++i) {
    fap::Frame frame;
    frame.number = i;
    frame.set(3, i >= 50 && i < 75 ? random.range(-500, 500) : 0);
    clip.frames.push_back(frame);
  }
  spill(dir / "a.fap", fap::write_text(clip));
  succeeds({"encode", dir / "a.fap", "-o", dir / "a.fba"});
  const Json stats = json_of({"stats", dir / "a.fba"});
  const Json planes = json_of({"info", dir / "a.fba", "--planes"})["plane_list"];
  std::int64_t most = 0;
  for (std::size_t first = 0; first + 25 <= planes.size(); ++first) {
    std::int64_t sum = first == 0 ? 32 : 0;  // the start code of the object
    for (std::size_t i = first; i < first + 25; ++i) sum += planes[i]["bits"].get<std::int64_t>();
    most = std::max(most, sum);
  }
  EXPECT_NEAR(stats["peak_kbit_per_s"].get<double>(), double(most) * 1e-3, 1e-9);
  EXPECT_GT(stats["peak_kbit_per_s"].get<double>(), 1.5 * stats["kbit_per_s"].get<double>());
}

TEST(Stats, ActivityOfText) {
  const TempDir dir;
  // FAP 6 and 7 are left and right; 3 stands still; 4 and 51 are inner and outer, 4 is held once.
  fap::Sequence clip{{10, 1}, {}, "x"};
  for (int i = 0; i < 5; ++i) {
    fap::Frame frame;
    frame.number = i;
    frame.set(3, 7);
    frame.set(6, i < 3 ? 0 : 30);
    frame.set(7, i < 3 ? 0 : 30);
    if (i != 2) frame.set(4, i * 10);
    frame.set(51, i * 10);
    clip.frames.push_back(frame);
  }
  spill(dir / "a.fap", fap::write_text(clip));
  const Json stats = json_of({"stats", dir / "a.fap"});
  EXPECT_EQ(stats["kind"], "fap");
  EXPECT_FALSE(stats.contains("kbit_per_s"));
  ASSERT_EQ(stats["faps"].size(), 5u);
  const Json& still = stats["faps"][0];
  EXPECT_EQ(still["name"], "open_jaw");
  EXPECT_EQ(still["never_moves"], true);
  EXPECT_EQ(still["moves"], 0.0);
  const Json& held = stats["faps"][1];  // 0 10 10 30 40
  EXPECT_EQ(held["frames"], 4);
  EXPECT_EQ(held["min"], 0);
  EXPECT_EQ(held["max"], 40);
  EXPECT_EQ(held["distinct"], 4);
  EXPECT_EQ(held["moves"], 0.75);
  EXPECT_NEAR(held["rms_speed"].get<double>(),
              std::sqrt((100. * 100 + 0 + 200. * 200 + 100. * 100) / 4), 1e-9);
  EXPECT_EQ(held["equal_to"], Json::array());
  EXPECT_EQ(stats["faps"][2]["equal_to"], Json::array({7}));
  EXPECT_EQ(stats["faps"][3]["equal_to"], Json::array({6}));
  EXPECT_EQ(stats["faps"][2]["moves"], 0.25);
  EXPECT_THAT(animeme({"stats", dir / "a.fap"}).out,
              AllOf(HasSubstr("never moves\n"), HasSubstr("= 7\n")));
}

}  // namespace codec_commands_test
}  // namespace animeme
