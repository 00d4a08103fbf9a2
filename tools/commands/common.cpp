#include "tools/commands/common.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <utility>

#include "tools/commands/arkit_csv.h"
#include "tools/commands/landmark_csv.h"

namespace animeme::tools {

namespace {

bool quiet_setting = false;

Error file_error(const std::string& path, const std::string& what) {
  const int reason = errno;
  Error error = make_error(reason == ENOENT ? Code::not_found : Code::io,
                           what + (reason != 0 ? std::string(": ") + std::strerror(reason) : ""));
  return std::move(error).in_file(path);
}

Result<void> write_stdout(std::span<const std::uint8_t> bytes) {
  const std::size_t written = std::fwrite(bytes.data(), 1, bytes.size(), stdout);
  if (written == bytes.size() && std::fflush(stdout) == 0) return {};
  return file_error("standard output", "cannot write");
}

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// A file that lies complete beside its place until it is published; removed if it never is.
class StagedFile {
 public:
  explicit StagedFile(std::string path) : path_(std::move(path)) {
    // Devices and pipes (/dev/null, /dev/stdout) cannot be renamed onto.
    std::error_code ignored;
    const auto status = std::filesystem::status(path_, ignored);
    special_ = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
    target_ = special_ ? path_ : path_ + ".part" + std::to_string(::getpid());
  }
  StagedFile(StagedFile&& other) noexcept
      : path_(std::move(other.path_)),
        target_(std::move(other.target_)),
        special_(other.special_),
        waiting_(std::exchange(other.waiting_, false)) {}
  StagedFile(const StagedFile&) = delete;
  ~StagedFile() {
    if (waiting_) std::remove(target_.c_str());
  }

  Result<void> stage(std::span<const std::uint8_t> bytes) {
    errno = 0;
    std::ofstream out(target_, std::ios::binary | std::ios::trunc);
    waiting_ = out.is_open() && !special_;
    out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    out.flush();
    if (!out) return file_error(path_, "cannot write");
    return {};
  }
  Result<void> publish() {
    if (!waiting_) return {};
    if (std::rename(target_.c_str(), path_.c_str()) != 0) return file_error(path_, "cannot write");
    waiting_ = false;
    return {};
  }

 private:
  std::string path_;
  std::string target_;
  bool special_ = false;
  bool waiting_ = false;
};

bool starts_with(std::span<const std::uint8_t> bytes, std::string_view text) {
  return bytes.size() >= text.size() && std::memcmp(bytes.data(), text.data(), text.size()) == 0;
}

}  // namespace

Result<std::vector<std::uint8_t>> read_file(const std::string& path) {
  errno = 0;
  if (path == "-") {
    return std::vector<std::uint8_t>{std::istreambuf_iterator<char>(std::cin), {}};
  }
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return make_error(Code::io, "this is a folder, a file is needed").in_file(path);
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) return file_error(path, "cannot open");
  std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
  if (in.bad()) return file_error(path, "cannot read");
  return bytes;
}

Result<std::string> read_text_file(const std::string& path) {
  Result<std::vector<std::uint8_t>> bytes = read_file(path);
  if (!bytes) return bytes.error();
  return std::string(bytes->begin(), bytes->end());
}

Result<void> write_file(const std::string& path, std::span<const std::uint8_t> bytes) {
  if (path == "-") return write_stdout(bytes);
  StagedFile file(path);
  if (auto done = file.stage(bytes); !done) return done;
  return file.publish();
}

Result<void> write_file(const std::string& path, std::string_view text) {
  return write_file(path, bytes_of(text));
}

Result<void> write_files(std::span<const OutputText> files) {
  std::vector<StagedFile> staged;
  for (const OutputText& file : files) {
    if (file.path == "-") continue;
    staged.emplace_back(file.path);
    if (auto done = staged.back().stage(bytes_of(file.text)); !done) return done;
  }
  for (const OutputText& file : files) {
    if (file.path != "-") continue;
    if (auto done = write_stdout(bytes_of(file.text)); !done) return done;
  }
  for (StagedFile& file : staged) {
    if (auto done = file.publish(); !done) return done;
  }
  return {};
}

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(c >= 'A' && c <= 'Z' ? c + 32 : c); });
  return extension;
}

