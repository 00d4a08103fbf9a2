#include "tools/app/dub/dub_table.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include "tools/formats/files/files.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/track_labels.h"
#include "tools/formats/programs/command_template.h"
#include "tools/formats/scripts/script_text.h"

namespace animeme::dub {

namespace {

using batch::Row;

Error wrong(std::string message) { return make_error(Code::syntax, std::move(message)); }

void put(Row& row, std::string_view column, std::string value) {
  for (auto& [name, old] : row.values) {
    if (name == column) {
      old = std::move(value);
      return;
    }
  }
  row.values.emplace_back(column, std::move(value));
}

// As a word of a command line.
std::string quoted_word(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\"'\"'") : std::string(1, c);
  return word + "'";
}

void replace_all(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
}

// A person's name as a part of a file's.
std::string part_of_name(std::string_view text) {
  std::string part(text);
  for (char& c : part) {
    const bool odd = static_cast<unsigned char>(c) < 32 || c == 127 || c == '/' || c == '\\';
    if (odd || c == '|') c = '_';
  }
  return part;
}

std::string language_tag(std::string_view lang) {
  std::string tag(lang.substr(0, lang.find('+')));
  std::replace(tag.begin(), tag.end(), '_', '-');  // of locales: "pt_BR"
  return tag;
}

// Whether subtitles tell who speaks. Those that cannot be read do not: their row will fail.
class Speakers {
 public:
  bool told_in(const std::string& path) {
    std::error_code unknown;
    const auto time = std::filesystem::last_write_time(path, unknown);
    const auto found = known_.find(path);
    if (found != known_.end() && found->second.first == time) return found->second.second;
    bool told = false;
    const auto text = tools::read_text_file(path, tools::kMostWritten);
    const auto timings = text ? scripts::read_labels(*text) : text.error();
    if (timings) {
      told = std::any_of(timings->labels.begin(), timings->labels.end(),
                         [](const dam::TimedLabel& one) { return !one.speaker.empty(); });
    }
    known_[path] = {time, told};
    return told;
  }

 private:
  std::map<std::string, std::pair<std::filesystem::file_time_type, bool>> known_;
};

std::vector<std::string> outputs_of(const Row& row) {
  std::string text(row.at("outputs"));
  std::replace(text.begin(), text.end(), ',', ' ');
  auto words = tools::split_arguments(text);
  return words ? *words : std::vector<std::string>();
}

// The ending of a face with its sound, of a word of `outputs`; empty: it is something else.
std::string film_ending(std::string word) {
  if (word.starts_with("speak:")) word.erase(0, 6);
  if (word.find(':') != std::string::npos) return {};
  if (!word.starts_with('.')) word.insert(0, 1, '.');
  const std::string last = tools::extension_of("x" + word);
  return last == ".mp4" || last == ".mkv" ? word : "";
}

bool is_tts(const std::pair<std::string, std::string>& value) { return value.first == "tts"; }

Result<bool> to_row(Row& row, const TableSettings& settings, Speakers& speakers) {
  const auto has = [&](const char* column) { return !row.at(column).empty(); };
  if (!has("lang")) return wrong("the row has no lang");
  const std::string tag = language_tag(row.at("lang")), speaker(row.at("speaker"));
  if (!media::is_language_tag(tag) || tag == "auto") {
    return wrong("lang \"" + std::string(row.at("lang")) +
                 "\" is no language tag, such as de or pt-BR");
  }
  if (speaker.size() > 60) return wrong("the name of a speaker is longer than 60 bytes");
  const bool speech = has("script") || has("audio");
  if (has("input")) {
    if (has("transcript")) {
      return wrong("a row with an input, which is kept as it is, has no transcript");
    }
  } else if (!speech) {
    return wrong("the row has nothing to say: subtitles, audio or input");
  }
  if (has("script") && has("transcript")) {
    return wrong("the row has a transcript beside subtitles, which say the same; give one of them");
  }
  if (has("transcript") && !has("audio")) return wrong("the row has a transcript without audio");
  // A command for all rows is for those that need one.
  if (has("audio") || has("input")) std::erase_if(row.values, is_tts);
  if (!has("id")) {
    std::string id = settings.name;
    if (id.empty()) id = speaker.empty() ? "{lang}" : "{lang}-{speaker}";
    replace_all(id, "{lang}", tag);
    replace_all(id, "{speaker}", part_of_name(speaker));
    put(row, "id", id);
  }
  if (has("input")) return settings.originals;
  std::string options(row.at("options"));
  const auto add = [&options](const std::string& more) {
    options += (options.empty() ? "" : " ") + more;
  };
  const std::string script(row.at("script"));
  if (!script.empty()) {
    add("--fit=" + quoted_word(has("fit") ? std::string(row.at("fit")) : settings.fit));
    if (!speaker.empty() && speakers.told_in(script)) add("--speaker=" + quoted_word(speaker));
  }
  put(row, "options", options);
  std::string outputs(row.at("outputs"));
  const std::vector<std::string> words = outputs_of(row);
  if (std::none_of(words.begin(), words.end(),
                   [](const std::string& word) { return !film_ending(word).empty(); })) {
    outputs = ".mp4" + (outputs.empty() ? std::string() : " " + outputs);
  }
  put(row, "outputs", outputs + " report:" + std::string(kReportEnding));
  return true;
}

std::string escaped_commas(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == ',' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

}  // namespace

std::string problem_of_name(const std::string& name) {
  if (name.find("{lang}") == std::string::npos) {
    return "'" + name + "' lacks {lang}, so that all rows would have one name";
  }
  std::string rest = name;
  replace_all(rest, "{lang}", "x");
  replace_all(rest, "{speaker}", "x");
  if (rest.find_first_of("{}") != std::string::npos) {
    return "'" + name + "' has a place other than {lang} and {speaker}";
  }
  return {};
}

batch::Dialect dialect_of_dub(const TableSettings& settings) {
  const auto speakers = std::make_shared<Speakers>();
  return {kDubColumns, [settings, speakers](Row& row) -> Result<bool> {
            return to_row(row, settings, *speakers);
          }};
}

FilmTrack film_track(const batch::Row& row, const std::string& out) {
  FilmTrack track;
  track.id = row.at("id");
  track.lang = language_tag(row.at("lang"));
  track.speaker = row.at("speaker");
  if (!row.at("input").empty()) {
    track.original = true;
    track.face = row.at("input");
    track.audio = row.at("audio");
    track.words = row.at("script");
    if (track.audio.empty() && media::AudioReader::open(track.face)) track.audio = track.face;
    return track;
  }
  for (const std::string& word : outputs_of(row)) {
    const std::string ending = film_ending(word);
    if (ending.empty()) continue;
    track.face = track.audio = out + "/" + track.id + ending;
    return track;
  }
  return track;
}

std::string mux_track(const FilmTrack& track) {
  std::string text = "lang=" + track.lang;
  if (!track.speaker.empty()) text += ",speaker=" + escaped_commas(track.speaker);
  text += ",face=" + escaped_commas(track.face);
  if (!track.audio.empty()) text += ",audio=" + escaped_commas(track.audio);
  if (!track.words.empty()) text += ",words=" + escaped_commas(track.words);
  return text;
}

}  // namespace animeme::dub
