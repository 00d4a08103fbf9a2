// Clients of five speech services, which pass on what their public documentation describes: sound
// in pieces of any length, and times of words with it, before it, behind it or never. No sound is
// lost, its order stays, and words are told where they are heard.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "codec/decode/access_unit.h"
#include "codec/decode/decoder.h"
#include "dam/model/builtin.h"
#include "tests/support/sanitized.h"
#include "tests/support/shared.h"
#include "tools/formats/files/base64.h"
#include "tools/formats/files/files.h"
#include "tools/formats/media/audio.h"
#include "tools/speech/talking/line_queue.h"
#include "tools/speech/talking/live_speaker.h"
#include "tools/speech/talking/pieces.h"
#include "tools/speech/talking/sound_coding.h"
#include "tools/speech/voice/listen_stream.h"
#include "tools/speech/voice/voice.h"

namespace animeme::speech {
namespace services_test {

using media::LiveTrack;
using Json = nlohmann::json;

constexpr int kPieces = 40;
constexpr double kSync = 0.04;  // seconds

const dam::Model& character() {
  static const dam::Model model = std::move(*dam::builtin_model());
  return model;
}

struct Word {
  double start = 0, end = 0;
  std::string text;
};

// What a service says: words, each a tone, and how it cuts them.
struct Utterance {
  std::vector<Word> words;
  std::vector<double> cuts;  // begin of each piece, and the end
  double seconds() const { return cuts.back(); }
  double sound(double time) const {
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (time < words[i].start || time >= words[i].end) continue;
      return 0.5 * std::sin(2 * M_PI * (300 + 20 * double(i)) * (time - words[i].start));
    }
    return 0;
  }
};

Utterance make_utterance(unsigned seed, int pieces = kPieces) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * double(random() % 1000) / 1000;
  };
  Utterance made;
  made.cuts = {0};
  for (int i = 0; i < pieces; ++i) made.cuts.push_back(made.cuts.back() + between(0.05, 0.6));
  const char* const texts[] = {"hello", "there", "my", "name", "is", "Anna", "and", "we", "talk"};
  for (double at = between(0.02, 0.2); at < made.seconds() - 0.5; at += between(0.06, 0.3)) {
    const double end = at + between(0.15, 0.45);
    made.words.push_back({at, end, texts[made.words.size() % 9]});
    at = end;
  }
  return made;
}

enum class Coding { s16, f32, mulaw };

std::uint8_t mulaw_of(double value) {
  // The nearest of all codes: the test knows no other way.
  static const std::vector<float> all = [] {
    std::vector<float> codes;
    for (int i = 0; i < 256; ++i) codes.push_back(from_mulaw(std::uint8_t(i)));
    return codes;
  }();
  const auto nearest = std::min_element(all.begin(), all.end(), [value](float a, float b) {
    return std::abs(a - value) < std::abs(b - value);
  });
  return std::uint8_t(nearest - all.begin());
}

std::vector<std::uint8_t> coded(const std::vector<double>& samples, Coding coding) {
  std::vector<std::uint8_t> bytes;
  for (const double sample : samples) {
    if (coding == Coding::mulaw) {
      bytes.push_back(mulaw_of(sample));
      continue;
    }
    std::uint32_t bits = 0;
    if (coding == Coding::s16) {
      bits = std::uint16_t(std::int16_t(std::lround(sample * 32767)));
    } else {
      const auto value = float(sample);
      std::memcpy(&bits, &value, sizeof bits);
    }
    for (int i = 0; i < (coding == Coding::s16 ? 2 : 4); ++i)
      bytes.push_back(bits >> (8 * i) & 255);
  }
  return bytes;
}

struct Message {
  double after = 0;  // seconds behind the instant at which its piece is there
  std::string line;
};

// One piece and its surroundings as a client sees them.
struct Chunk {
  std::string name;  // of the utterance
  double start = 0, end = 0;
  std::string audio;        // base64
  std::vector<Word> words;  // that begin in it
  bool first = false, last = false;
};

