#include "tools/formats/programs/run_program.h"

#include <algorithm>
#include <fstream>
#include <optional>

#include "tools/formats/common/text.h"

namespace animeme::tools {

namespace {

constexpr std::size_t kLastWords = 600;      // bytes of what a program said
constexpr std::streamoff kLastRead = 16384;  // of which those are found
constexpr double kLook = 0.2;                // seconds between looks at it

// The last output of a program: its progress, and the rest.
struct LastOutput {
  double share = -1;
  std::string words;
};

LastOutput said_in(const std::string& path, const ProgramRun& run) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? std::streamoff(file.tellg()) : 0;
  std::string text(std::size_t(std::min(size, kLastRead)), '\0');
  file.seekg(size - std::streamoff(text.size()));
  file.read(text.data(), std::streamsize(text.size()));
  text.resize(std::size_t(std::max<std::streamsize>(file.gcount(), 0)));
  LastOutput said;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    const double share = run.share_told ? run.share_told(line) : -1;
    if (share >= 0) {
      said.share = share;
    } else if (!line.empty()) {
      said.words += (said.words.empty() ? "" : "\n") + line;
    }
  }
  return said;
}

std::string how(const ChildEnd& end) {
  if (end.how == ChildEnd::How::crashed) return "ended by " + signal_text(end.code);
  return "ended with exit code " + std::to_string(end.code);
}

}  // namespace

std::string last_words(const std::string& err, const ProgramRun& run) {
  const std::string words = said_in(err, run).words;
  if (words.empty()) return {};
  return "; it said: " +
         (words.size() > kLastWords ? words.substr(words.size() - kLastWords) : words);
}

Result<void> run_program(const ChildJob& job, const ProgramRun& run) {
  Children children(run.seconds);
  if (auto started = children.start(0, job); !started) return started;
  std::optional<Children::Finished> finished;
  while (!(finished = children.wait_for(kLook))) {
    if (run.progress.stop()) {
      return make_error(Code::io, run.what + " was stopped before its end");
    }
    if (!run.share_told) continue;
    if (const double share = said_in(job.err, run).share; share >= 0) run.progress.at(share);
  }
  const ChildEnd end = finished->end;
  if (end.how == ChildEnd::How::timed_out) {
    const std::string remedy = run.allow_more.empty() ? "" : "; " + run.allow_more + " allows more";
    return make_error(Code::out_of_range,
                      run.what + format(" took more than %g s and was stopped", run.seconds) +
                          remedy + last_words(job.err, run));
  }
  if (end.how != ChildEnd::How::exited || end.code != 0) {
    return make_error(Code::not_found, run.what + " " + how(end) + last_words(job.err, run));
  }
  return {};
}

}  // namespace animeme::tools
