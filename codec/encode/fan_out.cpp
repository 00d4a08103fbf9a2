#include "codec/encode/fan_out.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "codec/decode/plane_header.h"
#include "codec/encode/splice.h"
#include "codec/encode/unit_decoder_internal.h"

namespace animeme::fba {

namespace {

// Receivers that have had the same units since their last intra plane.
struct Group {
  Splicer splicer;
  std::vector<std::uint8_t> bytes;
  bool intra = false;
  ObjectMask mask = ObjectMask::nothing;  // of the unit
  std::size_t receivers = 0;

  // Takes what the splicer has written; false: nothing.
  bool take() {
    const std::vector<std::uint8_t> written = splicer.take();
    const auto unit = internal::without_object(written);
    const auto header = read_plane_header(unit);
    if (!header) return false;
    bytes.assign(unit.begin(), unit.end());
    intra = header->intra;
    mask = header->object_mask;
    return true;
  }
};

}  // namespace

struct FanOut::Impl {
  std::size_t most = 1;
  internal::UnitDecoder decoder;
  std::optional<Splicer> source;           // has seen the source and writes nothing
  std::uint32_t skip = 0;                  // of the newest plane
  ObjectMask coded = ObjectMask::nothing;  // by any plane of the source so far: face, body
  std::vector<std::uint8_t> unit;          // of the source
  bool unit_is_intra = false;
  std::vector<std::unique_ptr<Group>> groups;
  std::map<Receiver, Group*> group_of;
  Group* fresh = nullptr;  // of receivers that began with the newest unit

  void lose() {
    source.reset();
    coded = ObjectMask::nothing;
    group_of.clear();
    groups.clear();
    fresh = nullptr;
  }

  // Receivers of `from` go on with `to`, or begin anew.
  void replace(Group* from, Group* to) {
    for (auto at = group_of.begin(); at != group_of.end();) {
      if (at->second != from) {
        ++at;
      } else if (to != nullptr) {
        at->second = to;
        ++to->receivers;
        ++at;
      } else {
        at = group_of.erase(at);
      }
    }
    from->receivers = 0;
  }
  void remove_empty() {
    std::erase_if(groups, [](const auto& group) { return group->receivers == 0; });
  }

  void code(const Plane& plane, bool another) {
    remove_empty();
    const bool together = groups.size() > most && plane.intra;
    for (const auto& group : groups) {
      if (another) group->splicer.begin_source();
      if (together) group->splicer.refresh();
      if (!group->splicer.copy(plane) || !group->take()) replace(group.get(), nullptr);
    }
    remove_empty();
    // The same intra plane of all that is coded makes all encoders the same.
    for (std::size_t i = 0; i < groups.size(); ++i) {
      const bool all = groups[i]->intra && groups[i]->mask == coded;
      for (std::size_t k = 0; k < i && all; ++k) {
        if (groups[k]->receivers == 0 || groups[k]->bytes != groups[i]->bytes) continue;
        replace(groups[i].get(), groups[k].get());
        break;
      }
    }
    remove_empty();
  }

  Group* begin() {
    if (fresh != nullptr) return fresh;
    Splicer splicer = source->fork();
    splicer.avoid_intra();
    auto group = std::make_unique<Group>(Group{.splicer = std::move(splicer), .bytes = {}});
    if (!group->splicer.copy_last(skip) || !group->take() || !group->intra) return nullptr;
    fresh = group.get();
    groups.push_back(std::move(group));
    return fresh;
  }
};

FanOut::FanOut(std::size_t most_encoders) : impl_(std::make_unique<Impl>()) {
  impl_->most = std::max<std::size_t>(1, most_encoders);
}
FanOut::FanOut(FanOut&&) noexcept = default;
FanOut& FanOut::operator=(FanOut&&) noexcept = default;
FanOut::~FanOut() = default;

void FanOut::push(std::span<const std::uint8_t> unit) {
  Impl& self = *impl_;
  self.fresh = nullptr;
  self.unit.assign(unit.begin(), unit.end());
  Plane plane;
  const bool decoded = self.decoder.decode(unit, plane);
  self.unit_is_intra = decoded && plane.intra;
  if (!decoded || (!self.source && !plane.intra)) return self.lose();
  const bool another = internal::begins_object(unit) && self.source;
  if (!self.source) self.source.emplace(StreamOptions{PlaneStartCodes::all});
  if (another) self.source->begin_source();
  self.source->pass(plane);
  self.skip = plane.temporal.skip.value_or(0);
  self.coded = ObjectMask(std::uint8_t(self.coded) | std::uint8_t(plane.object_mask));
  self.code(plane, another);
}

bool FanOut::ready() const { return impl_->source.has_value(); }

FanOut::Unit FanOut::unit_for(Receiver receiver) {
  Impl& self = *impl_;
  const auto known = self.group_of.find(receiver);
  Group* group = known != self.group_of.end() ? known->second : nullptr;
  if (group == nullptr && self.source) {
    group = self.begin();
    if (group != nullptr) {
      ++group->receivers;
      self.group_of[receiver] = group;
    }
  }
  if (group == nullptr) return {self.unit, self.unit_is_intra};
  return {group->bytes, group->intra};
}

void FanOut::forget(Receiver receiver) {
  const auto known = impl_->group_of.find(receiver);
  if (known == impl_->group_of.end()) return;
  --known->second->receivers;
  impl_->group_of.erase(known);
}

std::size_t FanOut::encoders() const { return impl_->groups.size(); }

}  // namespace animeme::fba
