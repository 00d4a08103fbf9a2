#include "tools/speech/voice/espeak_process.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <iterator>
#include <list>
#include <memory>
#include <utility>

#include "tools/speech/voice/child.h"
#include "tools/speech/voice/espeak_internal.h"

namespace animeme::voice {
namespace {

// Messages from the child.
enum Tag : std::uint32_t {
  kSampleRate,
  kSamples,  // int16 in the byte order of the machine
  kEvents,   // WireEvent
  kTextEnd,  // one text is spoken
  kVoice,    // name, identifier, language, language ... each ended by a zero byte
  kVariant,  // identifier
  kDataPath,
  kFailure,  // a sentence for people
};

struct WireEvent {
  std::int32_t kind, sample, text_position, text_length;
  char name[8];
};

// The callback of espeak-ng has no user pointer that survives all events; there is one sender in
// a child process.
Sender* g_sender = nullptr;

template <class T>
std::string_view bytes_of(const T* data, std::size_t count) {
  return {reinterpret_cast<const char*>(data), count * sizeof(T)};
}

int on_speech(short* samples, int count, espeak_EVENT* events) {
  bool good = true;
  if (samples != nullptr && count > 0) {
    good = g_sender->send(kSamples, bytes_of(samples, std::size_t(count)));
  }
  for (; good && events != nullptr && events->type != espeakEVENT_LIST_TERMINATED; ++events) {
    const bool word = events->type == espeakEVENT_WORD, mark = events->type == espeakEVENT_MARK;
    if (!word && !mark && events->type != espeakEVENT_PHONEME) continue;
    WireEvent wire{word   ? 0
                   : mark ? 2
                          : 1,
                   events->sample,
                   events->text_position,
                   events->length,
                   {}};
    if (mark && events->id.name != nullptr) {
      std::strncpy(wire.name, events->id.name, sizeof wire.name - 1);
    } else if (!word) {
      std::memcpy(wire.name, events->id.string, sizeof wire.name);
    }
    good = g_sender->send(kEvents, bytes_of(&wire, 1));
  }
  return good ? 0 : 1;
}

// espeak-ng opens its audio output even if nothing is played. That calls the PulseAudio client,
// which creates ~/.config/pulse and may start a server. Without a configuration folder and with a
// server address that cannot exist it fails at once. This runs in a child process.
void disable_audio_output() {
  ::setenv("XDG_CONFIG_HOME", "/dev/null", 1);
  ::setenv("PULSE_SERVER", "unix:/dev/null", 1);
}

std::int32_t initialise(const std::string& data_path) {
  disable_audio_output();
  return (*espeak())->initialize(
      AUDIO_OUTPUT_SYNCHRONOUS, 0, data_path.empty() ? nullptr : data_path.c_str(),
      espeakINITIALIZE_PHONEME_EVENTS | espeakINITIALIZE_PHONEME_IPA | espeakINITIALIZE_DONT_EXIT);
}

constexpr std::string_view kNoData =
    "espeak-ng cannot load its data; install the Debian package espeak-ng-data or set the data "
    "path to the folder that contains espeak-ng-data";

// What all jobs with a voice have in common; g_rate is 0 where there are no data.
std::int32_t g_rate = 0;
std::string g_voice_name;
bool g_voice = false;

void prepare(const std::string& data_path, const std::string& voice) {
  g_voice_name = voice;
  g_rate = std::max(initialise(data_path), 0);
  if (g_rate > 0) g_voice = (*espeak())->set_voice_by_name(voice.c_str()) == EE_OK;
}

bool speak_all(Sender& sender, const EspeakJob& job) {
  if (g_rate <= 0) return sender.send(kFailure, kNoData);
  const EspeakFunctions& library = **espeak();
  if (!sender.send(kSampleRate, bytes_of(&g_rate, 1))) return false;
  g_sender = &sender;
  library.set_synth_callback(on_speech);
  if (!g_voice) return sender.send(kFailure, "espeak-ng cannot load its voice " + g_voice_name);
  library.set_parameter(espeakRATE, job.options.words_per_minute, 0);
  library.set_parameter(espeakPITCH, job.options.pitch, 0);
  library.set_parameter(espeakRANGE, job.options.pitch_range, 0);
  library.set_parameter(espeakWORDGAP, job.options.word_gap, 0);
  const unsigned flags =
      espeakCHARS_UTF8 | (job.mnemonics ? espeakPHONEMES : 0) | (job.markup ? espeakSSML : 0);
  for (const std::string& text : job.texts) {
    if (library.synth(text.c_str(), text.size() + 1, 0, POS_CHARACTER, 0, flags, nullptr,
                      nullptr) != EE_OK) {
      return sender.send(kFailure, "espeak-ng failed to speak the text");
    }
    if (!sender.send(kTextEnd, {})) return false;
  }
  return true;
}

bool send_voices(Sender& sender, const std::string& data_path) {
  if (initialise(data_path) <= 0) return sender.send(kFailure, kNoData);
  const char* data = nullptr;
  (*espeak())->info(&data);
  if (data != nullptr && !sender.send(kDataPath, data)) return false;
  const espeak_VOICE** list = (*espeak())->list_voices(nullptr);
  for (; list != nullptr && *list != nullptr; ++list) {
    const espeak_VOICE& voice = **list;
    std::string wire = std::string(voice.name) + '\0' + voice.identifier + '\0';
    // Each language is a priority byte and a string; a zero byte ends the list.
    for (const char* at = voice.languages; at != nullptr && *at != '\0';) {
      wire += std::string(at + 1) + '\0';
      at += std::strlen(at + 1) + 2;
    }
    if (!sender.send(kVoice, wire)) return false;
  }
  espeak_VOICE wanted{};
  wanted.languages = "variant";
  list = (*espeak())->list_voices(&wanted);
  for (; list != nullptr && *list != nullptr; ++list) {
    if (!sender.send(kVariant, (*list)->identifier)) return false;
  }
  return true;
}

VoiceEvent unpack(const WireEvent& wire) {
  VoiceEvent event;
  event.kind = wire.kind == 0   ? EventKind::word
               : wire.kind == 2 ? EventKind::mark
                                : EventKind::phoneme;
  event.sample = wire.sample;
  event.text_position = wire.text_position;
  event.text_length = wire.text_length;
  if (event.kind != EventKind::word) {
    event.ipa.assign(wire.name, ::strnlen(wire.name, sizeof wire.name));
  }
  return event;
}

VoiceInfo unpack_voice(const std::string& bytes) {
  std::vector<std::string> fields;
  for (std::size_t at = 0; at < bytes.size();) {
    fields.emplace_back(bytes.c_str() + at);
    at += fields.back().size() + 1;
  }
  VoiceInfo voice;
  if (fields.size() < 3) return voice;
  voice.name = fields[0];
  voice.identifier = fields[1];
  voice.language = fields[2];
  voice.other_languages.assign(fields.begin() + 3, fields.end());
  return voice;
}

// A job as the bytes of a request; the voice and the data are those of the kept child.
std::string request_of(const EspeakJob& job) {
  const VoiceOptions& options = job.options;
  const std::int32_t numbers[] = {options.words_per_minute, options.pitch, options.pitch_range,
                                  options.word_gap,         job.mnemonics, job.markup};
  std::string request(bytes_of(numbers, std::size(numbers)));
  for (const std::string& text : job.texts) request += text + '\0';
  return request;
}

EspeakJob job_of(std::string_view request) {
  std::int32_t numbers[6];
  std::memcpy(numbers, request.data(), sizeof numbers);
  EspeakJob job;
  job.options.words_per_minute = numbers[0];
  job.options.pitch = numbers[1];
  job.options.pitch_range = numbers[2];
  job.options.word_gap = numbers[3];
  job.mnemonics = numbers[4] != 0;
  job.markup = numbers[5] != 0;
  for (std::size_t at = sizeof numbers; at < request.size();) {
    const std::size_t end = request.find('\0', at);
    job.texts.emplace_back(request.substr(at, end - at));
    at = end + 1;
  }
  return job;
}

constexpr unsigned kMostSecondsOfWork = 300;
constexpr int kSilentLevel = 8;  // of 32768: what espeak-ng leaves between sounds
constexpr std::int64_t kMostEventsPerSecond = 100;  // words and phones; speech has some 20
// One takes some 3 MB, starting one as long as a few lines.
constexpr std::size_t kMostKept = 10;
constexpr int kTries = 3;  // a process may be ended by others, such as for its memory

struct KeptVoice {
  std::string name, data_path;
  std::unique_ptr<KeptChild> child;
};
bool g_keep = false;
std::unique_ptr<Nursery> g_nursery;  // null: there is none, children are copies of what we are now
std::list<KeptVoice> g_kept;         // the last that was asked for first

// A voice and its data in the name of a child, and in front of its requests.
std::string name_of(const EspeakJob& job) { return job.voice + '\0' + job.options.data_path; }

void prepare_named(std::string_view name) {
  const std::size_t end = name.find('\0');
  prepare(std::string(name.substr(end + 1)), std::string(name.substr(0, end)));
}

bool answer_request(Sender& sender, std::string_view request) {
  return speak_all(sender, job_of(request));
}

// Nothing: it cannot be started.
KeptChild* kept_child(const EspeakJob& job) {
  for (auto at = g_kept.begin(); at != g_kept.end(); ++at) {
    if (at->name != job.voice || at->data_path != job.options.data_path) continue;
    g_kept.splice(g_kept.begin(), g_kept, at);
    return g_kept.front().child.get();
  }
  auto child = g_nursery ? g_nursery->child(name_of(job))
                         : KeptChild::start([&job] { prepare_named(name_of(job)); }, answer_request,
                                            kMostSecondsOfWork);
  if (!child) return nullptr;
  g_kept.push_front({job.voice, job.options.data_path, std::move(*child)});
  if (g_kept.size() > kMostKept) g_kept.pop_back();
  return g_kept.front().child.get();
}

// One that has gone is started again by the next job.
void forget_kept(const KeptChild* child) {
  g_kept.remove_if([child](const KeptVoice& one) { return one.child.get() == child; });
}

}  // namespace

void keep_voices() {
  // Loaded before there are children: each of them finds it there.
  if (!espeak() || std::exchange(g_keep, true)) return;
  auto nursery = Nursery::start(prepare_named, answer_request, kMostSecondsOfWork);
  if (nursery) g_nursery = std::move(*nursery);
}

namespace {

// Sound comes in small pieces. Kept in blocks until all is there, it never takes twice its size, as
// a vector that grows does: a text that is too long is refused after an hour of sound, 160 MB.
class SoundBlocks {
 public:
  void add(std::span<const std::int16_t> samples) {
    while (!samples.empty()) {
      if (blocks_.empty() || blocks_.back().size() == kBlockSamples) {
        blocks_.emplace_back().reserve(kBlockSamples);
      }
      std::vector<std::int16_t>& block = blocks_.back();
      const auto piece = samples.first(std::min(samples.size(), kBlockSamples - block.size()));
      block.insert(block.end(), piece.begin(), piece.end());
      samples = samples.subspan(piece.size());
      size_ += piece.size();
    }
  }
  // All of it; then there is none.
  std::vector<std::int16_t> take() {
    std::vector<std::int16_t> all;
    all.reserve(size_);
    for (; !blocks_.empty(); blocks_.pop_front()) {
      all.insert(all.end(), blocks_.front().begin(), blocks_.front().end());
    }
    size_ = 0;
    return all;
  }

