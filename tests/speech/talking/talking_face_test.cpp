#include "tools/speech/talking/talking_face.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "dam/model/builtin.h"
#include "dam/signal/fap_signal.h"

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

}  // namespace talking_face_test
}  // namespace animeme::speech
