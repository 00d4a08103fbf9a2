/// @file
/// Encoder parameter files of generated cases.
#pragma once

#include <string>
#include <vector>

#include "conformance/stream_writer.h"

namespace animeme::conformance {

/// The EPF from which an encoder makes the same planes out of a clip that has a frame for each
/// face plane and each body plane, numbered from 0. Empty if an EPF cannot say it: a plane without
/// face and body, or predictive limits of FAP 4 that are both 0, which reference encoders take
/// for "no ranges given".
std::string write_epf(const std::vector<PlaneSpec>& planes);

}  // namespace animeme::conformance
