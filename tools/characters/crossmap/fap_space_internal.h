// FAPs as lengths on a usual face, so that millimetres count alike whatever unit a FAP has.
// Internal.
#pragma once

#include <vector>

#include "fap/fapu.h"
#include "fap/frame.h"

namespace animeme::crossmap {

/// Rows of a fit: the lengths of some FAPs, then the distances of the lips where both are there.
class FapSpace {
 public:
  explicit FapSpace(std::vector<int> faps);
  std::size_t rows() const { return faps_.size() + pairs_.size(); }
  const std::vector<int>& faps() const { return faps_; }
  /// cm, of one value for each of faps().
  std::vector<double> lengths(const std::vector<double>& values) const;
  /// Of a frame; FAPs that it does not have are 0.
  std::vector<double> lengths(const fap::Frame& frame) const;
  /// How much of what a frame does to a face lies where points of faps() are: in the same groups
  /// of FAPs (lips and jaw are one), and forwards only if some of faps() are forwards. A share of
  /// squared lengths, 0..1; 1 if it does nothing.
  double seen_share(const fap::Frame& frame) const;

 private:
  std::vector<int> faps_;
  std::vector<double> unit_;  // cm of 1
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;
};

}  // namespace animeme::crossmap
