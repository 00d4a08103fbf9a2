#include <algorithm>
#include <cstdio>
#include <optional>

#include "fap/detail/walk.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/damage.h"
#include "tools/app/commands/fap_file.h"
#include "tools/app/commands/plane_file.h"
#include "tools/app/commands/track_option.h"
#include "tools/formats/inspect/comparison.h"

namespace animeme::tools {

namespace {

struct CompareOptions {
  std::string track;  // of several languages or people
  std::string a;
  std::string b;
  bool json = false;
  double max_rms = -1;
};

// What there is at one number.
struct Instant {
  std::int64_t number = 0;
  const fap::Frame* face = nullptr;
  const fba::BodyFrame* body = nullptr;
};

// One of the two inputs, instant after instant: a stream is decoded and FAP text read on the way.
class Side {
 public:
  Result<void> open(const std::string& path) {
    path_ = path;
    kind_ = FileKind::fba_stream;
    if (PlaneFile::can_read(path)) {
      file_.emplace(path);
      // Walked side by side with another, so damage has to be known before.
      std::vector<std::string> doubts;
      const auto pass = [](const fba::Plane&) { return Result<void>(); };
      if (!file_->for_each(pass, &doubts) || !doubts.empty()) {
        if (auto repaired = file_->repaired(path)) file_ = std::move(*repaired);
      }
      told_ = false;
    } else if (FapFile::can_read(path)) {
      Result<FapFile> text = FapFile::open(path);
      if (!text) return text.error();
      kind_ = FileKind::fap_text;
      motion_.face.rate = text->survey().rate;
      text_.emplace(text->reader());
    } else {
      Result<MotionInput> input = read_motion(path);
      if (!input) return input.error();
      kind_ = input->kind;
      motion_ = std::move(*input);
      if (!motion_.stream.empty()) file_.emplace(std::move(motion_.stream));
    }
    if (file_) reader_.emplace(*file_);
    return {};
  }

  // Good until the next call; null: there is no more, or an error() came.
  const Instant* next() {
    instant_ = {};
    const bool more = reader_ ? next_of_stream() : text_ ? next_of_file() : next_of_text();
    if (!more) return nullptr;
    faces_ += instant_.face != nullptr ? 1 : 0;
    bodies_ += instant_.body != nullptr ? 1 : 0;
    return &instant_;
  }

  const std::optional<Error>& error() const { return error_; }
  bool is_stream() const { return reader_.has_value(); }
  bool is_bap_text() const { return kind_ == FileKind::bap_text; }
  std::int64_t faces() const { return faces_; }
  std::int64_t bodies() const { return bodies_; }
  const std::string& path() const { return path_; }
  fap::Rate face_rate() const { return reader_ ? rate_ : motion_.face.rate; }
  fap::Rate body_rate() const { return reader_ ? rate_ : motion_.body.rate; }

 private:
  bool next_of_stream() {
    const Result<const fba::Plane*> plane = reader_->next();
    if (!plane) error_ = Error(plane.error()).in_file(path_);
    if (!plane || *plane == nullptr) {
      for (const std::string& text : reader_->warnings()) {
        if (!told_) warn(path_ + ": " + text);
      }
      told_ = true;
      return false;
    }
    if (!begun_) rate_ = (*plane)->rate;
    begun_ = true;
    instant_.number = (*plane)->number;
    if (fba::has_face((*plane)->object_mask)) instant_.face = &(*plane)->face;
    instant_.body = (*plane)->body.get();
    return true;
  }

  bool next_of_file() {
    const Result<const fap::Frame*> frame = text_->next();
    if (!frame) error_ = Error(frame.error()).in_file(path_);
    if (!frame || *frame == nullptr) return false;
    instant_.number = (*frame)->number;
    instant_.face = *frame;
    return true;
  }

  bool next_of_text() {
    const auto& faces = motion_.face.frames;
    const auto& bodies = motion_.body.frames;
    const bool face = at_ < faces.size();
    const bool body = body_at_ < bodies.size();
    if (!face && !body) return false;
    instant_.number =
        std::min(face ? faces[at_].number : INT64_MAX, body ? bodies[body_at_].number : INT64_MAX);
    if (face && faces[at_].number == instant_.number) instant_.face = &faces[at_++];
    if (body && bodies[body_at_].number == instant_.number) instant_.body = &bodies[body_at_++];
    return true;
  }

