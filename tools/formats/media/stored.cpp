#include "tools/formats/media/stored.h"

#include <span>
#include <utility>
#include <vector>

#include "tools/formats/media/container.h"
#include "tools/formats/media/detail/sound/coded_packets.h"
#include "tools/formats/media/detail/tracks/packet_store.h"

namespace animeme::media {

Result<std::optional<fba::UnitReader>> store_face(const std::string& path) {
  Result<PacketStore> made = PacketStore::make();
  if (!made) return made.error();
  const auto store = std::make_shared<PacketStore>(std::move(*made));
  std::vector<std::uint8_t> config;
  const auto summary = stream_face(
      path, [&](const fba::AccessUnit& unit, std::span<const std::uint8_t> told) -> Result<void> {
        config.assign(told.begin(), told.end());
        return store->add({0, unit.duration, 0, unit.intra}, unit.bytes);
      });
  if (!summary) return summary.error();
  if (!*summary || (*summary)->start < 0) return std::optional<fba::UnitReader>();
  struct Place {
    std::int64_t time;
    const std::int64_t start;
  };
  const auto place = std::make_shared<Place>(Place{0, (*summary)->start});
  fba::UnitSource source;
  source.rewind = [store, place]() -> Result<void> {
    place->time = place->start;
    return store->rewind();
  };
  source.next = [store, place](fba::AccessUnit& unit) -> Result<bool> {
    PacketStore::Head head;
    const Result<bool> more = store->next(head, unit.bytes);
    if (!more || !*more) return more;
    unit.time = place->time;
    unit.duration = head.duration;
    unit.intra = head.sync;
    place->time += head.duration;
    return true;
  };
  auto reader = fba::UnitReader::open(std::move(config), (*summary)->timescale, std::move(source));
  if (!reader) return reader.error();
  return std::optional(std::move(*reader));
}

struct StoredAudio::Impl {
  EncodedAudio head;  // without its packets
  PacketStore store;
  std::int64_t bit_rate = 0;
  AudioPacket packet;
};

StoredAudio::StoredAudio(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
StoredAudio::StoredAudio(StoredAudio&&) noexcept = default;
StoredAudio& StoredAudio::operator=(StoredAudio&&) noexcept = default;
StoredAudio::~StoredAudio() = default;

Result<StoredAudio> StoredAudio::read(const std::string& path) {
  Result<PacketStore> store = PacketStore::make();
  if (!store) return store.error();
  double bytes = 0, samples = 0;
  Result<EncodedAudio> head = read_coded_packets(path, [&](AudioPacket packet) -> Result<void> {
    bytes += double(packet.bytes.size());
    samples += double(packet.duration);
    return store->add({packet.time, packet.duration, 0, true}, packet.bytes);
  });
  if (!head) return head.error();
  if (auto done = store->rewind(); !done) return done.error();
  auto impl = std::make_unique<Impl>(Impl{std::move(*head), std::move(*store), 0, {}});
  if (samples > 0) {
    impl->bit_rate = std::int64_t(bytes * 8 * impl->head.format.sample_rate / samples);
  }
  return StoredAudio(std::move(impl));
}

const AudioFormat& StoredAudio::format() const { return impl_->head.format; }
std::int64_t StoredAudio::length() const { return impl_->head.length; }
std::int64_t StoredAudio::bit_rate() const { return impl_->bit_rate; }
Result<void> StoredAudio::rewind() { return impl_->store.rewind(); }

Result<const AudioPacket*> StoredAudio::next() {
  PacketStore::Head head;
  const Result<bool> more = impl_->store.next(head, impl_->packet.bytes);
  if (!more) return more.error();
  if (!*more) return nullptr;
  impl_->packet.time = head.time;
  impl_->packet.duration = head.duration;
  return &impl_->packet;
}

}  // namespace animeme::media