 private:
  static constexpr std::size_t kBlockSamples = std::size_t(1) << 20;
  std::deque<std::vector<std::int16_t>> blocks_;
  std::size_t size_ = 0;
};

// What comes from a child, text by text.
class SpeechIntake {
 public:
  explicit SpeechIntake(const EspeakJob& job) : job_(job) { result.speech.emplace_back(); }

  bool receive(std::uint32_t tag, std::string bytes) {
    if (tag == kFailure) failure = std::move(bytes);
    if (tag == kSampleRate && bytes.size() == sizeof(std::int32_t)) {
      std::memcpy(&result.sample_rate, bytes.data(), bytes.size());
      if (job_.sink.begin) sunk = job_.sink.begin(result.sample_rate);
    }
    if (tag == kTextEnd) {
      result.speech.back().samples = sound_.take();
      result.speech.emplace_back();
    }
    if (tag == kSamples) hear(bytes);
    if (tag == kEvents && bytes.size() == sizeof(WireEvent)) {
      WireEvent wire;
      std::memcpy(&wire, bytes.data(), sizeof wire);
      result.speech.back().events.push_back(unpack(wire));
      ++events_;
    }
    const std::int64_t rate = std::max(result.sample_rate, 1);
    too_long = samples_ > std::size_t(job_.max_seconds * rate) ||
               events_ > std::size_t(kMostEventsPerSecond * (job_.max_seconds + 1));
    return !too_long && sunk;
  }