struct Service {
  const char* name;
  int rate;
  Coding coding;
  bool words;  // whether it tells of them
  std::function<std::vector<Message>(const Chunk&)> say;
};

std::vector<Message> azure(const Chunk& chunk) {
  std::vector<Message> messages;
  const auto ticks = [](double seconds) { return std::llround(seconds * 1e7); };
  for (const Word& word : chunk.words) {
    messages.push_back({0, Json({{"utterance", chunk.name},
                                 {"audioOffset", ticks(word.start)},
                                 {"duration", ticks(word.end - word.start)},
                                 {"text", word.text},
                                 {"boundaryType", "WordBoundary"}})
                               .dump()});
  }
  messages.push_back({0, Json({{"utterance", chunk.name},
                               {"audio", chunk.audio},
                               {"output_format", "raw-24khz-16bit-mono-pcm"}})
                             .dump()});
  if (chunk.last) messages.push_back({0, Json({{"utterance", chunk.name}, {"done", true}}).dump()});
  return messages;
}

std::vector<Message> eleven_labs(const Chunk& chunk) {
  std::vector<Message> messages;
  if (chunk.first) messages.push_back({0, Json({{"output_format", "pcm_22050"}}).dump()});
  Json alignment = nullptr;
  if (!chunk.words.empty()) {
    Json chars = Json::array(), starts = Json::array(), lengths = Json::array();
    for (const Word& word : chunk.words) {
      const double each = (word.end - word.start) / double(word.text.size()) * 1000;
      for (std::size_t i = 0; i < word.text.size(); ++i) {
        chars.push_back(std::string(1, word.text[i]));
        starts.push_back((word.start - chunk.start) * 1000 + double(i) * each);
        lengths.push_back(each);
      }
      chars.push_back(" ");
      starts.push_back((word.end - chunk.start) * 1000);
      lengths.push_back(1);
    }
    alignment = {{"chars", chars}, {"charStartTimesMs", starts}, {"charDurationsMs", lengths}};
  }
  messages.push_back({0, Json({{"audio", chunk.audio},
                               {"isFinal", false},
                               {"alignment", alignment},
                               {"normalizedAlignment", alignment},
                               {"contextId", chunk.name}})
                             .dump()});
  if (chunk.last) {
    messages.push_back({0, Json({{"isFinal", true}, {"contextId", chunk.name}}).dump()});
  }
  return messages;
}

std::vector<Message> cartesia(const Chunk& chunk) {
  std::vector<Message> messages;
  if (chunk.first) {
    messages.push_back({0, Json({{"encoding", "pcm_f32le"}, {"sample_rate", 44100}}).dump()});
  }
  messages.push_back({0, Json({{"type", "chunk"},
                               {"status_code", 206},
                               {"done", false},
                               {"step_time", 12.3},
                               {"data", chunk.audio},
                               {"context_id", chunk.name}})
                             .dump()});
  if (!chunk.words.empty()) {
    Json texts = Json::array(), starts = Json::array(), ends = Json::array();
    for (const Word& word : chunk.words) {
      texts.push_back(word.text);
      starts.push_back(word.start);
      ends.push_back(word.end);
    }
    messages.push_back(
        {0.03, Json({{"type", "timestamps"},
                     {"status_code", 206},
                     {"done", false},
                     {"context_id", chunk.name},
                     {"word_timestamps", {{"words", texts}, {"start", starts}, {"end", ends}}}})
                   .dump()});
  }
  if (chunk.last) {
    messages.push_back(
        {0.04, Json({{"type", "done"}, {"done", true}, {"context_id", chunk.name}}).dump()});
  }
  return messages;
}

