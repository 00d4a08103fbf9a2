// Objects of their own in threads of their own: nothing is shared, and each gives what it gives
// alone.
#include <atomic>
#include <cstring>
#include <thread>

#include "tests/bindings/c/support.h"
#include "tests/support/random_clip.h"

namespace animeme::test {
namespace threads_test {
namespace {

constexpr const char* kScript = "0 0.1 SIL\n0.1 0.3 B\n0.3 0.8 AA\n0.8 1.0 M\n";

// Speaks, codes, decodes and fits, each with handles made here; all bytes that come of it.
Bytes work(std::uint64_t seed) {
  Bytes out;
  const auto keep = [&out](const void* bytes, std::size_t size) {
    const auto* first = static_cast<const std::uint8_t*>(bytes);
    out.insert(out.end(), first, first + size);
  };
  animeme_error error{};
  animeme_model* made_model = nullptr;
  if (animeme_model_builtin(&made_model, &error) != ANIMEME_OK) return out;
  const C<animeme_model> model(made_model);
  animeme_clip* spoken = nullptr;
  if (animeme_speak(model.get(), kScript, std::strlen(kScript), nullptr, &spoken, &error) !=
      ANIMEME_OK) {
    return out;
  }
  const C<animeme_clip> speech(spoken);
  const C<animeme_clip> walk = c_clip(random_clip(seed, 40));
  animeme_arkit* made_fit = nullptr;
  if (animeme_arkit_new(&made_fit, &error) != ANIMEME_OK) return out;
  const C<animeme_arkit> fit(made_fit);
  for (const animeme_clip* clip : {speech.get(), walk.get()}) {
    std::uint8_t* bytes = nullptr;
    std::size_t size = 0;
    if (animeme_clip_encode(clip, nullptr, &bytes, &size, &error) != ANIMEME_OK) return {};
    keep(bytes, size);
    animeme_clip* back = nullptr;
    const animeme_status status = animeme_clip_decode(bytes, size, &back, &error);
    animeme_free(bytes);
    if (status != ANIMEME_OK) return {};
    const C<animeme_clip> decoded(back);
    for (std::size_t i = 0; i < animeme_clip_count(back); ++i) {
      animeme_frame frame = empty_frame();
      float weights[ANIMEME_ARKIT_COUNT] = {};
      if (animeme_clip_get(back, i, &frame, &error) != ANIMEME_OK) return {};
      if (animeme_arkit_fit(fit.get(), &frame, weights, ANIMEME_ARKIT_COUNT, &error) !=
          ANIMEME_OK) {
        return {};
      }
      keep(frame.value, sizeof frame.value);
      keep(weights, sizeof weights);
    }
    // And an error, whose text is the thread's own.
    animeme_clip* none = nullptr;
    EXPECT_NE(animeme_clip_decode(reinterpret_cast<const std::uint8_t*>("no"), 2, &none, &error),
              ANIMEME_OK);
    keep(error.message, std::strlen(error.message));
  }
  return out;
}

TEST(CThreads, ObjectsOfTheirOwnDoNotKnowOfEachOther) {
  constexpr std::size_t kThreads = 3, kRounds = 3;
  std::vector<Bytes> alone;
  for (std::size_t i = 0; i < kThreads; ++i) alone.push_back(work(i));
  for (const Bytes& bytes : alone) ASSERT_GT(bytes.size(), 10'000u);
  std::atomic<int> different = 0;
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < kThreads; ++i) {
    threads.emplace_back([&, i] {
      for (std::size_t round = 0; round < kRounds; ++round) different += work(i) != alone[i];
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(different, 0);
}

}  // namespace
}  // namespace threads_test
}  // namespace animeme::test
