#include "tools/app/batch/plan.h"

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <optional>

#include "tools/formats/files/files.h"
#include "tools/formats/programs/command_template.h"

namespace animeme::batch {

namespace {

using Words = std::vector<std::string>;

Error bad(std::string message) { return make_error(Code::invalid_argument, std::move(message)); }

bool is_one_of(std::string_view text, std::initializer_list<std::string_view> list) {
  return std::find(list.begin(), list.end(), text) != list.end();
}

// An output of a row: which command makes it, and its ending.
struct Wanted {
  std::string command, ending;
  bool beside = false;  // written by the command that makes the first face
};

bool is_script(const std::string& ending) {
  return is_one_of(ending, {".textgrid", ".tsv", ".pho", ".vtt"});
}

bool shows_face(const std::string& command) {
  return is_one_of(command, {"render", "export", "view", "plot", "encode", "decode"});
}

// What read_face() reads: curves of a model are no face.
bool is_face(const std::string& ending) {
  return is_one_of(ending, {".mp4", ".mkv", ".ts", ".fba", ".fap"});
}

std::string last_of(const std::string& ending) { return tools::extension_of("x" + ending); }

std::string usual_command(const std::string& ending, bool speech) {
  if (is_script(ending)) return "align";
  if (is_one_of(ending, {".png", ".jpg", ".jpeg", ".webp", ".webm"})) return "render";
  if (is_one_of(ending, {".glb", ".gltf", ".vrm"})) return "export";
  if (is_one_of(ending, {".html", ".htm"})) return "view";
  if (ending == ".svg") return "plot";
  if (speech && is_one_of(ending, {".mp4", ".mkv", ".ts", ".m3u8", ".mpd", ".fba", ".fap", ".csv",
                                   ".json"})) {
    return "speak";
  }
  if (is_one_of(ending, {".fba", ".bit"})) return "encode";
  if (ending == ".fap") return "decode";
  if (is_one_of(ending, {".mp4", ".mkv"})) return "render";
  return is_one_of(ending, {".csv", ".json"}) ? "export" : "";
}

Result<Wanted> read_wanted(const std::string& text, bool speech) {
  Wanted wanted;
  const std::size_t dot = text.find('.'), colon = text.find(':');
  wanted.command = colon < dot ? text.substr(0, colon) : "";
  wanted.ending = text.substr(colon < dot ? colon + 1 : 0);
  // People write fba and mp4, too.
  if (!wanted.ending.starts_with('.')) wanted.ending.insert(0, 1, '.');
  const std::string last = last_of(wanted.ending);
  if (wanted.ending.size() < 2 || last.empty() || wanted.ending.find('/') != std::string::npos) {
    return bad("output \"" + text + "\" is no ending: write .fba, or render:.video.mp4");
  }
  if (wanted.command.empty()) wanted.command = usual_command(last, speech);
  if (wanted.command != "speak" && wanted.command != "align" && wanted.command != "report" &&
      !shows_face(wanted.command)) {
    return bad("no command makes the output \"" + text +
               "\"; put speak:, report:, align:, encode:, decode:, render:, export:, view: or "
               "plot: before it");
  }
  return wanted;
}

Result<std::vector<Wanted>> read_outputs(const Row& row, bool speech) {
  std::string text(row.at("outputs"));
  std::replace(text.begin(), text.end(), ',', ' ');
  Result<Words> words = tools::split_arguments(text);
  if (!words) return words.error();
  if (words->empty()) return bad("the row has no outputs");
  std::vector<Wanted> list;
  for (const std::string& word : *words) {
    Result<Wanted> one = read_wanted(word, speech);
    if (!one) return one.error();
    list.push_back(*one);
  }
  return list;
}

// Adds the options of a column. What is written is the batch's to say.
Result<void> add_options_of(const Row& row, const char* column, Plan& plan, Words& line) {
  Result<Words> words = tools::split_arguments(row.at(column));
  if (!words) return words.error().in_file(column);
  for (const std::string& word : *words) {
    const std::string name = word.substr(0, word.find('='));
    if (is_one_of(name, {"--output", "--save-script", "--preview", "--json", "--help",
                         "--save-poses", "--report"}) ||
        (word.starts_with("-o") && !word.starts_with("--")) || word == "-h") {
      return bad("column " + std::string(column) + " has " + name +
                 ": what is written is named in column outputs");
    }
    std::error_code unknown;
    if (std::filesystem::is_regular_file(word, unknown)) plan.inputs.push_back(word);
    line.push_back(word);
  }
  return {};
}

// --text=TEXT, so that a text may begin with a dash.
void add_value(const Row& row, const char* column, const char* option, Words& line) {
  if (!row.at(column).empty()) line.push_back(option + ("=" + std::string(row.at(column))));
}

Words speech_words(const Row& row) {
  Words line;
  for (const char* one : {"text", "script", "audio", "transcript", "tts", "model", "over"}) {
    add_value(row, one, ("--" + std::string(one)).c_str(), line);
  }
  add_value(row, "text_file", "--text-file", line);
  std::string language(row.at("lang"));
  if (!row.at("voice").empty()) {
    language = (language.empty() ? "en" : language) + "+" + std::string(row.at("voice"));
  }
  if (!language.empty()) line.push_back("--lang=" + language);
  return line;
}

Result<void> add_line(const Row& row, const std::string& command, const std::string& face,
                      const std::string& output, Plan& plan) {
  Words line{command};
  if (command == "speak") {
    const Words more = speech_words(row);
    line.insert(line.end(), more.begin(), more.end());
    line.emplace_back("--json");
  } else if (command == "align") {
    for (const std::string& word : speech_words(row)) {
      if (!word.starts_with("--model=")) line.push_back(word);
    }
    line.emplace_back("--json");
  } else {
    line.push_back(face);
    if (is_one_of(command, {"render", "export", "view"})) add_value(row, "head", "--head", line);
  }
  const std::string own = command + "_options";
  const bool has_own = std::find(kColumns.begin(), kColumns.end(), own) != kColumns.end();
  // Those without a column of their own are options of what is done first.
  const bool first = command == "speak" || row.at("input") == face;
  if (has_own || first) {
    auto added = add_options_of(row, has_own ? own.c_str() : "options", plan, line);
    if (!added) return added;
  }
  line.emplace_back("-o");
  line.push_back(output);
  plan.lines.push_back(std::move(line));
  return {};
}

}  // namespace

Result<Plan> plan_row(const Row& row, const std::string& stage) {
  const auto has = [&](const char* column) { return !row.at(column).empty(); };
  const bool speech = has("text") || has("text_file") || has("script") || has("audio");
  if (speech == has("input")) {
    return bad(speech ? "the row has both an input and speech; give only one"
                      : "the row has nothing to say: text, text_file, script, audio or input");
  }
  Result<std::vector<Wanted>> wanted = read_outputs(row, speech);
  if (!wanted) return wanted.error();
  Plan plan;
  for (const char* one : {"text_file", "script", "audio", "input", "model", "head", "over"}) {
    std::error_code unknown;
    const std::string path(row.at(one));
    const bool named = is_one_of(one, {"model", "head"});
    if (!path.empty() && (!named || std::filesystem::exists(path, unknown))) {
      plan.inputs.push_back(path);
    }
  }
  const std::string id(row.at("id"));
  const auto place = [&](const std::string& ending) { return stage + "/" + id + ending; };
  std::string face(row.at("input"));
  // Faces first, since the others show them.
  const auto speaks = [](const Wanted& one) { return one.command == "speak"; };
  // One line speaks, whatever it writes.
  std::optional<std::size_t> speaking;
  const auto speak = [&](const std::string& output) -> Result<void> {
    if (speaking) {
      plan.lines[*speaking].insert(plan.lines[*speaking].end(), {"-o", output});
      return {};
    }
    speaking = plan.lines.size();
    return add_line(row, "speak", {}, output, plan);
  };
  for (const Wanted& one : *wanted) {
    if (!speaks(one)) continue;
    if (!speech)
      return bad("output \"speak:" + one.ending +
                 "\" needs speech: text, text_file, script or audio");
    if (auto added = speak(place(one.ending)); !added) return added.error();
    if (face.empty() && is_face(last_of(one.ending))) face = place(one.ending);
  }
  bool script = speaking.has_value();  // which it writes, too, once
  for (const Wanted& one : *wanted) {
    if (speaks(one)) continue;
    if (one.command == "report") {
      if (!speaking || last_of(one.ending) != ".json") {
        return bad("output \"report:" + one.ending +
                   "\" is the JSON of speak; it needs an output of it, such as .mp4, and ends in "
                   ".json");
      }
      plan.lines[*speaking].insert(plan.lines[*speaking].end(), {"--report", place(one.ending)});
      continue;
    }
    if (one.command == "align" && script) {
      Words& line = plan.lines[*speaking];
      line.insert(line.end(), {"--save-script", place(one.ending)});
      script = false;
      continue;
    }
    if (one.command == "align" && !speech) return bad("output \"" + one.ending + "\" wants audio");
    if (face.empty() && shows_face(one.command)) {
      face = stage + "/.face.mp4";
      if (auto added = speak(face); !added) return added.error();
    }
    if (auto added = add_line(row, one.command, face, place(one.ending), plan); !added) {
      return added.error();
    }
  }
  for (const Wanted& one : *wanted) plan.outputs.push_back(id + one.ending);
  return plan;
}

}  // namespace animeme::batch
