// The descriptor in the program map of a transport stream.
#include "tools/formats/media/detail/ts/ts_pmt.h"

#include <gmock/gmock.h>

#include <map>
#include <span>

#include "tests/formats/media/media_support.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/detail/ts/ts_sections.h"
#include "tools/formats/media/mux.h"

namespace animeme::media {
namespace ts_pmt_test {

using test::Bytes;

constexpr std::size_t kPacket = 188;

Bytes with_crc(Bytes section) {
  section[2] = std::uint8_t(section.size() + 4 - 3);
  const std::uint32_t crc = ts_crc(section);
  for (const unsigned shift : {24u, 16u, 8u, 0u}) section.push_back(std::uint8_t(crc >> shift));
  return section;
}

Bytes packet(unsigned pid, const Bytes& section) {
  Bytes out = {0x47, std::uint8_t(0x40 | pid >> 8), std::uint8_t(pid), 0x10, 0};
  out.insert(out.end(), section.begin(), section.end());
  out.resize(kPacket, 0xFF);
  return out;
}

const Bytes kAssociation = with_crc({0x00, 0xB0, 0, 0, 1, 0xC1, 0, 0, 0, 1, 0xF0, 0x00});

// Streams: type, PID low byte, descriptors.
Bytes map(const std::vector<std::pair<int, Bytes>>& streams) {
  Bytes section = {0x02, 0xB0, 0, 0, 1, 0xC1, 0, 0, 0xE1, 0, 0xF0, 0};
  for (const auto& [type, descriptors] : streams) {
    section.insert(section.end(),
                   {std::uint8_t(type), 0xE1, 0, 0xF0, std::uint8_t(descriptors.size())});
    section.insert(section.end(), descriptors.begin(), descriptors.end());
  }
  return with_crc(section);
}

Bytes filtered(const Bytes& stream, std::size_t cut = 1 << 20, std::uint8_t profile = 0x61) {
  ProgramMapFilter filter(profile);
  Bytes out;
  for (std::size_t at = 0; at < stream.size(); at += cut) {
    const Bytes part =
        filter.push(std::span(stream).subspan(at, std::min(cut, stream.size() - at)));
    out.insert(out.end(), part.begin(), part.end());
  }
  return out;  // whole packets
}

Bytes joined(const Bytes& a, const Bytes& b) {
  Bytes out = a;
  out.insert(out.end(), b.begin(), b.end());
  return out;
}

TEST(ProgramMap, CrcOfAPublishedSection) {
  // The program association that libavformat and many broadcasters send: programme 1 on PID 1000.
  const Bytes section = {0x00, 0xB0, 0x0D, 0, 1, 0xC1, 0, 0, 0, 1, 0xF0, 0x00};
  EXPECT_EQ(ts_crc(section), 0x2AB104B2u);
}

TEST(ProgramMap, FacesGetTheDescriptor) {
  const Bytes before =
      joined(packet(0, kAssociation), packet(0x1000, map({{0x0F, {}}, {0x10, {0x0A, 1, 2}}})));
  const Bytes after =
      joined(packet(0, kAssociation),
             packet(0x1000, map({{0x0F, {}}, {0x10, {0x0A, 1, 2, 0x1B, 1, 0x62}}})));
  EXPECT_EQ(filtered(before, 1 << 20, 0x62), after);
  for (const std::size_t cut : {1u, 7u, 187u, 189u}) {
    EXPECT_EQ(filtered(before, cut, 0x62), after) << cut;
  }
}

TEST(ProgramMap, AllElsePassesAsItIs) {
  const Bytes described = map({{0x10, {0x1B, 1, 0x61}}});
  const Bytes video = map({{0x1B, {}}, {0x0F, {}}});
  const Bytes plain = map({{0x10, {}}});
  for (const Bytes& stream :
       {joined(packet(0, kAssociation), packet(0x1000, described)),
        joined(packet(0, kAssociation), packet(0x1000, video)),
        joined(packet(0, kAssociation), packet(0x1001, plain)),  // no map of a programme
        packet(0x1000, plain),                                   // before the association
        Bytes(kPacket * 5, 0x47), Bytes(kPacket * 5, 0)}) {
    EXPECT_EQ(filtered(stream, 50), stream);
  }
  Bytes full = map({{0x10, Bytes(160, 0)}});  // 3 bytes more do not fit
  full = joined(packet(0, kAssociation), packet(0x1000, full));
  EXPECT_EQ(filtered(full), full);
}

TEST(ProgramMap, DamageIsPassedOn) {
  const Bytes good = joined(packet(0, kAssociation), packet(0x1000, map({{0x10, {}}, {0x0F, {}}})));
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (const int value : {0x00, 0xFF, 0x7F}) {
      Bytes damaged = good;
      damaged[at] = std::uint8_t(value);
      EXPECT_EQ(filtered(damaged).size(), damaged.size());
    }
  }
}

TEST(ProgramMap, OurFilesHaveIt) {
  const test::TempDir dir;
  fba::AccessUnits face = test::make_face(30);
  face.config[4] = 0x62;
  const Pcm sound = test::make_clicks(48000, 48000, {24000});
  ASSERT_TRUE(write_container(dir.file("a.ts"), {.face = &face, .audio = &sound}));
  const Bytes file = test::read_bytes(dir.file("a.ts"));
  int maps = 0;
  for (std::size_t at = 0; at + kPacket <= file.size(); at += kPacket) {
    const Bytes each(file.begin() + std::ptrdiff_t(at),
                     file.begin() + std::ptrdiff_t(at + kPacket));
    if ((each[1] & 0x1F) != 0x10 || each[2] != 0) continue;  // PID 0x1000
    ++maps;
    const std::size_t size = 3 + each[7];
    EXPECT_EQ(ts_crc(std::span(each).subspan(5, size)), 0u) << "with its CRC, all is zero";
    EXPECT_THAT(std::string(each.begin(), each.end()), testing::HasSubstr("\x1B\x01\x62"));
  }
  EXPECT_GT(maps, 0);
  const Result<Container> back = read_container(file);
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_EQ(back->face.units.size(), face.units.size());
}

// Two planes and no sound: fewer packets than libavformat wants to see.
TEST(ProgramMap, ShortFilesAreTransportStreamsToo) {
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(2);
  ASSERT_TRUE(write_container(dir.file("a.ts"), {.face = &face}));
  EXPECT_EQ(test::read_bytes(dir.file("a.ts")).size() % kPacket, 0u);
  const Result<Container> back = read_container(dir.file("a.ts"));
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_EQ(back->format, "mpegts");
  EXPECT_EQ(back->face.units.size(), 2u);
}

struct Count {
  int packets = 0, units = 0;  // transport packets, PES packets or sections
};

std::map<int, Count> count_packets(const Bytes& file) {
  std::map<int, Count> found;
  for (std::size_t at = 0; at + kPacket <= file.size(); at += kPacket) {
    Count& each = found[(file[at + 1] & 0x1F) << 8 | file[at + 2]];
    ++each.packets;
    each.units += (file[at + 1] & 0x40) != 0 ? 1 : 0;
  }
  return found;
}

TEST(SharedPackets, CostAFractionOfAPacketAPlane) {
  constexpr int kTables = 0, kFace = 0x100, kSound = 0x101;
  const test::TempDir dir;
  const auto sample = read_container((test::data_dir() / "containers" / "std_aac.mp4").string());
  ASSERT_TRUE(sample) << sample.error().describe();
  const int planes = int(sample->face.units.size());  // of 10 s
  const Pcm sound = test::make_clicks(48000, 480000, {24000});
  const MuxInput input{.face = &sample->face, .audio = &sound};
  ASSERT_TRUE(write_container(dir.file("a.ts"), input));
  auto alone = count_packets(test::read_bytes(dir.file("a.ts")));
  EXPECT_EQ(alone[kFace].units, planes);
  EXPECT_LE(alone[kSound].units, 50) << "frames of sound share them always";
  EXPECT_GE(alone[kTables].units, 80);
  ASSERT_TRUE(write_container(dir.file("a.ts"), input, {.shared_seconds = 0.4}));
  auto shared = count_packets(test::read_bytes(dir.file("a.ts")));
  EXPECT_LE(shared[kFace].units, planes / 10 + 5) << "ten planes a packet, but for intra planes";
  EXPECT_LE(shared[kFace].packets * 3, alone[kFace].packets);
  EXPECT_LE(shared[kTables].units, 30);
  EXPECT_GE(shared[kTables].units, 20) << "no less than two a second";
}

}  // namespace ts_pmt_test
}  // namespace animeme::media
