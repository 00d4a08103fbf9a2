// The settings of training that rank_methods compares.
#pragma once

#include <string>
#include <vector>

#include "dam/training/train.h"

namespace animeme::bench {

struct Variant {
  std::string name;
  dam::TrainOptions options;
};

/// Every method, the default first, with the variants worth a row.
std::vector<Variant> variants();

/// From dam+f (dam/lipsync.md, section 2) to dam, one change after the other, and changes of dam.
std::vector<Variant> steps();

}  // namespace animeme::bench
