// Which extensions of glTF a head may need.
#pragma once

#include "fap/result.h"
#include "tools/view/gltf/detail/json_access.h"

namespace animeme::gltf {

/// An error if a required extension is not known here, with what to export instead.
Result<void> check_extensions(const Json& root);

/// A buffer whose bytes are given only in a compressed form, which may be missing.
bool is_fallback_buffer(const Json& buffer);

/// What meshopt says of a buffer view; null: nothing.
const Json& meshopt_of(const Json& view);

/// True if the view or primitive is given in a compressed form alone.
bool is_compressed(const Json& entry);

/// What to say then.
Error compressed_error(const std::string& what);

}  // namespace animeme::gltf
