// SSML, and any text through what is said for it, cleaned as voice::speak_text() cleans it: what is
// handed to espeak-ng has a place for each character, inside of the source, and is well-formed
// markup where it claims to be.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "dam/script/script_text_internal.h"
#include "tests/fuzz/require.h"
#include "tools/speech/text/ssml.h"
#include "tools/speech/text/utterance.h"

using animeme::test::require;

namespace {

using namespace animeme;

// UTF-8 without control characters, which no markup may have.
std::string cleaned(std::string_view text) {
  std::string out;
  const std::string utf8 = dam::to_utf8(text);
  for (std::string_view rest = utf8; !rest.empty();) {
    const char32_t code = dam::take_code_point(rest);
    const bool blank = code <= U' ' || code == 0x7F || code == 0xA0 || code == 0xFFFD;
    dam::append_utf8(out, blank && code != U'\n' ? U' ' : code);
  }
  return out;
}

text::Speakers speakers() {
  text::Speakers all;
  all.automatic = true;
  all.list.push_back(text::make_speaker("en-us", "gmw/en-US", "English"));
  all.find = [](const std::string& language) -> std::optional<text::Speaker> {
    return text::make_speaker(language == "zh" ? "cmn" : language, "x/" + language, language);
  };
  return all;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 4000) return 0;
  const std::string text = cleaned({reinterpret_cast<const char*>(data), size});
  text::Helpers helpers;
  helpers.find = [](const std::string& language,
                    const std::string&) -> std::optional<text::Speaker> {
    return text::make_speaker(language, "x/y", language);
  };
  const auto made = text::make_utterance(text, speakers(), helpers);
  if (!made) {
    require(!made.error().message.empty());
    return 0;
  }
  require(made->input.text.size() == made->input.places.size());
  for (const text::Place place : made->input.places) {
    require(place.first <= place.last && place.last <= made->source.size());
  }
  for (const text::Stretch& stretch : made->stretches) {
    require(stretch.first < stretch.last && stretch.last <= made->input.size());
    require(stretch.speaker < made->speakers.size());
  }
  if (made->markup && text::read_ssml("<speak/>")) {
    require(text::read_ssml("<speak>" + text::utf8(made->input.text) + "</speak>").has_value());
  }
  return 0;
}
