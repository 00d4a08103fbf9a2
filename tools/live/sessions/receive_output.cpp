#include "tools/live/sessions/receive_output.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>

#include "fap/receiver.h"
#include "fap/text.h"
#include "tools/formats/files/files.h"

namespace animeme::live {

namespace {

constexpr int kFramesAtOnce = 500;

std::string name_of(const std::string& output) {
  return output == "-" ? "live" : std::filesystem::path(output).stem().string();
}

std::optional<fap::FillOptions> shown_by(const FapOutputOptions& options) {
  if (options.coded) return std::nullopt;
  return fap::FillOptions{
      .keep_high_level = !options.fill, .expand = options.expand, .complete = options.fill};
}

Error not_written(const std::string& output) {
  return make_error(Code::io, std::string("cannot be written: ") + std::strerror(errno))
      .in_file(output);
}

}  // namespace

bool is_container_output(const std::string& output) {
  const std::string extension = tools::extension_of(output);
  return extension == ".mp4" || extension == ".mkv" || extension == ".ts";
}

bool is_fap_output(const std::string& output) {
  return output == "-" || tools::extension_of(output) == ".fap";
}

Result<void> check_place(const std::string& output) {
  if (output == "-") return {};
  std::error_code ignored;
  if (std::filesystem::is_directory(output, ignored)) {
    return make_error(Code::io, "this is a folder; give the name of a file").in_file(output);
  }
  const std::filesystem::path folder = std::filesystem::path(output).parent_path();
  if (::access(folder.empty() ? "." : folder.c_str(), W_OK) == 0) return {};
  return make_error(Code::io, "cannot write into this folder").in_file(output);
}

FapOutput::FapOutput(const std::string& output, const FapOutputOptions& options)
    : output_(output), options_(options), frames_(options.gap, shown_by(options)) {
  options_.exact = options.exact || options.coded;
}

std::string FapOutput::header(std::int64_t frames) const {
  return fap::text_header(frames_.rate(), name_of(output_), frames,
                          {.whole_rate = !options_.exact});
}

Result<std::string> FapOutput::push(const media::LiveUnit& unit, std::uint32_t timescale,
                                    bool after_gap) {
  std::string text;
  if (!wanted() || unit.track != media::LiveTrack::face) return text;
  std::vector<fap::Frame> frames = frames_.push(unit, timescale, after_gap);
  if (frames.empty()) return text;
  if (options_.gap == media::GapRule::skip && !options_.exact) {
    for (std::size_t i = 0; i < frames.size(); ++i) frames[i].number = count_ + std::int64_t(i);
  }
  if (count_ == 0) text = header(0);
  for (const fap::Frame& frame : frames) fap::append_text(text, frame);
  count_ += std::int64_t(frames.size());
  mask_ = frames.back().mask;
  if (output_ == "-") return text;
  if (auto appended = append(text); !appended) return appended.error();
  return std::string();
}

Result<void> FapOutput::append(const std::string& text) {
  if (file_ == nullptr) {
    // The first text takes the place of an old file as a whole; the rest is put behind it.
    if (auto begun = tools::write_file(output_, text); !begun) return begun;
    file_.reset(std::fopen(output_.c_str(), "ab"));
    return file_ != nullptr ? Result<void>() : not_written(output_);
  }
  const bool written = std::fwrite(text.data(), 1, text.size(), file_.get()) == text.size() &&
                       std::fflush(file_.get()) == 0;
  return written ? Result<void>() : not_written(output_);
}

/// Writes the file once more, with the count of frames and with one mask for all.
Result<void> FapOutput::complete() {
  std::ifstream in(output_, std::ios::binary);
  tools::OutputFile out(output_);
  std::string line, text;
  std::getline(in, line);  // the header
  if (auto ok = out.write(header(count_)); !ok) return ok;
  while (in) {
    text = header(0);
    for (int lines = 0; lines < 2 * kFramesAtOnce && std::getline(in, line); ++lines) {
      text += line + '\n';
    }
    Result<fap::Sequence> clip = fap::read_text(text, {.keep_numbers = true});
    if (!clip) return clip.error().in_file(output_);
    text.clear();
    for (const fap::Frame& frame : clip->frames) {
      fap::append_text(text, options_.coded ? frame : fap::with_mask(frame, mask_));
    }
    if (auto ok = out.write(text); !ok) return ok;
    in.peek();
  }
  return out.publish();
}

Result<void> FapOutput::finish() {
  if (file_ == nullptr) return {};
  file_.reset();
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(output_, ignored)) return {};  // a pipe
  return complete();
}

}  // namespace animeme::live
