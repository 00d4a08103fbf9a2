#include "tools/speech/talking/talking_face.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "dam/model/builtin.h"
#include "dam/signal/fap_signal.h"
#include "fap/tables.h"

namespace animeme::speech {
namespace talking_face_test {

// A sentence of 4 s: phones of 70 to 130 ms.
dam::Script sentence() {
  dam::Script script;
  double at = 0;
  const char* labels[] = {"M",  "AA", "P",  "IY", "T",  "UW", "B", "AO", "F", "AE", "L", "OW", "W",
                          "EH", "K",  "AH", "N",  "S",  "IH", "M", "EY", "R", "UW", "D", "AA", "B",
                          "IY", "SH", "OW", "P",  "AE", "T",  "W", "AO", "M", "EH", "G", "UW"};
  for (std::size_t i = 0; i < std::size(labels); ++i) {
    const double end = at + 0.07 + 0.02 * double(i % 4);
    script.phones.push_back({at, end, labels[i], {}});
    at = end;
  }
  return script;
}

// The phones of a script from `first` to `last`, from 0 on.
dam::Script piece(const dam::Script& script, std::size_t first, std::size_t last) {
  dam::Script out;
  for (std::size_t i = first; i < last; ++i) {
    dam::Phone phone = script.phones[i];
    phone.start -= script.phones[first].start;
    phone.end -= script.phones[first].start;
    out.phones.push_back(phone);
  }
  return out;
}

class Face : public testing::Test {
 protected:
  void SetUp() override {
    auto built = dam::builtin_model();
    ASSERT_TRUE(built);
    model = std::move(*built);
  }
  TalkingFace open(bool idle_motion = false) {
    FaceOptions options;
    options.idle_motion = idle_motion;
    auto face = TalkingFace::open(model, options);
    return std::move(*face);
  }
  // A sentence in pieces of `phones` phones, each told `lead` seconds before its sound or, where
  // that has passed, with the first one.
  std::vector<fap::Frame> speak(std::size_t phones, double lead, bool idle_motion = false) {
    const dam::Script script = sentence();
    TalkingFace face = open(idle_motion);
    std::vector<fap::Frame> frames;
    std::size_t next = 0;
    const auto total = std::size_t(std::ceil(script.duration() * 25));
    while (frames.size() < total) {
      const double now = double(frames.size()) / 25;
      while (next < script.phones.size() && script.phones[next].start <= now + lead) {
        const std::size_t end = std::min(next + phones, script.phones.size());
        const auto line = face.join(piece(script, next, end), script.phones[next].start - now);
        EXPECT_TRUE(line) << line.error().describe();
        next = end;
      }
      auto frame = face.next();
      EXPECT_TRUE(frame);
      frames.push_back(*frame);
    }
    return frames;
  }
  // RMS over the FAPs of the lips, in units of FAPs.
  double distance(const std::vector<fap::Frame>& a, const std::vector<fap::Frame>& b) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
      for (const dam::Control& control : model.controls) {
        const auto fap = std::size_t(dam::fap_of_channel(control.name));
        const double off = double(a[i].value[fap]) - double(b[i].value[fap]);
        sum += off * off;
        ++count;
      }
    }
    return std::sqrt(sum / double(count));
  }

  dam::Model model;
};

TEST_F(Face, PiecesOfASentenceMoveAsTheSentence) {
  const auto whole = speak(1000, 0);
  // Before: pieces one by one, each for itself.
  const dam::Script script = sentence();
  TalkingFace face = open();
  std::vector<fap::Frame> alone;
  for (std::size_t i = 0; i < script.phones.size(); i += 2) {
    const std::size_t end = std::min(i + 2, script.phones.size());
    const double from = script.phones[i].start, to = script.phones[end - 1].end;
    ASSERT_TRUE(face.say(piece(script, i, end)));
    while (double(alone.size()) / 25 < to - 1e-9 && double(alone.size() + 1) / 25 > from) {
      alone.push_back(*face.next());
    }
  }
  const double usual = distance(alone, whole);
  std::cout << "two phones a piece: RMS from the whole sentence " << usual << " each for itself, ";
  for (const double lead : {0.5, 0.2}) {
    const double joined = distance(speak(2, lead), whole);
    std::cout << joined << " told " << lead << " s before";
    std::cout << (lead == 0.5 ? ", " : "\n");
    EXPECT_LT(joined, usual / (lead == 0.5 ? 4 : 2));
  }
}

