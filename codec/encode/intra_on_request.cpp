#include "codec/encode/intra_on_request.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include "codec/decode/plane_header.h"
#include "codec/encode/splice.h"
#include "codec/encode/unit_decoder_internal.h"

namespace animeme::fba {

namespace {

template <class Settings>
bool sends_all(const std::shared_ptr<const Settings>& settings) {
  return !settings ||
         std::all_of(settings->send_range.begin(), settings->send_range.end(), std::identity());
}

// An intra plane that depends on nothing before it.
bool is_independent(const Plane& plane) {
  return plane.intra && sends_all(plane.face_settings) && sends_all(plane.body_settings);
}

}  // namespace

struct IntraOnRequest::Impl {
  internal::UnitDecoder decoder;
  std::optional<Splicer> splicer;
  bool recoding = false;

  // Nothing is known of what receivers have.
  void lose() {
    splicer.reset();
    recoding = false;
  }

  std::optional<std::vector<std::uint8_t>> code(const Plane& plane) {
    if (!splicer->copy(plane)) return std::nullopt;
    const std::vector<std::uint8_t> bytes = splicer->take();
    const auto unit = internal::without_object(bytes);
    return std::vector<std::uint8_t>(unit.begin(), unit.end());
  }
};

IntraOnRequest::IntraOnRequest() : impl_(std::make_unique<Impl>()) {}
IntraOnRequest::IntraOnRequest(IntraOnRequest&&) noexcept = default;
IntraOnRequest& IntraOnRequest::operator=(IntraOnRequest&&) noexcept = default;
IntraOnRequest::~IntraOnRequest() = default;

std::optional<RecodedUnit> IntraOnRequest::pass(std::span<const std::uint8_t> unit, bool wanted) {
  if (internal::begins_object(unit))
    impl_->lose();  // another stream, or the same from its beginning
  Plane plane;
  if (!impl_->decoder.decode(unit, plane)) {
    impl_->lose();
    return std::nullopt;
  }
  if (!impl_->splicer) {
    if (!plane.intra) return std::nullopt;
    impl_->splicer.emplace(StreamOptions{PlaneStartCodes::all});
  }
  if (is_independent(plane)) impl_->recoding = false;
  const bool answers = wanted && !is_independent(plane);
  if (!impl_->recoding && !answers) {
    impl_->splicer->pass(plane);
    return std::nullopt;
  }
  if (answers) impl_->splicer->refresh();
  impl_->recoding = true;
  std::optional<std::vector<std::uint8_t>> bytes = impl_->code(plane);
  const auto header = bytes ? read_plane_header(*bytes) : std::nullopt;
  if (!header) {
    impl_->lose();
    return std::nullopt;
  }
  return RecodedUnit{std::move(*bytes), header->intra};
}

}  // namespace animeme::fba