std::vector<Message> open_ai(const Chunk& chunk) {
  std::vector<Message> messages;
  if (chunk.first) messages.push_back({0, Json({{"sample_rate", 24000}}).dump()});
  const auto event = [&](const char* type) {
    return Json({{"type", type},
                 {"event_id", "event_1"},
                 {"response_id", chunk.name},
                 {"item_id", "item_" + chunk.name},
                 {"output_index", 0},
                 {"content_index", 0}});
  };
  for (const Word& word : chunk.words) {
    Json text = event("response.output_audio_transcript.delta");
    text["delta"] = word.text + " ";
    messages.push_back({0, text.dump()});
  }
  Json sound = event("response.output_audio.delta");
  sound["delta"] = chunk.audio;
  messages.push_back({0, sound.dump()});
  if (chunk.last) messages.push_back({0, event("response.output_audio.done").dump()});
  return messages;
}

std::vector<Message> deepgram(const Chunk& chunk) {
  std::vector<Message> messages;
  if (chunk.first) {
    messages.push_back({0, Json({{"encoding", "mulaw"}, {"sample_rate", 8000}}).dump()});
    messages.push_back({0, Json({{"type", "Metadata"}, {"model_name", "aura-2"}}).dump()});
  }
  messages.push_back({0, Json({{"audio", chunk.audio}}).dump()});
  if (chunk.last) messages.push_back({0, Json({{"type", "Flushed"}, {"sequence_id", 0}}).dump()});
  return messages;
}

const Service kServices[] = {{"Azure", 24000, Coding::s16, true, azure},
                             {"ElevenLabs", 22050, Coding::s16, true, eleven_labs},
                             {"Cartesia", 44100, Coding::f32, true, cartesia},
                             {"OpenAI", 24000, Coding::s16, false, open_ai},
                             {"Deepgram", 8000, Coding::mulaw, false, deepgram}};

struct Arrival {
  double at = 0;
  std::string line;
};

// When the pieces are there: `speed` times as fast as they are spoken, each late by up to `late`.
std::vector<Arrival> arrivals(const Service& service, const Utterance& said,
                              const std::string& name, double begin, double speed, double late,
                              unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Arrival> all;
  std::vector<std::uint8_t> bytes;  // cut anywhere, also inside of a sample
  double at = begin;
  for (std::size_t i = 0; i + 1 < said.cuts.size(); ++i) {
    const double start = said.cuts[i], end = said.cuts[i + 1];
    std::vector<double> samples;
    for (std::int64_t k = std::llround(start * service.rate); k < std::llround(end * service.rate);
         ++k) {
      samples.push_back(said.sound(double(k) / service.rate));
    }
    const auto more = coded(samples, service.coding);
    bytes.insert(bytes.end(), more.begin(), more.end());
    const bool last = i + 2 == said.cuts.size();
    const std::size_t held = last ? 0 : random() % 2;
    Chunk chunk{name, start, end, {}, {}, i == 0, last};
    const std::size_t sent = bytes.size() - held;
    chunk.audio = tools::base64_of(std::span(bytes).first(sent));
    bytes.erase(bytes.begin(), bytes.begin() + std::ptrdiff_t(sent));
    for (const Word& word : said.words) {
      if (word.start >= start && word.start < end) chunk.words.push_back(word);
    }
    at = std::max(at, begin + start / speed + late * double(random() % 1000) / 1000);
    for (const Message& message : service.say(chunk)) {
      all.push_back({at + message.after, message.line});
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.at < b.at; });
  return all;
}

// A head that speaks pieces, by the clock of the test.
struct Stage {
  LineMaker maker = piece_lines({});
  LineQueue queue{maker.most_bytes, maker.cut, maker.json, maker.pieces};
  media::JumpingClock clock;
  std::unique_ptr<LiveSpeaker> speaker;
  std::vector<LineEvent> events;
  fba::AccessUnits planes;
  media::EncodedAudio packets;

