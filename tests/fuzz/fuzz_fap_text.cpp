// Any bytes as FAP text: an answer without a crash, and what was read survives writing, filling
// and comparing. The first byte chooses the options.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fap/compare.h"
#include "fap/fill.h"
#include "fap/players.h"
#include "fap/text.h"
#include "tests/fuzz/require.h"

using animeme::test::require;

namespace {

void check(const animeme::fap::Sequence& clip) {
  using namespace animeme::fap;
  const auto again = read_text(write_text(clip), {.keep_numbers = true});
  require(again.has_value());
  require(again->frames == clip.frames && again->rate == clip.rate);
  require(compare(clip, *again).equal());
  const auto whole = read_text(write_text(clip, {.whole_rate = true}), {.keep_numbers = true});
  require(whole.has_value() && whole->rate == clip.rate && whole->frames == clip.frames);
  const auto low = fill(clip, {.expand = true, .max_frames = 1000});
  if (low && !low->frames.empty()) {
    require(player_problems(write_text(*low, {.whole_rate = true})).empty());
  }
  const auto full = fill(clip, {.max_frames = 1000});
  if (full && !full->frames.empty()) {
    require(full->frames.back().number == clip.frames.back().number);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  animeme::fap::ReadTextOptions options;
  options.headerless = (data[0] & 1) != 0;
  options.keep_numbers = (data[0] & 2) != 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  std::vector<std::string> warnings;
  const auto clip = animeme::fap::read_text(text, options, &warnings);
  (void)animeme::fap::player_problems(text);
  if (clip) {
    check(*clip);
  } else {
    require(!clip.error().message.empty());
  }
  return 0;
}
