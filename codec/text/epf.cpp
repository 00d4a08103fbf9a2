#include "codec/text/epf.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <iterator>
#include <string>

namespace animeme::fba {

namespace {

// The numbers of one line behind its tag.
class Numbers {
 public:
  Numbers(std::string_view text, std::int64_t line, std::size_t offset)
      : text_(text), line_(line), at_(offset) {}

  Result<std::int64_t> next(std::int64_t low, std::int64_t high) {
    skip_blanks();
    const char* begin = text_.data() + at_;
    const char* end = text_.data() + text_.size();
    std::int64_t value = 0;
    const auto [stop, status] = std::from_chars(begin, end, value);
    if (status != std::errc() || (stop != end && *stop != ' ' && *stop != '\t')) {
      return fail(Code::syntax, begin == end ? "a number is missing" : "this is not a number");
    }
    if (value < low || value > high) {
      return fail(Code::out_of_range, std::to_string(value) + " is outside " + std::to_string(low) +
                                          ".." + std::to_string(high));
    }
    at_ = std::size_t(stop - text_.data());
    return value;
  }
  bool at_end() {
    skip_blanks();
    return at_ == text_.size();
  }
  std::int64_t line() const { return line_; }
  Error fail(Code code, std::string message) const {
    return error_at_line(code, std::move(message), line_, std::int64_t(at_) + 1);
  }

 private:
  void skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }

  std::string_view text_;
  std::int64_t line_;
  std::size_t at_;
};

class EpfReader {
 public:
  Result<std::vector<EpfPlane>> read(std::string_view text) {
    std::int64_t line = 0;
    while (!text.empty()) {
      ++line;
      const std::size_t end = text.find('\n');
      std::string_view row = text.substr(0, end);
      text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
      row = row.substr(0, row.find('#'));
      if (!row.empty() && row.back() == '\r') row.remove_suffix(1);
      if (auto done = read_line(row, line); !done) return done.error();
    }
    if (auto done = close_plane(); !done) return done.error();
    if (planes_.empty()) {
      return error_at_line(Code::truncated, "the file holds no plane; one begins with FBM", line);
    }
    return std::move(planes_);
  }

 private:
  Result<void> read_line(std::string_view row, std::int64_t line) {
    const std::size_t begin = row.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return {};
    std::size_t end = row.find_first_of(" \t", begin);
    if (end == std::string_view::npos) end = row.size();
    const std::string_view tag = row.substr(begin, end - begin);
    Numbers in(row, line, end);
    if (tag == "FBM") {
      if (auto done = close_plane(); !done) return done;
      Result<std::int64_t> mask = in.next(1, 3);
      if (!mask) return mask.error();
      open_ = true;
      plane_ = {};
      plane_.object_mask = ObjectMask(*mask);
      plane_.face = last_face_;
      plane_.body = last_body_;
      plane_.face.send_range = {};
      plane_.body.send_range = {};
      line_ = line;
      intra_tag_ = {};
    } else if (!open_) {
      return in.fail(Code::syntax, "a plane begins with FBM, this line with " + std::string(tag));
    } else if (auto done = read_tag(tag, in); !done) {
      return done;
    }
    if (!in.at_end()) return in.fail(Code::syntax, "too many numbers for " + std::string(tag));
    return {};
  }

  Result<void> read_tag(std::string_view tag, Numbers& in) {
    if (belongs_into_intra_planes(tag)) {
      intra_tag_ = tag;
      intra_tag_line_ = in.line();
    }
    if (tag == "FFR") return number(in, plane_.face_frame, std::int64_t(1) << 40);
    if (tag == "BFR") return number(in, plane_.body_frame, std::int64_t(1) << 40);
    if (tag == "ISI") return number(in, plane_.intra, 1);
    if (tag == "FRR" || tag == "BRR") return rate(in);
    if (tag == "TC" || tag == "BTC") return time_code(in);
    if (tag == "SKN" || tag == "BSK") {
      std::uint32_t skip = 0;
      auto done = number(in, skip, 1 << 20);
      plane_.temporal.skip = skip;
      return done;
    }
    if (tag == "FMT") return face_masks(in);
    if (tag == "BMT") return body_masks(in);
    if (tag == "FQU") return quantiser(in, tag, plane_.face.fap_quant, plane_.face.send_range);
    if (tag == "BQU") return quantiser(in, tag, plane_.body.bap_quant, plane_.body.send_range);
    if (tag == "GDR") {
      auto done = number(in, plane_.face.male, 1);
      plane_.body.male = plane_.face.male;
      return done;
    }
    if (tag == "CDM") {
      Result<std::int64_t> mode = in.next(0, 1);
      if (!mode) return mode.error();
      if (*mode == 0) return {};
      return in.fail(Code::unsupported,
                     "CDM 1 selects DCT mode, which is not supported; only CDM 0 (arithmetic "
                     "coding) can be written");
    }
    constexpr std::string_view kSuffix[4] = {"IX", "IN", "PX", "PN"};
    for (std::size_t kind = 0; kind < 4; ++kind) {
      if (tag.size() != 3 || tag.substr(1) != kSuffix[kind]) continue;
      if (tag[0] == 'F') {
        return ranges(in, kind, plane_.face, fap::kFirstLowLevel, fap::kFapCount);
      }
      if (tag[0] == 'B') {
        return ranges(in, kind, plane_.body, 1, kBapCount);
      }
    }
    return in.fail(Code::syntax, "unknown tag " + std::string(tag));
  }

  static bool belongs_into_intra_planes(std::string_view tag) {
    constexpr std::string_view kTags[] = {"FRR", "BRR", "TC",  "BTC", "FMT", "BMT", "FQU", "BQU",
                                          "FIX", "FIN", "FPX", "FPN", "BIX", "BIN", "BPX", "BPN"};
    return std::find(std::begin(kTags), std::end(kTags), tag) != std::end(kTags);
  }

