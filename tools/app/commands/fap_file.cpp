#include "tools/app/commands/fap_file.h"

#include <algorithm>
#include <fstream>
#include <memory>
#include <utility>
#include <vector>

#include "tools/app/commands/common.h"

namespace animeme::tools {

namespace {

// More than kind_of() looks at, and more than the first line of any FAP text.
constexpr std::size_t kHeadBytes = 1 << 16;

fap::ReadTextPiece text_of(const std::string& path) {
  auto file = std::make_shared<std::ifstream>(path, std::ios::binary);
  return [file = std::move(file)](std::span<char> to) -> Result<std::size_t> {
    file->read(to.data(), std::streamsize(to.size()));
    const auto count = std::size_t(file->gcount());
    if (file->bad() || (!*file && !file->eof())) return make_error(Code::io, "cannot read");
    return count;
  };
}

}  // namespace

bool FapFile::can_read(const std::string& path) {
  if (!is_on_disk(path)) return false;
  std::ifstream in(path, std::ios::binary);
  std::vector<std::uint8_t> head(kHeadBytes);
  in.read(reinterpret_cast<char*>(head.data()), std::streamsize(head.size()));
  head.resize(std::size_t(in.gcount()));
  if (in.bad() || exchange::kind_of(head) != FileKind::fap_text) return false;
  return head.size() < kHeadBytes || std::find(head.begin(), head.end(), '\n') != head.end();
}

Result<FapFile> FapFile::open(const std::string& path, exchange::FrameNumbers numbers) {
  FapFile file(path);
  const bool keep = numbers == exchange::FrameNumbers::keep;
  Result<fap::TextSurvey> survey = fap::survey_text(text_of(path), {.keep_numbers = keep});
  if (!survey) return std::move(survey).error().in_file(path);
  file.survey_ = std::move(*survey);
  for (const std::string& text : file.survey_.warnings) warn(path + ": " + text);
  return file;
}

fap::TextReader FapFile::reader() const { return {text_of(path_), survey_}; }

Result<void> FapFile::for_each(const Take& take) const {
  fap::TextReader frames = reader();
  for (;;) {
    Result<const fap::Frame*> frame = frames.next();
    if (!frame) return std::move(frame).error().in_file(path_);
    if (*frame == nullptr) return {};
    if (auto done = take(**frame); !done) return done;
  }
}

}  // namespace animeme::tools