  Stage() {
    SpeakerOptions options;
    options.events = true;
    options.voice_rate = maker.sample_rate;
    options.audio = media::AudioSettings{media::AudioCodec::opus, 96000};
    auto opened = LiveSpeaker::open(character(), queue, clock, options);
    EXPECT_TRUE(opened);
    speaker = std::move(*opened);
    packets.format = *speaker->info().audio;
  }
  void push(const std::string& line) {
    EXPECT_TRUE(queue.push(line, clock.now())) << line.substr(0, 200);
  }
  void make() {
    while (auto job = queue.try_job()) {
      const std::uint64_t line = job->line;
      queue.made(line, make_line(maker, std::move(*job), [] { return true; }), clock.now());
    }
  }
  void take() {
    auto made = speaker->take(clock.now());
    ASSERT_TRUE(made) << made.error().describe();
    for (media::LiveUnit& unit : *made) {
      speaker->sent(unit, clock.now());
      if (unit.track == LiveTrack::face) {
        planes.units.push_back({std::move(unit.bytes), unit.intra, 0, 1});
      } else {
        packets.packets.push_back({std::move(unit.bytes), unit.time, unit.duration});
      }
    }
    for (LineEvent& event : speaker->take_events()) events.push_back(std::move(event));
  }
  // Until all of it has been spoken. What has come is made before the next unit is due.
  void run(std::deque<Arrival> coming) {
    for (;;) {
      make();
      const auto due = speaker->next_due();
      if (!due) break;
      if (!coming.empty() && coming.front().at <= *due) {
        clock.sleep_until(coming.front().at);
        push(coming.front().line);
        coming.pop_front();
        if (coming.empty()) queue.close();
        continue;
      }
      clock.sleep_until(*due);
      take();
    }
    speaker->end("over");
    for (LineEvent& event : speaker->take_events()) events.push_back(std::move(event));
  }
  std::size_t count(LineEvent::What what) const {
    return std::size_t(std::count_if(events.begin(), events.end(),
                                     [what](const auto& event) { return event.what == what; }));
  }
  media::Pcm sound() const {
    const auto pcm = media::decode_audio(packets);
    EXPECT_TRUE(pcm);
    return pcm ? *pcm : media::Pcm{};
  }
  fap::Sequence face() const {
    const auto decoded = fba::decode(fba::join_access_units(planes));
    EXPECT_TRUE(decoded);
    return decoded ? fba::face_sequence(*decoded) : fap::Sequence{};
  }
};

// Milliseconds in which something is heard.
std::vector<bool> heard(const media::Pcm& pcm) {
  std::vector<bool> all;
  const auto step = std::size_t(pcm.sample_rate / 1000);
  for (std::size_t at = 0; at + 5 * step <= pcm.samples.size(); at += step) {
    float peak = 0;  // over 5 ms: more than half a period
    for (std::size_t i = at; i < at + 5 * step; ++i)
      peak = std::max(peak, std::abs(pcm.samples[i]));
    all.push_back(peak > 0.1F);
  }
  return all;
}

double seconds_of(const std::vector<bool>& heard) {
  return double(std::count(heard.begin(), heard.end(), true)) / 1000;
}

struct Pace {
  const char* name;
  double speed, late;
};
constexpr Pace kPaces[] = {{"in real time", 1, 0}, {"ten times faster", 10, 0}, {"late", 1, 0.3}};

bool has_pronunciations() {
  return bool(read_piece(R"({"words": [{"word": "hello", "start": 0, "end": 0.4}]})", {}));
}

