#include "tools/app/check/run_suite.h"

#include <algorithm>
#include <sstream>

#include "codec/text/bap_text.h"
#include "conformance/trial.h"
#include "fap/rate_text.h"
#include "fap/text.h"
#include "tools/formats/common/exit_code.h"
#include "tools/formats/files/files.h"

namespace animeme::tools {
namespace {

namespace fs = std::filesystem;
using conformance::Case;

// The files of one run of one case.
struct RunFiles {
  std::string stream, face, body, out, err, errors, encoder;
};

RunFiles files_of(const fs::path& scratch, std::size_t i, const SuiteCase& one,
                  const RunOptions& options) {
  const std::string base = (scratch / std::to_string(i)).string();
  // An external decoder gets a copy, under a name without special characters.
  RunFiles files{options.command ? base + ".fba" : one.path.at("stream").string(),
                 base + ".fap",
                 base + ".bap",
                 base + ".out",
                 base + ".err",
                 base + ".errors",
                 base + ".encoder"};
  if (options.command && !options.command->names("out")) files.face = files.out;
  return files;
}

std::string path_of(const SuiteCase& one, const char* role) {
  const auto found = one.path.find(role);
  return found == one.path.end() ? std::string() : found->second.string();
}

// Empty if there is no such file.
std::string small_file(const std::string& path) {
  Result<std::string> text = read_text_file(path);
  return text ? *text : std::string();
}

// Runs in the child process: writes the decoded values and the report as files.
int run_own(const SuiteCase& one, const RunFiles& files, bool encode) {
  const auto bytes = read_file(files.stream);
  if (!bytes) return kBadInput;
  const conformance::Trial trial = conformance::decode_all(*bytes);
  const fap::Sequence face = fba::face_sequence(trial.stream);
  const fba::BodySequence body = fba::body_sequence(trial.stream);
  if (!face.frames.empty() && !write_file(files.face, fap::write_text(face))) return kInternal;
  if (!body.frames.empty() && !write_file(files.body, fba::write_bap_text(body))) return kInternal;
  std::string errors;
  for (const Error& error : trial.errors) {
    errors += conformance::kind_of_error(error.code) + " " + error.describe() + "\n";
  }
  if (!write_file(files.errors, errors)) return kInternal;
  if (!encode || one.path.count("parameters") == 0) return kOk;

  Case info = one.info;
  if (!one.described) conformance::set_switches(*bytes, trial.stream, info);
  const auto text = [&](const char* role) { return small_file(path_of(one, role)); };
  const auto again =
      conformance::encode_again(info, text("parameters"), text("source_face"), text("source_body"));
  std::string said = "same";
  if (!again) {
    said = again.error().describe();
  } else if (*again != *bytes) {
    const auto [a, b] = std::mismatch(again->begin(), again->end(), bytes->begin(), bytes->end());
    said = "written again, the stream differs from byte " + std::to_string(a - again->begin());
  }
  return write_file(files.encoder, said) ? kOk : kInternal;
}

// The last line that is not empty.
std::string last_line(const std::string& text) {
  std::string last;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  }
  return last.size() > 200 ? last.substr(0, 200) + "..." : last;
}

// A text of values; no such file, or an empty one, is a clip without frames.
Result<CodedClip> read_clip(const std::string& path, bool body) {
  CodedClip none;
  none.body = body;
  std::error_code ignored;
  if (path.empty() || !fs::exists(path) || fs::file_size(path, ignored) == 0) return none;
  Result<std::string> text = read_text_file(path);
  if (!text) return text.error();
  if (body) {
    Result<fba::BodySequence> clip = fba::read_bap_text(*text);
    if (!clip) return clip.error();
    return coded_values(*clip);
  }
  Result<fap::Sequence> clip = fap::read_text(*text, {.keep_numbers = true});
  if (!clip) return clip.error();
  return coded_values(*clip);
}

// Judges what a decoder has left behind.
class Judge {
 public:
  Judge(const SuiteCase& one, const RunFiles& files, const RunOptions& options, CaseResult& result)
      : one_(one), files_(files), own_(!options.command), result_(result) {
    with_body_ = own_ || options.command->names("bap");
  }

