#include "tools/files/files.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <utility>

#include "fap/detail/text_scanner.h"

namespace animeme::tools {

namespace {

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

OutputFile::OutputFile(std::string path) : path_(std::move(path)) {
  if (path_ == "-") return;
  // Devices and pipes (/dev/null, /dev/stdout) cannot be renamed onto.
  std::error_code ignored;
  const auto status = std::filesystem::status(path_, ignored);
  special_ = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
  target_ = special_ ? path_ : path_ + ".part" + std::to_string(::getpid());
}
OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      special_(other.special_),
      waiting_(std::exchange(other.waiting_, false)),
      out_(std::move(other.out_)) {}
OutputFile::~OutputFile() {
  if (waiting_) std::remove(target_.c_str());
}

Result<void> OutputFile::open() {
  if (path_ == "-" || out_.is_open()) return {};
  errno = 0;
  out_.open(target_, std::ios::binary | std::ios::trunc);
  waiting_ = out_.is_open() && !special_;
  if (!out_.is_open()) return file_error(path_, "cannot write");
  return {};
}

Result<void> OutputFile::write(std::span<const std::uint8_t> bytes) {
  if (path_ == "-") return write_stdout(bytes);
  if (auto opened = open(); !opened) return opened;
  out_.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  out_.flush();  // a full disk is told now, not when other files have taken their places
  if (!out_) return file_error(path_, "cannot write");
  return {};
}

Result<void> OutputFile::write(std::string_view text) { return write(bytes_of(text)); }

Result<void> OutputFile::publish() {
  if (path_ == "-") return {};
  if (auto opened = open(); !opened) return opened;
  out_.close();
  if (!out_) return file_error(path_, "cannot write");
  if (!waiting_) return {};
  if (std::rename(target_.c_str(), path_.c_str()) != 0) return file_error(path_, "cannot write");
  waiting_ = false;
  return {};
}

Result<void> write_file(const std::string& path, std::span<const std::uint8_t> bytes) {
  OutputFile file(path);
  if (auto done = file.write(bytes); !done) return done;
  return file.publish();
}

Result<void> write_file(const std::string& path, std::string_view text) {
  return write_file(path, bytes_of(text));
}

Result<void> write_files(std::span<const OutputText> files) {
  std::vector<OutputFile> staged;
  for (const OutputText& file : files) {
    if (file.path == "-") continue;
    staged.emplace_back(file.path);
    if (auto done = staged.back().write(file.text); !done) return done;
  }
  for (const OutputText& file : files) {
    if (file.path != "-") continue;
    if (auto done = write_stdout(bytes_of(file.text)); !done) return done;
  }
  for (OutputFile& file : staged) {
    if (auto done = file.publish(); !done) return done;
  }
  return {};
}

std::string extension_of(const std::string& path) {
  return fap::detail::lower_case(std::filesystem::path(path).extension().string());
}

std::string name_of_output(const std::string& path) {
  return path == "-" ? "standard output" : path;
}

}  // namespace animeme::tools