  std::string path_;
  FileKind kind_ = FileKind::fba_stream;
  MotionInput motion_;
  std::optional<PlaneFile> file_;
  std::optional<PlaneReader> reader_;
  std::optional<fap::TextReader> text_;
  std::optional<Error> error_;
  fap::Rate rate_;  // of a stream
  Instant instant_;
  std::size_t at_ = 0, body_at_ = 0;
  std::int64_t faces_ = 0, bodies_ = 0;
  bool begun_ = false, told_ = true;
};

// What two inputs can be compared in. Text holds one half only, which says nothing about the
// other half.
struct Common {
  bool face = false;
  bool body = false;
};
Common in_common(const Side& a, const Side& b) {
  const auto can_hold_body = [](const Side& side) {
    return side.is_bap_text() || side.is_stream();
  };
  const bool bodies = a.bodies() + b.bodies() > 0;
  const bool only_bodies = a.faces() + b.faces() == 0 && bodies;
  return {!a.is_bap_text() && !b.is_bap_text() && !only_bodies,
          can_hold_body(a) && can_hold_body(b) && bodies};
}

// A text against a stream that codes nothing of its kind.
Result<void> check_half(const Side& text, const Side& other) {
  if (text.is_stream()) return {};
  const char* what = nullptr;
  if (text.is_bap_text()) {
    if (other.bodies() == 0 && !other.is_bap_text()) {
      what = "this has no body to compare with BAP text";
    }
  } else if (other.is_bap_text()) {
    what = "this is BAP text: it has a body but no face";
  } else if (other.is_stream() && other.faces() == 0) {
    what = other.bodies() == 0 ? "the stream codes neither a face nor a body"
                               : "the stream codes a body but no face";
  }
  if (what == nullptr) return {};
  return make_error(Code::not_found, what).in_file(other.path());
}

// Goes through both once.
Result<inspect::Comparison> compare(Side& a, Side& b) {
  fap::Comparer face;
  inspect::BodyComparer body;
  const auto of_a = [&](const Instant& one) {
    if (one.face != nullptr) face.only_a(*one.face);
    if (one.body != nullptr) body.only_a(*one.body);
  };
  const auto of_b = [&](const Instant& one) {
    if (one.face != nullptr) face.only_b(*one.face);
    if (one.body != nullptr) body.only_b(*one.body);
  };
  const auto of_both = [&](const Instant& one, const Instant& other) {
    if (one.face != nullptr && other.face != nullptr) {
      face.both(*one.face, *other.face);
    } else {
      of_a({one.number, one.face, nullptr});
      of_b({other.number, other.face, nullptr});
    }
    if (one.body != nullptr && other.body != nullptr) {
      body.both(*one.body, *other.body);
    } else {
      of_a({one.number, nullptr, one.body});
      of_b({other.number, nullptr, other.body});
    }
  };
  fap::walk_side_by_side([&a] { return a.next(); }, [&b] { return b.next(); }, of_a, of_b, of_both);
  for (const Side* side : {&a, &b}) {
    if (side->error()) return *side->error();
  }
  if (auto ok = check_half(a, b); !ok) return ok.error();
  if (auto ok = check_half(b, a); !ok) return ok.error();
  const Common common = in_common(a, b);
  inspect::Comparison comparison;
  if (common.face) comparison.face = face.compared(a.face_rate(), b.face_rate());
  if (common.body) comparison.body = body.compared(a.body_rate(), b.body_rate());
  return comparison;
}

Result<int> run(const CompareOptions& options) {
  const media::TrackScope tracks(wanted_track_of(options.track));
  Side a, b;
  if (auto ok = a.open(options.a); !ok) return ok.error();
  if (auto ok = b.open(options.b); !ok) return ok.error();
  const Result<inspect::Comparison> comparison = compare(a, b);
  if (!comparison) return comparison.error();
  const std::string text = options.json
                               ? inspect::comparison_json(*comparison, damage_reported()) + "\n"
                               : inspect::comparison_text(*comparison);
  std::fputs(text.c_str(), stdout);
  const auto accepted = [&](const auto& difference) {
    if (options.max_rms < 0 || !difference) return !difference || difference->equal();
    return difference->rms_steps <= options.max_rms && difference->mask_differences == 0;
  };
  return accepted(comparison->face) && accepted(comparison->body) ? kOk : kCheckFailed;
}

void add_options(OptionTable& cli, CompareOptions& options) {
  cli.add("a", options.a, "FAP or BAP text, FBA stream or container")->required();
  cli.add("b", options.b, "The same or another format")->required();
  cli.add("--max-rms", options.max_rms,
          "Accept an error up to this, in quantiser steps RMS over all FAPs, and over all "
          "BAPs")
      ->at_least_zero();
  cli.add("--json", options.json, "Print a machine-readable result");
  add_track_option(cli, options.track);
}

}  // namespace

const Command kCompare{
    "compare", "Compare two clips in FAP units and quantiser steps; exit code 1 if they differ",
    "  animeme compare talk.fap talk.fba\n"
    "  animeme compare body.bap dance.fba\n"
    "  animeme compare before.fap after.fap --max-rms 0.5 --json",
    set_up<CompareOptions>};

}  // namespace animeme::tools