TEST(Services, LoseNoPieceAndKeepOrderAndTime) {
  if (!has_pronunciations()) GTEST_SKIP() << "no pronunciations: neither a dictionary nor a voice";
  for (const Service& service : kServices) {
    for (const Pace& pace : kPaces) {
      if (test::kAddressSanitizer && pace.late == 0) continue;  // takes eight times as long
      SCOPED_TRACE(std::string(service.name) + ", " + pace.name);
      const Utterance said = make_utterance(unsigned(&service - kServices) + 1);
      const auto coming = arrivals(service, said, "u1", 0.5, pace.speed, pace.late, 7);
      Stage stage;
      stage.run({coming.begin(), coming.end()});

      EXPECT_EQ(stage.count(LineEvent::What::queued), std::size_t(kPieces));
      EXPECT_EQ(stage.count(LineEvent::What::done), std::size_t(kPieces));
      EXPECT_EQ(stage.count(LineEvent::What::cancelled), 0u);
      double spoken = 0;
      for (const Word& word : said.words) spoken += word.end - word.start;
      const media::Pcm sound = stage.sound();
      const std::vector<bool> loud = heard(sound);
      // Where a piece is late, words are interrupted, but nothing of them is left out.
      EXPECT_NEAR(seconds_of(loud), spoken, 0.05 * spoken);
      if (!service.words) continue;
      std::vector<std::string> wanted, told;
      for (const Word& word : said.words) wanted.push_back(word.text);
      double worst = 0;
      for (const LineEvent& event : stage.events) {
        if (event.what != LineEvent::What::word) continue;
        told.push_back(event.text);
        // Its tone begins there: silent before, loud behind.
        const auto at = std::int64_t(event.time * 1000);
        std::int64_t begin = at - 100;
        while (begin < at + 100 && !(loud[std::size_t(begin)] && !loud[std::size_t(begin - 20)])) {
          ++begin;
        }
        worst = std::max(worst, std::abs(double(begin + 4 - at)) / 1000);
      }
      EXPECT_EQ(told, wanted);
      EXPECT_LE(worst, kSync);
    }
  }
}

// ANIMEME_EXHAUSTIVE=1: fifty of each.
TEST(Services, InterruptionsEndEachLineOnce) {
  const int usual = test::kAddressSanitizer ? 3 : 12;
  const int count = std::getenv("ANIMEME_EXHAUSTIVE") != nullptr ? 50 : usual;
  for (const Service& service : kServices) {
    SCOPED_TRACE(service.name);
    Stage stage;
    std::mt19937 random(3);
    std::deque<Arrival> coming;
    double at = 0.5;
    for (int i = 0; i < count; ++i) {
      const Utterance said = make_utterance(unsigned(i), 8);
      const std::string name = "u" + std::to_string(i);
      const double stop = at + 0.1 + double(random() % 1500) / 1000;
      for (Arrival& one : arrivals(service, said, name, at, 3, 0.05, unsigned(i))) {
        if (one.at < stop) coming.push_back(std::move(one));
      }
      coming.push_back({stop, R"({"do": "stop"})"});
      at = stop + 0.4;
    }
    stage.run(coming);
    std::map<std::uint64_t, int> ends;
    std::vector<double> stops;
    for (const LineEvent& event : stage.events) {
      if (event.what == LineEvent::What::queued) ends.try_emplace(event.line, 0);
      if (event.what == LineEvent::What::stopped) stops.push_back(event.time);
      const bool end =
          event.what == LineEvent::What::done || event.what == LineEvent::What::cancelled;
      if (end && event.line > 0) ++ends[event.line];
    }
    EXPECT_EQ(stops.size(), std::size_t(count));
    EXPECT_GT(ends.size(), std::size_t(count));
    for (const auto& [line, times] : ends) EXPECT_EQ(times, 1) << "line " << line;
    const std::vector<bool> loud = heard(stage.sound());
    for (const double stop : stops) {
      const auto from = std::size_t((stop + 0.12) * 1000);
      const auto to = std::min(loud.size(), from + 250);
      EXPECT_EQ(
          std::count(loud.begin() + std::ptrdiff_t(from), loud.begin() + std::ptrdiff_t(to), true),
          0)
          << stop;
    }
  }
}

double opening(const fap::Frame& frame) { return -(frame.value[4] + frame.value[5]); }

// Opening of the lips in each frame, without its mean.
std::vector<double> openings(const fap::Sequence& face) {
  std::vector<double> all;
  double mean = 0;
  for (const fap::Frame& frame : face.frames) {
    all.push_back(opening(frame));
    mean += all.back() / double(face.frames.size());
  }
  for (double& value : all) value -= mean;
  return all;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b, int lag) {
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 20; i + 20 < std::min(a.size(), b.size()); ++i) {
    const double other = b[std::size_t(std::int64_t(i) + lag)];
    ab += a[i] * other;
    aa += a[i] * a[i];
    bb += other * other;
  }
  return ab / std::sqrt(aa * bb + 1e-9);
}

