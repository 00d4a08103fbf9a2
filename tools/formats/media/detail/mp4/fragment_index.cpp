#include "tools/formats/media/detail/mp4/fragment_index.h"

#include <algorithm>

#include "tools/formats/media/detail/mp4/box_writer.h"

namespace animeme::media {
namespace {

constexpr std::size_t kMostEntries = 65535;
constexpr std::uint64_t kLargestEntry = 0x7FFFFFFF;
constexpr std::uint32_t kNoSync = 0x10000;            // in the flags of a sample
constexpr std::uint32_t kStartsWithSap = 0x90000000;  // SAP of type 1: a sync sample

/// Fields of a full box.
class Fields : public WireReader {
 public:
  Fields(Bytes bytes, const Box& box)
      : WireReader(bytes.subspan(box.begin, box.end - box.begin)),
        version_(u8()),
        flags_(std::uint32_t(get(3))) {}

  /// Wide in version 1.
  std::uint64_t time() { return get(version_ == 1 ? 8 : 4); }
  bool has(std::uint32_t flag) const { return (flags_ & flag) != 0; }
  std::uint32_t u32_if(std::uint32_t flag, std::uint32_t other) {
    return has(flag) ? u32() : other;
  }
  unsigned version() const { return version_; }

 private:
  unsigned version_;
  std::uint32_t flags_;
};

/// Of mvhd or mdhd.
std::uint32_t timescale_of(Bytes moov, const Box& header) {
  Fields fields(moov, header);
  fields.time();  // made
  fields.time();  // changed
  return std::max<std::uint32_t>(1, fields.u32());
}

/// From media time to presentation by an edit list: empty edits delay, the first other one says
/// where it begins.
std::int64_t shift_of(Bytes moov, const Box& elst, std::uint32_t timescale, std::uint32_t movie) {
  Fields fields(moov, elst);
  std::int64_t delay = 0;
  for (std::uint32_t left = fields.u32(); left > 0 && !fields.failed(); --left) {
    const auto length = std::int64_t(fields.time());
    const std::uint64_t start = fields.time();
    const bool empty = start == (fields.version() == 1 ? ~std::uint64_t(0) : 0xFFFFFFFF);
    if (!empty) return delay - std::int64_t(start);
    delay += (length * timescale + movie / 2) / movie;
    fields.u32();  // rate
  }
  return delay;
}

/// Calls `visit` for the boxes of this path below `parent`.
template <class Visit>
void at_path(Bytes bytes, const Box& parent, std::string_view path, const Visit& visit) {
  for_each_box(bytes, parent.begin, parent.end, [&](const Box& box) {
    if (box.type != path.substr(0, 4)) return;
    path.size() > 4 ? at_path(bytes, box, path.substr(5), visit) : visit(box);
  });
}

}  // namespace

FragmentIndex::FragmentIndex(Bytes moov) {
  const Box whole = box_at(moov, 0, moov.size());
  at_path(moov, whole, "mvhd", [&](const Box& box) { movie_timescale_ = timescale_of(moov, box); });
  at_path(moov, whole, "trak", [&](const Box& box) { add_track(moov, box); });
  at_path(moov, whole, "mvex/trex", [&](const Box& box) {
    Fields fields(moov, box);
    const std::uint32_t id = fields.u32();
    fields.u32();  // sample description
    for (Track& track : tracks_) {
      if (track.id != id) continue;
      track.default_duration = fields.u32();
      fields.u32();  // size
      track.default_flags = fields.u32();
    }
  });
}

void FragmentIndex::add_track(Bytes moov, const Box& trak) {
  Track track;
  track.id = track_id(moov, trak);
  at_path(moov, trak, "mdia/mdhd",
          [&](const Box& box) { track.timescale = timescale_of(moov, box); });
  at_path(moov, trak, "edts/elst", [&](const Box& box) {
    track.shift = shift_of(moov, box, track.timescale, movie_timescale_);
  });
  tracks_.push_back(std::move(track));
}

void FragmentIndex::add(Bytes moof, std::uint64_t size) {
  sizes_.push_back(size);
  for (Track& track : tracks_) track.parts.emplace_back();
  at_path(moof, box_at(moof, 0, moof.size()), "traf",
          [&](const Box& traf) { add_part(moof, traf); });
}

void FragmentIndex::add_part(Bytes moof, const Box& traf) {
  Track* track = nullptr;
  std::uint32_t duration = 0, flags = 0;
  std::int64_t time = 0;
  for_each_box(moof, traf.begin, traf.end, [&](const Box& box) {
    Fields fields(moof, box);
    if (box.type == "tfhd") {
      const std::uint32_t id = fields.u32();
      for (Track& each : tracks_) track = each.id == id ? &each : track;
      if (track == nullptr) return;
      if (fields.has(0x1)) fields.get(8);  // where the data is
      fields.u32_if(0x2, 0);               // sample description
      duration = fields.u32_if(0x8, track->default_duration);
      fields.u32_if(0x10, 0);  // size
      flags = fields.u32_if(0x20, track->default_flags);
    } else if (box.type == "tfdt") {
      time = std::int64_t(fields.time());
    } else if (box.type == "trun" && track != nullptr) {
      const std::uint32_t count = fields.u32();
      fields.u32_if(0x1, 0);  // where the data is
      std::uint32_t first = fields.u32_if(0x4, flags);
      Part& part = track->parts.back();
      const bool begins = !part.there;
      part.there = true;
      if (begins) part.begin = std::max<std::int64_t>(0, time + track->shift);
      for (std::uint32_t i = 0; i < count && !fields.failed(); ++i) {
        time += fields.u32_if(0x100, duration);
        fields.u32_if(0x200, 0);  // size
        const std::uint32_t own = fields.u32_if(0x400, flags);
        if (i == 0 && !fields.has(0x4)) first = own;
        fields.u32_if(0x800, 0);  // presentation against decoding
      }
      if (begins) part.sync = (first & kNoSync) == 0;
      track->end = std::max(track->end, time + track->shift);
    }
  });
}

std::uint64_t FragmentIndex::duration() const {
  std::uint64_t longest = 0;
  for (const Track& track : tracks_) {
    const auto ticks = std::uint64_t(track.end), scale = std::uint64_t(track.timescale);
    longest = std::max(longest, ticks / scale * movie_timescale_ +
                                    (ticks % scale * movie_timescale_ + scale - 1) / scale);
  }
  return longest;
}

std::vector<std::uint8_t> FragmentIndex::boxes() const {
  const bool large = std::any_of(sizes_.begin(), sizes_.end(),
                                 [](std::uint64_t size) { return size > kLargestEntry; });
  if (sizes_.empty() || sizes_.size() > kMostEntries || large) return {};
  constexpr std::size_t kHead = 40, kEntry = 12;
  const std::size_t box_size = kHead + kEntry * sizes_.size();
  std::size_t behind = box_size * tracks_.size();  // from the begin of a box to the fragments
  BoxWriter out;
  for (const Track& track : tracks_) {
    behind -= box_size;
    // A fragment without the track begins where the next one with it does.
    std::vector<std::int64_t> begins(sizes_.size() + 1, track.end);
    for (std::size_t i = sizes_.size(); i-- > 0;) {
      begins[i] = track.parts[i].there ? track.parts[i].begin : begins[i + 1];
    }
    out.begin_full("sidx", 1, 0);
    out.u32({track.id, track.timescale});
    out.u64(std::uint64_t(begins[0]));
    out.u64(behind);
    out.u16(0);
    out.u16(unsigned(sizes_.size()));
    for (std::size_t i = 0; i < sizes_.size(); ++i) {
      out.u32({sizes_[i], std::uint64_t(begins[i + 1] - begins[i]),
               track.parts[i].sync ? kStartsWithSap : 0});
    }
    out.end();
  }
  return out.bytes();
}

}  // namespace animeme::media
