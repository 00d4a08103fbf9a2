#include <atomic>

#include "codec/decode/decoder_internal.h"

namespace animeme::fba {

namespace {

constexpr std::size_t kWorthForgetting = 64;  // bytes; the buffer of a live stream stays this small

// What planes share is written again in place where no plane has it any more, so that a stream that
// is shown as it comes needs no memory for each.
template <class Shared>
void renew(std::shared_ptr<Shared>& shared, const Shared& value) {
  if (shared.use_count() == 1) {
    std::atomic_thread_fence(std::memory_order_acquire);  // behind what others did with it
    *shared = value;
  } else {
    shared = std::make_shared<Shared>(value);
  }
}

}  // namespace

void Decoder::Impl::warn(std::string text, std::size_t bit) {
  Event& event = waiting.emplace_back();
  event.kind = Event::Kind::warning;
  event.text = std::move(text);
  event.bit = stream_bit(bit);
}

void Decoder::Impl::tell_info() {
  Event& event = waiting.emplace_back();
  event.kind = Event::Kind::info;
  event.info = info;
  event.bit = stream_bit(position);
  info = {};
  info_told = true;
}

void Decoder::Impl::lose() {
  phase = Phase::lost;
  state.face.coding.valid = false;
  state.body.coding.valid = false;
}

Error Decoder::Impl::at_end(Code code, std::string message) {
  spoken = true;
  return error_at_bit(code, std::move(message), end_bit);
}

Error Decoder::Impl::at(Code code, std::string message, std::size_t bit) {
  spoken = true;
  lose();
  return error_at_bit(code, std::move(message), stream_bit(bit));
}

void Decoder::Impl::trim() {
  const std::size_t bytes = position / 8;
  if (bytes < kWorthForgetting || bytes < buffer.size() / 2 || parsed.begun()) return;
  buffer.erase(buffer.begin(), buffer.begin() + std::ptrdiff_t(bytes));
  if (buffer.capacity() > 8 * internal::kPieceBytes && buffer.size() < internal::kPieceBytes)
    buffer.shrink_to_fit();
  position -= bytes * 8;
  dropped_bits += std::int64_t(bytes) * 8;
}

Result<bool> Decoder::Impl::advance(Plane& plane) {
  for (;;) {
    if (!waiting.empty()) return false;
    trim();
    const Result<bool> progress = step();
    if (!progress) return progress.error();
    if (!*progress) continue;
    if (const Result<void> filled = fill(plane); !filled) return filled.error();
    return true;
  }
}

Event Decoder::Impl::take_waiting() {
  Event event = std::move(waiting.front());
  waiting.erase(waiting.begin());
  return event;
}

Result<bool> Decoder::Impl::step() {
  switch (phase) {
    case Phase::headers:
      return read_header();
    case Phase::user_data:
      return skip_to(false);
    case Phase::planes:
      return read_plane();
    case Phase::lost:
      return skip_to(true);
    case Phase::ended:
      break;
  }
  if (!spoken) return at_end(Code::truncated, "the stream holds no plane");
  return error_at_bit(Code::end_of_stream, "the stream is over", end_bit);
}

Result<bool> Decoder::Impl::read_plane() {
  if (!after_start_code && !parsed.begun()) {
    Result<bool> moved = plane_border();
    if (!moved) return moved;
    // A warning is returned before the plane that follows it.
    if (*moved || !waiting.empty()) return false;
  }
  BitReader in(buffer, position);
  const Result<void> done = internal::parse_plane(in, state, finished, parsed);
  if (!done) {
    Error error = done.error();
    if (error.code == Code::need_data) return error;
    const bool started = after_start_code;
    after_start_code = false;
    // The next start code lies behind the header of this plane at the earliest.
    const std::size_t bit = error.where.bit >= 0 ? std::size_t(error.where.bit) : position;
    if (started) position += 8;
    return at(error.code, std::move(error.message), bit);
  }
  plane_begin = position;
  plane_end = in.position();
  had_start_code = after_start_code;
  after_start_code = first_plane = false;
  position = plane_end;
  if (!parsed.settled) warn(std::string(internal::kUnsettled), plane_begin);
  return true;
}

Result<void> Decoder::Impl::fill(Plane& plane) {
  plane.intra = parsed.intra;
  plane.object_mask = last_mask = parsed.object_mask;
  plane.temporal = parsed.temporal;
  plane.start_code = had_start_code;
  plane.bit_begin = stream_bit(plane_begin);
  plane.bit_end = stream_bit(plane_end);
  tell_time(plane);
  spoken = true;

  const bool with_body = has_body(plane.object_mask);
  if (with_body) {
    renew(body, BodyFrame{});
    body->number = plane.number;
  }
  const Result<void> applied = internal::apply_plane(parsed, state, plane.face, body.get());
  if (!applied) return at(applied.error().code, applied.error().message, plane_begin);
  if (has_face(plane.object_mask)) {
    if (plane.intra) renew(face_settings, state.face_settings);
    plane.face_settings = face_settings;
  }
  if (with_body) {
    if (plane.intra) renew(body_settings, state.body_settings);
    plane.body_settings = body_settings;
    plane.body = body;
  }
  return {};
}

void Decoder::Impl::tell_time(Plane& plane) {
  const double now = clock + rate.seconds(double(number - clock_number));
  const TemporalHeader& temporal = parsed.temporal;
  if (temporal.rate || temporal.time_code) {
    clock = now;
    clock_number = number;
  }
  if (temporal.rate) rate = temporal.rate->rate();
  if (temporal.time_code) {
    const TimeCode& code = *temporal.time_code;
    clock = code.hours * 3600.0 + code.minutes * 60.0 + code.seconds;
  }
  plane.number = number;
  plane.face.number = number;
  plane.rate = rate;
  plane.seconds = clock + rate.seconds(double(number - clock_number));
  number += 1 + std::int64_t(temporal.skip.value_or(0));
}

Decoder::Decoder() : impl_(std::make_unique<Impl>()) {}
Decoder::Decoder(const Decoder& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
Decoder& Decoder::operator=(const Decoder& other) {
  impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}
Decoder::Decoder(Decoder&&) noexcept = default;
Decoder& Decoder::operator=(Decoder&&) noexcept = default;
Decoder::~Decoder() = default;

void Decoder::push(std::span<const std::uint8_t> bytes) {
  if (impl_->finished) return;
  impl_->buffer.insert(impl_->buffer.end(), bytes.begin(), bytes.end());
}

void Decoder::finish() { impl_->finished = true; }

Result<Event> Decoder::next() {
  Result<Event> event{Event{}};
  const Result<bool> plane = impl_->advance(event->plane);
  if (!plane) return plane.error();
  if (!*plane) return impl_->take_waiting();
  event->bit = event->plane.bit_begin;
  return event;
}

}  // namespace animeme::fba
