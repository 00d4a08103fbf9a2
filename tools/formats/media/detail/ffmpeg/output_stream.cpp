#include "tools/formats/media/detail/ffmpeg/output_stream.h"

#include <cerrno>
#include <utility>

namespace animeme::media {
namespace {

const char* remedy(int status) {
  switch (status) {
    case AVERROR(ENOSPC):
      return "; free some space or write to another disk";
    case AVERROR(EFBIG):
      return "; the file system or a limit of the shell (ulimit -f) allows no larger file";
    case AVERROR(EPIPE):
      return "; the program that was to read it has ended";
    default:
      return "";
  }
}

}  // namespace

Error write_error(int status) {
  return make_error(av::error_code(status),
                    "cannot be written: " + av::error_text(status) + remedy(status));
}

Result<std::unique_ptr<OutputStream>> OutputStream::to_file(const std::string& path,
                                                            Filter filter) {
  std::unique_ptr<OutputStream> out(new OutputStream);
  out->file_ = std::fopen(path.c_str(), "wb");
  if (out->file_ == nullptr) return write_error(AVERROR(errno));
  // libavformat has a buffer already, and a full disk is to be seen where it happens.
  std::setvbuf(out->file_, nullptr, _IONBF, 0);
  out->filter_ = std::move(filter);
  out->io_ = av::make_io(out.get(), nullptr, &OutputStream::write,
                         out->filter_ ? nullptr : &OutputStream::seek);
  if (!out->io_) return av::no_memory();
  return out;
}

OutputStream::~OutputStream() {
  if (file_ != nullptr) std::fclose(file_);
}

int OutputStream::write_all(std::span<const std::uint8_t> bytes) {
  errno = 0;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) == bytes.size()) return 0;
  return errno != 0 ? AVERROR(errno) : AVERROR(EIO);
}

int OutputStream::write(void* self, std::uint8_t* bytes, int size) {
  auto& out = *static_cast<OutputStream*>(self);
  const std::span<const std::uint8_t> given(bytes, std::size_t(size));
  try {
    const int status = out.filter_ ? out.write_all(out.filter_(given)) : out.write_all(given);
    return status < 0 ? status : size;
  } catch (...) {  // no exception through C code
    return AVERROR(ENOMEM);
  }
}

std::int64_t OutputStream::seek(void* self, std::int64_t offset, int whence) {
  std::FILE* file = static_cast<OutputStream*>(self)->file_;
  if (whence == AVSEEK_SIZE) return AVERROR(ENOSYS);
  if (std::fseek(file, long(offset), whence) != 0) return AVERROR(errno);
  return std::ftell(file);
}

Result<void> OutputStream::close() {
  avio_flush(io_.get());
  int status = io_->error;
  if (std::fclose(file_) != 0 && status >= 0) status = AVERROR(errno);
  file_ = nullptr;
  return status < 0 ? write_error(status) : Result<void>();
}

}  // namespace animeme::media
