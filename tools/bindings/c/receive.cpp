// Frame by frame: what a receiver shows, visemes as low-level FAPs, ARKit weights.
#include <algorithm>

#include "fap/arkit.h"
#include "fap/expand.h"
#include "fap/receiver.h"
#include "tools/bindings/c/c_internal.h"

using namespace animeme;

struct animeme_receiver {
  fap::Receiver receiver;
};

struct animeme_arkit {
  fap::ArkitFitter fitter;
};

animeme_status animeme_receiver_new(uint32_t flags, animeme_receiver** receiver,
                                    animeme_error* error) {
  if (receiver == nullptr) return c::invalid(error, "receiver is NULL");
  *receiver = nullptr;
  fap::FillOptions options;
  if (!c::fill_options(flags, options)) return c::invalid(error, "these are not ANIMEME_FILL_...");
  return c::guarded(error, [&]() -> animeme_status {
    return c::give(receiver,
                   std::make_unique<animeme_receiver>(animeme_receiver{fap::Receiver(options)}));
  });
}

void animeme_receiver_free(animeme_receiver* receiver) { delete receiver; }

animeme_status animeme_receiver_next(animeme_receiver* receiver, const animeme_frame* frame,
                                     animeme_frame* shown, animeme_error* error) {
  if (receiver == nullptr) return c::invalid(error, "receiver is NULL");
  if (!c::writable(shown, error)) return ANIMEME_INVALID_ARGUMENT;
  return c::guarded(error, [&]() -> animeme_status {
    fap::Receiver& state = receiver->receiver;
    if (frame == nullptr) {
      c::put_frame(shown, fap::with_mask(state.hold(), state.mask()));
      return ANIMEME_OK;
    }
    fap::Frame taken;
    fap::GroupRules rules;
    const auto status = c::take_frame(frame, taken, &rules, error);
    if (status != ANIMEME_OK) return status;
    animeme_frame given;
    c::take(*frame, given, animeme_frame{});
    const c::FrameTimes times{given.flags, given.seconds, {given.rate_num, given.rate_den}};
    const fap::Frame& held = state.receive(taken, rules);
    c::put_frame(shown, fap::with_mask(held, state.mask()), {}, times);
    return status;
  });
}

animeme_status animeme_expand(const animeme_frame* frame, animeme_frame* expanded,
                              animeme_error* error) {
  if (!c::writable(expanded, error)) return ANIMEME_INVALID_ARGUMENT;
  return c::guarded(error, [&]() -> animeme_status {
    fap::Frame taken;
    const auto status = c::take_frame(frame, taken, nullptr, error);
    if (status == ANIMEME_OK) c::put_frame(expanded, fap::low_level(taken));
    return status;
  });
}

animeme_status animeme_arkit_new(animeme_arkit** arkit, animeme_error* error) {
  if (arkit == nullptr) return c::invalid(error, "arkit is NULL");
  *arkit = nullptr;
  return c::guarded(error, [&] { return c::give(arkit, std::make_unique<animeme_arkit>()); });
}

void animeme_arkit_free(animeme_arkit* arkit) { delete arkit; }

animeme_status animeme_arkit_fit(animeme_arkit* arkit, const animeme_frame* frame, float* weights,
                                 size_t count, animeme_error* error) {
  if (arkit == nullptr) return c::invalid(error, "arkit is NULL");
  if (weights == nullptr) return c::invalid(error, "weights is NULL");
  if (count < ANIMEME_ARKIT_SHAPES) return c::invalid(error, "there is room for too few weights");
  return c::guarded(error, [&]() -> animeme_status {
    fap::Frame taken;
    const auto status = c::take_frame(frame, taken, nullptr, error);
    if (status != ANIMEME_OK) return status;
    const fap::ArkitFrame fitted = arkit->fitter.fit(taken);
    for (std::size_t i = 0; i < std::min(count, fitted.size()); ++i) weights[i] = float(fitted[i]);
    return status;
  });
}

animeme_status animeme_arkit_to_frame(const float* weights, size_t count, animeme_frame* frame,
                                      animeme_error* error) {
  if (weights == nullptr) return c::invalid(error, "weights is NULL");
  if (!c::writable(frame, error)) return ANIMEME_INVALID_ARGUMENT;
  return c::guarded(error, [&]() -> animeme_status {
    fap::ArkitFrame all{};
    for (std::size_t i = 0; i < std::min(count, all.size()); ++i) all[i] = double(weights[i]);
    c::put_frame(frame, fap::arkit_to_fap(all, fap::kAllArkit));
    return ANIMEME_OK;
  });
}
