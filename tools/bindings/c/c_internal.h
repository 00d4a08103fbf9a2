// What the functions of the C interface share: failures, structs that grow, frames. Not installed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <string_view>
#include <vector>

#include "codec/decode/decoder.h"
#include "fap/fill.h"
#include "fap/frame.h"
#include "fap/result.h"
#include "tools/bindings/c/animeme.h"

/// A clip: frames, and what their absent FAPs do (one entry a frame).
struct animeme_clip {
  animeme::fap::Sequence sequence;
  std::vector<animeme::fap::GroupRules> rules;
};

namespace animeme::c {

/// The number of a failure in animeme.h.
animeme_status status_of(Code code);

/// Writes a failure; `error` may be null. Allocates nothing.
animeme_status fail(animeme_error* error, animeme_status status, std::string_view message);
/// The same of the library's own.
animeme_status fail(animeme_error* error, const Error& from);
/// "<name> is NULL" and the like.
animeme_status invalid(animeme_error* error, std::string_view message);

/// Runs the body of a function: what is thrown becomes a status.
template <class Body>
animeme_status guarded(animeme_error* error, Body body) noexcept {
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return fail(error, ANIMEME_NO_MEMORY, "there is no more memory");
  } catch (const std::exception& thrown) {
    return fail(error, ANIMEME_INTERNAL, thrown.what());
  } catch (...) {
    return fail(error, ANIMEME_INTERNAL, "something was thrown");
  }
}

/// Gives out a new handle, or bytes below.
template <class Handle>
animeme_status give(Handle** out, std::unique_ptr<Handle> handle) {
  *out = handle.release();
  return ANIMEME_OK;
}

/// A copy for animeme_free(), with a 0 behind it.
template <class Byte, class Container>
animeme_status give_copy(Byte** out, std::size_t* size, const Container& bytes) {
  auto* copy = static_cast<Byte*>(std::malloc(bytes.size() + 1));
  if (copy == nullptr) throw std::bad_alloc();
  if (!bytes.empty()) std::memcpy(copy, bytes.data(), bytes.size());
  copy[bytes.size()] = 0;
  *out = copy;
  if (size != nullptr) *size = bytes.size();
  return ANIMEME_OK;
}

/// The first version's size of each struct: callers cannot have less.
inline constexpr std::size_t kFirstSize = 2 * sizeof(std::uint32_t);

/// Sets a struct to `value`, as much of it as the caller has room for, and zeros behind.
template <class Struct>
void put(Struct* out, std::size_t size, Struct value) {
  value.size = std::uint32_t(size);
  std::memcpy(static_cast<void*>(out), &value, size < sizeof value ? size : sizeof value);
  if (size > sizeof value) {
    std::memset(reinterpret_cast<unsigned char*>(out) + sizeof value, 0, size - sizeof value);
  }
}

/// What the `..._init` functions do.
template <class Struct>
void init(Struct* out, std::size_t size, const Struct& value) {
  if (out != nullptr && size >= kFirstSize && size <= 0xFFFFFFFFU) put(out, size, value);
}

/// A caller's struct in today's form: members that it does not have are those of `defaults`.
/// False: its size cannot be, or it has something set that this library does not know.
template <class Struct>
bool take(const Struct& given, Struct& out, const Struct& defaults) {
  const std::size_t size = given.size;
  if (size < kFirstSize) return false;
  out = defaults;
  std::memcpy(static_cast<void*>(&out), &given, size < sizeof out ? size : sizeof out);
  const auto* bytes = reinterpret_cast<const unsigned char*>(&given);
  for (std::size_t at = sizeof out; at < size; ++at) {
    if (bytes[at] != 0) return false;
  }
  return true;
}

/// A frame as the library has it. The failure names what is not one.
animeme_status take_frame(const animeme_frame* given, fap::Frame& frame, fap::GroupRules* rules,
                          animeme_error* error);
/// True if frames can be written there; else the failure is written.
bool writable(const animeme_frame* frame, animeme_error* error);
/// What a frame of animeme.h has besides.
struct FrameTimes {
  std::uint32_t flags = 0;
  double seconds = 0;
  fap::Rate rate{0, 0};
};

/// Writes a frame, which must be writable().
void put_frame(animeme_frame* out, const fap::Frame& frame, const fap::GroupRules& rules,
               const FrameTimes& times);
/// The same without times.
void put_frame(animeme_frame* out, const fap::Frame& frame, const fap::GroupRules& rules = {});

/// What the absent FAPs of a plane do.
fap::GroupRules rules_of(const fba::Plane& plane);

/// FillOptions of ANIMEME_FILL_...; false: unknown flags.
bool fill_options(std::uint32_t flags, fap::FillOptions& options);

}  // namespace animeme::c
