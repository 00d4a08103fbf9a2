#include "tools/speech/talking/pieces.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "tools/formats/media/audio.h"
#include "tools/formats/media/mp3_stream.h"
#include "tools/formats/scripts/script_text.h"
#include "tools/speech/talking/json_line_internal.h"
#include "tools/speech/talking/piece_message_internal.h"
#include "tools/speech/talking/sound_coding.h"
#include "tools/speech/talking/sound_ear.h"
#include "tools/speech/talking/utterance_times.h"
#include "tools/speech/talking/written_text.h"
#include "tools/speech/text/mood_marks.h"
#include "tools/speech/text/ssml.h"

namespace animeme::speech {

namespace {

using From = PieceMessage::From;

constexpr int kPieceRate = 48000;    // Hz of the sound that is sent
constexpr double kBorder = 0.02;     // seconds of sound around a piece that its rate change hears
constexpr double kOldSound = 1;      // seconds of sound that are kept behind what is spoken
constexpr double kAfterSound = 0.3;  // seconds: times that end later than their sound are told of
constexpr double kTimely = 0.05;  // seconds: times are those of a piece that begins so much later
constexpr double kKnown = 0.05;   // seconds: a piece whose times end so early has them all
constexpr std::size_t kMostUtterances = 64;  // that are kept when all of them has been spoken
constexpr double kLeastAligned = 0.25;       // seconds of sound
constexpr double kMostLetters = 25;          // of a text, for each second of its sound

struct Piece;

// Times as they came.
struct Labels {
  std::string text;
  double piece = 0;    // where the sound begins that they came with
  double length = 0;   // of that sound; 0: they came alone
  bool given = false;  // certainly times
  From from = From::unknown;
  std::weak_ptr<Piece> owner = {};  // with the sound that they came with
};

struct Utterance;

struct Piece {
  std::shared_ptr<Utterance> utterance;
  double start = 0;  // in it, seconds
  std::shared_ptr<const media::Pcm> sound;
  std::string text, language;
  Labels labels;           // of a piece without sound
  std::string doubt;       // of its times, which another piece has read
  bool made = false;       // its line was, at least once
  bool aligned = false;    // its text, or that was tried
  bool timed = false;      // it came with times
  bool released = false;   // forget() was called
  bool heard_all = false;  // it was made with the sound behind it

