// The error of an argument.
#pragma once

#include <string>
#include <utility>

#include "fap/result.h"

namespace animeme::media {

inline Error invalid(std::string message) {
  return make_error(Code::invalid_argument, std::move(message));
}

}  // namespace animeme::media
