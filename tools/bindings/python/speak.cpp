// Speech: text, phones or a recorded voice in, a face with its sound out.
#include <cmath>

#include "dam/signal/fap_signal.h"
#include "dam/speaking/idle_motion.h"
#include "dam/speaking/moods.h"
#include "dam/speaking/stream.h"
#include "tools/bindings/python/python_internal.h"
#include "tools/formats/files/files.h"
#include "tools/speech/talking/spoken.h"
#include "tools/speech/voice/pitch.h"

namespace animeme::python {

namespace {

// The spoken script and the motion of the face.
struct Speech {
  speech::Spoken spoken;
  dam::Signal signal;
  std::string language;
};

struct Motion {
  dam::SynthesisOptions synthesis;
  std::optional<bool> idle_motion;
  dam::IdleMotionOptions idle;
  dam::Mood mood;
};

Result<Speech> spoken_of(speech::SpokenOptions source, const dam::Script* script,
                         WarningLog& heard) {
  if (script == nullptr) {
    auto spoken = speech::get_spoken(source, heard.log());
    if (!spoken) return spoken.error();
    return Speech{std::move(*spoken), {}, {}};
  }
  Speech speech;
  speech.spoken.script = *script;
  speech.spoken.times = speech::TimesFrom::script;
  if (source.audio.empty()) return speech;
  auto audio = speech::read_voice(source.audio, heard.log());
  if (!audio) return audio.error();
  if (auto ok = dam::check_against_audio(*script, audio->duration()); !ok) return ok.error();
  speech.spoken.audio = std::move(*audio);
  return speech;
}

// As the program does: the face goes on as long as the sound.
Result<void> move_face(const dam::Model& model, Motion motion, Speech& speech) {
  const auto& audio = speech.spoken.audio;
  if (audio) {
    motion.synthesis.tail = std::max(0.0, audio->duration() - speech.spoken.script.duration());
  }
  auto signal = speech::move_face(model, speech.spoken, motion.synthesis);
  if (!signal) return signal.error();
  speech.signal = std::move(*signal);
  const bool lives = motion.idle_motion.value_or(true);
  const dam::Prosody prosody = lives && audio ? voice::measure_prosody(*audio) : dam::Prosody{};
  motion.idle.prosody = &prosody;
  if (!lives) motion.idle.liveliness = 0;
  const auto added = dam::add_idle_motion(speech.signal, speech.spoken.script, motion.idle);
  // Without being asked: models of other rigs do without.
  if (!added && motion.idle_motion.value_or(false)) return added.error();
  const auto moody = dam::add_moods(speech.signal, speech.spoken.script,
                                    dam::MoodTrack(motion.mood, speech.spoken.moods));
  if (!moody && !motion.mood.neutral()) return moody.error();
  return {};
}

std::unique_ptr<Speech> speak(const Model& model, const py::object& said, const py::object& audio,
                              const py::object& transcript, const std::string& lang,
                              const py::object& rate, double style, double sharpness,
                              std::optional<double> articulation, bool closure,
                              std::optional<bool> idle_motion, std::uint64_t seed, int speed,
                              int pitch, const std::string& tts, const std::string& mood,
                              double liveliness, const std::string& still, const std::string& look,
                              bool tongue, bool symmetric) {
  speech::SpokenOptions source;
  std::optional<dam::Script> script;
  if (py::isinstance<py::str>(said)) {
    source.text = said.cast<std::string>();
    source.has_text = true;
  } else if (!said.is_none()) {
    script = script_of(said);
  } else if (audio.is_none()) {
    throw py::type_error("speak() needs a text, phones, or audio");
  }
  if (source.has_text && !audio.is_none()) {
    throw py::type_error("what is said in audio is its transcript");
  }
  if (!audio.is_none()) source.audio = path_of(audio);
  if (!transcript.is_none()) {
    if (source.audio.empty()) throw py::type_error("a transcript is that of audio");
    source.transcript = transcript.cast<std::string>();
    source.has_transcript = true;
  }
  source.listen = !source.audio.empty() && !source.has_transcript;
  source.language = lang;
  source.words_per_minute = speed;
  source.pitch = pitch;
  source.tts = tts;
  Motion motion{
      {.rate = rate_of(rate),
       .closure = closure,
       .style = style,
       .sharpness = sharpness,
       .articulation = articulation,
       .tongue = tongue,
       .symmetric_rest = symmetric},
      idle_motion,
      {liveliness, seed, value_of(dam::parse_still(still)), value_of(dam::parse_look(look))},
      value_of(dam::read_mood(mood))};
  WarningLog heard;
  auto speech = unlocked([&]() -> Result<Speech> {
    auto made = spoken_of(source, script ? &*script : nullptr, heard);
    if (!made) return made;
    if (auto done = move_face(model.model, motion, *made); !done) return done.error();
    return made;
  });
  heard.tell();
  auto done = std::make_unique<Speech>(value_of(std::move(speech)));
  const auto& languages = done->spoken.languages;
  done->language = !languages.empty() ? languages.front().language : script ? "" : lang;
  return done;
}

Clip clip_of_speech(const Speech& speech) {
  return clip_of(value_of(dam::to_sequence(speech.signal)));
}

py::object sound_of(const Speech& speech) {
  if (!speech.spoken.audio) return py::none();
  const auto& samples = speech.spoken.audio->samples;
  return py::array_t<float>(py::ssize_t(samples.size()), samples.data());
}

void save_speech(const Speech& speech, const py::object& path, const std::string& preset, int quant,
                 double max_rms, double max_bits_per_second, std::optional<double> intra_seconds) {
  Beside beside;
  if (speech.spoken.audio) beside.sound = &*speech.spoken.audio;
  beside.texts = speech::carried_texts(speech.spoken.script, speech.language);
  if (tools::extension_of(path_of(path)) != ".mp4") speech::add_captions(beside.texts);
  save(value_of(dam::to_sequence(speech.signal)), path_of(path),
       {preset, quant, max_rms, max_bits_per_second, intra_seconds}, beside);
}

py::array_t<double> speech_times(const Speech& speech) {
  py::array_t<double> times(py::ssize_t(speech.signal.frames()));
  for (std::size_t i = 0; i < speech.signal.frames(); ++i) {
    times.mutable_at(i) = speech.signal.time(i);
  }
  return times;
}

std::unique_ptr<dam::SpeechStream> make_stream(const Model& model, const py::object& rate,
                                               std::optional<double> look_ahead, double style,
                                               double sharpness, std::optional<double> articulation,
                                               bool closure, bool tongue, const std::string& mood,
                                               bool symmetric) {
  const dam::StreamOptions options{{.rate = rate_of(rate),
                                    .closure = closure,
                                    .style = style,
                                    .sharpness = sharpness,
                                    .articulation = articulation,
                                    .tongue = tongue,
                                    .symmetric_rest = symmetric},
                                   look_ahead,
                                   dam::StreamOptions().cross_fade,
                                   value_of(dam::read_mood(mood))};
  value_of(dam::validate(options.synthesis));
  return std::make_unique<dam::SpeechStream>(model.model, options);
}

void bind_speech_stream(py::module_& module) {
  py::class_<dam::SpeechStream>(module, "SpeechStream",
                                R"(Incremental speech: phones in, frames out.

    for phone in my_voice:
        show(stream.push(*phone))

A frame is returned as soon as no later phone can change it, or earlier with `look_ahead`.)")
      .def(py::init(&make_stream), py::arg("model"), py::kw_only(), py::arg("rate") = 25,
           py::arg("look_ahead") = py::none(), py::arg("style") = 1.0, py::arg("sharpness") = 1.0,
           py::arg("articulation") = py::none(), py::arg("closure") = true,
           py::arg("tongue") = false, py::arg("mood") = "neutral", py::arg("symmetric") = true,
           py::keep_alive<1, 2>(),
           R"(A stream that begins at time 0.

model: who speaks.
rate: frames a second.
look_ahead: seconds of script needed beyond a frame; None: everything that can change it.
style, sharpness, articulation, closure, symmetric: as for Model.speak().
tongue, mood: likewise; what they move and the model lacks follows its controls as further columns:
    FAP 44 to 47, then FAPs ascending.)")
      .def(
          "push",
          [](dam::SpeechStream& s, double start, double end, const std::string& label,
             const std::string& word) {
            value_of(s.push({start, end, label, word}));
            return array_of(value_of(s.pull()));
          },
          py::arg("start"), py::arg("end"), py::arg("label"), py::arg("word") = "",
          R"(Adds a phone; returns the frames that became final: float64 (frames, controls), often none.

start, end: seconds, not before the end of the last phone; gaps are silence.
label: ARPAbet without stress or "SIL".
word: to which it belongs.

Raises Error.)")
      .def(
          "finish", [](dam::SpeechStream& s) { return array_of(value_of(s.finish())); },
          "Ends the script; returns the remaining frames, float64 (frames, controls).");
}

}  // namespace

void bind_speak(py::module_& module) {
  py::class_<Speech>(module, "Speech", "What Model.speak() made: a face with its script and sound.")
      .def_property_readonly("clip", &clip_of_speech,
                             "The face as a Clip; raises Error if the controls of the model are\n"
                             "neither FAPs nor ARKit's.")
      .def_property_readonly(
          "values", [](const Speech& s) { return array_of(s.signal); },
          "float64 (frames, names): the controls in their own units.")
      .def_property_readonly(
          "names", [](const Speech& s) { return s.signal.names; },
          "Names of the columns of `values`.")
      .def_property_readonly("times", &speech_times, "float64 (frames,): seconds of each frame.")
      .def_property_readonly(
          "rate", [](const Speech& s) { return s.signal.rate.frames_per_second(); },
          "Frames a second.")
      .def_property_readonly(
          "phones", [](const Speech& s) { return phones_of(s.spoken.script); },
          "list of Phone: start and end in seconds, label, word.")
      .def_property_readonly("audio", &sound_of,
                             "float32 (samples,): one channel, +-1 is full scale; None: no sound.")
      .def_property_readonly(
          "sample_rate",
          [](const Speech& s) { return s.spoken.audio ? s.spoken.audio->sample_rate : 0; },
          "Samples a second; 0: no sound.")
      .def_property_readonly(
          "voice", [](const Speech& s) { return s.spoken.voice; },
          "Name of the synthetic voice; empty: none.")
      .def("save", &save_speech, py::arg("path"), py::kw_only(), py::arg("preset") = "file",
           py::arg("quant") = 1, py::arg("max_rms") = 0.0, py::arg("max_bits_per_second") = 0.0,
           py::arg("intra_seconds") = py::none(),
           R"(Writes face, sound, words and phones in the format given by the file name.

path, preset, quant, max_rms, max_bits_per_second, intra_seconds: as for Clip.save().)");

  auto model = py::reinterpret_borrow<py::class_<Model>>(module.attr("Model"));
  model.def("speak", &speak, py::arg("said") = py::none(), py::kw_only(),
            py::arg("audio") = py::none(), py::arg("transcript") = py::none(),
            py::arg("lang") = "en", py::arg("rate") = 25, py::arg("style") = 1.0,
            py::arg("sharpness") = 1.0, py::arg("articulation") = py::none(),
            py::arg("closure") = true, py::arg("idle_motion") = py::none(), py::arg("seed") = 1,
            py::arg("speed") = 175, py::arg("pitch") = 50, py::arg("tts") = "",
            py::arg("mood") = "neutral", py::arg("liveliness") = 1.0, py::arg("still") = "",
            py::arg("look") = "camera", py::arg("tongue") = true, py::arg("symmetric") = true,
            R"(Speaks: returns a Speech.

said: a text, plain or SSML, for a synthetic voice; or phones, tuples (start, end, label[, word]):
    seconds, ARPAbet without stress or "SIL"; None: recognise audio.
audio: a sound file: with phones used as their sound, with a transcript aligned, alone recognised.
transcript: what is said in audio.
lang: language of the text: "en", "de", "pt-br"; "zh+en": further ones by script; "auto".
rate: frames a second.
style: intensity, 0 keeps the mouth at rest, 1 is as learned, 0..1.5.
sharpness: quickness, 0 is the mean of sentences, 1 more as people, 0..3.
articulation: how clearly vowels show, 0 is as learned, 0..2; None: 1 for the built-in model, 0 for others.
closure: P, B and M close the lips, F and V reach the teeth.
idle_motion: gaze, blinks, brows and head; None: where the controls of the model are known;
False: brows at question marks alone.
seed: of the idle motion: another seed, other times of blinks.
liveliness, still, look: its amount (0..2); parts without it ("gaze,head,brows,blinks"); where the
    eyes look: "camera", "away", "YAW,PITCH" in degrees, "X,Y,Z" in metres.
speed, pitch: words a minute (80..450) and pitch (0..100) of the synthetic voice.
tts: command of a voice of yours, that writes sound to {wav}.
tongue: FAP 44 to 47 follow the sounds, for models without a tongue; it does not fit into streams with quant=0.
symmetric: the resting mouth is the same on both sides; False: as learned, with its speaker's smirk.
mood: "joy", "anger:0.5", "thinking" ...; SSML, emoji and exclamation marks of the text change it.

What a voice left out or spelled is warned of as InputWarning. Raises Error. Other threads run
meanwhile.)");
  bind_speech_stream(module);
}

}  // namespace animeme::python
