// Speech that comes phone by phone has the values of the whole clip.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "dam/speaking/stream.h"
#include "dam/speaking/synthesise.h"

namespace animeme::dam {

/// Pushes the phones one by one, pulling after each, and compares bit by bit with synthesise().
inline void expect_stream_is_whole(const Model& model, const Script& script,
                                   const StreamOptions& options) {
  const auto whole = synthesise(model, script, options.synthesis);
  ASSERT_TRUE(whole);
  SpeechStream stream(model, options);
  std::vector<double> values;
  for (const Phone& phone : script.phones) {
    ASSERT_TRUE(stream.push(phone));
    const auto piece = stream.pull();
    ASSERT_TRUE(piece);
    values.insert(values.end(), piece->values.begin(), piece->values.end());
  }
  const auto rest = stream.finish();
  values.insert(values.end(), rest->values.begin(), rest->values.end());
  EXPECT_EQ(values, whole->values);
}

}  // namespace animeme::dam
