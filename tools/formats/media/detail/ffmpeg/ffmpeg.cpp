#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <mutex>

namespace animeme::media::av {
namespace {

// No single table or packet of a sane file comes near this; a hostile header asks for gigabytes.
constexpr std::size_t kLargestAllocation = std::size_t(1) << 28;
constexpr std::size_t kMaxLines = 16;

thread_local LogCapture* current = nullptr;

void on_log(void* context, int level, const char* format, va_list arguments) {
  if (current == nullptr) {
    av_log_default_callback(context, level, format, arguments);
    return;
  }
  if (level > AV_LOG_ERROR) return;
  std::array<char, 256> text{};
  if (std::vsnprintf(text.data(), text.size(), format, arguments) <= 0) return;
  try {
    current->add(text.data());
  } catch (...) {  // a lost log line is harmless, an exception through C code is not
  }
}

void set_up_once() {
  static std::once_flag once;
  std::call_once(once, [] {
    av_log_set_callback(on_log);
    av_max_alloc(kLargestAllocation);
  });
}

}  // namespace

bool set_extradata(AVCodecParameters& parameters, const std::vector<std::uint8_t>& bytes) {
  auto* data = static_cast<std::uint8_t*>(av_mallocz(bytes.size() + AV_INPUT_BUFFER_PADDING_SIZE));
  if (data == nullptr) return false;
  if (!bytes.empty()) std::memcpy(data, bytes.data(), bytes.size());
  parameters.extradata = data;
  parameters.extradata_size = int(bytes.size());
  return true;
}

Io make_io(void* self, Transfer read, Transfer write, Seek seek) {
  constexpr int kBufferSize = 1 << 16;
  auto* buffer = static_cast<unsigned char*>(av_malloc(kBufferSize));
  if (buffer == nullptr) return nullptr;
  Io io(avio_alloc_context(buffer, kBufferSize, write != nullptr, self, read, write, seek));
  if (!io) av_free(buffer);
  return io;
}

std::string error_text(int status) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  if (av_strerror(status, text.data(), text.size()) < 0) return "error " + std::to_string(status);
  return text.data();
}

Code error_code(int status) {
  switch (status) {
    case AVERROR(ENOENT):
      return Code::not_found;
    case AVERROR(EIO):
    case AVERROR(EACCES):
    case AVERROR(EPERM):
    case AVERROR(EISDIR):
    case AVERROR(ENOSPC):
    case AVERROR(EFBIG):
    case AVERROR(EPIPE):
    case AVERROR(ENOTDIR):
    case AVERROR(EROFS):
      return Code::io;
    case AVERROR(ENOMEM):
      return Code::out_of_range;
    case AVERROR_INVALIDDATA:
      return Code::syntax;
    case AVERROR_EOF:
      return Code::truncated;
    case AVERROR_DECODER_NOT_FOUND:
    case AVERROR_DEMUXER_NOT_FOUND:
    case AVERROR_ENCODER_NOT_FOUND:
    case AVERROR_MUXER_NOT_FOUND:
    case AVERROR_PATCHWELCOME:
    case AVERROR(ENOSYS):
      return Code::unsupported;
    default:
      return Code::syntax;
  }
}

Error make_av_error(int status, const std::string& what) {
  return make_error(error_code(status), what + ": " + error_text(status));
}

LogCapture::LogCapture() : outer_(current) {
  set_up_once();
  current = this;
}

LogCapture::~LogCapture() { current = outer_; }

void LogCapture::add(std::string line) {
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.pop_back();
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';  // from the file: no escapes
  }
  if (line.empty() || lines_.size() >= kMaxLines) return;
  if (std::find(lines_.begin(), lines_.end(), line) == lines_.end()) {
    lines_.push_back(std::move(line));
  }
}

}  // namespace animeme::media::av