  double end() const { return start + (sound ? sound->duration() : 0); }
};

struct Utterance {
  std::uint64_t number = 0;
  bool named = false;
  // With the mutex of the stream:
  double sound = 0;  // seconds that have come
  std::string text;  // of all of it
  bool text_told = false;
  std::string language;
  bool over = false;
  bool dropped = false;     // nothing finds it by its name
  bool told_alone = false;  // times came in messages of their own
  std::vector<Labels> unread;
  std::deque<std::shared_ptr<Piece>> pieces;  // with sound, ascending
  std::vector<std::uint8_t> rest;             // of a sample that is not whole
  std::optional<media::Mp3Stream> mp3;        // its sound is that
  // Of who makes lines:
  UtteranceTimes times;
  From times_from = From::unknown;
  std::shared_ptr<SoundEar> ear;  // with the mutex of the stream; what it is is theirs
};

bool is_file(std::span<const std::uint8_t> bytes) {
  const auto starts = [&](std::size_t at, std::string_view tag) {
    return bytes.size() >= at + tag.size() &&
           std::memcmp(bytes.data() + at, tag.data(), tag.size()) == 0;
  };
  return starts(0, "RIFF") || starts(0, "ID3") || starts(0, "OggS") || starts(0, "fLaC") ||
         starts(0, "\x1A\x45\xDF\xA3") || starts(4, "ftyp");
}

void add_sentence(std::string& all, const std::string& more) {
  if (more.empty() || all.find(more) != std::string::npos) return;
  all += (all.empty() ? "" : "; ") + more;
}

// Pieces and their utterance hold each other, until all of a dropped one has been spoken.
void drop(Utterance& utterance) {
  utterance.dropped = true;
  const bool spoken = std::all_of(utterance.pieces.begin(), utterance.pieces.end(),
                                  [](const auto& piece) { return piece->released; });
  if (spoken) utterance.pieces.clear();
}

// Whether a text may be what is said in so much sound, and not in more of it.
bool fits(const std::string& text, double seconds) {
  const auto letters = std::count_if(text.begin(), text.end(), [](char c) {
    return c != ' ' && (std::uint8_t(c) & 0xC0U) != 0x80U;
  });
  return letters > 0 && seconds >= kLeastAligned && double(letters) <= kMostLetters * seconds;
}

// The sound of a piece at the rate that is sent. Its neighbours keep its ends from clicking.
Result<media::Pcm> converted(const Piece& piece, const std::vector<SoundEar::Piece>& around,
                             int sample_rate) {
  const media::Pcm& sound = *piece.sound;
  if (sample_rate == 0 || sound.sample_rate == sample_rate) return sound;
  const auto border = std::size_t(kBorder * sound.sample_rate);
  media::Pcm wide{sound.sample_rate, {}};
  std::vector<float> after;
  for (const SoundEar::Piece& one : around) {
    if (one.sound->sample_rate != sound.sample_rate || one.sound == &sound) continue;
    if (one.end() < piece.start - kBorder || after.size() >= border) continue;
    std::vector<float>& side = one.start < piece.start ? wide.samples : after;
    side.insert(side.end(), one.sound->samples.begin(), one.sound->samples.end());
  }
  if (wide.samples.size() > border) {
    wide.samples.erase(wide.samples.begin(), wide.samples.end() - std::ptrdiff_t(border));
  }
  const std::size_t before = wide.samples.size();
  after.resize(border, after.empty() ? sound.samples.back() : after.back());
  wide.samples.insert(wide.samples.end(), sound.samples.begin(), sound.samples.end());
  wide.samples.insert(wide.samples.end(), after.begin(), after.end());
  Result<media::Pcm> all = media::resample(wide, sample_rate);
  if (!all) return all;
  // From border to border on the clock of the utterance, so that no sample is lost or made.
  const auto at = [&](double seconds) { return std::llround(seconds * sample_rate); };
  const auto count = std::size_t(at(piece.end()) - at(piece.start));
  const auto skip = std::size_t(at(double(before) / sound.sample_rate));
  media::Pcm pcm{sample_rate, std::vector<float>(count, 0.0F)};
  for (std::size_t i = 0; i < count && skip + i < all->samples.size(); ++i) {
    pcm.samples[i] = all->samples[skip + i];
  }
  return pcm;
}

}  // namespace

struct PieceStream::Impl {
  voice::VoiceOptions voice;
  ScriptInput input;
  int made_rate = 0;  // of sound that is made; 0: its own

  std::mutex mutex;  // guards what follows, and parts of utterances
  std::map<std::string, std::shared_ptr<Utterance>> utterances;  // "": of pieces without a name
  std::map<std::uint64_t, std::shared_ptr<Piece>> pieces;
  std::uint64_t numbers = 0;
  std::string coding;  // of samples, as was said last
  double sample_rate = 0;
  int channels = 1;
  bool waits_for_times = false;  // times came in messages of their own before
  bool files = true;             // messages may name some

  Result<Taken> take(PieceMessage& message);
  std::shared_ptr<Utterance> utterance_of(const PieceMessage& message);
  void prune();
  Result<media::Pcm> decode(PieceMessage& message, Utterance& utterance);
  Result<Taken> speech_of(PieceMessage& message, const std::shared_ptr<Utterance>& utterance);