  // The reference encoder scales the ranges as it reads them, so a quantiser behind them would be
  // the wrong one there.
  static Result<void> quantiser(Numbers& in, std::string_view tag, int& quant,
                                const std::array<bool, 4>& ranges_seen) {
    for (const bool seen : ranges_seen) {
      if (seen) return in.fail(Code::syntax, std::string(tag) + " must precede the ranges");
    }
    return number(in, quant, 31);
  }

  template <class T>
  static Result<void> number(Numbers& in, T& value, std::int64_t high) {
    Result<std::int64_t> read = in.next(0, high);
    if (!read) return read.error();
    value = T(*read);
    return {};
  }

  Result<void> rate(Numbers& in) {
    CodedRate coded;
    if (auto done = number(in, coded.frame_rate, 255); !done) return done;
    if (auto done = number(in, coded.sixteenths, 15); !done) return done;
    if (auto done = number(in, coded.frequency_offset, 1); !done) return done;
    if (!coded.rate().valid()) return in.fail(Code::out_of_range, "the frame rate is 0");
    plane_.temporal.rate = coded;
    return {};
  }

  Result<void> time_code(Numbers& in) {
    TimeCode code;
    bool marker = true;
    if (auto done = number(in, code.hours, 31); !done) return done;
    if (auto done = number(in, code.minutes, 63); !done) return done;
    if (auto done = number(in, marker, 1); !done) return done;
    if (auto done = number(in, code.seconds, 63); !done) return done;
    if (!marker) return in.fail(Code::out_of_range, "the marker of a time code must be 1");
    plane_.temporal.time_code = code;
    return {};
  }

  Result<void> face_masks(Numbers& in) {
    FaceSettings& face = plane_.face;
    face.mask.reset();
    for (std::size_t group = 0; group < fap::kGroupCount; ++group) {
      if (auto done = number(in, face.mask_type[group], 3); !done) return done;
      const fap::GroupInfo& info = fap::kGroups[group];
      for (int i = 0; i < info.size; ++i) {
        bool coded = face.mask_type[group] == MaskType::all;
        if (by_mask(face.mask_type[group])) {
          if (auto done = number(in, coded, 1); !done) return done;
        }
        face.mask[std::size_t(info.first + i)] = coded;
      }
    }
    return {};
  }

  Result<void> body_masks(Numbers& in) {
    BodySettings& body = plane_.body;
    body.mask.reset();
    std::size_t slot = 0;
    for (std::size_t group = 0; group < kBodyGroupCount; ++group) {
      if (auto done = number(in, body.mask_type[group], 3); !done) return done;
      if (body.mask_type[group] == MaskType::interpolate) {
        return in.fail(Code::out_of_range, "body mask type 2 is not allowed");
      }
      for (int i = 0; i < kBodyGroupSizes[group]; ++i, ++slot) {
        bool coded = body.mask_type[group] == MaskType::all;
        if (by_mask(body.mask_type[group])) {
          if (auto done = number(in, coded, 1); !done) return done;
        }
        body.mask[kBapOrder[slot]] = coded;
      }
    }
    return {};
  }

  static bool by_mask(MaskType type) {
    return type == MaskType::hold || type == MaskType::interpolate;
  }

  template <class Settings>
  static Result<void> ranges(Numbers& in, std::size_t kind, Settings& settings, int first,
                             int last) {
    settings.send_range[kind] = true;
    const bool maximum = kind % 2 == 0;
    for (int i = first; i <= last; ++i) {
      Result<std::int64_t> limit = maximum ? in.next(0, 1860) : in.next(-1860, 0);
      if (!limit) return limit.error();
      settings.range[kind][std::size_t(i)] = std::uint8_t((std::abs(*limit) + 59) / 60);
    }
    return {};
  }

  // The reference encoder takes an empty predictive range of FAP 4 for "no ranges were given" and
  // codes +-1020 for everything. Its streams are the measure, so the same is done here.
  static void imitate_reference_default(FaceSettings& face) {
    constexpr std::size_t kProbe = 4;
    constexpr std::uint8_t kDefault = 1020 / 60;
    if (!face.send_range[kPredictiveMax] || !face.send_range[kPredictiveMin]) return;
    if (face.range[kPredictiveMax][kProbe] != 0 || face.range[kPredictiveMin][kProbe] != 0) return;
    for (auto& set : face.range) set.fill(kDefault);
  }

  Result<void> close_plane() {
    if (!open_) return {};
    if (plane_.intra) {
      imitate_reference_default(plane_.face);
      if (has_face(plane_.object_mask)) last_face_ = plane_.face;
      if (has_body(plane_.object_mask)) last_body_ = plane_.body;
    } else if (planes_.empty()) {
      return error_at_line(Code::syntax, "the first plane must be intra (ISI 1)", line_);
    } else if (!intra_tag_.empty()) {
      return error_at_line(Code::syntax, intra_tag_ + " belongs in a plane with ISI 1",
                           intra_tag_line_);
    }
    planes_.push_back(plane_);
    open_ = false;
    return {};
  }

  std::vector<EpfPlane> planes_;
  EpfPlane plane_;
  FaceSettings last_face_;
  BodySettings last_body_;
  std::int64_t line_ = 0;
  std::string intra_tag_;  // last tag of this plane that only an intra plane may have
  std::int64_t intra_tag_line_ = 0;
  bool open_ = false;
};

}  // namespace

Result<std::vector<EpfPlane>> read_epf(std::string_view text) { return EpfReader().read(text); }

}  // namespace animeme::fba