// A voice in pieces without any times: the face moves as with the phones of the voice.
TEST(Services, TheFaceFollowsSoundAlone) {
  const auto speech = voice::speak_text(
      "My mouth moves by numbers. How many boats are there, and who paid for all of them?", {});
  if (!speech) GTEST_SKIP() << speech.error().describe();
  if (const auto ear = voice::SoundListener::open(16000, {}); !ear) {
    GTEST_SKIP() << ear.error().describe();
  }
  std::vector<std::vector<double>> faces;
  for (const bool timed : {true, false}) {
    Stage stage;
    std::deque<Arrival> coming;
    const auto& samples = speech->audio.samples;
    const int rate = speech->audio.sample_rate;
    const std::size_t step = timed ? samples.size() : std::size_t(rate) / 8;
    for (std::size_t at = 0; at < samples.size(); at += step) {
      std::vector<double> some(
          samples.begin() + std::ptrdiff_t(at),
          samples.begin() + std::ptrdiff_t(std::min(at + step, samples.size())));
      Json piece = {{"audio", tools::base64_of(coded(some, Coding::s16))}, {"sample_rate", rate}};
      if (timed) piece["script"] = dam::write_script_tsv(speech->script);
      coming.push_back({0.5 + double(at) / rate / 3, piece.dump()});
    }
    // The last one ends what was said, or it would wait for more.
    coming.push_back({coming.back().at + 0.01, R"({"done": true})"});
    stage.run(coming);
    faces.push_back(openings(stage.face()));
  }
  double best = 0;
  int best_lag = 99;
  for (int lag = -15; lag <= 15; ++lag) {
    const double found = correlation(faces[0], faces[1], lag);
    if (found > best) best = found, best_lag = lag;
  }
  // The first piece waits for what follows it by up to 0.1 s.
  EXPECT_GT(best, 0.5);
  EXPECT_LE(std::abs(best_lag), 4);
}

std::vector<std::string> given_lines() {
  std::vector<std::string> lines;
  const auto folder = test::shared_dir();
  if (folder.empty()) return lines;
  for (const char* name : {"piece_without_words", "piece_word_crosses", "piece_one_ulp_short"}) {
    const auto text =
        tools::read_text_file((folder / "cases/live" / name).string() + ".json", 1 << 20);
    if (text) lines.push_back(*text);
  }
  return lines;
}

// The same kinds of pieces without the shared files.
std::vector<std::string> made_lines() {
  const std::string audio = tools::base64_of(std::vector<std::uint8_t>(21982, 7));
  std::vector<std::string> lines;
  for (const double end : {0.4579583333333333, 0.52, 3.0}) {
    lines.push_back(Json({{"audio", audio},
                          {"sample_rate", 24000},
                          {"words", {{{"word", "hello"}, {"start", 0.0}, {"end", end}}}}})
                        .dump());
  }
  lines.push_back(Json({{"audio", audio}, {"sample_rate", 24000}, {"alignment", nullptr}}).dump());
  lines.push_back(Json({{"audio", audio}, {"sample_rate", 24000}, {"usage", {{"a", 1}}}}).dump());
  lines.push_back(Json({{"audio", audio}, {"sample_rate", 24000}, {"script", "no script"}}).dump());
  return lines;
}

TEST(Services, APieceIsSpokenWhateverItsTimes) {
  auto lines = made_lines();
  for (std::string& line : given_lines()) lines.push_back(std::move(line));
  for (const std::string& text : lines) {
    const auto line = read_piece(text, {});
    ASSERT_TRUE(line) << text.substr(0, 60) << text.substr(text.size() - 60)
                      << line.error().message;
    EXPECT_NEAR(line->speech.audio.duration(), 0.45796, 0.001);
    EXPECT_DOUBLE_EQ(line->speech.script.duration(), 10991.0 / 24000);
  }
}

}  // namespace services_test
}  // namespace animeme::speech