TEST_F(Face, JoiningNeverJumps) {
  const auto whole = speak(1000, 0, true), pieces = speak(3, 0.3, true);
  const auto quickest = [&](const std::vector<fap::Frame>& frames, std::size_t fap) {
    int most = 0;
    for (std::size_t i = 1; i < frames.size(); ++i) {
      most = std::max(most, std::abs(frames[i].value[fap] - frames[i - 1].value[fap]));
    }
    return most;
  };
  // Jaw, lower lip, a lid (it closes in two frames), the head.
  for (const std::size_t fap : {3, 5, 48}) {
    EXPECT_LE(quickest(pieces, fap), quickest(whole, fap) * 3 / 2 + 5) << fap;
  }
  EXPECT_LE(quickest(pieces, 19), 1024);
}

TEST_F(Face, JoiningNothingIsALineAfterSilence) {
  TalkingFace face = open();
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(face.next());
  const auto line = face.join(piece(sentence(), 0, 4), 0.4);
  ASSERT_TRUE(line);
  EXPECT_EQ(line->first, 10);
  EXPECT_NEAR(double(line->frames), (0.4 + piece(sentence(), 0, 4).duration()) * 25, 2);
  EXPECT_FALSE(face.join(sentence(), -1));
  EXPECT_FALSE(face.join(sentence(), std::nan("")));
  EXPECT_TRUE(face.speaking()) << "the line before goes on";
}

// Frames of 0.04 s.
std::vector<fap::Frame> take(TalkingFace& face, int count) {
  std::vector<fap::Frame> frames;
  for (int i = 0; i < count; ++i) {
    auto frame = face.next();
    EXPECT_TRUE(frame);
    frames.push_back(*frame);
  }
  return frames;
}

// Brows become part of the frames where a question asks for them.
TEST_F(Face, QuestionsRaiseBrowsWithoutLife) {
  TalkingFace face = open(false);
  const auto highest = [&](const std::string& mark) {
    const dam::Script script{{{0, 0.5, "SIL", ""},
                              {0.5, 0.8, "S", "so" + mark},
                              {0.8, 1.4, "OW", "so" + mark},
                              {1.4, 3, "SIL", ""}}};
    EXPECT_TRUE(face.say(script));
    int most = 0;
    for (int i = 0; i < 75; ++i) {
      const auto frame = face.next();
      EXPECT_TRUE(frame);
      EXPECT_EQ(frame->mask, face.mask());
      most = std::max(most, frame->value[33]);
    }
    return most;
  };
  EXPECT_EQ(highest("."), 0);
  EXPECT_FALSE(face.mask()[33] || face.mask()[19]);
  EXPECT_GT(highest("?"), 40);
  EXPECT_TRUE(face.mask()[33]);
  EXPECT_EQ(highest("."), 0);
}

TEST_F(Face, WithoutAMoodSpeechIsAsItWas) {
  TalkingFace face = open();
  ASSERT_TRUE(face.say(sentence()));
  const auto frames = take(face, 60);
  dam::SynthesisOptions options;
  const auto clip = dam::to_sequence(*dam::synthesise(model, sentence(), options));
  for (std::size_t i = 8; i < 60; ++i) {  // the beginning is led over from rest
    EXPECT_EQ(frames[i].mask, face.mask());
    EXPECT_EQ(frames[i].value, clip->frames[i].value) << i;
  }
}

TEST_F(Face, MoodsOfTheFaceAndOfALine) {
  FaceOptions options;
  options.mood = {"anger", 1};
  TalkingFace face = *TalkingFace::open(model, options);
  const auto brow = [&](const std::string& mood) {
    return int(std::lround(dam::mood_pose({mood, 1}).fap[31]));
  };
  EXPECT_EQ(take(face, 1)[0].value[31], brow("anger")) << "from the first frame";
  LineMoods moods;
  moods.mood = dam::Mood{"surprise", 1};
  moods.spans = {{2, 3, dam::Mood{"sadness", 1}, 1}};
  ASSERT_TRUE(face.say(sentence(), moods));
  const auto line = take(face, 130);
  EXPECT_EQ(line[30].value[31], brow("surprise"));
  EXPECT_EQ(line[68].value[31], brow("sadness"));
  EXPECT_EQ(line[90].value[31], brow("surprise"));
  EXPECT_EQ(line[129].value[31], brow("anger")) << "behind the line";
  face.set_mood({"joy", 1});
  const auto later = take(face, 12);
  EXPECT_NE(later[2].value[31], brow("joy"));
  EXPECT_EQ(later[11].value[31], brow("joy"));
  face.set_mood({});
  EXPECT_EQ(take(face, 20)[19].value[31], 0);
}

