// The small form of /faps, against the values that the other form has.
#include "tools/live/web/detail/planes.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/support/live_loop.h"
#include "tests/support/reference_streams.h"
#include "tools/live/web/detail/values.h"

namespace animeme::test {
namespace planes_test {

using Bytes = std::vector<std::uint8_t>;

/// A reader of what tools/live/web/protocol.md says, on its own.
class Reader {
 public:
  std::uint64_t time = 0, duration = 0, size = 0;
  std::map<int, std::vector<long>> values;

  void read(const Bytes& message) {
    bytes_ = message;
    at_ = 10;
    ASSERT_EQ(message[0] & ~7, 0);
    if ((message[0] & 4) != 0) {
      values.clear();
      time = 0;
    }
    time += number();
    duration = number();
    size = number();
    for (int fap = 1; fap <= 72; ++fap) {
      if ((message[1 + std::size_t(fap - 1) / 8] >> (fap - 1) % 8 & 1) == 0) continue;
      ASSERT_LE(fap, 68);
      std::vector<long>& value = values[fap];
      if (fap <= 2) value.clear();
      value.resize(fap > 2 ? 1 : std::size_t(2 + fap));
      for (long& each : value) {
        const std::uint64_t folded = number();
        each += folded % 2 == 0 ? long(folded / 2) : -long(folded / 2) - 1;
      }
    }
    ASSERT_EQ(at_, message.size());
  }

 private:
  std::uint64_t number() {
    std::uint64_t sum = 0;
    for (int shift = 0; at_ < bytes_.size(); shift += 7) {
      const std::uint8_t byte = bytes_[at_++];
      sum |= std::uint64_t(byte & 127) << shift;
      if (byte < 128) return sum;
    }
    ADD_FAILURE() << "the message is too short";
    return 0;
  }
  Bytes bytes_;
  std::size_t at_ = 0;
};

std::map<int, std::vector<long>> values_of(const fap::Frame& face) {
  std::map<int, std::vector<long>> values;
  for (int fap = 1; fap <= 68; ++fap) {
    if (!face.mask[std::size_t(fap)]) continue;
    const fap::Viseme& v = face.viseme;
    const fap::Expression& e = face.expression;
    if (fap == 1) {
      values[fap] = {v.select1, v.select2, v.blend};
    } else if (fap == 2) {
      values[fap] = {e.select1, e.intensity1, e.select2, e.intensity2};
    } else {
      values[fap] = {face.value[std::size_t(fap)]};
    }
  }
  return values;
}

TEST(Planes, ByteForByte) {
  web::PlaneWriter writer;
  fap::Frame face;
  face.set(3, -65);
  face.set(68, 3);
  face.mask.set(1);
  face.viseme = {2, 5, 40, false};
  EXPECT_EQ(writer.write({300, 1000, true, 99}, face),
            (Bytes{5, 5, 0, 0, 0, 0, 0, 0, 0, 8, 0xAC, 2, 0xE8, 7, 99, 4, 10, 80, 0x81, 1, 6}));
  face.set(3, -66);
  EXPECT_EQ(writer.write({301, 1000, false, 7}, face),
            (Bytes{0, 4, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0xE8, 7, 7, 1}));
  face.mask.reset(68);
  const Bytes gone = writer.write({302, 1000, false, 7}, face);
  EXPECT_EQ(gone[0], 4) << "what is gone makes a whole plane";
  Reader reader;
  reader.read(gone);
  EXPECT_EQ(reader.values, values_of(face));
}

TEST(Planes, ValuesAreThoseOfEveryReferenceStream) {
  int planes = 0;
  std::size_t small = 0, json = 0;
  for (const auto& base : reference_streams()) {
    SCOPED_TRACE(base.filename());
    const auto units = fba::split_access_units(read_bytes(with(base, ".fba")));
    if (!units) continue;
    web::Values values;
    web::PlaneWriter writer;
    Reader reader, late;
    bool joined = false;
    std::uint64_t time = 25000;
    for (const fba::AccessUnit& unit : units->units) {
      const auto face = values.push(unit.bytes);
      time += std::uint64_t(unit.duration);
      if (!face) continue;
      const Bytes message =
          writer.write({time, std::uint32_t(unit.duration), unit.intra, unit.bytes.size()}, *face);
      reader.read(message);
      ASSERT_EQ(reader.values, values_of(*face)) << "plane " << planes;
      ASSERT_EQ(reader.time, time);
      ASSERT_EQ(reader.duration, std::uint64_t(unit.duration));
      ASSERT_EQ(reader.size, unit.bytes.size());
      joined = joined || (unit.intra && planes % 7 == 3);  // somebody comes later
      if (joined) {
        late.read(message);
        ASSERT_EQ(late.values, reader.values);
        ASSERT_EQ(late.time, time);
      }
      ++planes;
      small += message.size();
      json += web::write_values({}, *face).size();
    }
  }
  EXPECT_GT(planes, 5000);
  EXPECT_LT(small, json / 3);
}

}  // namespace planes_test
}  // namespace animeme::test