  Result<std::shared_ptr<Piece>> find(std::uint64_t key);
  Result<SpokenLine> make_alone(const Piece& piece);
  Result<SpokenLine> make_sound(Piece& piece);
  void read(Utterance& utterance, const std::vector<Labels>& unread, const ScriptInput& how,
            std::string& doubt);
  void align(Piece& piece, const std::string& text, const ScriptInput& how, std::string& doubt);
  ScriptInput reading(const std::string& language) const;
};

ScriptInput PieceStream::Impl::reading(const std::string& language) const {
  ScriptInput how = input;
  how.most_seconds = kMostPieceSeconds;
  if (!language.empty()) how.language = language;
  return how;
}

std::shared_ptr<Utterance> PieceStream::Impl::utterance_of(const PieceMessage& message) {
  std::shared_ptr<Utterance>& found = utterances[message.utterance];
  // A name may be used again; what has no name goes on after its end as another one.
  if (!found || (found->over && message.has_sound())) {
    if (found) drop(*found);
    found = std::make_shared<Utterance>();
    found->number = ++numbers;
    found->named = !message.utterance.empty();
  }
  const std::shared_ptr<Utterance> utterance = found;
  if (utterances.size() > kMostUtterances) prune();
  return utterance;
}

// The oldest one of which nothing waits to be spoken.
void PieceStream::Impl::prune() {
  auto oldest = utterances.end();
  for (auto one = utterances.begin(); one != utterances.end(); ++one) {
    const auto& all = one->second->pieces;
    const bool spoken =
        std::all_of(all.begin(), all.end(), [](const auto& piece) { return piece->released; });
    if (!spoken || one->first.empty()) continue;
    if (oldest == utterances.end() || one->second->number < oldest->second->number) oldest = one;
  }
  if (oldest == utterances.end()) return;
  drop(*oldest->second);
  utterances.erase(oldest);
}

Result<media::Pcm> PieceStream::Impl::decode(PieceMessage& message, Utterance& utterance) {
  if (message.pcm) return std::move(*message.pcm);
  const media::ReadAudioOptions limit{.max_seconds = kMostPieceSeconds};
  if (!message.file.empty()) {
    Result<media::Pcm> pcm = media::read_audio(message.file, limit);
    if (!pcm) return pcm.error().in_file(message.file);
    return pcm;
  }
  const NamedCoding named = read_coding(coding);
  const double rate = sample_rate > 0 ? sample_rate : named.sample_rate;
  const bool unsaid = coding.empty() && rate == 0;
  const bool unknown = !coding.empty() && !named.coding;
  if (utterance.mp3 || ((unsaid || unknown) && media::Mp3Stream::begins(message.bytes))) {
    if (!utterance.mp3) utterance.mp3.emplace();
    return utterance.mp3->push(message.bytes);
  }
  if (is_file(message.bytes) || unsaid || unknown) {
    Result<media::Pcm> pcm = media::read_audio(message.bytes, limit);
    if (!pcm && unsaid) {
      return make_error(pcm.error().code,
                        pcm.error().message + "; samples without a header need \"sample_rate\"");
    }
    return pcm;
  }
  if (rate == 0) {
    return make_error(Code::invalid_argument,
                      "samples need \"sample_rate\", from 1000 to 384000 a second");
  }
  // A service may cut its sound anywhere, also inside of a sample.
  std::vector<std::uint8_t>& bytes = utterance.rest;
  bytes.insert(bytes.end(), message.bytes.begin(), message.bytes.end());
  const SoundCoding how = named.coding.value_or(SoundCoding::s16);
  media::Pcm pcm{int(rate), decode_samples(bytes, how, channels)};
  const std::size_t used = pcm.samples.size() * bytes_of(how) * std::size_t(channels);
  bytes.erase(bytes.begin(), bytes.begin() + std::ptrdiff_t(used));
  if (pcm.duration() > kMostPieceSeconds) {
    return make_error(Code::out_of_range, "it has more than 600 s of sound; send shorter pieces");
  }
  return pcm;
}

// With the mutex.
Result<PieceStream::Taken> PieceStream::Impl::speech_of(
    PieceMessage& message, const std::shared_ptr<Utterance>& utterance) {
  Taken taken;
  auto piece = std::make_shared<Piece>();
  piece->utterance = utterance;
  piece->language = message.language;
  if (message.has_sound()) {
    Result<media::Pcm> sound = decode(message, *utterance);
    if (!sound) return sound.error();
    if (sound->samples.empty()) return taken;  // a part of a sample
    piece->sound = std::make_shared<const media::Pcm>(std::move(*sound));
    piece->start = utterance->sound;
    utterance->sound = piece->end();
    utterance->pieces.push_back(piece);
    piece->timed = !message.labels.empty();
  }
  Labels labels{std::move(message.labels), piece->start,
                piece->sound ? piece->sound->duration() : 0, message.labels_given,
                message.times_from};
  if (labels.from == From::unknown && !utterance->named) labels.from = From::piece;
  if (!labels.text.empty()) {
    labels.owner = piece;
    (piece->sound ? utterance->unread.emplace_back() : piece->labels) = std::move(labels);
  }
  piece->text = std::move(message.text);
  if (piece->text.empty() && !utterance->text_told) piece->text = utterance->text;
  utterance->text_told = true;
  taken.text = piece->text;
  taken.key = ++numbers;
  taken.utterance = utterance->number;
  pieces.emplace(taken.key, std::move(piece));
  return taken;
}

PieceStream::PieceStream(const voice::VoiceOptions& voice, const ScriptInput& input,
                         int sample_rate)
    : impl_(new Impl{}) {
  impl_->made_rate = sample_rate;
  impl_->voice = voice;
  impl_->input = input;
}

PieceStream::~PieceStream() {
  const std::lock_guard lock(impl_->mutex);
  for (const auto& [name, utterance] : impl_->utterances) utterance->pieces.clear();
  for (const auto& [key, piece] : impl_->pieces) piece->utterance->pieces.clear();
}

void PieceStream::refuse_files() {
  const std::lock_guard lock(impl_->mutex);
  impl_->files = false;
}

Result<PieceStream::Taken> PieceStream::add_sound(const std::string& utterance, media::Pcm sound,
                                                  bool last) {
  if (sound.sample_rate < 1000 || sound.sample_rate > 384000) {
    return make_error(Code::invalid_argument, "a sound has 1000 to 384000 samples a second");
  }
  if (sound.duration() > kMostPieceSeconds) {
    return make_error(Code::out_of_range, "it has more than 600 s of sound; send shorter pieces");
  }
  PieceMessage message;
  message.utterance = utterance;
  message.last = last;
  message.small_talk = true;  // the end of an utterance may come alone
  if (!sound.samples.empty()) message.pcm = std::move(sound);
  const std::lock_guard lock(impl_->mutex);
  return impl_->take(message);
}

Result<PieceStream::Taken> PieceStream::add(std::string_view json) {
  Result<PieceMessage> read = read_message(json);
  if (!read) return read.error();
  const std::lock_guard lock(impl_->mutex);
  if (!read->file.empty() && !impl_->files) {
    return make_error(Code::invalid_argument,
                      "the sound cannot be a file here; put it into \"audio\" as base64");
  }
  return impl_->take(*read);
}

// With the mutex.
Result<PieceStream::Taken> PieceStream::Impl::take(PieceMessage& message) {
  if (message.has_format()) {
    // A coding that is named says all; a rate alone leaves the rest as it was.
    if (!message.coding.empty()) {
      coding = message.coding;
      sample_rate = 0;
      channels = 1;
    }
    if (message.sample_rate > 0) sample_rate = message.sample_rate;
    if (message.channels > 0) channels = message.channels;
  }
  const std::shared_ptr<Utterance> utterance = utterance_of(message);
  if (!message.language.empty()) utterance->language = message.language;
  Taken taken;
  taken.utterance = utterance->number;
  const bool nothing = !message.has_sound() && message.labels.empty() && message.text.empty();
  const bool whole_text = !message.text.empty() && !message.text_goes_on;
  if (message.text_goes_on) {
    utterance->text += message.text;
    message.text.clear();
  }
  if (message.has_sound() || (!utterance->named && (whole_text || !message.labels.empty()) &&
                              !(message.small_talk && message.text.empty()))) {
    if (whole_text && utterance->named && utterance->text.empty()) utterance->text = message.text;
    Result<Taken> spoken = speech_of(message, utterance);
    if (!spoken) return spoken;
    taken = std::move(*spoken);
  } else {
    // About the sound of others.
    if (whole_text) utterance->text = message.text;
    if (!message.labels.empty() && utterance->named) {
      utterance->told_alone = waits_for_times = true;
      utterance->unread.push_back(
          {std::move(message.labels), 0, 0, message.labels_given,
           message.times_from == From::unknown ? From::utterance : message.times_from});
      if (message.times_from == From::piece) {
        utterance->unread.back().piece =
            utterance->pieces.empty() ? 0 : utterance->pieces.back()->start;
      }
    }
    if (message.last && utterance->sound == 0 && !utterance->text.empty()) {
      message.text = utterance->text;
      message.labels.clear();
      Result<Taken> spoken = speech_of(message, utterance);
      if (!spoken) return spoken;
      taken = std::move(*spoken);
    } else if (nothing && !message.small_talk && !message.has_format() && message.error.empty()) {
      return make_error(Code::invalid_argument,
                        "there is neither sound nor a text, and no timings");
    }
  }
  if (message.last) {
    utterance->over = true;
    utterance->rest.clear();
  }
  if (!message.error.empty()) taken.warning = "the service reports an error: " + message.error;
  return taken;
}

bool PieceStream::may_improve(std::uint64_t key) {
  const std::lock_guard lock(impl_->mutex);
  const auto found = impl_->pieces.find(key);
  if (found == impl_->pieces.end()) return false;
  const Piece& piece = *found->second;
  const Utterance& utterance = *piece.utterance;
  const bool more = utterance.over || utterance.sound >= piece.end() + SoundEar::kLookAhead;
  return !utterance.unread.empty() || (more && !piece.heard_all);
}

bool PieceStream::times_came(std::uint64_t key) {
  const std::lock_guard lock(impl_->mutex);
  const auto found = impl_->pieces.find(key);
  return found != impl_->pieces.end() && !found->second->utterance->unread.empty();
}

void PieceStream::forget(std::uint64_t key) {
  const std::lock_guard lock(impl_->mutex);
  const auto found = impl_->pieces.find(key);
  if (found == impl_->pieces.end()) return;
  const std::shared_ptr<Piece> piece = found->second;
  impl_->pieces.erase(found);
  piece->released = true;
  // Sound that has just been spoken is what the next one follows.
  auto& all = piece->utterance->pieces;
  const double old = piece->end() - kOldSound;
  while (!all.empty() && all.front()->released && all.front()->end() < old) all.pop_front();
  if (piece->utterance->over && (all.empty() || all.back()->released)) {
    piece->utterance->ear.reset();
  }
  if (piece->utterance->dropped) drop(*piece->utterance);
}

// Gives times their place in the utterance. Doubts are told with the piece that the times came
// with, if it has still to be made.
void PieceStream::Impl::read(Utterance& utterance, const std::vector<Labels>& unread,
                             const ScriptInput& how, std::string& doubt) {
  for (const Labels& labels : unread) {
    const std::shared_ptr<Piece> owner = labels.owner.lock();
    std::string& told = owner && !owner->made ? owner->doubt : doubt;
    tools::Log log;
    log.warn = [&told](const std::string& warning) { add_sentence(told, warning); };
    const auto timings = scripts::read_labels(labels.text, how.reading);
    if (!timings) {
      log.warn((labels.given ? "its script cannot be read (" : "its members are not timings (") +
               timings.error().message + ")");
      continue;
    }
    const bool events = timings->format == "azure" || timings->format == "polly";
    const Result<dam::Script> script = parse_script(labels.text, "the piece", how, log);
    if (!script) {
      log.warn("its times cannot be used (" + script.error().message + ")");
      continue;
    }
    From from = labels.from == From::unknown ? utterance.times_from : labels.from;
    if (from == From::unknown) {
      // By what they fit. At the begin of an utterance both are the same.
      const auto first = std::find_if(script->phones.begin(), script->phones.end(),
                                      [](const auto& p) { return p.label != dam::kSilence; });
      const double start = first == script->phones.end() ? labels.piece : first->start;
      const bool later = start >= labels.piece - kTimely;
      const bool inside = script->duration() <= labels.length + kAfterSound;
      from = later || !inside ? From::utterance : From::piece;
      if (labels.piece > kTimely && first != script->phones.end()) utterance.times_from = from;
    }
    const double offset = from == From::piece ? labels.piece : 0;
    const double over = script->duration() + offset - labels.piece - labels.length;
    if (labels.length > 0 && over > kAfterSound) {
      log.warn("its times reach " + std::to_string(std::lround(over * 1000)) +
               " ms behind its sound; they wait for the next piece");
    }
    utterance.times.add(*script, offset, events);
  }
}

// Of a piece whose text is all that is said in it.
void PieceStream::Impl::align(Piece& piece, const std::string& text, const ScriptInput& how,
                              std::string& doubt) {
  piece.aligned = true;
  tools::Log log;
  log.warn = [&doubt](const std::string& warning) { add_sentence(doubt, warning); };
  TimedSound sound;
  sound.from = "the piece";
  sound.text = text;
  sound.audio = *piece.sound;
  const Result<TimedSpeech> timed = time_sound(std::move(sound), how, log);
  if (!timed) {
    log.warn("its text cannot be aligned (" + timed.error().message +
             "); the face follows the sound");
    return;
  }
  piece.utterance->times.add(timed->speech.script, piece.start);
}

Result<SpokenLine> PieceStream::Impl::make_sound(Piece& piece) {
  Utterance& utterance = *piece.utterance;
  std::vector<Labels> unread;
  std::vector<std::shared_ptr<Piece>> kept;  // so that their sound stays
  bool over = false, waits = false, more = false, ends = false;
  ScriptInput how;
  {
    const std::lock_guard lock(mutex);
    unread.swap(utterance.unread);
    kept.assign(utterance.pieces.begin(), utterance.pieces.end());
    over = utterance.over;
    how = reading(utterance.language);
    more = utterance.sound >= piece.end() + SoundEar::kLookAhead;
    piece.heard_all = more || over;
    ends = over && piece.end() >= utterance.sound;
    waits = utterance.named && (utterance.told_alone || waits_for_times);
  }
  std::vector<SoundEar::Piece> sounds;
  for (const auto& one : kept) sounds.push_back({one->start, one->sound.get()});
  SpokenLine line;
  line.joins = true;
  line.text = piece.text;
  piece.made = true;
  read(utterance, unread, how, line.doubt);
  add_sentence(line.doubt, std::exchange(piece.doubt, {}));
  tools::Log log;
  log.warn = [&line](const std::string& warning) { add_sentence(line.doubt, warning); };
  const std::string text = text_to_say(piece.text, input.reading.speak_marks, log);
  const double told = utterance.times.known();
  const bool timed = piece.timed || told >= piece.end() - kKnown;
  if (!timed && told <= piece.start && !piece.aligned && fits(text, piece.sound->duration())) {
    align(piece, text, how, line.doubt);
  }
  std::optional<dam::Script> heard;
  if (!timed && utterance.times.known() < piece.end() - kKnown) {
    std::shared_ptr<SoundEar> ear;
    {
      const std::lock_guard lock(mutex);
      if (!utterance.ear) utterance.ear = std::make_shared<SoundEar>(how.language);
      ear = utterance.ear;
    }
    heard = ear->hear(sounds, piece.start, piece.end());
    if (!heard) {
      log.warn("the face cannot follow its sound (" + ear->why() + ")");
    }
    line.improvable = !over && (waits || !more);
  }
  UtterancePart part = utterance.times.between(piece.start, piece.end(), heard ? &*heard : nullptr);
  line.speech.script = std::move(part.script);
  line.words = std::move(part.words);
  line.goes_on = part.goes_on;
  if (!text::is_ssml(text)) {
    line.speech.moods = text::find_moods(text, line.speech.script);
  }
  Result<media::Pcm> sound = converted(piece, sounds, made_rate);
  line.speech.audio = sound ? std::move(*sound) : *piece.sound;
  utterance.times.forget(piece.start - 2 * kOldSound);
  if (ends) {  // megabytes, of which nothing more is heard
    const std::lock_guard lock(mutex);
    utterance.ear.reset();
  }
  return line;
}

// What has no sound of its own.
Result<SpokenLine> PieceStream::Impl::make_alone(const Piece& piece) {
  SpokenLine line;
  line.joins = true;
  line.text = piece.text;
  tools::Log log;
  log.warn = [&line](const std::string& warning) { add_sentence(line.doubt, warning); };
  const ScriptInput how = reading(piece.language);
  TimedSound sound;
  sound.from = "the piece";
  sound.text = text_to_say(piece.text, input.reading.speak_marks, log);
  sound.labels = piece.labels.text;
  sound.audio.sample_rate = kPieceRate;
  if (!piece.labels.given && !sound.labels.empty() && !sound.text.empty()) {
    if (const auto timings = scripts::read_labels(sound.labels); !timings) {
      log.warn("its members are not timings (" + timings.error().message + ")");
      sound.labels.clear();
    }
  }
  if (sound.labels.empty()) {
    voice::VoiceOptions settings = voice;
    settings.language = how.language;
    Result<voice::Speech> speech = voice::speak_text(sound.text, settings);
    if (!speech) return speech.error();
    line.speech = std::move(*speech);
    return line;
  }
  Result<TimedSpeech> timed = time_sound(std::move(sound), how, log);
  if (!timed) {
    Error error = timed.error();
    error.where = {};  // positions are inside a part of the line
    return error;
  }
  line.speech = std::move(timed->speech);
  return line;
}

Result<std::shared_ptr<Piece>> PieceStream::Impl::find(std::uint64_t key) {
  const std::lock_guard lock(mutex);
  const auto found = pieces.find(key);
  if (found == pieces.end()) return make_error(Code::not_found, "it is no longer needed");
  return found->second;
}

Result<SpokenLine> PieceStream::make(std::uint64_t key) {
  const Result<std::shared_ptr<Piece>> piece = impl_->find(key);
  if (!piece) return piece.error();
  return (*piece)->sound ? impl_->make_sound(**piece) : impl_->make_alone(**piece);
}

Result<SpokenLine> PieceStream::words(std::uint64_t key) {
  const Result<std::shared_ptr<Piece>> found = impl_->find(key);
  if (!found) return found.error();
  const Piece& piece = **found;
  std::vector<Labels> unread;
  ScriptInput how;
  {
    const std::lock_guard lock(impl_->mutex);
    unread.swap(piece.utterance->unread);
    how = impl_->reading(piece.utterance->language);
  }
  SpokenLine line;
  impl_->read(*piece.utterance, unread, how, line.doubt);
  line.words = piece.utterance->times.between(piece.start, piece.end(), nullptr).words;
  return line;
}

bool is_piece(std::string_view json) {
  const Result<PieceMessage> message = read_message(json);
  if (!message) return parse_object(json).has_value();  // one that is wrong
  if (message->has_sound() || message->has_format() || !message->utterance.empty()) return true;
  if (message->small_talk || message->labels_given || message->labels_are_events) return true;
  return !message->labels.empty() && scripts::read_labels(message->labels).has_value();
}

Result<SpokenLine> read_piece(std::string_view json, const voice::VoiceOptions& voice,
                              const ScriptInput& input) {
  PieceStream stream(voice, input);
  const Result<PieceStream::Taken> taken = stream.add(json);
  if (!taken) return taken.error();
  if (taken->key == 0) {
    return make_error(Code::invalid_argument, "there is neither sound nor a text, and no timings");
  }
  return stream.make(taken->key);
}

LineMaker piece_lines(const voice::VoiceOptions& voice, const ScriptInput& input) {
  LineMaker maker;
  maker.sample_rate = kPieceRate;
  maker.most_bytes = kMostPiece;
  maker.cut = false;
  maker.json = true;
  maker.pieces = std::make_shared<PieceStream>(voice, input, kPieceRate);
  return maker;
}

}  // namespace animeme::speech
