// A text that is read frame by frame, in pieces of any size, gives what read_text() gives.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "fap/text_reader.h"

namespace animeme::fap::in_pieces {

/// Hands out a text in pieces of at most `size` bytes.
inline ReadTextPiece pieces_of(std::string_view text, std::size_t size) {
  return [text, size](std::span<char> to) mutable -> Result<std::size_t> {
    const std::size_t count = std::min({size, to.size(), text.size()});
    std::copy_n(text.data(), count, to.data());
    text.remove_prefix(count);
    return count;
  };
}

struct Whole {
  Sequence clip;
  std::vector<std::string> warnings;
  std::string error;  // empty: none
};

inline Whole as_whole(std::string_view text, const ReadTextOptions& options) {
  Whole whole;
  const Result<Sequence> clip = read_text(text, options, &whole.warnings);
  if (clip) {
    whole.clip = *clip;
  } else {
    whole.error = std::to_string(int(clip.error().code)) + " " + clip.error().describe();
    whole.warnings.clear();
  }
  return whole;
}

inline Whole frame_by_frame(std::string_view text, const ReadTextOptions& options,
                            std::size_t piece) {
  Whole whole;
  const auto fail = [&whole](const Error& error) {
    whole.error = std::to_string(int(error.code)) + " " + error.describe();
    return whole;
  };
  const Result<TextSurvey> survey = survey_text(pieces_of(text, piece), options);
  if (!survey) return fail(survey.error());
  whole.warnings = survey->warnings;
  whole.clip = {survey->rate, {}, survey->name};
  Mask mask;
  TextReader reader(pieces_of(text, piece), *survey);
  for (;;) {
    const Result<const Frame*> frame = reader.next();
    if (!frame) return fail(frame.error());
    if (*frame == nullptr) break;
    whole.clip.frames.push_back(**frame);
    mask |= (*frame)->mask;
  }
  EXPECT_EQ(survey->frames, std::int64_t(whole.clip.frames.size())) << text;
  EXPECT_EQ(survey->mask, mask) << text;
  if (!whole.clip.frames.empty()) {
    EXPECT_EQ(survey->last, whole.clip.frames.back().number) << text;
  }
  return whole;
}

inline void expect_as_whole(std::string_view text, const ReadTextOptions& options = {}) {
  const Whole whole = as_whole(text, options);
  // A part is read again with each piece, so that small pieces are for small texts.
  for (const std::size_t piece : {std::size_t(7), std::size_t(500), std::size_t(1) << 20}) {
    if (text.size() / piece > 200) continue;
    const Whole read = frame_by_frame(text, options, piece);
    EXPECT_EQ(read.error, whole.error) << text;
    EXPECT_EQ(read.warnings, whole.warnings) << text;
    EXPECT_EQ(read.clip, whole.clip) << text;
  }
}

}  // namespace animeme::fap::in_pieces
