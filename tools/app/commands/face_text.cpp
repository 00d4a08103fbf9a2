#include "tools/app/commands/face_text.h"

#include <cmath>

#include "fap/rate_text.h"
#include "fap/receiver.h"
#include "fap/resample.h"
#include "fap/text.h"
#include "tools/app/commands/options.h"
#include "tools/app/commands/terminal.h"
#include "tools/formats/common/text.h"

namespace animeme::tools {

namespace {

constexpr std::size_t kTextBytes = 1 << 16;             // bytes of text written at once
constexpr std::int64_t kMostSkippedFrames = 1'000'000;  // a small stream can skip any number

fap::FillOptions filling(const FaceText& text) {
  return {.keep_high_level = !text.fill, .expand = text.expand, .complete = text.fill};
}

// Frames as text, written in pieces.
class Pen {
 public:
  explicit Pen(OutputFile& out) : out_(out) {}

  void write(const fap::Frame& frame) {
    fap::append_text(text_, frame);
    ++frames_;
    if (text_.size() >= kTextBytes) flush();
  }
  void write(const std::string& text) { text_ += text; }
  void flush() {
    if (done_) done_ = out_.write(text_);
    text_.clear();
  }
  const Result<void>& done() const { return done_; }
  std::int64_t frames() const { return frames_; }

 private:
  OutputFile& out_;
  std::string text_;
  std::int64_t frames_ = 0;
  Result<void> done_;
};

Result<void> write_coded(const FaceText& text, Pen& pen) {
  return text.frames([&](const fap::Frame& frame, const fap::GroupRules&) {
    pen.write(frame);
    return pen.done();
  });
}

Result<void> write_shown(const FaceText& text, const fap::Mask& mask, Pen& pen) {
  fap::Receiver receiver(filling(text));
  std::optional<fap::Resampler> resampler;
  if (text.resampled) resampler.emplace(text.rate, *text.resampled);
  const fap::Resampler::Emit emit = [&](const fap::Frame& frame) { pen.write(frame); };
  const auto show = [&](const fap::Frame& frame, std::int64_t number) {
    fap::Frame shown = fap::with_mask(frame, mask);
    shown.number = number;
    if (resampler) {
      resampler->push(shown, emit);
    } else {
      pen.write(shown);
    }
  };
  std::int64_t next = 0;
  auto done = text.frames([&](const fap::Frame& frame, const fap::GroupRules& rules) {
    const bool gaps_stay = text.exact && !resampler;
    for (; !gaps_stay && next < frame.number && pen.done(); ++next) show(receiver.hold(), next);
    show(receiver.receive(frame, rules), frame.number);
    next = frame.number + 1;
    return pen.done();
  });
  if (done && resampler) resampler->finish(emit);
  return done;
}

// FAP 1 or 2 beside others.
bool is_mixed(const fap::Mask& mask) {
  fap::Mask low = mask;
  low.reset(1);
  low.reset(2);
  return low != mask && low.any();
}

void warn_of_mixture(const std::string& path, const fap::Mask& mask) {
  if (!is_mixed(mask)) return;
  warn(path +
       ": FAP 1 or 2 are used together with low-level FAPs, of which players show only one kind; "
       "--expand converts them to low-level FAPs");
}

}  // namespace

FaceText face_text(const fap::Sequence& clip) {
  FaceText text;
  text.rate = clip.rate;
  text.name = clip.name;
  text.frames = [&clip](const TakeFrame& take) {
    for (const fap::Frame& frame : clip.frames) {
      if (auto done = take(frame, fap::GroupRules{}); !done) return done;
    }
    return Result<void>();
  };
  return text;
}

Result<FaceExtent> extent_of(const FaceText& text) {
  FaceExtent extent;
  fap::Receiver receiver(filling(text));
  std::int64_t skipped = 0;
  auto done = text.frames([&](const fap::Frame& frame, const fap::GroupRules& rules) {
    if (frame.number < extent.shown) {
      return Result<void>(make_error(Code::invalid_argument, "the frame numbers do not ascend"));
    }
    if (!text.exact && !text.coded) skipped += frame.number - extent.shown;
    if (skipped > kMostSkippedFrames) {
      return Result<void>(make_error(
          Code::out_of_range, "more than a million frames are skipped before frame " +
                                  std::to_string(frame.number) + "; --exact leaves them out"));
    }
    ++extent.frames;
    extent.shown = frame.number + 1;
    if (!text.coded) receiver.receive(frame, rules);
    return Result<void>();
  });
  if (!done) return done.error();
  extent.mask = receiver.mask();
  return extent;
}

void warn_of_rate(const std::string& path, fap::Rate rate, const std::string& remedy) {
  const fap::Rate whole = fap::whole_rate(rate);
  if (!rate.valid() || whole == rate) return;
  const double late = 60 * (rate.frames_per_second() / whole.frames_per_second() - 1);
  const std::string number = fap::format_rate(whole);
  warn(path + ": players support integer rates only and show " + number +
       " frames per second instead of " + fap::format_rate(rate) + ", which is " +
       format("%.2f s per minute too %s; ", std::abs(late), late < 0 ? "fast" : "slow") +
       (remedy.empty() ? "--rate " + number + " corrects it" : remedy) +
       ". The exact rate is noted after the name");
}

Result<std::int64_t> write_face_text(OutputFile& out, const std::string& path,
                                     const FaceText& text) {
  const Result<FaceExtent> extent = extent_of(text);
  if (!extent) return extent.error();
  return write_face_text(out, path, text, *extent);
}

Result<std::int64_t> write_face_text(OutputFile& out, const std::string& path, const FaceText& text,
                                     const FaceExtent& extent) {
  const bool exact = text.exact || text.coded;
  if (text.expand_mixed && !exact && !text.expand && is_mixed(extent.mask)) {
    FaceText expanded = text;
    expanded.expand = true;
    const Result<FaceExtent> wider = extent_of(expanded);
    if (!wider) return wider.error();
    say(path +
        ": FAP 1 and 2 are written as low-level FAPs, since players show only one kind; --exact "
        "leaves them as they are");
    return write_face_text(out, path, expanded, *wider);
  }
  const fap::Rate rate = text.resampled ? *text.resampled : text.rate;
  std::int64_t frames = exact ? extent.frames : extent.shown;
  if (text.resampled) {
    if (auto sensible = fap::check_resampling(text.rate, rate, extent.shown); !sensible) {
      return sensible.error();
    }
    frames = fap::Resampler(text.rate, rate).frames(extent.shown);
  }
  Pen pen(out);
  pen.write(fap::text_header(rate, text.name, frames, {.whole_rate = !exact}));
  auto done = text.coded ? write_coded(text, pen) : write_shown(text, extent.mask, pen);
  if (!done) return done.error();
  pen.flush();
  if (!pen.done()) return pen.done().error();
  if (!exact) {
    warn_of_rate(path, rate);
    warn_of_mixture(path, extent.mask);
  }
  return pen.frames();
}

void add_exact_option(OptionTable& cli, bool& exact) {
  cli.add("--exact", exact,
          "FAP text as it is, not for players: fractional rates such as 29.97 in the header, "
          "gaps in the numbers of skipped frames");
}

}  // namespace animeme::tools