std::string name_of_output(const std::string& path) {
  return path == "-" ? "standard output" : path;
}

void set_quiet(bool quiet) { quiet_setting = quiet; }

void warn(const std::string& text) {
  if (!quiet_setting) std::cerr << "animeme: warning: " << text << "\n";
}

void say(const std::string& text) {
  if (!quiet_setting) std::cerr << text << "\n";
}

int usage_error(const std::string& text) {
  std::cerr << "animeme: " << text << "\nRun with --help for more information.\n";
  return kUsage;
}

ProgressLine::ProgressLine(std::string what) : what_(std::move(what)) {}

ProgressLine::~ProgressLine() { clear(); }

void ProgressLine::clear() {
  if (shown_) std::cerr << "\r\x1b[K" << std::flush;
  shown_ = false;
}

void ProgressLine::update(double done, const std::string& detail) {
  if (quiet_setting || ::isatty(STDERR_FILENO) == 0) return;
  const int percent = int(100 * std::clamp(done, 0.0, 1.0));
  if (percent == last_percent_ && detail.empty()) return;
  last_percent_ = percent;
  shown_ = true;
  const int filled = percent / 4;
  std::cerr << "\r\x1b[K" << what_ << " [" << std::string(std::size_t(filled), '#')
            << std::string(std::size_t(25 - filled), '.') << "] " << percent << " % " << detail
            << std::flush;
}

bool is_playlist(std::span<const std::uint8_t> bytes) {
  if (starts_with(bytes, "#EXTM3U")) return true;
  const auto head = bytes.first(std::min<std::size_t>(bytes.size(), 4096));
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  return text.starts_with("<") && text.find("<MPD") != std::string_view::npos;
}

FileKind kind_of(std::span<const std::uint8_t> bytes) {
  if (starts_with(bytes, "ANIMEDAM")) return FileKind::model;
  if (is_playlist(bytes)) return FileKind::media;
  if (bytes.size() >= 4 && bytes[0] == 0 && bytes[1] == 0 && bytes[2] == 1) {
    const std::uint32_t code = bytes[3];
    const bool fba = code == 0xB0 || code == 0xB2 || code == 0xB5 || code == 0xBA || code == 0xBB ||
                     code == 0x01 || code == 0x03;
    if (fba) return FileKind::fba_stream;
  }
  // Text has no control bytes but blanks; UTF-16 scripts have a byte order mark.
  if (starts_with(bytes, "\xFF\xFE") || starts_with(bytes, "\xFE\xFF")) return FileKind::script;
  const auto head = bytes.first(std::min<std::size_t>(bytes.size(), 4096));
  const bool text = std::none_of(head.begin(), head.end(), [](std::uint8_t c) {
    return c < 0x20 && c != '\t' && c != '\n' && c != '\r' && c != '\f';
  });
  if (!text) return FileKind::media;
  std::string_view view(reinterpret_cast<const char*>(head.data()), head.size());
  const char* const end_of_file = view.data() + bytes.size();
  if (view.starts_with("\xEF\xBB\xBF")) view.remove_prefix(3);
  if (view.find("ooTextFile") != std::string_view::npos) return FileKind::script;
  // A table with a header line of words is a script; FAP text is numbers from its first word on.
  while (!view.empty()) {
    const std::size_t end = view.find('\n');
    const std::string_view line = view.substr(0, end);
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first != std::string_view::npos && line[first] != '#') {
      // The header of a table of landmarks is longer than the head.
      const std::string_view rest(line.data(), std::size_t(end_of_file - line.data()));
      if (line.substr(first).starts_with("time_s") || is_arkit_csv(line) || is_landmark_csv(rest)) {
        return FileKind::curves;
      }
      const char c = line[first];
      const bool number = (c >= '0' && c <= '9') || c == '-' || c == '.';
      if (!number) return FileKind::script;
      const std::string_view version =
          line.substr(first, line.find_first_of(" \t\r", first) - first);
      return version == "3.1" || version == "3.2" ? FileKind::bap_text : FileKind::fap_text;
    }
    if (end == std::string_view::npos) break;
    view.remove_prefix(end + 1);
  }
  return FileKind::unknown;
}

}  // namespace animeme::tools
