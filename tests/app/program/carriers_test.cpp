// stats --carriers: messages against sizes counted by hand and against readers in Python, deflate
// against zlib's inflate, rows against the encoder and the head they are about.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstdio>

#include "codec/decode/decoder.h"
#include "codec/decode/fill.h"
#include "codec/encode/live.h"
#include "fap/head/rig.h"
#include "tests/app/program/commands.h"
#include "tests/support/files.h"
#include "tests/support/folders.h"
#include "tests/support/temp_dir.h"
#include "tools/formats/inspect/carriers.h"

namespace animeme {
namespace carriers_test {

using inspect::Headers;
using test::animeme;
using test::Json;
using test::json_of;
using test::TempDir;
using testing::HasSubstr;

const std::string kSamples = std::string(test::kSourceFolder) + "/tools/release/samples/";

// A weight for each channel that no other has; angles of both signs.
fap::ArkitFrame some_weights() {
  fap::ArkitFrame weights{};
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = i < 52 ? double(i + 1) / 64 : (double(i) - 56.5) / 10;
  }
  return weights;
}

TEST(Carriers, SizesAsCountedByHand) {
  const auto weights = some_weights();
  EXPECT_EQ(inspect::float_weights(weights).size(), 52u * 4);
  EXPECT_EQ(inspect::packed_weights(weights, 8).size(), 52u);
  EXPECT_EQ(inspect::packed_weights(weights, 7).size(), 46u);  // 364 bits
  EXPECT_EQ(inspect::packed_weights(weights, 16).size(), 104u);
  // 1 + (4 + 36) + (4 + 6) + (4 + 4 + 4 + 4) + 1 + 61 x 4
  EXPECT_EQ(inspect::live_link_packet(weights, {}).size(), 312u);
  EXPECT_EQ(inspect::live_link_packet(weights, {.device = "d", .subject = ""}).size(), 271u);
  // 1 + 4, then 4 + 2 + 1 + 2 and 52 x (2 + 4)
  EXPECT_EQ(inspect::arf_unit(weights, 7).size(), 326u);
  // 8 + 8, 4 + 20 + 4 + name + 4 for each shape, 4 + 24 + 4 at the end
  std::size_t vmc = 16 + 32;
  for (std::size_t i = 0; i < 52; ++i) vmc += 32 + (fap::kArkitNames[i].size() / 4 + 1) * 4;
  EXPECT_EQ(inspect::vmc_bundle(weights).size(), vmc);
  EXPECT_EQ(vmc, 2524u);
}

TEST(Carriers, Headers) {
  EXPECT_EQ(inspect::header_bytes(Headers::none, 1000), 0u);
  EXPECT_EQ(inspect::header_bytes(Headers::udp, 0), 28u);
  EXPECT_EQ(inspect::header_bytes(Headers::udp, 1472), 28u);
  EXPECT_EQ(inspect::header_bytes(Headers::udp, 1473), 48u);  // a second fragment
  EXPECT_EQ(inspect::header_bytes(Headers::udp, 2524), 48u);
  EXPECT_EQ(inspect::header_bytes(Headers::rtp, 30), 40u);
  EXPECT_EQ(inspect::header_bytes(Headers::websocket, 125), 42u);
  EXPECT_EQ(inspect::header_bytes(Headers::websocket, 126), 44u);
  EXPECT_EQ(inspect::header_bytes(Headers::websocket, 1457), 84u);  // a second segment
  EXPECT_EQ(inspect::header_bytes(Headers::websocket, 65536), 10 + 45 * 40u);
}

TEST(Carriers, PackedLevelsComeBack) {
  fap::ArkitFrame weights = some_weights();
  weights[3] = -0.2;
  weights[4] = 1.3;
  for (const int bits : {1, 5, 7, 8, 11, 16}) {
    const auto bytes = inspect::packed_weights(weights, bits);
    ASSERT_EQ(bytes.size(), std::size_t(52 * bits + 7) / 8);
    for (std::size_t i = 0; i < 52; ++i) {
      std::uint32_t level = 0;
      for (std::size_t bit = i * bits; bit < (i + 1) * bits; ++bit) {
        level = level * 2 + (bytes[bit / 8] >> (7 - bit % 8) & 1);
      }
      const double most = double((1 << bits) - 1);
      EXPECT_NEAR(level / most, std::clamp(weights[i], 0.0, 1.0), 0.5 / most + 1e-12) << bits;
    }
  }
}

TEST(Carriers, OthersReadTheMessages) {
  const TempDir dir;
  const fap::ArkitFrame weights = some_weights();
  const fap::ArkitFrame two[] = {weights, {}};
  test::write_bytes(dir / "floats", (inspect::float_weights(weights)));
  test::write_bytes(
      dir / "live_link",
      (inspect::live_link_packet(
          weights, {.device = "my phone", .subject = "Ada", .frame = 77, .rate = 30})));
  test::write_bytes(dir / "vmc", (inspect::vmc_bundle(weights)));
  test::write_bytes(dir / "arf", (inspect::arf_unit(weights, 9)));
  test::spill(dir / "azure", inspect::azure_event(two, 120, 3));
  const auto reader = test::run_command(
      {"python3", std::string(test::kSourceFolder) + "/tests/app/program/read_carriers.py",
       dir.path().string()});
  ASSERT_EQ(reader.exit_code, 0) << reader.err;
  const Json read = Json::parse(reader.out);
  const auto floats = [&](const Json& list, std::size_t count) {
    ASSERT_EQ(list.size(), count);
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(float(list[i]), float(weights[i])) << i;
  };
  floats(read["floats"], 52);
  floats(read["live_link"]["values"], 61);
  EXPECT_EQ(read["live_link"]["device"], "my phone");
  EXPECT_EQ(read["live_link"]["subject"], "Ada");
  EXPECT_EQ(read["live_link"]["frame"], 77);
  EXPECT_EQ(read["live_link"]["rate"], 30);
  EXPECT_EQ(read["vmc"].size(), 52u);
  EXPECT_EQ(float(read["vmc"]["EyeBlinkLeft"]), float(weights[0]));
  EXPECT_EQ(float(read["vmc"]["TongueOut"]), float(weights[51]));
  EXPECT_EQ(read["arf"]["time"], 9);
  for (std::size_t i = 0; i < 52; ++i) {
    EXPECT_EQ(read["arf"]["entries"][i][0], i);
    EXPECT_EQ(float(read["arf"]["entries"][i][1]), float(weights[i]));
  }
  EXPECT_EQ(read["azure"]["FrameIndex"], 120);
  ASSERT_EQ(read["azure"]["BlendShapes"].size(), 2u);
  ASSERT_EQ(read["azure"]["BlendShapes"][0].size(), 55u);
  EXPECT_EQ(read["azure"]["BlendShapes"][0][0], 0.016);   // 1 / 64
  EXPECT_EQ(read["azure"]["BlendShapes"][0][52], -0.25);  // roll of the head
  EXPECT_EQ(read["azure"]["BlendShapes"][1][54], 0);
}

TEST(Carriers, DeflatedMessagesAreReadByZlib) {
  inspect::Deflater deflater;
  z_stream reader{};
  ASSERT_EQ(inflateInit2(&reader, -MAX_WBITS), Z_OK);
  std::size_t first = 0, last = 0;
  for (int i = 0; i < 20; ++i) {
    auto weights = some_weights();
    weights[std::size_t(i)] = 0.5;
    const auto message = inspect::float_weights(weights);
    auto packed = deflater.pack(message);
    (i == 0 ? first : last) = packed.size();
    for (const int tail : {0, 0, 0xFF, 0xFF}) packed.push_back(std::uint8_t(tail));
    std::vector<std::uint8_t> out(1000);
    reader.next_in = packed.data();
    reader.avail_in = uInt(packed.size());
    reader.next_out = out.data();
    reader.avail_out = uInt(out.size());
    ASSERT_EQ(inflate(&reader, Z_SYNC_FLUSH), Z_OK);
    out.resize(out.size() - reader.avail_out);
    EXPECT_EQ(out, message);
  }
  EXPECT_LT(last, first / 3);  // it remembers the messages before
  inflateEnd(&reader);
}

// --- the command

const Json& row(const Json& clip, const std::string& name, bool fitted) {
  for (const Json& one : clip["carriers"]) {
    if (one["carrier"] == name && one["fitted"] == fitted) return one;
  }
  ADD_FAILURE() << "no row " << name;
  static const Json none;
  return none;
}

fap::Sequence complete_talk() {
  const auto decoded = fba::decode(test::read_bytes(kSamples + "talk.fba"));
  return *fba::fill(*decoded);
}

TEST(Carriers, RowsAreWhatIsSent) {
  const Json told = json_of({"stats", "--carriers", kSamples + "talk.fba"});
  const Json& clip = told["clips"][0];
  const std::size_t frames = clip["frames"];
  EXPECT_EQ(frames, complete_talk().frames.size());
  EXPECT_DOUBLE_EQ(clip["seconds"], double(frames) / 25);
  const Json& link = row(clip, "Live Link Face, 61 float32", false);
  EXPECT_EQ(link["bytes"], 312 * frames);
  EXPECT_EQ(link["bytes_with_headers"], 340 * frames);
  EXPECT_DOUBLE_EQ(link["kbit_per_s_with_headers"], 340 * 8 * 25 / 1000.0);
  EXPECT_EQ(row(clip, "VMC, OSC bundle", false)["bytes_with_headers"], (2524 + 48) * frames);
  EXPECT_EQ(row(clip, "ARF, AAU of 52 float32", false)["bytes_with_headers"], 366 * frames);
  EXPECT_EQ(row(clip, "52 x float32", false)["bytes"], 208 * frames);

  // FBA once more: its units, and its error by a head of this test's.
  const auto talk = complete_talk();
  const int quant =
      std::stoi(std::string(row(clip, "FBA, joins each second", true)["setting"]).substr(6));
  fba::LiveOptions options;
  options.rate = talk.rate;
  options.fap_quant = quant;
  options.intra_seconds = 1;
  options.faps = talk.frames.front().mask;
  fba::LiveEncoder encoder(options);
  head::HeadParameters few;
  few.density = 0.5;
  const auto rig = head::make_rig(*head::make_head(few));
  const auto skin = [&](fap::Frame frame) {
    frame.value[48] = frame.value[49] = frame.value[50] = 0;
    return head::pose(rig, frame).positions[0];
  };
  const auto rest = skin({});
  std::vector<std::vector<head::Vec3>> given, got;
  std::size_t bytes = 0;
  for (const auto& frame : talk.frames) {
    bytes += encoder.write(frame)->size();
    given.push_back(skin(frame));
    got.push_back(skin(encoder.reconstruction()));
  }
  const auto apart = [](const head::Vec3& a, const head::Vec3& b) {
    return std::hypot(double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z);
  };
  double sum = 0;
  std::size_t points = 0;
  for (std::size_t v = 0; v < rest.size(); ++v) {
    double most = 0;
    for (const auto& face : given) most = std::max(most, apart(face[v], rest[v]));
    if (most <= 0.01) continue;
    ++points;
    for (std::size_t i = 0; i < given.size(); ++i)
      sum += std::pow(apart(given[i][v], got[i][v]), 2);
  }
  const Json& fba = row(clip, "FBA, joins each second", true);
  EXPECT_EQ(fba["bytes"], bytes);
  EXPECT_EQ(fba["bytes_with_headers"], bytes + 40 * frames);
  EXPECT_EQ(clip["points"], points);
  EXPECT_NEAR(fba["error_mm"], 10 * std::sqrt(sum / double(points * frames)), 1e-6);
}

// Faces of talk.fba, as text: each of them is posed some fifty times.
std::string few_faces(const TempDir& dir, std::size_t count = 12) {
  auto talk = complete_talk();
  talk.frames.resize(count);
  test::spill(dir / "few.fap", fap::write_text(talk));
  return dir / "few.fap";
}

TEST(Carriers, FittedRowsKeepTheErrorAndLessErrorCostsMore) {
  const TempDir dir;
  const std::string clip = few_faces(dir);
  const Json fine = json_of({"stats", "--carriers", clip, "--error", "0.02"});
  const Json coarse = json_of({"stats", "--carriers", clip, "--error", "0.3"});
  ASSERT_EQ(fine["clips"][0]["carriers"].size(), coarse["clips"][0]["carriers"].size());
  int fitted = 0;
  for (std::size_t i = 0; i < fine["clips"][0]["carriers"].size(); ++i) {
    const Json &a = fine["clips"][0]["carriers"][i], &b = coarse["clips"][0]["carriers"][i];
    ASSERT_EQ(a["carrier"], b["carrier"]);
    if (!a["fitted"]) {
      EXPECT_EQ(a["bytes"], b["bytes"]) << a;
      continue;
    }
    ++fitted;
    EXPECT_LE(a["error_mm"], 0.02) << a;
    EXPECT_LE(b["error_mm"], 0.3) << b;
    EXPECT_GT(a["bytes"], b["bytes"]) << a << b;
  }
  EXPECT_GE(fitted, 11);
}

TEST(Carriers, ACaptureIsSentByItsOwnWeights) {
  const TempDir dir;
  const Json told = json_of(
      {"stats", "--carriers", kSamples + "LiveLinkFace.csv", few_faces(dir), "--quant", "4"});
  ASSERT_EQ(told["clips"].size(), 2u);
  EXPECT_LT(told["clips"][0]["shapes_error_mm"], 0.01);  // the face was made of these weights
  EXPECT_GT(told["clips"][1]["shapes_error_mm"], 0.1);   // a face of FAPs
  EXPECT_EQ(row(told["clips"][0], "FBA, joins each second", false)["setting"], "quant 4");
  EXPECT_EQ(told["all"]["frames"],
            int(told["clips"][0]["frames"]) + int(told["clips"][1]["frames"]));
  EXPECT_EQ(row(told["all"], "52 x float32", false)["messages"], told["all"]["frames"]);
}

TEST(Carriers, TheSameTextTwice) {
  const TempDir dir;
  const std::string clip = few_faces(dir, 5);
  const auto once = animeme({"stats", "--carriers", clip});
  const auto twice = animeme({"stats", "--carriers", clip});
  EXPECT_EQ(once.exit_code, 0) << once.err;
  EXPECT_EQ(once.out, twice.out);
  EXPECT_THAT(once.out, HasSubstr("VMC, OSC bundle"));
}

TEST(Carriers, UseAndMisuse) {
  EXPECT_EQ(animeme({"stats", kSamples + "talk.fba", "--quant", "2"}).exit_code, 2);
  EXPECT_EQ(animeme({"stats", kSamples + "talk.fba", "--error", "1"}).exit_code, 2);
  EXPECT_EQ(animeme({"stats", "--carriers", "--sizes", kSamples + "talk.fba"}).exit_code, 2);
  const auto nothing = animeme({"stats", "--carriers", kSamples + "voice.txt"});
  EXPECT_EQ(nothing.exit_code, 3);
  EXPECT_EQ(inspect::measure_carriers("a", {}, {}, {}).error().code, Code::truncated);
  EXPECT_EQ(inspect::measure_carriers("a", complete_talk(), {{}}, {}).error().code,
            Code::invalid_argument);
}

TEST(Carriers, AStillFaceHasNoErrorAndIsSent) {
  fap::Sequence still;
  for (int i = 0; i < 3; ++i) {
    fap::Frame frame;
    frame.number = i;
    frame.mask.set(3);
    still.frames.push_back(frame);
  }
  const auto measured = inspect::measure_carriers("still", still, {}, {});
  ASSERT_TRUE(measured);
  EXPECT_EQ(measured->points, 0u);
  for (const auto& by : measured->carriers) {
    EXPECT_EQ(by.error, 0) << by.name;
    EXPECT_GT(by.bytes, 0u) << by.name;
  }
}

}  // namespace carriers_test
}  // namespace animeme