  EspeakResult result;
  std::string failure;
  bool too_long = false;
  Result<void> sunk;  // the error of the sink

 private:
  void hear(const std::string& bytes) {
    piece_.resize(bytes.size() / sizeof(std::int16_t));
    std::memcpy(piece_.data(), bytes.data(), piece_.size() * sizeof(std::int16_t));
    samples_ += piece_.size();
    std::vector<bool>& silent = result.speech.back().silent;
    for (const std::int16_t sample : piece_) {
      silent.push_back(std::abs(int(sample)) <= kSilentLevel);
    }
    if (!job_.sink.take) return sound_.add(piece_);
    floats_.clear();
    for (const std::int16_t sample : piece_) floats_.push_back(float(sample) / 32768.0f);
    sunk = job_.sink.take(floats_);
  }

  const EspeakJob& job_;
  std::vector<std::int16_t> piece_;
  std::vector<float> floats_;
  SoundBlocks sound_;  // of the text that is being spoken
  std::size_t samples_ = 0, events_ = 0;
};

// `ended`: the process of the voice has ended before the text, though nothing was wrong with it.
Result<void> run_job(const EspeakJob& job, SpeechIntake& hearing, bool& ended) {
  const auto receive = [&hearing](std::uint32_t tag, std::string bytes) {
    return hearing.receive(tag, std::move(bytes));
  };
  const auto speak = [&job](Sender& sender) {
    prepare(job.options.data_path, job.voice);
    return speak_all(sender, job);
  };
  KeptChild* kept = g_keep ? kept_child(job) : nullptr;
  const auto run = kept != nullptr ? kept->run("espeak-ng", request_of(job), receive)
                                   : run_child("espeak-ng", kMostSecondsOfWork, speak, receive);
  if (!run && kept != nullptr) forget_kept(kept);
  if (hearing.too_long) {
    return make_error(Code::out_of_range, "the text makes more than " +
                                              std::to_string(job.max_seconds) +
                                              " s of speech; speak it in parts");
  }
  if (!hearing.sunk) return hearing.sunk.error();
  if (!hearing.failure.empty()) return make_error(Code::io, hearing.failure);
  ended = !run;
  if (!run) return run.error();
  hearing.result.speech.pop_back();  // opened by the last kTextEnd
  return {};
}

Result<EspeakResult> try_espeak(const EspeakJob& job, bool& ended) {
  SpeechIntake hearing(job);
  if (auto ran = run_job(job, hearing, ended); !ran) return ran.error();
  return std::move(hearing.result);
}

}  // namespace

Result<EspeakResult> run_espeak(const EspeakJob& job) {
  if (!espeak()) return espeak().error();
  for (int tries = 1;; ++tries) {
    bool ended = false;
    Result<EspeakResult> result = try_espeak(job, ended);
    if (result || !ended || !g_keep || tries == kTries) return result;
    if (tries == 1) continue;
    // The nursery may be gone, and its children with it.
    g_kept.clear();
    g_nursery.reset();
    auto nursery = Nursery::start(prepare_named, answer_request, kMostSecondsOfWork);
    if (nursery) g_nursery = std::move(*nursery);
  }
}

Result<VoiceLists> read_espeak_voices(const std::string& data_path) {
  if (!espeak()) return espeak().error();
  VoiceLists lists;
  std::string failure;
  const auto receive = [&](std::uint32_t tag, std::string bytes) {
    if (tag == kFailure) failure = std::move(bytes);
    if (tag == kVoice) {
      VoiceInfo voice = unpack_voice(bytes);
      const bool usable = !voice.name.empty() && !voice.identifier.starts_with("mb/");
      if (usable) lists.voices.push_back(std::move(voice));
    }
    if (tag == kDataPath) lists.data_path = bytes;
    if (tag == kVariant) lists.variants.push_back(bytes.substr(bytes.rfind('/') + 1));
    return true;
  };
  const auto run = run_child(
      "espeak-ng", 60, [&](Sender& sender) { return send_voices(sender, data_path); }, receive);
  if (!failure.empty()) return make_error(Code::io, failure);
  if (!run) return run.error();
  return lists;
}

}  // namespace animeme::voice
