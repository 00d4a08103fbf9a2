#include "tools/app/commands/text_or_file.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <vector>

#include "tools/app/commands/did_you_mean.h"
#include "tools/formats/files/files.h"

namespace animeme::tools {
namespace {

bool is_one_of(const std::string& extension, std::string_view list) {
  return !extension.empty() && list.find(" " + extension + " ") != list.npos;
}

// Of a file in the folder of `path`, with that folder as it was typed.
std::string nearest_file(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  const std::string folder = slash == path.npos ? "" : path.substr(0, slash + 1);
  std::vector<std::string> names;
  std::error_code failed;
  std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, failed), end;
  for (; !failed && entry != end; entry.increment(failed)) {
    names.push_back(entry->path().filename().string());
  }
  std::sort(names.begin(), names.end());  // of equally near names always the same
  const std::string nearest = nearest_name(path.substr(folder.size()), names);
  return nearest.empty() ? "" : folder + nearest;
}

}  // namespace

SpokenFile spoken_file(const std::string& path) {
  const std::string extension = extension_of(path);
  if (is_one_of(extension, " .txt .ssml ")) return SpokenFile::text;
  if (is_one_of(extension,
                " .wav .flac .mp3 .m4a .aac .ogg .opus .aif .aiff .wma .webm .mp4 .mkv ")) {
    return SpokenFile::recording;
  }
  if (is_one_of(extension, " .textgrid .tsv .pho .vtt .srt .lab .phn .wrd .ctm .json .jsonl ")) {
    return SpokenFile::script;
  }
  return SpokenFile::other;
}

bool has_file_extension(const std::string& text) {
  return text.find_first_of(" \t\r\n") == text.npos &&
         (spoken_file(text) != SpokenFile::other ||
          is_one_of(extension_of(text), " .fap .fba .bap .ts .m3u8 .mpd .csv .dam .glb .gltf "));
}

Result<void> no_missing_file(const std::string& text, const std::string& option) {
  const bool path = text.find_first_of(" \t\r\n<") == text.npos && text.find('/') != text.npos;
  if (!path && !has_file_extension(text)) return {};
  const std::string nearest = nearest_file(text);
  return make_error(Code::not_found,
                    "there is no file " + text +
                        (nearest.empty() ? "" : "; did you mean " + nearest + "?") +
                        "; to speak it as a text, give it after " + option);
}

std::string problem_with_transcript(const std::string& text) {
  if (!has_file_extension(text)) return {};
  return text + " looks like a file, but the words are wanted: --transcript \"$(cat " + text +
         ")\"";
}

}  // namespace animeme::tools