  void judge() {
    using How = ChildEnd::How;
    if (result_.end.how == How::crashed) return say(Verdict::crash, signal_text(result_.end.code));
    if (result_.end.how == How::timed_out) return say(Verdict::timeout, "it did not end in time");
    const bool refused = result_.end.code != 0;
    if (refused && (own_ || !one_.info.damaged)) return say(Verdict::error, refusal());

    for (const bool body : {false, true}) {
      if (body && !with_body_) continue;
      if (!compare_part(body, refused)) return;
    }
    if (own_) own_errors();
    if (own_ && is_right(result_.verdict)) own_encoder();
  }

 private:
  void say(Verdict verdict, std::string detail) {
    result_.verdict = verdict;
    result_.detail = std::move(detail);
  }
  // The worse of what is known and `verdict`; later means worse among the right ones.
  void at_best(Verdict verdict, const std::string& detail) {
    if (result_.verdict == Verdict::skipped || verdict > result_.verdict) say(verdict, detail);
  }

  std::string refusal() const {
    const std::string line = last_line(small_file(files_.err));
    return "exit code " + std::to_string(result_.end.code) + (line.empty() ? "" : ": " + line);
  }

  // False when there is nothing more to find out.
  bool compare_part(bool body, bool refused) {
    Result<CodedClip> expected = read_clip(path_of(one_, body ? "body" : "face"), body);
    if (!expected) {
      say(Verdict::bad_data, expected.error().describe());
      return false;
    }
    const Result<CodedClip> got = read_clip(body ? files_.body : files_.face, body);
    if (!got) {
      say(Verdict::error, "what it wrote cannot be read: " + got.error().describe());
      return false;
    }
    // Texts from elsewhere often have whole rates only, so case.json alone is trusted.
    const Result<fap::Rate> rate = fap::parse_rate(one_.info.rate);
    expected->rate = rate ? *rate : got->rate;
    if (expected->frames.empty() && got->frames.empty()) {
      if (one_.info.damaged) at_best(Verdict::exact, "");
      return true;
    }
    const Comparison comparison = compare(*expected, *got);
    // Here an additional frame was decoded from damaged bits.
    const bool too_many = got->frames.size() > expected->frames.size();
    if (comparison.right && !(one_.info.damaged && too_many)) {
      at_best(comparison.exact ? Verdict::exact : Verdict::values, comparison.text);
      return true;
    }
    if (one_.info.damaged && damage_is_handled(body, *expected, *got, refused)) return true;
    result_.difference = comparison.difference;
    const bool nothing = got->frames.empty() && !one_.info.damaged;
    say(nothing ? Verdict::error : Verdict::wrong, nothing ? "it wrote no values"
                                                   : comparison.right
                                                       ? "values were made of damaged bits"
                                                       : comparison.text);
    return false;
  }

  bool damage_is_handled(bool body, const CodedClip& expected, const CodedClip& got, bool refused) {
    if (!body && !path_of(one_, "face_ignored").empty()) {
      const Result<CodedClip> whole = read_clip(path_of(one_, "face_ignored"), body);
      if (whole && compare(*whole, got).right) {
        at_best(Verdict::ignored, "the damage was not seen");
        return true;
      }
    }
    // Without a word and without values, nothing was recognised.
    if (!is_beginning(expected, got) || (got.frames.empty() && !refused)) return false;
    at_best(Verdict::stopped, refused ? refusal() : "stopped at the damage");
    return true;
  }

