#include "tools/app/commands/licences.h"

#include <dlfcn.h>

#include <filesystem>
#include <iomanip>
#include <sstream>
#include <string_view>
#include <vector>

#include "tools/formats/common/json.h"
#include "tools/formats/common/module.h"

#ifdef __linux__
#include <link.h>
#endif

namespace animeme::tools {

namespace {

namespace fs = std::filesystem;

// A library that is there, with the file that it is in: what links would name, and the real one.
struct Found {
  const Library* library;
  std::string version, licence, file;
};

struct Loaded {
  const Module* module;
  std::string problem;  // why it does not load; empty: it is there
};

// A stem ends where the version begins: "libz" is not "libzstd".
bool is_object(std::string_view file, std::string_view stem) {
  return file.starts_with(stem) && file.size() > stem.size() &&
         (file[stem.size()] == '.' || file[stem.size()] == '-');
}

std::vector<std::string> loaded_objects() {
  std::vector<std::string> paths;
#ifdef __linux__
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* to) {
        static_cast<std::vector<std::string>*>(to)->push_back(info->dlpi_name);
        return 0;
      },
      &paths);
#endif
  return paths;
}

// What FFmpeg says of itself: a function without arguments, of the object at `path`, which is
// loaded.
std::string said_by(const std::string& path, const char* function) {
  void* const object = dlopen(path.c_str(), RTLD_LAZY | RTLD_NOLOAD);
  if (object == nullptr) return {};
  const auto call = reinterpret_cast<const char* (*)()>(dlsym(object, function));
  const std::string said = call != nullptr ? call() : "";
  dlclose(object);
  return said;
}

std::string licence_of_ffmpeg(const Library& library, const std::string& path) {
  const std::string function = std::string(library.name).substr(3) + "_license";
  const std::string said = said_by(path, function.c_str());
  for (const Library& words : known_libraries()) {
    if (words.object == std::string_view("?") && words.name == said) return words.licence;
  }
  return said.empty() ? "NOASSERTION" : said;
}

std::vector<Found> found_libraries() {
  const std::vector<std::string> paths = loaded_objects();
  std::vector<Found> found;
  for (const Library& library : known_libraries()) {
    const bool is_ours = library.object == std::string_view("-") && *library.by == '\0';
    if (is_ours && *library.version != '\0') {
      found.push_back({&library, library.version, library.licence, ""});
    }
    for (const std::string& path : paths) {
      if (!is_object(fs::path(path).filename().string(), library.object)) continue;
      std::error_code ignored;
      const fs::path real = fs::canonical(path, ignored);
      Found one{&library, library.version, library.licence, real.filename().string()};
      if (one.licence == "FFmpeg") one.licence = licence_of_ffmpeg(library, path);
      if (one.version.empty()) {
        const std::size_t digits = one.file.find(".so.");
        if (digits != std::string::npos) one.version = one.file.substr(digits + 4);
      }
      found.push_back(std::move(one));
      break;
    }
  }
  return found;
}

// The most demanding of the licences: under which the program is passed on.
std::string licence_of_all(const std::vector<Found>& found, std::string& why) {
  for (const char* licence : {"LicenseRef-nonfree", "GPL-3.0-or-later", "GPL-2.0-or-later"}) {
    for (const Found& one : found) {
      if (one.licence != licence) continue;
      why = one.library->name;
      return licence;
    }
  }
  return "MIT AND CC-BY-4.0";
}

std::vector<Loaded> load_all() {
  std::vector<Loaded> all;
  for (const Module& module : kModules) {
#ifndef ANIMEME_LATE  // a program of shared libraries is linked with the others
    if (find_module(module).empty()) continue;
#endif
    Loaded& one = all.emplace_back(Loaded{&module, ""});
    load_module(module, RTLD_NOW | RTLD_LOCAL, one.problem);
  }
  return all;
}

// Rows that nobody else brings, of libraries that are not there. Those of Python's module are not
// ours.
std::vector<const Library*> absent_libraries(const std::vector<Found>& found) {
  std::vector<const Library*> absent;
  for (const Library& library : known_libraries()) {
    bool is_there = *library.by != '\0' || *library.object == '?' || *library.object == '-';
    for (const Found& one : found) is_there = is_there || one.library == &library;
    if (!is_there) absent.push_back(&library);
  }
  return absent;
}

std::string as_json(const std::vector<Loaded>& modules, const std::vector<Found>& found) {
  std::string why;
  Json json = {{"version", ANIMEME_VERSION},
               {"licence_of_sources", "MIT AND CC-BY-4.0"},
               {"licence_as_linked", licence_of_all(found, why)}};
  json["modules"] = json_list(modules, [](const Loaded& loaded) {
    const Module& module = *loaded.module;
    Json one = {{"file", module.file}, {"for", module.use}, {"found", loaded.problem.empty()}};
    if (!loaded.problem.empty()) {
      one["problem"] = loaded.problem;
      one["packages"] = module.packages;
    }
    return one;
  });
  json["libraries"] = json_list(found, [](const Found& one) {
    Json row = {{"name", one.library->name}, {"version", one.version}, {"licence", one.licence}};
    if (!one.file.empty()) row["file"] = one.file;
    row["for"] = one.library->use;
    if (*one.library->by != '\0') row["brought_by"] = one.library->by;
    return row;
  });
  json["without"] = json_list(absent_libraries(found), [](const Library* library) {
    return Json{{"name", library->name}, {"for", library->use}};
  });
  return pretty(json);
}

std::string as_text(const std::vector<Loaded>& modules, const std::vector<Found>& found) {
  std::ostringstream out;
  std::string why;
  const std::string licence = licence_of_all(found, why);
  out << "animeme " ANIMEME_VERSION "\n"
      << "Sources: MIT; built-in model: CC-BY-4.0 (GRID corpus, see LICENSE and README)\n"
      << "As linked here: " << licence << (why.empty() ? "" : " (by " + why + ")") << "\n";
  out << "\nModules, loaded when they are asked for:\n";
  for (const auto& [module, problem] : modules) {
    out << "  " << std::left << std::setw(20) << module->file << module->use << ": "
        << (problem.empty()
                ? "found"
                : std::string("not found: apt install ") + module->packages + " (" + problem + ")")
        << "\n";
  }
  out << "\nLibraries, with those that modules bring:\n";
  for (const Found& one : found) {
    std::string use = one.library->use;
    if (*one.library->by != '\0') use += ", by " + std::string(one.library->by);
    out << "  " << std::left << std::setw(28) << one.library->name << std::setw(12) << one.version
        << " " << one.licence << " (" << use << ")\n";
  }
  const std::vector<const Library*> absent = absent_libraries(found);
  if (!absent.empty()) out << "\nNot there:\n";
  for (const Library* library : absent)
    out << "  " << library->name << " (" << library->use << ")\n";
  std::string text = out.str();
  text.pop_back();  // the caller ends the line
  return text;
}

}  // namespace

std::string version_text(bool verbose, bool json) {
  if (!verbose) {
    return json ? pretty(Json{{"version", ANIMEME_VERSION}}) : "animeme " ANIMEME_VERSION;
  }
  const std::vector<Loaded> modules = load_all();
  const std::vector<Found> found = found_libraries();
  return json ? as_json(modules, found) : as_text(modules, found);
}

}  // namespace animeme::tools
