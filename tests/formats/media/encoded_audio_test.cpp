// Coded sound: in place to the sample, the same in any cut, and silent where packets are missing.
#include "tools/formats/media/encoded_audio.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <span>

#include "tests/formats/media/media_support.h"
#include "tests/support/folders.h"
#include "tools/formats/media/audio.h"

namespace animeme::media {
namespace encoded_audio_test {

struct Rate {
  AudioCodec codec;
  int sample_rate;
};

std::string name(const testing::TestParamInfo<Rate>& info) {
  return std::string(name_of(info.param.codec)) + "_" + std::to_string(info.param.sample_rate);
}

class EncodedAudioRate : public testing::TestWithParam<Rate> {};

TEST_P(EncodedAudioRate, ClicksComeBackInPlace) {
  const auto [codec, rate] = GetParam();
  const auto length = std::size_t(rate) * 2 + 123;
  const std::vector<std::size_t> starts = {std::size_t(rate) / 2 + 37, std::size_t(rate) + 11};
  const Pcm sound = test::make_clicks(rate, length, starts);
  const Result<EncodedAudio> coded = encode_audio(sound, {.codec = codec});
  ASSERT_TRUE(coded) << coded.error().describe();
  const int coded_rate = coded->format.sample_rate;
  EXPECT_EQ(coded->format.codec, codec);
  EXPECT_EQ(coded->format.channels, 1);
  EXPECT_EQ(coded->format.priming, codec == AudioCodec::aac ? 1024 : 312);
  EXPECT_EQ(coded->packets.front().time, -coded->format.priming);
  EXPECT_EQ(coded->length, std::llround(double(length) * coded_rate / rate));
  const Result<Pcm> back = decode_audio(*coded);
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_EQ(back->sample_rate, coded_rate);
  EXPECT_EQ(back->samples.size(), std::size_t(coded->length));
  const double limit = codec == AudioCodec::aac ? 1.01 : 0.001 * coded_rate;
  for (const std::size_t start : starts) {
    const double wanted = double(start) * coded_rate / rate;
    EXPECT_NEAR(double(test::find_click(*back, std::int64_t(wanted), 2000)), wanted, limit);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Rates, EncodedAudioRate,
    testing::Values(Rate{AudioCodec::aac, 16000}, Rate{AudioCodec::aac, 22050},
                    Rate{AudioCodec::aac, 44100}, Rate{AudioCodec::aac, 48000},
                    Rate{AudioCodec::aac, 47999}, Rate{AudioCodec::aac, 192000},
                    Rate{AudioCodec::opus, 16000}, Rate{AudioCodec::opus, 44100},
                    Rate{AudioCodec::opus, 48000}, Rate{AudioCodec::opus, 192000}),
    name);

TEST(EncodedAudio, EveryRateIsTaken) {
  for (const AudioCodec codec : {AudioCodec::aac, AudioCodec::opus}) {
    for (const int rate : {1000, 7350, 7351, 11025, 12345, 64000, 96000, 384000}) {
      const Pcm sound{rate, std::vector<float>(std::size_t(rate) / 4 + 3, 0.1f)};
      const Result<EncodedAudio> coded = encode_audio(sound, {.codec = codec});
      ASSERT_TRUE(coded) << rate << coded.error().describe();
      EXPECT_GE(coded->format.sample_rate, std::min(rate, 48000));
      const Result<Pcm> back = decode_audio(*coded);
      ASSERT_TRUE(back) << rate << back.error().describe();
      EXPECT_NEAR(back->duration(), sound.duration(), 0.6 / coded->format.sample_rate) << rate;
    }
  }
}

std::vector<float> noise(std::size_t count) {
  std::uint32_t state = 3;
  std::vector<float> samples(count);
  for (float& sample : samples) {
    state = state * 1664525u + 1013904223u;
    sample = float(state >> 8) / float(1 << 24) - 0.5f;
  }
  return samples;
}

TEST(EncodedAudio, SamePacketsInAnyCut) {
  for (const AudioCodec codec : {AudioCodec::aac, AudioCodec::opus}) {
    for (const int rate : {48000, 22050, 20000}) {
      const Pcm sound{rate, noise(std::size_t(rate) + 77)};
      const Result<EncodedAudio> whole = encode_audio(sound, {.codec = codec});
      ASSERT_TRUE(whole) << whole.error().describe();
      for (const std::size_t cut : {1u, 100u, 1024u, 5000u}) {
        Result<AudioEncoder> encoder = AudioEncoder::open(rate, {.codec = codec});
        ASSERT_TRUE(encoder) << encoder.error().describe();
        EXPECT_EQ(encoder->format(), whole->format);
        std::vector<AudioPacket> packets;
        const std::span<const float> all(sound.samples);
        for (std::size_t at = 0; at < all.size(); at += cut) {
          auto some = encoder->push(all.subspan(at, std::min(cut, all.size() - at)));
          ASSERT_TRUE(some) << some.error().describe();
          packets.insert(packets.end(), some->begin(), some->end());
        }
        const auto rest = encoder->finish();
        ASSERT_TRUE(rest) << rest.error().describe();
        packets.insert(packets.end(), rest->begin(), rest->end());
        EXPECT_EQ(packets, whole->packets) << name_of(codec) << " " << rate << " cut " << cut;
      }
    }
  }
}

TEST(EncodedAudio, PacketsFollowEachOtherWithoutGaps) {
  for (const AudioCodec codec : {AudioCodec::aac, AudioCodec::opus}) {
    const Result<EncodedAudio> coded = encode_audio({48000, noise(50000)}, {.codec = codec});
    ASSERT_TRUE(coded);
    std::int64_t at = -coded->format.priming;
    for (const AudioPacket& packet : coded->packets) {
      EXPECT_EQ(packet.time, at);
      at += packet.duration;
    }
    EXPECT_EQ(at, 50000);
    EXPECT_EQ(at, coded->length);
  }
}

TEST(EncodedAudio, ShortSoundsKeepTheirLength) {
  for (const AudioCodec codec : {AudioCodec::aac, AudioCodec::opus}) {
    for (const std::size_t length : {1u, 2u, 311u, 312u, 313u, 648u, 649u, 960u, 1024u, 1025u}) {
      const Pcm sound{48000, std::vector<float>(length, 0.25f)};
      const Result<EncodedAudio> coded = encode_audio(sound, {.codec = codec});
      ASSERT_TRUE(coded) << length << coded.error().describe();
      EXPECT_EQ(coded->length, std::int64_t(length)) << name_of(codec);
      const Result<Pcm> back = decode_audio(*coded);
      ASSERT_TRUE(back) << length << back.error().describe();
      EXPECT_EQ(back->samples.size(), length);
    }
  }
}

TEST(EncodedAudio, NonsenseSamplesDoNotSpread) {
  Pcm sound = test::make_clicks(16000, 32000, {8000});
  Pcm odd = sound;
  odd.samples[100] = NAN;
  Pcm silent = sound;
  silent.samples[100] = 0;
  for (const AudioCodec codec : {AudioCodec::aac, AudioCodec::opus}) {
    const auto coded = encode_audio(odd, {.codec = codec});
    ASSERT_TRUE(coded) << coded.error().describe();
    EXPECT_EQ(*coded, *encode_audio(silent, {.codec = codec}));
    odd.samples[200] = INFINITY;
    odd.samples[201] = -1e30f;
    EXPECT_TRUE(encode_audio(odd, {.codec = codec}));
    odd.samples[200] = odd.samples[201] = 0;
  }
}

TEST(EncodedAudio, MissingPacketsAreSilence) {
  for (const AudioCodec codec : {AudioCodec::aac, AudioCodec::opus}) {
    const Pcm sound = test::make_clicks(48000, 96000, {12000, 48000, 84000});
    Result<EncodedAudio> coded = encode_audio(sound, {.codec = codec});
    ASSERT_TRUE(coded);
    std::erase_if(coded->packets, [](const AudioPacket& packet) {
      return packet.time > 40000 && packet.time < 56000;
    });
    const Result<Pcm> back = decode_audio(*coded);
    ASSERT_TRUE(back) << back.error().describe();
    EXPECT_EQ(back->samples.size(), 96000u);
    EXPECT_NEAR(double(test::find_click(*back, 12000, 2000)), 12000, 48);
    EXPECT_NEAR(double(test::find_click(*back, 84000, 2000)), 84000, 48);
    for (std::size_t i = 44000; i < 54000; ++i) ASSERT_EQ(back->samples[i], 0.0f) << i;
  }
}

TEST(EncodedAudio, ADamagedPacketIsAMissingOne) {
  const Pcm sound = test::make_clicks(48000, 96000, {12000, 84000});
  Result<EncodedAudio> coded = encode_audio(sound);
  ASSERT_TRUE(coded);
  coded->packets[40].bytes.assign(20, 0xFF);
  const Result<Pcm> back = decode_audio(*coded);
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_EQ(back->samples.size(), 96000u);
  EXPECT_NEAR(double(test::find_click(*back, 84000, 2000)), 84000, 1.01);
}

TEST(EncodedAudio, BitRateIsKept) {
  for (const AudioCodec codec : {AudioCodec::aac, AudioCodec::opus}) {
    const Pcm sound{48000, noise(240000)};
    for (const int rate : {24000, 96000}) {
      const auto coded = encode_audio(sound, {.codec = codec, .bit_rate = rate});
      ASSERT_TRUE(coded);
      double bytes = 0;
      for (const AudioPacket& packet : coded->packets) bytes += double(packet.bytes.size());
      EXPECT_NEAR(bytes * 8 / 5, rate, 0.2 * rate) << name_of(codec);
    }
  }
}

TEST(EncodedAudio, RefusalsNameTheReason) {
  const auto refused = [](const auto& result, Code code, const std::string& words) {
    ASSERT_FALSE(result) << words;
    EXPECT_EQ(result.error().code, code);
    EXPECT_THAT(result.error().message, testing::HasSubstr(words));
  };
  refused(encode_audio({48000, {}}), Code::invalid_argument, "empty");
  refused(AudioEncoder::open(999), Code::invalid_argument, "sample rate");
  refused(AudioEncoder::open(48000, {.bit_rate = 7999}), Code::invalid_argument, "bit rate of aac");
  refused(AudioEncoder::open(48000, {.codec = AudioCodec::opus, .bit_rate = 256001}),
          Code::invalid_argument, "bit rate of opus");
  Result<AudioEncoder> encoder = AudioEncoder::open(48000);
  ASSERT_TRUE(encoder);
  const auto nothing = encoder->finish();
  ASSERT_TRUE(nothing);
  EXPECT_TRUE(nothing->empty());
  refused(encoder->push(std::vector<float>(10)), Code::invalid_argument, "finished");
  refused(decode_audio({}), Code::invalid_argument, "empty");
  Result<EncodedAudio> coded = encode_audio({48000, noise(9000)});
  ASSERT_TRUE(coded);
  EncodedAudio order = *coded;
  order.packets[2].time = order.packets[1].time;
  refused(decode_audio(order), Code::invalid_argument, "ascend");
  EncodedAudio endless = *coded;
  endless.packets.back().time = std::int64_t(48000) * 3600 * 4;
  endless.length = 0;
  refused(decode_audio(endless), Code::out_of_range, "3 hours");
  EncodedAudio junk = *coded;
  for (AudioPacket& packet : junk.packets) packet.bytes.assign(9, 0xFF);
  refused(decode_audio(junk), Code::syntax, "can be decoded");
}

// A share of the packets of a voice that have the one before them again: RFC 6716, section 4.2.4,
// and, of the table of contents in front, RFC 6716, section 3.1.
double share_with_fec(const EncodedAudio& sound) {
  std::size_t with = 0;
  for (const AudioPacket& packet : sound.packets) {
    const unsigned toc = packet.bytes.at(0);
    const bool one_frame = (toc & 3) == 0, has_silk = (toc >> 3) < 16, of_20_ms = toc >> 3 & 1;
    EXPECT_TRUE(one_frame);
    if (has_silk && of_20_ms && packet.bytes.size() > 1) with += packet.bytes[1] >> 6 & 1;
  }
  return double(with) / double(sound.packets.size());
}

TEST(EncodedAudio, OpusRepeatsWhatIsExpectedToBeLost) {
  const auto voice =
      read_audio(std::string(test::kSourceFolder) + "/tools/release/samples/voice.wav");
  ASSERT_TRUE(voice);
  AudioSettings settings{AudioCodec::opus, 48000, 5};
  const auto plain = encode_audio(*voice, settings);
  settings.expected_loss = 10;
  const auto repeated = encode_audio(*voice, settings);
  ASSERT_TRUE(plain && repeated);
  EXPECT_EQ(share_with_fec(*plain), 0);
  EXPECT_GT(share_with_fec(*repeated), 0.5);
  EXPECT_EQ(repeated->format.priming, plain->format.priming) << "sound and face stay together";
  std::size_t plain_bytes = 0, repeated_bytes = 0;
  for (const AudioPacket& packet : plain->packets) plain_bytes += packet.bytes.size();
  for (const AudioPacket& packet : repeated->packets) repeated_bytes += packet.bytes.size();
  EXPECT_NEAR(double(repeated_bytes), double(plain_bytes), 0.1 * double(plain_bytes));
  for (const int wrong : {-2, 51}) {
    settings.expected_loss = wrong;
    EXPECT_EQ(encode_audio(*voice, settings).error().code, Code::invalid_argument);
  }
}

// Mean square of the difference of two sounds in [from, to) seconds.
double difference(const Pcm& one, const Pcm& other, double from, double to) {
  double sum = 0;
  const auto begin = std::size_t(from * one.sample_rate), end = std::size_t(to * one.sample_rate);
  for (std::size_t i = begin; i < end; ++i) {
    const double apart = double(one.samples.at(i)) - double(other.samples.at(i));
    sum += apart * apart / double(end - begin);
  }
  return sum;
}

// A voice of eight seconds at 48 kHz, whose packets from each of `turns` on (seconds) expect
// another loss.
EncodedAudio encoded_with_turns(const Pcm& voice, AudioSettings settings,
                                const std::vector<std::pair<double, int>>& turns) {
  auto encoder = AudioEncoder::open(voice.sample_rate, settings);
  EXPECT_TRUE(encoder);
  EncodedAudio sound{encoder->format(), {}, std::int64_t(voice.samples.size())};
  const auto add = [&](Result<std::vector<AudioPacket>> packets) {
    ASSERT_TRUE(packets);
    for (AudioPacket& packet : *packets) sound.packets.push_back(std::move(packet));
  };
  std::size_t at = 0;
  for (const auto& [time, percent] : turns) {
    const auto until = std::size_t(time * voice.sample_rate);
    add(encoder->push(std::span(voice.samples).subspan(at, until - at)));
    EXPECT_TRUE(encoder->expect_loss(percent));
    at = until;
  }
  add(encoder->push(std::span(voice.samples).subspan(at)));
  add(encoder->finish());
  return sound;
}

EncodedAudio part_of(const EncodedAudio& sound, double from, double to) {
  EncodedAudio part{sound.format, {}, 0};
  for (const AudioPacket& packet : sound.packets) {
    const double time = double(packet.time) / sound.format.sample_rate;
    if (time >= from && time < to) part.packets.push_back(packet);
  }
  return part;
}

// The loss that is expected changes while a voice is encoded: no packet is missing, none comes
// twice, and nothing is heard of the change.
TEST(EncodedAudio, OpusFollowsTheLossThatIsExpected) {
  const auto read =
      read_audio(std::string(test::kSourceFolder) + "/tools/release/samples/voice.wav");
  ASSERT_TRUE(read);
  auto voice = resample(*read, 48000);
  ASSERT_TRUE(voice);
  const std::vector<float> once = voice->samples;
  while (voice->duration() < 8) {
    voice->samples.insert(voice->samples.end(), once.begin(), once.end());
  }
  voice->samples.resize(48000 * 8);
  for (const int effort : {5, 10}) {
    AudioSettings settings{AudioCodec::opus, 48000, effort};
    const auto fixed = [&](int percent) {
      settings.expected_loss = percent;
      return encode_audio(*voice, settings);
    };
    const auto plain = fixed(0), most = fixed(20);
    ASSERT_TRUE(plain && most);
    settings.expected_loss = AudioSettings::kLossByReports;
    const auto untold = encode_audio(*voice, settings);
    ASSERT_TRUE(untold);
    EXPECT_EQ(untold->packets, plain->packets) << "nothing was said";

    const EncodedAudio sound =
        encoded_with_turns(*voice, settings, {{2, 10}, {4, 20}, {4.1, 5}, {6, 0}});
    ASSERT_EQ(sound.packets.size(), plain->packets.size());
    for (std::size_t i = 0; i < sound.packets.size(); ++i) {
      EXPECT_EQ(sound.packets[i].time, plain->packets[i].time);
      EXPECT_EQ(sound.packets[i].duration, plain->packets[i].duration);
    }
    EXPECT_EQ(share_with_fec(part_of(sound, 0, 2.15)), 0);
    EXPECT_GT(share_with_fec(part_of(sound, 2.3, 6)), 0.4);
    EXPECT_EQ(share_with_fec(part_of(sound, 6.25, 8)), 0);

    // Noise of coding around the turns is what it is elsewhere.
    const auto heard = decode_audio(sound), a = decode_audio(*plain), b = decode_audio(*most);
    ASSERT_TRUE(heard && a && b);
    for (double time = 0.2; time < 7.8; time += 0.02) {
      const double usual = std::max(difference(*a, *voice, time - 0.04, time + 0.06),
                                    difference(*b, *voice, time - 0.04, time + 0.06));
      EXPECT_LT(difference(*heard, *voice, time, time + 0.02), 6 * usual + 1e-6)
          << time << " s, effort " << effort;
    }
    // One that was fixed stays so, AAC has none, and there are bounds.
    settings.expected_loss = 0;
    EXPECT_EQ(encoded_with_turns(*voice, settings, {{2, 20}}).packets, plain->packets);
  }
  auto encoder = AudioEncoder::open(48000, {.expected_loss = AudioSettings::kLossByReports});
  ASSERT_TRUE(encoder);
  EXPECT_TRUE(encoder->expect_loss(50));
  EXPECT_EQ(encoder->expect_loss(-1).error().code, Code::invalid_argument);
  EXPECT_EQ(encoder->expect_loss(51).error().code, Code::invalid_argument);
}

}  // namespace encoded_audio_test
}  // namespace animeme::media