  void own_errors() {
    std::istringstream lines(small_file(files_.errors));
    bool any = false;
    const auto& right = one_.info.errors;
    for (std::string line; std::getline(lines, line);) {
      any = true;
      const std::string kind = line.substr(0, line.find(' '));
      const bool known = std::find(right.begin(), right.end(), kind) != right.end();
      if (!one_.info.damaged || (!known && !right.empty())) {
        return say(one_.info.damaged ? Verdict::wrong : Verdict::error,
                   "message of the decoder: " + line);
      }
    }
    if (one_.info.damaged && !any) say(Verdict::wrong, "the damage was not reported");
  }

  void own_encoder() {
    const std::string said = small_file(files_.encoder);
    if (said.empty()) return;
    if (said == "same") {
      result_.encoded_again = true;
    } else {
      say(Verdict::encoder, said);
    }
  }

  const SuiteCase& one_;
  const RunFiles& files_;
  bool own_;
  bool with_body_ = true;
  CaseResult& result_;
};

ChildJob job_for(const SuiteCase& one, const RunFiles& files, const RunOptions& options) {
  ChildJob job;
  job.out = files.out;
  job.err = files.err;
  if (options.command) {
    const std::string in = path_argument(files.stream), out = path_argument(files.face),
                      bap = path_argument(files.body);
    auto arguments = fill_in(*options.command, {{{"in", in}, {"out", out}, {"bap", bap}}});
    if (arguments) job.arguments = std::move(*arguments);
  } else {
    job.work = [&one, files, encode = options.encode] { return run_own(one, files, encode); };
  }
  return job;
}

void remove_files(const RunFiles& files, const RunOptions& options) {
  std::error_code kept;
  if (options.command) fs::remove(files.stream, kept);
  for (const std::string& path :
       {files.face, files.body, files.out, files.err, files.errors, files.encoder}) {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
}

}  // namespace

const char* verdict_name(Verdict verdict) {
  constexpr const char* kNames[] = {"exact", "values", "ignored", "stopped", "wrong",   "encoder",
                                    "error", "crash",  "timeout", "skipped", "bad_data"};
  return kNames[std::size_t(verdict)];
}

bool is_right(Verdict verdict) { return verdict <= Verdict::stopped; }

Result<std::vector<CaseResult>> run_suite(const std::vector<const SuiteCase*>& cases,
                                          const RunOptions& options) {
  auto scratch = ScratchFolder::make();
  if (!scratch) return scratch.error();
  std::vector<CaseResult> results(cases.size());
  std::vector<RunFiles> files(cases.size());
  Children children(options.timeout_seconds);
  std::size_t done = 0;
  const auto finish = [&](std::size_t i) {
    ++done;
    if (options.progress) options.progress(done, cases[i]->info.name);
  };
  const auto wait = [&] {
    const Children::Finished finished = children.wait();
    CaseResult& result = results[finished.id];
    result.end = finished.end;
    Judge(*cases[finished.id], files[finished.id], options, result).judge();
    remove_files(files[finished.id], options);
    finish(finished.id);
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const SuiteCase& one = *cases[i];
    CaseResult& result = results[i];
    result.one = &one;
    if (!one.problem.empty()) {
      result.verdict = Verdict::bad_data;
      result.detail = one.problem;
      finish(i);
      continue;
    }
    if (one.info.object == "body" && options.command && !options.command->names("bap")) {
      result.detail = "a body alone, and the command has no {bap}";
      finish(i);
      continue;
    }
    while (children.running() >= std::max<std::size_t>(options.jobs, 1)) wait();
    files[i] = files_of((*scratch)->path(), i, one, options);
    std::error_code unwritten;
    if (options.command) fs::copy_file(one.path.at("stream"), files[i].stream, unwritten);
    if (unwritten) {
      return make_error(Code::io, "cannot be copied for the decoder: " + unwritten.message())
          .in_file(one.path.at("stream").string());
    }
    if (auto ok = children.start(i, job_for(one, files[i], options)); !ok) return ok.error();
  }
  while (children.running() > 0) wait();
  return results;
}

}  // namespace animeme::tools
