// A Decoder stays within 2 MB, whatever comes in. Counts what is allocated inside its calls and
// not freed; a program of its own because it replaces operator new.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "codec/decode/decoder.h"
#include "codec/encode/encode.h"
#include "codec/syntax/bits.h"
#include "tests/support/random_clip.h"

namespace {

constexpr std::int64_t kLimit = 2'000'000;

bool counting = false;
std::int64_t live = 0;
std::int64_t peak = 0;

// In front of each block: its size if it was counted, else 0.
struct alignas(std::max_align_t) Header {
  std::size_t counted;
};

void* allocate(std::size_t size) {
  auto* header = static_cast<Header*>(std::malloc(sizeof(Header) + size));
  if (header == nullptr) std::abort();
  header->counted = counting ? size : 0;
  live += std::int64_t(header->counted);
  peak = std::max(peak, live);
  return header + 1;
}

void release(void* block) {
  if (block == nullptr) return;
  Header* header = static_cast<Header*>(block) - 1;
  live -= std::int64_t(header->counted);
  std::free(header);
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
void operator delete(void* block) noexcept { release(block); }
void operator delete[](void* block) noexcept { release(block); }
void operator delete(void* block, std::size_t) noexcept { release(block); }
void operator delete[](void* block, std::size_t) noexcept { release(block); }

namespace animeme {
namespace {

// Counts while it lives.
struct Counted {
  Counted() { counting = true; }
  ~Counted() { counting = false; }
};

class DecoderMemory : public testing::Test {
 protected:
  void SetUp() override { live = peak = 0; }

  // Pushes and pulls; planes are dropped.
  void feed(std::span<const std::uint8_t> bytes) {
    const Counted counted;
    decoder_.push(bytes);
    for (;;) {
      const Result<fba::Event> event = decoder_.next();
      if (event) {
        planes_ += event->kind == fba::Event::Kind::plane ? 1 : 0;
      } else if (event.error().code == Code::need_data ||
                 event.error().code == Code::end_of_stream) {
        return;
      } else {
        ++errors_;
      }
    }
  }
  void feed_often(std::span<const std::uint8_t> piece, std::size_t bytes) {
    for (std::size_t at = 0; at < bytes; at += piece.size()) feed(piece);
  }

  fba::Decoder decoder_;
  std::size_t planes_ = 0;
  std::size_t errors_ = 0;
};

// All FAPs and BAPs at ranges of +-1860: 362 models of 3721 symbols.
struct EveryParameter {
  EveryParameter() {
    face.mask_type.fill(fba::MaskType::all);
    for (std::size_t fap = 1; fap <= fap::kFapCount; ++fap) face.mask.set(fap);
    body.mask_type.fill(fba::MaskType::all);
    for (std::size_t bap = 1; bap <= fba::kBapCount; ++bap) body.mask.set(bap);
    face.send_range = body.send_range = {true, true, true, true};
    for (auto& set : face.range) set.fill(31);
    for (auto& set : body.range) set.fill(31);
  }
  // One more plane in which every parameter changes by `level`.
  std::vector<std::uint8_t> plane(bool intra, int level) {
    if (!intra) {
      for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
        frame.value[fap] += level * fap::info(int(fap)).quant_step;
      }
      for (std::size_t slot = 0; slot < fba::kBapCount; ++slot) {
        body_frame.value[fba::kBapOrder[slot]] += level * fba::kBapSteps[slot];
      }
    }
    fba::PlaneInput input;
    input.intra = intra;
    input.object_mask = fba::ObjectMask::face_and_body;
    input.face_settings = &face;
    input.body_settings = &body;
    input.face = &frame;
    input.body = &body_frame;
    const Result<void> done = encoder.write(input);
    EXPECT_TRUE(done) << done.error().describe();
    return encoder.take();
  }

  fba::FaceSettings face;
  fba::BodySettings body;
  fap::Frame frame;
  fba::BodyFrame body_frame;
  fba::Encoder encoder;
};

TEST_F(DecoderMemory, HoldsWithEverySymbolOfEveryModelSeen) {
  EveryParameter stream;
  feed(stream.plane(true, 0));
  for (int level = 1; level <= 1860; ++level) {
    feed(stream.plane(false, level));
    feed(stream.plane(false, -level));
  }
  feed(stream.plane(false, 0));
  // And so many symbols that do not fit a byte as a total allows.
  for (int i = 0; i < 49 * 256; ++i) {
    const int level = 40 * (1 + i / 2 % 24);
    feed(stream.plane(false, i % 2 == 0 ? level : -level));
  }
  feed(stream.encoder.finish());
  EXPECT_EQ(planes_, 2U + 2 * 1860 + 49 * 256);
  EXPECT_EQ(errors_, 0U);
  EXPECT_GT(peak, kLimit / 2) << "the stream is not as hostile as it was meant to be";
  EXPECT_LT(peak, kLimit);
  RecordProperty("peak", int(peak));
}

TEST_F(DecoderMemory, HoldsWithoutEndOfUserDataPlaneOrSkippedFrames) {
  const auto bytes = [](std::size_t count, std::uint8_t value) {
    return std::vector<std::uint8_t>(count, value);
  };
  const std::vector<std::uint8_t> user_data = {0, 0, 1, 0xB2};
  feed(user_data);
  feed_often(bytes(1000, 0x55), 4'000'000);
  EXPECT_LT(peak, kLimit / 10);
  // A plane that skips frames without end (P, body): an error, then a search for the next one.
  decoder_ = fba::Decoder();
  fba::BitWriter out;
  out.start_code(fba::kObjectStart);
  out.bits(0b101001, 6);
  feed(out.take());
  feed_often(bytes(1000, 0xFF), 4'000'000);
  EXPECT_EQ(errors_, 1U);
  EXPECT_LT(peak, kLimit / 10);
}

TEST_F(DecoderMemory, HoldsOnNoise) {
  test::Random random(3);
  const std::vector<std::uint8_t> start = {0, 0, 1, 0xBA};
  for (int stream = 0; stream < 20; ++stream) {
    decoder_ = fba::Decoder();
    feed(start);
    for (int piece = 0; piece < 100; ++piece) {
      std::vector<std::uint8_t> noise(1000);
      for (auto& byte : noise) byte = random.chance(30) ? 0 : std::uint8_t(random.next());
      for (int code = 0; code < 10; ++code) {
        const std::size_t at = std::size_t(random.range(0, 990));
        noise[at] = noise[at + 1] = 0;
        noise[at + 2] = 1;
        noise[at + 3] = 0xBB;
      }
      feed(noise);
    }
  }
  EXPECT_GT(errors_, 20U);
  EXPECT_LT(peak, kLimit);
}

TEST_F(DecoderMemory, DecodingAWholeStreamDoesNotCopyIt) {
  std::vector<std::uint8_t> stream = {0, 0, 1, 0xB0, 0x61, 0, 0, 1, 0xB2};
  stream.resize(8'000'000, 0x55);
  const auto raw = fba::encode(test::random_clip(1, 5));
  ASSERT_TRUE(raw) << raw.error().describe();
  stream.insert(stream.end(), raw->begin(), raw->end());
  const Counted counted;
  const auto decoded = fba::decode(stream);
  ASSERT_TRUE(decoded) << decoded.error().describe();
  EXPECT_EQ(decoded->planes.size(), 5U);
  EXPECT_LT(peak, kLimit / 2);
}

}  // namespace
}  // namespace animeme
