// A model, or motion, for another face with the same controls: gain and offset from a few poses.
#include <algorithm>
#include <cstdio>

#include "dam/corpus/corpus.h"
#include "dam/model/rescale.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/poses.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/corpus.h"
#include "tools/app/commands/face_text.h"
#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"
#include "tools/formats/exchange/curves.h"
#include "tools/formats/exchange/pose_table.h"
#include "tools/speech/talking/spoken.h"

namespace animeme::tools {

namespace {

struct RetargetOptions {
  std::string input;
  std::string poses;
  std::string output;
  std::string from;
  std::string save_poses;
  std::vector<std::string> labels = {"rest", "AA", "AE", "IY", "OW", "UW", "M", "F", "CH"};
  std::vector<std::string> renames;
  CorpusSettings limits;
  bool json = false;
};

// What is retargeted: a model, or curves.
struct Subject {
  std::optional<dam::Model> model;
  dam::Signal curves;

  std::vector<std::string> names() const {
    if (!model) return curves.names;
    std::vector<std::string> names;
    for (const dam::Control& control : model->controls) names.push_back(control.name);
    return names;
  }
};

bool is_model(const std::string& path) { return path == "builtin" || extension_of(path) == ".dam"; }

Result<Subject> read_subject(const std::string& path) {
  Subject subject;
  if (is_model(path)) {
    auto model = speech::read_model(path);
    if (!model) return model.error();
    subject.model = std::move(*model);
    return subject;
  }
  Result<dam::Signal> curves = make_error(Code::internal, "");
  if (extension_of(path) == ".csv") {
    const auto bytes = read_input(path);
    if (!bytes) return bytes.error();
    curves = dam::read_curves({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
  } else {
    const auto face = read_face(path);
    if (!face) return face.error();
    curves = dam::to_signal(face->clip);
  }
  if (!curves) return std::move(curves).error().in_file(path);
  subject.curves = std::move(*curves);
  return subject;
}

Result<dam::Poses> read_poses(const std::string& path) {
  const auto text = read_text_file(path, kMostWritten);
  if (!text) return text.error();
  auto poses = exchange::read_pose_table(*text, exchange::Blanks::allowed);
  if (!poses) return std::move(poses).error().in_file(path);
  return poses;
}

// "jawOpen=Jaw_Open": the second face calls its control otherwise.
Result<void> rename(const std::vector<std::string>& renames, std::vector<std::string>& names) {
  for (const std::string& item : renames) {
    const std::size_t equals = item.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == item.size()) {
      return make_error(Code::invalid_argument,
                        "--rename " + item + ": write OLD=NEW, such as jawOpen=Jaw_Open");
    }
    const auto at = std::find(names.begin(), names.end(), item.substr(0, equals));
    if (at == names.end()) {
      return make_error(Code::not_found, "--rename " + item + ": there is no such control");
    }
    const std::string name = item.substr(equals + 1);
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      return make_error(Code::invalid_argument,
                        "--rename " + item + ": another control has that name");
    }
    *at = name;
  }
  return {};
}

const char* name_of(dam::GainSource source) {
  switch (source) {
    case dam::GainSource::poses:
      return "poses";
    case dam::GainSource::others:
      return "others";
    case dam::GainSource::none:
      break;
  }
  return "none";
}

void tell(const RetargetOptions& options, const std::vector<std::string>& names,
          const std::vector<dam::GainOffset>& gains) {
  if (options.json) {
    Json json = {{"output", options.output}, {"poses", options.poses}};
    json["controls"] = Json::array();
    for (std::size_t c = 0; c < names.size(); ++c) {
      json["controls"].push_back({{"name", names[c]},
                                  {"gain", gains[c].gain},
                                  {"offset", gains[c].offset},
                                  {"from", name_of(gains[c].source)},
                                  {"poses", gains[c].poses},
                                  {"missed_rms", gains[c].residual}});
    }
    std::printf("%s\n", pretty(json).c_str());
    return;
  }
  std::string table, others, none;
  double usual = 1;
  for (std::size_t c = 0; c < names.size(); ++c) {
    const dam::GainOffset& one = gains[c];
    if (one.source == dam::GainSource::poses) {
      table += format("  %-28s %8.3f %10.4g  %zu poses, missed by %.3g\n", names[c].c_str(),
                      one.gain, one.offset, one.poses, one.residual);
    } else if (one.source == dam::GainSource::others) {
      others += " " + names[c];
      usual = one.gain;
    } else {
      none += " " + names[c];
    }
  }
  say(format("  %-28s %8s %10s", "control", "gain", "offset"));
  if (!table.empty()) table.pop_back();
  say(table);
  if (!others.empty()) {
    say(format("the poses do not move these controls; they get the gain %.3f of the others:",
               usual) +
        others);
  }
  if (!none.empty()) say("no pose has these controls; they stay unchanged:" + none);
}

Result<void> write_result(const RetargetOptions& options, Subject& subject) {
  if (subject.model) {
    subject.model->provenance += "; retargeted by poses";
    return write_file(options.output, dam::write_model(*subject.model));
  }
  if (extension_of(options.output) == ".csv") {
    return write_file(options.output, exchange::write_curves(subject.curves));
  }
  const auto clip = dam::to_sequence(subject.curves);
  if (!clip) return clip.error();
  OutputFile file(options.output);
  const auto frames = write_face_text(file, options.output, face_text(*clip));
  if (!frames) return frames.error();
  return file.publish();
}

Result<void> save_poses(const RetargetOptions& options) {
  const auto subject = read_subject(options.input);
  if (!subject) return subject.error();
  if (!subject->model) {
    return make_error(Code::invalid_argument,
                      "--save-poses is for models; curves have no poses of their own");
  }
  const auto poses = dam::poses_of(*subject->model, options.labels);
  if (!poses) return poses.error();
  if (auto done = write_file(options.save_poses, exchange::write_pose_table(*poses)); !done) {
    return done;
  }
  if (options.json) {
    const Json json = {
        {"output", options.save_poses}, {"labels", poses->labels}, {"controls", poses->names}};
    std::printf("%s\n", pretty(json).c_str());
    return {};
  }
  say(options.save_poses + ": " + std::to_string(poses->labels.size()) + " poses of " +
      std::to_string(poses->names.size()) +
      " controls; enter the values of your face (leave fields empty that do not matter), and pass "
      "the table to retarget");
  return {};
}

// Columns in the order of `names`; what is not there says nothing.
dam::Poses in_order(const dam::Poses& poses, const std::vector<std::string>& names) {
  dam::Poses out{names, poses.labels, {}};
  for (std::size_t p = 0; p < poses.labels.size(); ++p) {
    for (const std::string& name : names) {
      const auto at = std::find(poses.names.begin(), poses.names.end(), name);
      out.values.push_back(at == poses.names.end()
                               ? std::numeric_limits<double>::quiet_NaN()
                               : poses.at(p, std::size_t(at - poses.names.begin())));
    }
  }
  return out;
}

// The poses of the input's face, those that `to` has.
Result<dam::Poses> poses_of_input(const RetargetOptions& options, const Subject& subject,
                                  const dam::Poses& to) {
  if (options.from.empty()) {
    auto poses = dam::poses_of(*subject.model, to.labels);
    if (!poses) return std::move(poses).error().in_file(options.poses);
    return poses;
  }
  const auto poses = read_poses(options.from);
  if (!poses) return poses.error();
  return in_order(*poses, subject.names());
}

// `names`: of the controls, in the other face.
Result<std::vector<dam::GainOffset>> fit(const RetargetOptions& options, const Subject& subject,
                                         const std::vector<std::string>& names) {
  const auto to = read_poses(options.poses);
  if (!to) return to.error();
  auto from = poses_of_input(options, subject, *to);
  if (!from) return from.error();
  from->names = names;
  for (const std::string& name : to->names) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    warn(options.poses + ": there is no control " + name + " in " + options.input +
         "; it is ignored; --rename OLD=" + name + " if it has another name there");
  }
  std::vector<double> typical;
  if (subject.model) {
    for (const dam::Control& control : subject.model->controls) typical.push_back(control.sd);
  }
  auto gains = dam::fit_gain_offset(*from, *to, typical);
  if (!gains) return std::move(gains).error().in_file(options.poses);
  return gains;
}

Result<void> apply(const RetargetOptions& options, const std::vector<std::string>& names,
                   const std::vector<dam::GainOffset>& gains, Subject& subject) {
  if (!subject.model) {
    dam::apply_gain_offset(subject.curves, gains);
    subject.curves.names = names;
    return {};
  }
  if (auto done = dam::rescale(*subject.model, gains); !done) return done;
  for (std::size_t c = 0; c < names.size(); ++c) subject.model->controls[c].name = names[c];
  if (options.limits.limits.empty()) return {};
  return set_limits(options.limits, *subject.model);
}

Result<int> retarget(const RetargetOptions& options) {
  const bool to_model = extension_of(options.output) == ".dam";
  if (to_model != is_model(options.input)) {
    return usage_error(to_model ? "the result of curves is curves: -o FILE.csv or FILE.fap"
                                : "the result of a model is a model: -o FILE.dam");
  }
  if (!to_model && options.from.empty()) {
    return usage_error("curves need --from: the same poses of their own face");
  }
  auto subject = read_subject(options.input);
  if (!subject) return subject.error();
  std::vector<std::string> names = subject->names();
  if (auto done = rename(options.renames, names); !done) return usage_error(done.error().message);
  const auto gains = fit(options, *subject, names);
  if (!gains) return gains.error();
  if (auto done = apply(options, names, *gains, *subject); !done) return done.error();
  if (auto done = write_result(options, *subject); !done) return done.error();
  tell(options, names, *gains);
  return kOk;
}

Result<int> run(const RetargetOptions& options) {
  if (!options.save_poses.empty()) {
    if (!options.poses.empty() || !options.output.empty()) {
      return usage_error("--save-poses is the first step; POSES and -o belong to the second");
    }
    if (auto done = save_poses(options); !done) return done.error();
    return kOk;
  }
  if (options.poses.empty() || options.output.empty()) {
    return usage_error("POSES and -o are needed, or --save-poses to get a table to start from");
  }
  return retarget(options);
}

void add_options(OptionTable& cli, RetargetOptions& options) {
  cli.add("input", options.input,
          "Model (.dam, or builtin), or curves (.csv with time_s, .fap) of a face")
      ->required();
  cli.add("poses", options.poses,
          "Poses of your face: a table with the column `pose` (rest, or phones such as AA "
          "and M) and a column per control; empty fields are ignored");
  cli.add("-o,--output", options.output, "Model or curves to write")
      ->output(".dam .csv .fap", OutputKind::file);
  cli.add("--from", options.from,
          "The same poses of the face of the input, with any names; needed for curves. "
          "Default: the poses of the model for these phones");
  cli.add("--save-poses", options.save_poses, "Write the model's own poses, for you to edit")
      ->output(".csv", OutputKind::file_or_dash);
  cli.add("--labels", options.labels, "Poses that --save-poses writes")
      ->at_commas()
      ->show_default();
  cli.add("--rename", options.renames, "OLD=NEW: name of a control of the input on your face");
  cli.add("--limits", options.limits.limits,
          "Table of limits of your face's controls, as for train");
  cli.add("--json", options.json, "Print gains and offsets as JSON");
}

}  // namespace

const Command kRetarget{
    "retarget", "Adapt a model or curves to another face with the same controls, from a few poses",
    "  animeme retarget me.dam --save-poses poses.csv     (change it to what your rig needs)\n"
    "  animeme retarget me.dam poses.csv -o rig.dam\n"
    "  animeme retarget me.dam poses.csv -o rig.dam --rename mouthSmileLeft=smile_L\n"
    "  animeme retarget take.csv hers.csv --from mine.csv -o hers_take.csv",
    set_up<RetargetOptions>};

}  // namespace animeme::tools
