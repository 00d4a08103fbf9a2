/// @file
/// case.json: what one conformance case is about, as data.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

/// Cases for FBA decoders, and their generator.
namespace animeme::conformance {

/// A file of a case.
struct CaseFile {
  std::string role;    ///< stream, face, body, face_ignored, source_face, source_body, parameters
  std::string name;    ///< beside case.json
  std::string sha256;  ///< 64 hexadecimal digits; empty: not checked
  std::int64_t bytes = 0;  ///< of the file
};

/// One case. The README of this folder describes the file.
struct Case {
  std::string name;                   ///< name of its folder
  std::string title;                  ///< one line for people
  std::string note;                   ///< what to watch out for; may be empty
  std::string origin;                 ///< where the stream comes from
  std::string object;                 ///< face, body or both
  bool damaged = false;               ///< expected: "error"; else "decode"
  std::vector<std::string> errors;    ///< kinds of error that are right, if damaged
  std::string certainty;              ///< mark of the description: C, S, M, T or ?
  std::vector<std::string> features,  ///< ids of features.h
      sections;                       ///< of codec/bitstream.md
  std::string rate;                   ///< frames per second as in fap/rate_text.h; empty: no plane
  int planes = 0,                     ///< all of them
      intra_planes = 0;               ///< of them
  int largest_alphabet = 0;           ///< see StreamFacts
  std::int64_t largest_plane_bits = 0;  ///< see StreamFacts
  /// Switches for writing the stream again from `parameters`: none, intra or all.
  std::string plane_start_codes = "none";
  bool old_codes = false;       ///< likewise
  std::vector<CaseFile> files;  ///< all but case.json itself

  /// The file of a role; nullptr: there is none.
  const CaseFile* file(std::string_view role) const {
    for (const CaseFile& one : files) {
      if (one.role == role) return &one;
    }
    return nullptr;
  }
};

/// Extension of the file with a role in a case named X: X.fba, X.dec.fap ... Of damaged cases
/// the face and body are X.intact.fap and X.intact.bap: the planes that can be had.
std::string extension_of_role(std::string_view role, bool damaged);
/// All roles, in the order of case.json.
const std::vector<std::string>& file_roles();

/// Reads a case.json. Errors: syntax (no JSON, a member missing or of another type; a name that is
/// none of a file: empty, longer than 200 bytes, with a control character, / or \, or - at its
/// beginning); the message names the member.
Result<Case> read_case(std::string_view json);

/// The text of case.json, always the same for the same case.
std::string write_case(const Case& one);

}  // namespace animeme::conformance
