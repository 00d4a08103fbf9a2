#include "codec/encode/intra_on_request.h"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <utility>

#include "codec/decode/decoder.h"
#include "codec/decode/plane_header.h"
#include "codec/encode/splice.h"

namespace animeme::fba {

namespace {

constexpr std::array<std::uint8_t, 3> kPrefix = {0, 0, 1};  // of any start code

bool begins_with_code(std::span<const std::uint8_t> bytes) {
  return bytes.size() > kPrefix.size() && std::equal(kPrefix.begin(), kPrefix.end(), bytes.begin());
}

bool begins_object(std::span<const std::uint8_t> bytes) {
  return begins_with_code(bytes) && is_object_start((kPlaneStart & ~0xFFU) | bytes[kPrefix.size()]);
}

template <class Settings>
bool sends_all(const std::shared_ptr<const Settings>& settings) {
  return !settings || std::ranges::all_of(settings->send_range, std::identity());
}

// An intra plane that depends on nothing before it.
bool is_independent(const Plane& plane) {
  return plane.intra && sends_all(plane.face_settings) && sends_all(plane.body_settings);
}

// The unit of a splicer that begins here: an object start code stands before its plane.
std::span<const std::uint8_t> without_object(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kCodeAndStuffing = 5;
  const bool object = begins_object(bytes);
  return object && bytes.size() > kCodeAndStuffing ? bytes.subspan(kCodeAndStuffing) : bytes;
}

}  // namespace

struct IntraOnRequest::Impl {
  Decoder decoder;
  bool ahead = false;  // the prefix of the next unit was pushed
  std::optional<Splicer> splicer;
  bool recoding = false;

  // A decoder wants to see what stands behind a plane; all units begin with a start code.
  std::optional<Plane> decode(std::span<const std::uint8_t> unit) {
    if (!begins_with_code(unit)) return std::nullopt;
    decoder.push(ahead ? unit.subspan(kPrefix.size()) : unit);
    decoder.push(kPrefix);
    ahead = true;
    std::optional<Plane> plane;
    for (;;) {
      Result<Event> event = decoder.next();
      if (event && event->kind == Event::Kind::plane) plane = std::move(event->plane);
      if (event) continue;
      const Code code = event.error().code;
      if (code == Code::need_data) return plane;
      plane.reset();
      if (code == Code::end_of_stream) return plane;
    }
  }

  // Nothing is known of what receivers have.
  void lose() {
    splicer.reset();
    recoding = false;
  }

  std::optional<std::vector<std::uint8_t>> code(const Plane& plane) {
    if (!splicer->copy(plane)) return std::nullopt;
    const std::vector<std::uint8_t> bytes = splicer->take();
    const auto unit = without_object(bytes);
    return std::vector<std::uint8_t>(unit.begin(), unit.end());
  }
};

IntraOnRequest::IntraOnRequest() : impl_(std::make_unique<Impl>()) {}
IntraOnRequest::IntraOnRequest(IntraOnRequest&&) noexcept = default;
IntraOnRequest& IntraOnRequest::operator=(IntraOnRequest&&) noexcept = default;
IntraOnRequest::~IntraOnRequest() = default;

std::optional<RecodedUnit> IntraOnRequest::pass(std::span<const std::uint8_t> unit, bool wanted) {
  if (begins_object(unit)) impl_->lose();  // another stream, or the same from its beginning
  const std::optional<Plane> plane = impl_->decode(unit);
  if (!plane) {
    impl_->lose();
    return std::nullopt;
  }
  if (!impl_->splicer) {
    if (!plane->intra) return std::nullopt;
    impl_->splicer.emplace(StreamOptions{PlaneStartCodes::all});
  }
  if (is_independent(*plane)) impl_->recoding = false;
  const bool answers = wanted && !is_independent(*plane);
  if (!impl_->recoding && !answers) {
    impl_->splicer->pass(*plane);
    return std::nullopt;
  }
  if (answers) impl_->splicer->refresh();
  impl_->recoding = true;
  std::optional<std::vector<std::uint8_t>> bytes = impl_->code(*plane);
  const auto header = bytes ? read_plane_header(*bytes) : std::nullopt;
  if (!header) {
    impl_->lose();
    return std::nullopt;
  }
  return RecodedUnit{std::move(*bytes), header->intra};
}

}  // namespace animeme::fba
