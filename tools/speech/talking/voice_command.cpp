#include "tools/speech/talking/voice_command.h"

#include <filesystem>
#include <utility>

#include "tools/formats/files/files.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/programs/command_template.h"
#include "tools/formats/programs/run_program.h"
#include "tools/formats/programs/scratch_folder.h"

namespace animeme::speech {

namespace {

namespace fs = std::filesystem;

constexpr int kLiveRate = 48000;                              // Hz; neural voices have 16 to 48
constexpr std::uint64_t kMostSound = std::uint64_t(1) << 30;  // bytes, as tools::read_file()

bool is_there(const std::string& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && fs::file_size(path, ignored) > 0;
}

bool has_words_to_say(const std::string& text) {
  return text.find_first_not_of(" \t\r\n") != std::string::npos;
}

}  // namespace

Result<TimedSpeech> run_voice_command(const std::string& text, const VoiceCommand& voice,
                                      const tools::Log& log, const tools::Progress& progress) {
  const Result<tools::CommandTemplate> command = tools::parse_command(voice.command);
  if (!command) return command.error();
  if (!has_words_to_say(text)) {
    return make_error(Code::invalid_argument, "there is nothing to say in the text");
  }
  const auto scratch = tools::ScratchFolder::make();
  if (!scratch) return scratch.error();
  const tools::ScratchFolder& folder = **scratch;
  const std::string text_file = folder.file("text.txt"), wav = folder.file("voice.wav");
  const std::string times = folder.file("times"), out = folder.file("out");
  if (auto done = tools::write_file(text_file, text + "\n"); !done) return done.error();
  const bool sound_in_file = command->names("wav");
  const bool times_in_file = command->names("script");
  tools::ChildJob job;
  Result<std::vector<std::string>> arguments =
      tools::fill_in(*command, {{{"text", text},
                                 {"text_file", text_file},
                                 {"wav", wav},
                                 {"script", times},
                                 {"lang", voice.input.language}}});
  if (!arguments) return arguments.error();
  job.arguments = std::move(*arguments);
  const std::string program = fs::path(job.arguments.front()).filename().string();
  job.in = text_file;
  job.out = out;
  job.err = folder.file("err");
  job.most_bytes = kMostSound;
  tools::ProgramRun run;
  run.what = "the voice " + program;
  run.seconds = voice.seconds;
  run.progress = progress;
  if (auto done = tools::run_program(job, run); !done) return done.error();

  const std::string& sound_file = sound_in_file ? wav : out;
  if (!is_there(sound_file)) {
    return make_error(Code::not_found,
                      run.what + " produced no sound" +
                          (sound_in_file ? "; it is to write it to {wav}"
                                         : "; {wav} in its command is where a file for it goes") +
                          tools::last_words(job.err, run));
  }
  TimedSound sound;
  sound.text = text;
  sound.from = "what " + program + " says";
  std::vector<std::string> warnings;
  Result<media::Pcm> audio = media::read_audio(sound_file, {.warnings = &warnings});
  if (!audio) {
    Error error = audio.error();
    error.message = "the sound of " + program + ": " + error.message;
    error.where = {};
    return error;
  }
  for (const std::string& warning : warnings) log.warn(program + ": " + warning);
  sound.audio = std::move(*audio);
  const std::string& script_file = times_in_file ? times : out;
  if ((times_in_file || sound_in_file) && is_there(script_file)) {
    Result<std::string> labels = tools::read_text_file(script_file, tools::kMostWritten);
    if (!labels && times_in_file) return labels.error();
    if (labels) sound.labels = std::move(*labels);
    // Standard output may be anything; a format that was asked for is insisted on.
    sound.labels_may_be_none = !times_in_file && voice.input.reading.format.empty();
  }
  Result<TimedSpeech> timed = time_sound(std::move(sound), voice.input, log);
  if (timed) timed->speech.voice = program;
  return timed;
}

Result<LineMaker> command_lines(const VoiceCommand& voice) {
  const Result<tools::CommandTemplate> command = tools::parse_command(voice.command);
  if (!command) return command.error();
  LineMaker maker;
  maker.sample_rate = kLiveRate;
  maker.make_in = [voice](std::string line, const std::string& language,
                          const Wanted& wanted) -> Result<SpokenLine> {
    VoiceCommand how = voice;
    if (!language.empty()) how.input.language = language;
    SpokenLine spoken;
    tools::Log log;
    log.warn = [&spoken](const std::string& text) {
      spoken.doubt += (spoken.doubt.empty() ? "" : "; ") + text;
    };
    tools::Progress progress;
    progress.stop = [&wanted] { return !wanted(); };
    const std::string text(without_stray_mark(line, log));
    Result<TimedSpeech> timed = run_voice_command(text, how, log, progress);
    if (!timed) return timed.error();
    spoken.text = std::move(line);
    spoken.speech = std::move(timed->speech);
    spoken.joins = true;
    return spoken;
  };
  maker.make = [make = maker.make_in](std::string line, const Wanted& wanted) {
    return make(std::move(line), {}, wanted);
  };
  return maker;
}

}  // namespace animeme::speech
