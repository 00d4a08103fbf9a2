// Streaming through the program: clips, texts and lines sent over RTP on this machine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "codec/decode/decoder.h"
#include "fap/players.h"
#include "fap/text.h"
#include "tests/formats/media/live/stream_support.h"
#include "tools/formats/media/audio.h"

namespace animeme {
namespace stream_test {

using test::animeme;
using test::container;
using test::Running;
using test::Streams;
using test::wait_for;
using testing::HasSubstr;

TEST_F(Streams, WhatIsReceivedIsTheSourceByteForByte) {
  // Repeated, so that the receivers, who begin a little later, see all of the second round.
  Running send(sender({dir / "talk.mp4", "--loop", "--stats", "--json"}), dir / "s.out",
               dir / "s.err");
  ASSERT_TRUE(wait_for([&] { return described(); }));
  Running mp4({"receive", dir / "talk.sdp", "-o", dir / "got.mp4", "--json"}, dir / "1.out",
              dir / "1.err");
  ASSERT_TRUE(
      wait_for([&] { return test::slurp(dir / "s.err").find("\n6 s") != std::string::npos; }));
  send.signal(SIGINT);
  EXPECT_EQ(send.wait(), 130) << test::slurp(dir / "s.err");
  EXPECT_EQ(mp4.wait(), 0) << test::slurp(dir / "1.err");

  const media::Container source = container(dir / "talk.mp4"), got = container(dir / "got.mp4");
  ASSERT_GT(got.face.units.size(), source.face.units.size());
  EXPECT_EQ(got.face.timescale, source.face.timescale);
  EXPECT_EQ(got.face.config, source.face.config);
  // Where the first plane that was received lies in the source, and from there on plane by plane.
  const auto same = [&](std::size_t at, std::size_t i) {
    const auto& want = source.face.units[(at + i) % source.face.units.size()].bytes;
    const auto& have = got.face.units[i].bytes;
    const std::size_t tail = std::min(want.size(), have.size()) - 5;
    return std::equal(want.end() - std::ptrdiff_t(tail), want.end(),
                      have.end() - std::ptrdiff_t(tail));
  };
  std::size_t at = 0;
  while (at < source.face.units.size() && !(same(at, 0) && same(at, 1) && same(at, 2))) ++at;
  ASSERT_LT(at, source.face.units.size());
  for (std::size_t i = 0; i < got.face.units.size(); ++i) ASSERT_TRUE(same(at, i)) << i;
  // The sound is all there and was not coded again.
  const auto sound = media::read_encoded_audio(dir / "talk.mp4");
  const auto heard = media::read_encoded_audio(dir / "got.mp4");
  ASSERT_TRUE(sound && heard);
  EXPECT_EQ(sound->format.config, heard->format.config);
  std::size_t known = 0;
  for (const media::AudioPacket& packet : heard->packets) {
    known += std::any_of(sound->packets.begin(), sound->packets.end(),
                         [&](const media::AudioPacket& p) { return p.bytes == packet.bytes; });
  }
  EXPECT_EQ(known, heard->packets.size());
  EXPECT_THAT(test::slurp(dir / "1.out"), HasSubstr("\"interval_share_least\": 1.0"));
  EXPECT_THAT(test::slurp(dir / "s.out"), HasSubstr("\"late_99_ms\""));
}

TEST_F(Streams, TextAndStreamHaveTheFapsOfTheSource) {
  ASSERT_EQ(animeme({"demux", dir / "talk.mp4", "--face", dir / "talk.fba"}).exit_code, 0);
  ASSERT_EQ(animeme({"decode", dir / "talk.fba", "--coded", "-o", dir / "talk.fap"}).exit_code, 0);
  Running send(sender({dir / "talk.fba", "--loop", "--stats"}), dir / "s.out", dir / "s.err");
  ASSERT_TRUE(wait_for([&] { return described(); }));
  Running text({"receive", dir / "talk.sdp", "-o", "-", "--duration", "5"}, dir / "got.fap",
               dir / "1.err");
  EXPECT_EQ(text.wait(), 0) << test::slurp(dir / "1.err");
  Running stream({"receive", dir / "talk.sdp", "-o", dir / "got.fba", "--duration", "3"},
                 dir / "2.out", dir / "2.err");
  EXPECT_EQ(stream.wait(), 0) << test::slurp(dir / "2.err");
  Running players({"receive", dir / "talk.sdp", "-o", dir / "players.fap", "--duration", "2"},
                  dir / "3.out", dir / "3.err");
  EXPECT_EQ(players.wait(), 0) << test::slurp(dir / "3.err");
  EXPECT_THAT(fap::player_problems(test::slurp(dir / "players.fap")), testing::IsEmpty());
  send.signal(SIGTERM);
  EXPECT_EQ(send.wait(), 130);

  const auto source = fap::read_text(test::slurp(dir / "talk.fap"));
  const auto printed = fap::read_text(test::slurp(dir / "got.fap"));
  ASSERT_TRUE(source && printed);
  ASSERT_GT(printed->frames.size(), 100u);
  std::size_t at = 0;
  while (at < source->frames.size() &&
         !(source->frames[at].value == printed->frames[0].value &&
           source->frames[at + 1].value == printed->frames[1].value)) {
    ++at;
  }
  for (std::size_t i = 0; i < printed->frames.size(); ++i) {
    const fap::Frame& want = source->frames[(at + i) % source->frames.size()];
    ASSERT_EQ(printed->frames[i].value, want.value) << i;
    ASSERT_EQ(printed->frames[i].mask, want.mask) << i;
  }
  const std::string bytes = test::slurp(dir / "got.fba");
  const auto decoded =
      fba::decode({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  ASSERT_TRUE(decoded) << decoded.error().describe();
  EXPECT_GT(decoded->planes.size(), 70u);
}

TEST_F(Streams, LinesFromStandardInputAreSpokenAsTheyCome) {
  int pipe[2];
  ASSERT_EQ(::pipe2(pipe, O_CLOEXEC), 0);
  Running send(sender({"--say", "-", "--idle-motion", "--stats", "--json"}), dir / "s.out",
               dir / "s.err", pipe[0]);
  ::close(pipe[0]);
  ASSERT_TRUE(wait_for([&] { return described(); }));
  Running receive({"receive", dir / "talk.sdp", "-o", dir / "got.mp4"}, dir / "1.out",
                  dir / "1.err");
  ASSERT_TRUE(
      wait_for([&] { return test::slurp(dir / "s.err").find("\n1 s") != std::string::npos; }));
  ASSERT_GT(::write(pipe[1], "Good morning.\n", 14), 0);
  ASSERT_TRUE(
      wait_for([&] { return test::slurp(dir / "s.err").find("\n3 s") != std::string::npos; }));
  ASSERT_GT(::write(pipe[1], "Bye.", 4), 0);  // the end of the input ends the line
  ::close(pipe[1]);
  EXPECT_EQ(send.wait(), 0) << test::slurp(dir / "s.err");
  EXPECT_EQ(receive.wait(), 0) << test::slurp(dir / "1.err");
  EXPECT_THAT(test::slurp(dir / "s.out"), HasSubstr("\"lines\": 2"));
  const auto sound = media::read_audio(dir / "got.mp4", {.sample_rate = 16000});
  ASSERT_TRUE(sound);
  // Silence, a line, silence, a line: two stretches with sound.
  int stretches = 0, quiet = 16000;
  for (const float sample : sound->samples) {
    const bool loud = std::abs(sample) > 0.05F;
    stretches += loud && quiet > 8000;
    quiet = loud ? 0 : quiet + 1;
  }
  EXPECT_EQ(stretches, 2);
  EXPECT_GT(container(dir / "got.mp4").face.units.size(), 60u);
}

TEST_F(Streams, CtrlCLeavesAReadableFile) {
  Running send(sender({dir / "talk.mp4", "--loop"}), dir / "s.out", dir / "s.err");
  ASSERT_TRUE(wait_for([&] { return described(); }));
  Running receive({"receive", dir / "talk.sdp", "-o", dir / "got.mp4", "--stats"}, dir / "1.out",
                  dir / "1.err");
  ASSERT_TRUE(
      wait_for([&] { return test::slurp(dir / "1.err").find("1 s: ") != std::string::npos; }));
  receive.signal(SIGINT);
  EXPECT_EQ(receive.wait(), 130) << test::slurp(dir / "1.err");
  EXPECT_GT(container(dir / "got.mp4").face.units.size(), 10u);
  EXPECT_THAT(test::slurp(dir / "1.err"), HasSubstr("intra intervals"));
}

TEST_F(Streams, FastDoesNotWaitForTheClock) {
  const auto made =
      animeme(sender({dir / "talk.mp4", "--fast", "--loop", "--duration", "20", "--json"}));
  EXPECT_EQ(made.exit_code, 0) << made.err;
  const auto json = nlohmann::json::parse(made.out);
  EXPECT_NEAR(json["face"]["units"].get<double>(), 490, 15);  // a loop ends with a short pause
  EXPECT_NEAR(json["sound"]["units"].get<double>(), 20 * 22050 / 1024.0, 15);
  EXPECT_NEAR(json["seconds"].get<double>(), 20, 0.2);
}

TEST_F(Streams, AStreamThatCannotBeJoinedIsCodedAgain) {
  ASSERT_EQ(animeme({"demux", dir / "talk.mp4", "--face", dir / "talk.fba"}).exit_code, 0);
  ASSERT_EQ(animeme({"decode", dir / "talk.fba", "--coded", "-o", dir / "talk.fap"}).exit_code, 0);
  ASSERT_EQ(animeme({"encode", dir / "talk.fap", "-o", dir / "one.fba"}).exit_code, 0);
  const auto intra = [&](std::vector<std::string> more) {
    more.insert(more.end(), {dir / "one.fba", "--fast", "--json"});
    const auto made = animeme(sender(more));
    EXPECT_EQ(made.exit_code, 0) << made.err;
    const auto json = nlohmann::json::parse(made.out);
    return std::pair(json["face"]["intra"].get<int>(), made.err);
  };
  const auto [joints, talk] = intra({});
  EXPECT_GT(joints, 1);
  EXPECT_THAT(talk, HasSubstr("re-encoded, so that receivers can join every 1.0 s"));
  const auto [kept, warning] = intra({"--intra-seconds", "0.2", "--copy"});
  EXPECT_EQ(kept, 1);
  EXPECT_THAT(warning, HasSubstr("without --copy it is re-encoded"));
  EXPECT_GT(intra({"--intra-seconds", "0.2"}).first, 8);
}

}  // namespace stream_test
}  // namespace animeme
