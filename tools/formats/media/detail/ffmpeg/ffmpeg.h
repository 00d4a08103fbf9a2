// Ownership, error text and log of FFmpeg's C types. Internal: public headers never include this.
#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/formats/media/detail/ffmpeg/ffmpeg_calls.h"

namespace animeme::media::av {

struct Deleter {
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
  void operator()(SwrContext* swr) const { swr_free(&swr); }
  void operator()(SwsContext* sws) const { sws_freeContext(sws); }
  void operator()(AVCodecParameters* parameters) const { avcodec_parameters_free(&parameters); }
  void operator()(AVIOContext* io) const {
    av_freep(&io->buffer);
    avio_context_free(&io);
  }
};

using Packet = std::unique_ptr<AVPacket, Deleter>;
using Frame = std::unique_ptr<AVFrame, Deleter>;
using Codec = std::unique_ptr<AVCodecContext, Deleter>;
using Swr = std::unique_ptr<SwrContext, Deleter>;
using Sws = std::unique_ptr<SwsContext, Deleter>;
using Parameters = std::unique_ptr<AVCodecParameters, Deleter>;
using Io = std::unique_ptr<AVIOContext, Deleter>;

/// Gives `parameters` a copy of the decoder configuration. False: no memory.
bool set_extradata(AVCodecParameters& parameters, const std::vector<std::uint8_t>& bytes);

/// Error of what could not be allocated.
inline Error no_memory() { return make_error(Code::out_of_range, "not enough memory"); }

using Transfer = int (*)(void* self, std::uint8_t* bytes, int size);
using Seek = std::int64_t (*)(void* self, std::int64_t offset, int whence);

/// What lies between libavformat and our bytes; one of `read` and `write` is nullptr, `seek` may
/// be. nullptr: no memory.
Io make_io(void* self, Transfer read, Transfer write, Seek seek);

/// AVDictionary with an owner.
class Options {
 public:
  Options() = default;
  Options(const Options&) = delete;
  Options& operator=(const Options&) = delete;
  ~Options() { av_dict_free(&entries_); }

  void set(const char* key, const std::string& value) {
    av_dict_set(&entries_, key, value.c_str(), 0);
  }
  void set(const char* key, std::int64_t value) { av_dict_set_int(&entries_, key, value, 0); }
  AVDictionary** get() { return &entries_; }
  /// First entry that nobody used, or nullptr: a misspelt option must not pass silently.
  const char* unused() const {
    const AVDictionaryEntry* entry = av_dict_get(entries_, "", nullptr, AV_DICT_IGNORE_SUFFIX);
    return entry == nullptr ? nullptr : entry->key;
  }

 private:
  AVDictionary* entries_ = nullptr;
};

/// FFmpeg's own words for a negative return value.
std::string error_text(int status);

/// The nearest Code: not_found, io, syntax, truncated, unsupported or internal.
Code error_code(int status);

/// Error "what: <FFmpeg's words>".
Error make_av_error(int status, const std::string& what);

/// Keeps FFmpeg silent in this thread while it lives and collects what was said at error level
/// or worse: at most 16 different lines. Threads without one log as before.
class LogCapture {
 public:
  LogCapture();
  ~LogCapture();
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;

  void add(std::string line);
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  LogCapture* outer_;
  std::vector<std::string> lines_;
};

/// Runs `body`, which returns a Result, and turns an exception (memory, in practice) into an
/// Error: none may cross the public border.
template <class Body>
auto guarded(Body&& body) -> decltype(body()) {
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return no_memory();
  } catch (const std::exception& problem) {
    return make_error(Code::internal, problem.what());
  }
}

/// The same with the name of a file in the Error that `body` returns.
template <class Body>
auto guarded(const std::string& path, const Body& body) -> decltype(body()) {
  return guarded([&] {
    auto result = body();
    if (!result) result.error() = std::move(result.error()).in_file(path);
    return result;
  });
}

}  // namespace animeme::media::av
