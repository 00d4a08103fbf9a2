// Forms that other writers may choose: short descriptor lengths, configuration in band or nowhere,
// access units in several packets; and video that looks much like a face.
#include <gmock/gmock.h>

#include "tests/formats/media/media_support.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/detail/ts/ts_sections.h"
#include "tools/formats/media/mux.h"

namespace animeme::media {
namespace foreign_files_test {

using test::Bytes;

// Position of the content of the face's esds in an mp4 of ours.
std::size_t face_esds(const Bytes& file) {
  const std::string text(file.begin(), file.end());
  return text.find("esds", text.find("stsd")) + 4;
}

void append(Bytes& out, const Bytes& more) { out.insert(out.end(), more.begin(), more.end()); }

Bytes descriptor(unsigned tag, const Bytes& content, int length_bytes) {
  Bytes out = {std::uint8_t(tag)};
  for (int i = length_bytes - 1; i > 0; --i) {
    out.push_back(std::uint8_t(0x80 | (content.size() >> (7 * i) & 0x7F)));
  }
  out.push_back(std::uint8_t(content.size() & 0x7F));
  append(out, content);
  return out;
}

// The content of an esds with lengths of so many bytes; `config` may be empty: none.
Bytes esds(const Bytes& config, int length_bytes) {
  Bytes decoder = {0x20, 0x11, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  if (!config.empty()) append(decoder, descriptor(5, config, length_bytes));
  Bytes inside = {0, 0, 0};
  append(inside, descriptor(4, decoder, length_bytes));
  append(inside, descriptor(6, {2}, length_bytes));
  Bytes out = {0, 0, 0, 0};
  append(out, descriptor(3, inside, length_bytes));
  return out;
}

class ForeignMp4 : public testing::TestWithParam<FaceTrackType> {
 protected:
  void write(const std::string& path, const fba::AccessUnits& face) const {
    MuxOptions options;
    options.face_track = GetParam();
    EXPECT_TRUE(write_container(path, {.face = &face}, options));
  }
  Bytes file_with(const fba::AccessUnits& face, const Bytes& content) {
    const test::TempDir dir;
    write(dir.file("a.mp4"), face);
    Bytes file = test::read_bytes(dir.file("a.mp4"));
    const std::size_t at = face_esds(file);
    const Bytes whole = esds(face.config, 4);
    EXPECT_LE(content.size(), whole.size());
    // What is left of the box is zeros, which are no descriptor.
    std::fill_n(file.begin() + std::ptrdiff_t(at), whole.size(), std::uint8_t(0));
    std::copy(content.begin(), content.end(), file.begin() + std::ptrdiff_t(at));
    return file;
  }

  fba::AccessUnits face_ = test::make_face(60);
};

TEST_P(ForeignMp4, DescriptorLengthsOfOneToFourBytes) {
  for (int bytes = 1; bytes <= 4; ++bytes) {
    const Result<Container> back = read_container(file_with(face_, esds(face_.config, bytes)));
    ASSERT_TRUE(back) << bytes << back.error().describe();
    EXPECT_TRUE(back->face == face_) << bytes;
  }
}

TEST_P(ForeignMp4, ShortConfigurationWithoutIdentifier) {
  const Bytes config = {0, 0, 1, 0xB0, 0x62, 0, 0, 1, 0xB5, 0x23};
  const Result<Container> back = read_container(file_with(face_, esds(config, 4)));
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_EQ(back->face.config, config);
  EXPECT_EQ(back->visual_profile, 0x62);
}

TEST_P(ForeignMp4, NoConfigurationAtAll) {
  const Result<Container> back = read_container(file_with(face_, esds({}, 4)));
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_EQ(back->face.units, face_.units);
  EXPECT_EQ(back->face.config, test::kFaceConfig) << "Simple Face Animation is assumed";
  EXPECT_THAT(back->warnings, testing::Contains(testing::HasSubstr("configuration")));
}

TEST_P(ForeignMp4, ConfigurationInBandOnly) {
  fba::AccessUnits in_band = face_;
  for (fba::AccessUnit& unit : in_band.units) {
    if (unit.intra) unit.bytes.insert(unit.bytes.begin(), face_.config.begin(), face_.config.end());
  }
  const Result<Container> back = read_container(file_with(in_band, esds({}, 1)));
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_TRUE(back->face == face_);
  EXPECT_THAT(back->warnings, testing::IsEmpty());
}

TEST_P(ForeignMp4, UserDataInTheConfigurationIsKept) {
  Bytes config = face_.config;
  append(config, {0, 0, 1, 0xB2, 'h', 'i'});
  face_.config = config;
  const test::TempDir dir;
  write(dir.file("a.mp4"), face_);
  const Result<Container> back = read_container(dir.file("a.mp4"));
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_TRUE(back->face == face_);
}

TEST_P(ForeignMp4, OtherVisualObjectsAreNoFace) {
  for (const int type : {1, 2, 3, 5}) {  // video, still texture, mesh, 3-D mesh
    Bytes config = face_.config;
    config[10] = std::uint8_t(type << 4 | 7);
    const Result<Container> back = read_container(file_with(face_, esds(config, 4)));
    ASSERT_FALSE(back) << type;
    EXPECT_EQ(back.error().code, Code::not_found);
  }
}

TEST_P(ForeignMp4, ContentsBehindTheDataAreFoundToo) {
  const test::TempDir dir;
  const MuxOptions options{.face_track = GetParam(), .faststart = false};
  ASSERT_TRUE(write_container(dir.file("a.mp4"), {.face = &face_}, options));
  const Result<Container> back = read_container(dir.file("a.mp4"));
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_TRUE(back->face == face_);
}

INSTANTIATE_TEST_SUITE_P(Types, ForeignMp4,
                         testing::Values(FaceTrackType::metadata, FaceTrackType::video),
                         [](const auto& value) {
                           return value.param == FaceTrackType::video ? "video" : "metadata";
                         });

// A transport stream by hand: one PES packet for each of `parts`.
struct Part {
  Bytes bytes;
  std::int64_t time = -1;  // 90 kHz; -1: none
};

class HandMadeTs {
 public:
  explicit HandMadeTs(std::uint8_t stream_type) {
    section(0, {0x00, 0xB0, 13, 0, 1, 0xC1, 0, 0, 0, 1, 0xF0, 0x00});
    section(0x1000,
            {0x02, 0xB0, 18, 0, 1, 0xC1, 0, 0, 0xE1, 0, 0xF0, 0, stream_type, 0xE1, 0, 0xF0, 0});
  }

  void add(const Part& part) {
    Bytes pes = {0, 0, 1, 0xE0};
    const bool timed = part.time >= 0;
    const std::size_t length = 3 + (timed ? 5 : 0) + part.bytes.size();
    append(pes, {std::uint8_t(length >> 8), std::uint8_t(length), 0x80,
                 std::uint8_t(timed ? 0x80 : 0), std::uint8_t(timed ? 5 : 0)});
    if (timed) {
      const auto t = std::uint64_t(part.time);
      append(pes, {std::uint8_t(0x21 | (t >> 29 & 0x0E)), std::uint8_t(t >> 22),
                   std::uint8_t(1 | (t >> 14 & 0xFE)), std::uint8_t(t >> 7),
                   std::uint8_t(1 | (t << 1 & 0xFE))});
    }
    append(pes, part.bytes);
    for (std::size_t at = 0; at < pes.size();) {
      const std::size_t room = 184;
      std::size_t count = std::min(room, pes.size() - at);
      Bytes packet = {0x47, std::uint8_t((at == 0 ? 0x40 : 0) | 1), 0, 0};
      if (count < room) {
        const std::size_t stuffing = room - count;
        packet[3] = std::uint8_t(0x30 | (counter_++ & 15));
        packet.push_back(std::uint8_t(stuffing - 1));
        if (stuffing > 1) packet.push_back(0);
        packet.resize(4 + stuffing, 0xFF);
      } else {
        packet[3] = std::uint8_t(0x10 | (counter_++ & 15));
      }
      packet.insert(packet.end(), pes.begin() + std::ptrdiff_t(at),
                    pes.begin() + std::ptrdiff_t(at + count));
      append(bytes_, packet);
      at += count;
    }
  }

  const Bytes& bytes() const { return bytes_; }

 private:
  void section(unsigned pid, Bytes section) {
    const std::uint32_t crc = ts_crc(section);
    for (const unsigned shift : {24u, 16u, 8u, 0u}) section.push_back(std::uint8_t(crc >> shift));
    Bytes packet = {0x47, std::uint8_t(0x40 | pid >> 8), std::uint8_t(pid), 0x10, 0};
    append(packet, section);
    packet.resize(188, 0xFF);
    append(bytes_, packet);
  }

  Bytes bytes_;
  unsigned counter_ = 0;
};

TEST(ForeignTs, UnitsInSeveralPackets) {
  fba::AccessUnits face = test::make_face(40, 90000, 3600, 10);
  for (const int type : {0x10, 0x06}) {
    for (const bool repeat_time : {false, true}) {
      HandMadeTs stream{std::uint8_t(type)};
      for (const fba::AccessUnit& unit : face.units) {
        Bytes bytes = unit.intra ? face.config : Bytes();
        append(bytes, unit.bytes);
        const std::int64_t time = 90000 + unit.time;
        const auto cut = bytes.begin() + std::ptrdiff_t(bytes.size() - 6);
        stream.add({Bytes(bytes.begin(), cut), time});
        stream.add({Bytes(cut, bytes.end()), repeat_time ? time : -1});
      }
      const Result<Container> back = read_container(stream.bytes());
      ASSERT_TRUE(back) << back.error().describe();
      ASSERT_EQ(back->face.units.size(), face.units.size());
      for (std::size_t i = 0; i < face.units.size(); ++i) {
        EXPECT_EQ(back->face.units[i].bytes, face.units[i].bytes) << i;
        EXPECT_EQ(back->face.units[i].time, face.units[i].time) << i;
      }
      EXPECT_EQ(back->face.config, face.config);
    }
  }
}

TEST(ForeignTs, ALostPartLosesTheUnitUpToTheNextIntraPlane) {
  const fba::AccessUnits face = test::make_face(40, 90000, 3600, 10);
  HandMadeTs stream(0x10);
  for (std::size_t i = 0; i < face.units.size(); ++i) {
    const fba::AccessUnit& unit = face.units[i];
    Bytes bytes = unit.bytes;
    if (i == 13) bytes.erase(bytes.begin(), bytes.begin() + 6);  // its begin is missing
    stream.add({bytes, 90000 + unit.time});
  }
  const Result<Container> back = read_container(stream.bytes());
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_EQ(back->face.units.size(), 33u);
  EXPECT_EQ(back->face.units[13].bytes, face.units[20].bytes);
}

}  // namespace foreign_files_test
}  // namespace animeme::media
