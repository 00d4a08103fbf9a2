#include <algorithm>

#include "fap/detail/text_writing.h"
#include "fap/rate_text.h"
#include "fap/text.h"

namespace animeme::fap {
namespace {

class FrameWriter {
 public:
  explicit FrameWriter(std::string& text) : text_(text) {}

  void write(const Frame& frame, std::int64_t number) {
    for (std::size_t fap = 1; fap <= kFapCount; ++fap) {
      text_ += frame.mask[fap] ? '1' : '0';
      text_ += fap < kFapCount ? ' ' : '\n';
    }
    detail::append_number(text_, number);
    if (frame.mask[1]) write(frame.viseme);
    if (frame.mask[2]) write(frame.expression);
    for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      if (frame.mask[fap]) value(frame.value[fap]);
    }
    text_ += '\n';
  }

 private:
  void write(const Viseme& v) {
    value(v.select1);
    value(v.select2);
    value(v.blend);
    value(v.def);
  }
  void write(const Expression& e) {
    value(e.select1);
    value(e.intensity1);
    value(e.select2);
    value(e.intensity2);
    value(e.init_face);
    value(e.def);
  }
  void value(std::int32_t v) {
    text_ += ' ';
    detail::append_number(text_, v);
  }
  std::string& text_;
};

}  // namespace

Rate whole_rate(Rate rate) {
  if (!rate.valid()) return rate;
  const std::uint64_t rounded = (std::uint64_t(rate.num) * 2 + rate.den) / (2ull * rate.den);
  return {std::uint32_t(std::max<std::uint64_t>(rounded, 1)), 1};
}

std::string text_header(Rate rate, const std::string& name, std::int64_t frames,
                        const WriteTextOptions& options) {
  const Rate written = options.whole_rate ? whole_rate(rate) : rate;
  std::string word = detail::one_word(name);
  if (const std::size_t tag = detail::exact_rate_at(word, written); tag != std::string::npos) {
    word[tag] = '_';
  }
  if (written != rate) word += detail::exact_rate_tag(rate);
  return "2.1 " + word + " " + format_rate(written) + " " + std::to_string(frames) + "\n";
}

void append_text(std::string& text, const Frame& frame) {
  FrameWriter(text).write(frame, frame.number);
}

std::string write_text(const Sequence& sequence, const WriteTextOptions& options) {
  std::string text =
      text_header(sequence.rate, sequence.name, std::int64_t(sequence.frames.size()), options);
  FrameWriter writer(text);
  std::int64_t running = 0;
  for (const Frame& frame : sequence.frames) {
    writer.write(frame, options.renumber ? running++ : frame.number);
  }
  return text;
}

}  // namespace animeme::fap
