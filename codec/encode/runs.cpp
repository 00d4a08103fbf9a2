#include <algorithm>
#include <optional>

#include "codec/encode/code_length_internal.h"
#include "codec/encode/plan_internal.h"
#include "codec/syntax/settings_internal.h"
#include "codec/syntax/state_internal.h"

namespace animeme::fba::internal {

namespace {

using Planes = std::vector<std::size_t>;  // indices, ascending

constexpr int kTurnsBeforeIntra = 3;  // detours taken for one plane

// Cuts a clip where it has to be, and where that saves bits.
class Splitter {
 public:
  Splitter(const ClipData& clip, const Decision& decision, const PlanOptions& options)
      : clip_(clip), decision_(decision), options_(options), coded_(coded_channels(decision)) {}

  Planes begins() const {
    const Planes needed = split_where_needed(hazardous());
    Planes begins;
    for (std::size_t i = 0; i < needed.size(); ++i) {
      const std::size_t end = i + 1 < needed.size() ? needed[i + 1] : clip_.planes();
      add_periods(clip_.number, needed[i], end, options_.intra_frames, begins);
    }
    return options_.extra_intra ? split_where_it_pays(begins) : begins;
  }

 private:
  int scale(std::size_t i) const {
    return scale_at(clip_.channels[i].body, decision_.quant(clip_.channels[i]));
  }
  std::span<const std::int32_t> levels(std::size_t i, std::size_t first, std::size_t count) const {
    return std::span(decision_.rows[i].levels).subspan(first, count);
  }

  // Where other ranges do not help against a hazard (there may be no parameter that has any, or all
  // are as wide as they can be), an intra plane will.
  Planes hazardous() const {
    Planes begins = {0};
    if (decision_.first) begins.push_back(1);  // behind the coarse plane
    const Planes& again = options_.hazardous;
    for (auto it = again.begin(); it != again.end();) {
      const auto next = std::upper_bound(it, again.end(), *it);
      if ((coded_.empty() || next - it > kTurnsBeforeIntra) && can_be_intra(*it)) {
        begins.push_back(*it);
      }
      it = next;
    }
    return begins;
  }

  bool can_be_intra(std::size_t plane) const {
    return std::all_of(coded_.begin(), coded_.end(), [&](std::size_t i) {
      return std::abs(std::int64_t(decision_.rows[i].levels[plane])) <=
             level_range(kMaxRange, scale(i));
    });
  }

  static void tidy(Planes& planes) {
    std::sort(planes.begin(), planes.end());
    planes.erase(std::unique(planes.begin(), planes.end()), planes.end());
  }

  // An intra plane at every change that no range can hold.
  Planes split_where_needed(Planes begins) const {
    for (const std::size_t i : coded_) {
      const auto row = levels(i, 0, clip_.planes());
      const std::int64_t limit = level_range(kMaxRange, scale(i));
      for (std::size_t plane = 1; plane < row.size(); ++plane) {
        if (std::abs(std::int64_t(row[plane]) - row[plane - 1]) > limit) begins.push_back(plane);
      }
    }
    tidy(begins);
    return begins;
  }

  // What a run costs without the symbols of FAP 1 and 2 and the headers of its planes; nothing if
  // its intra plane cannot be coded.
  std::optional<Bits> cost(std::size_t first, std::size_t count) const {
    Bits bits = 80 * kOneBit;  // header and masks, within a few bits
    for (const std::size_t i : coded_) {
      const RunCost run = run_cost(levels(i, first, count), scale(i));
      if (!run.fits) return std::nullopt;
      bits += run.bits;
    }
    return bits;
  }

  // The plane whose change alone makes the ranges of its run so wide that learning them costs
  // most, if that could be more than an intra plane does; 0: none.
  std::size_t costly_jump(std::size_t first, std::size_t count) const {
    std::vector<Bits> loss(count, 0);
    for (const std::size_t i : coded_) {
      const auto row = levels(i, first, count);
      std::int64_t largest = 0;
      std::int64_t second = 0;
      std::size_t at = 0;
      for (std::size_t plane = 1; plane < count; ++plane) {
        const std::int64_t change = std::abs(std::int64_t(row[plane]) - row[plane - 1]);
        if (change > largest) {
          second = largest;
          largest = change;
          at = plane;
        } else {
          second = std::max(second, change);
        }
      }
      const std::uint32_t wide = alphabet(largest, scale(i));
      const std::uint32_t narrow = alphabet(second, scale(i));
      if (wide == narrow) continue;
      const std::uint32_t planes = std::uint32_t(count);
      loss[at] += log2_factorial(wide + planes) - log2_factorial(wide) -
                  log2_factorial(narrow + planes) + log2_factorial(narrow);
    }
    const auto worst = std::max_element(loss.begin(), loss.end());
    const Bits intra_plane = Bits(80 + 24 * coded_.size()) * kOneBit;
    return *worst > intra_plane ? std::size_t(worst - loss.begin()) : 0;
  }

  static std::uint32_t alphabet(std::int64_t change, int scale) {
    return std::uint32_t(2 * level_range(range_number(change, scale), scale) + 1);
  }

  Planes split_where_it_pays(const Planes& begins) const {
    Planes out;
    for (std::size_t i = 0; i < begins.size(); ++i) {
      const std::size_t end = i + 1 < begins.size() ? begins[i + 1] : clip_.planes();
      split(begins[i], end - begins[i], out);
    }
    tidy(out);
    return out;
  }

  void split(std::size_t first, std::size_t count, Planes& out) const {
    out.push_back(first);
    const std::size_t jump = costly_jump(first, count);
    if (jump == 0) return;
    const std::optional<Bits> one = cost(first, count);
    const std::optional<Bits> before = cost(first, jump);
    const std::optional<Bits> behind = cost(first + jump, count - jump);
    if (!one || !before || !behind || *before + *behind >= *one) return;
    split(first, jump, out);
    split(first + jump, count - jump, out);
  }

  const ClipData& clip_;
  const Decision& decision_;
  const PlanOptions& options_;
  std::vector<std::size_t> coded_;
};

}  // namespace

std::vector<std::size_t> coded_channels(const Decision& decision) {
  std::vector<std::size_t> coded;
  for (std::size_t i = 0; i < decision.rows.size(); ++i) {
    if (decision.rows[i].role == Role::coded) coded.push_back(i);
  }
  return coded;
}

std::vector<std::size_t> run_begins(const ClipData& clip, const Decision& decision,
                                    const PlanOptions& options) {
  return Splitter(clip, decision, options).begins();
}

}  // namespace animeme::fba::internal
