/// @file
/// The name of an error code, as JSON reports and exceptions of bindings have it.
#pragma once

#include "fap/result.h"

namespace animeme::tools {

/// The name of the enumerator: "not_found".
inline const char* code_name(Code code) {
  switch (code) {
    case Code::invalid_argument:
      return "invalid_argument";
    case Code::syntax:
      return "syntax";
    case Code::out_of_range:
      return "out_of_range";
    case Code::truncated:
      return "truncated";
    case Code::need_data:
      return "need_data";
    case Code::end_of_stream:
      return "end_of_stream";
    case Code::unsupported:
      return "unsupported";
    case Code::not_found:
      return "not_found";
    case Code::io:
      return "io";
    case Code::internal:
      break;
  }
  return "internal";
}

}  // namespace animeme::tools