TEST_F(Face, MoodsNeverJump) {
  const std::vector<std::string> names = dam::mood_names();
  const auto soak = [&](bool moody) {
    TalkingFace face = open();
    std::vector<fap::Frame> frames;
    std::uint32_t seed = 7;
    const auto below = [&](std::uint32_t n) {
      seed = seed * 1664525u + 1013904223u;
      return (seed >> 8) % n;
    };
    for (int i = 0; i < 200; ++i) {
      const dam::Mood mood{names[below(std::uint32_t(names.size()))], 1};
      const auto what = below(4);
      LineMoods moods;
      if (moody && below(2) == 0) moods.mood = mood;
      if (moody) moods.spans = {{0.5, 1.1, mood, 1}, {0.9, 1.3, std::nullopt, 0.3}};
      if (what == 0) {
        EXPECT_TRUE(face.cut());
      } else if (what == 1) {
        EXPECT_TRUE(face.join(sentence(), 0.1 * below(5), moods));
      } else if (what == 2) {
        EXPECT_TRUE(face.say(sentence(), moods));
      } else if (moody) {
        face.set_mood(mood);
      }
      for (const fap::Frame& frame : take(face, int(1 + below(40)))) frames.push_back(frame);
    }
    return frames;
  };
  const auto quickest = [](const std::vector<fap::Frame>& frames, std::size_t fap) {
    int most = 0;
    for (std::size_t i = 1; i < frames.size(); ++i)
      most = std::max(most, std::abs(frames[i].value[fap] - frames[i - 1].value[fap]));
    return most;
  };
  const auto plain = soak(false), moody = soak(true);
  for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    double low = 0, high = 0;
    for (const std::string& name : names) {
      low = std::min(low, dam::mood_pose({name, 1}).fap[fap]);
      high = std::max(high, dam::mood_pose({name, 1}).fap[fap]);
    }
    // A mood takes 0.4 s; the mouth, which speech takes hold of, 0.1 s.
    const auto& info = fap::info(int(fap));
    const bool mouth = info.group == 2 || info.group == 8;
    const double most = (high - low) * 0.04 * (mouth ? 1.6 / 0.1 : 1.6 / 0.4);
    const double speech = 1.4 * quickest(plain, fap);  // of shouting
    EXPECT_LE(quickest(moody, fap), speech + most + 1) << fap;
  }
}

// A head that looks about and smiles, for two seconds.
std::shared_ptr<const dam::Performance> performance() {
  fap::Sequence clip{{25, 1}, {}, ""};
  for (int i = 0; i < 50; ++i) {
    fap::Frame frame;
    frame.number = i;
    frame.set(12, 150), frame.set(13, 150);
    frame.set(49, std::int32_t(std::lround(8000 * std::sin(i * 0.12))));
    frame.set(31, 100 + i);
    clip.frames.push_back(frame);
  }
  return std::make_shared<const dam::Performance>(*dam::Performance::make(clip));
}

TEST(TalkingFace, SpeaksOverAPerformance) {
  const dam::Model model = *dam::builtin_model();
  FaceOptions options;
  options.idle_motion = true;
  auto alone = TalkingFace::open(model, options);
  options.over = performance();
  auto kept = TalkingFace::open(model, options);
  ASSERT_TRUE(alone);
  ASSERT_TRUE(kept);
  fap::Frame before;
  for (int i = 0; i < 260; ++i) {
    if (i == 30) {
      ASSERT_TRUE(kept->say(sentence()));
      ASSERT_TRUE(alone->say(sentence()));
    }
    const auto frame = kept->next(), other = alone->next();
    ASSERT_TRUE(frame);
    ASSERT_TRUE(other);
    EXPECT_EQ(frame->mask, kept->mask());
    if (i < 50) {
      EXPECT_EQ(frame->value[49], std::int32_t(std::lround(8000 * std::sin(i * 0.12))));
      EXPECT_EQ(frame->value[31], 100 + i);
    }
    // Groups that it lacks go on as without it; lips meet where they met.
    EXPECT_EQ(frame->value[19], other->value[19]);
    const int gap = -(frame->value[4] + frame->value[5]);
    const int gap_alone = -(other->value[4] + other->value[5]);
    if (gap_alone < 30) {
      EXPECT_LT(gap, 45) << "frame " << i;
    }
    // It repeats without a jump.
    if (i > 0) {
      EXPECT_LT(std::abs(frame->value[49] - before.value[49]), 1200) << "frame " << i;
      EXPECT_LT(std::abs(frame->value[31] - before.value[31]), 12) << "frame " << i;
    }
    before = *frame;
  }
  EXPECT_GT(before.value[12], 60);
}

}  // namespace talking_face_test
}  // namespace animeme::speech
