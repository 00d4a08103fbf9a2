#include "tests/readers/movie.h"

#include <algorithm>
#include <set>
#include <utility>

namespace animeme::test {
namespace {

using Size = std::size_t;

class Reader {
 public:
  explicit Reader(const BoxFile& file) : file_(file) { movie_.errors = file.errors(); }

  Movie read() {
    const std::vector<Box>& boxes = file_.root().boxes;
    if (boxes.empty() || boxes[0].type != "ftyp") fail("ftyp is not first");
    const Box* moov = file_.root().find("moov");
    const Box* mvhd = moov != nullptr ? moov->find("mvhd") : nullptr;
    if (mvhd == nullptr) {
      fail("no moov with mvhd");
      return std::move(movie_);
    }
    movie_.timescale = std::uint32_t(get(*mvhd, wide(*mvhd) ? 20 : 12, 4));
    movie_.duration = wide(*mvhd) ? get(*mvhd, 24, 8) : get(*mvhd, 16, 4);
    fragmented_ = moov->find("mvex") != nullptr;
    for (const Box* trak : moov->all("trak")) read_track(*trak);
    read_fragments(moov->find("mvex"));
    check_ids(*mvhd);
    check_data();
    return std::move(movie_);
  }

 private:
  void fail(const std::string& sentence) { movie_.errors.push_back(sentence); }
  std::uint64_t get(const Box& box, Size offset, Size count) const {
    return file_.number(box, offset, count);
  }
  bool wide(const Box& box) const { return get(box, 0, 1) == 1; }

  void read_track(const Box& trak) {
    for (const char* needed :
         {"tkhd", "mdia/mdhd", "mdia/hdlr", "mdia/minf/dinf/dref", "mdia/minf/stbl/stsd",
          "mdia/minf/stbl/stts", "mdia/minf/stbl/stsc", "mdia/minf/stbl/stsz"}) {
      if (trak.find(needed) != nullptr) continue;
      fail(std::string("a track without ") + needed);
      return;
    }
    MovieTrack track;
    const Box& tkhd = *trak.find("tkhd");
    track.id = std::uint32_t(get(tkhd, wide(tkhd) ? 20 : 12, 4));
    track.duration = wide(tkhd) ? get(tkhd, 28, 8) : get(tkhd, 20, 4);
    const Box& mdhd = *trak.find("mdia/mdhd");
    track.timescale = std::uint32_t(get(mdhd, wide(mdhd) ? 20 : 12, 4));
    track.media_duration = wide(mdhd) ? get(mdhd, 24, 8) : get(mdhd, 16, 4);
    track.handler = file_.text(*trak.find("mdia/hdlr"), 8);
    const Box& stsd = *trak.find("mdia/minf/stbl/stsd");
    if (stsd.boxes.size() != 1 || get(stsd, 4, 4) != 1) fail("stsd: not one entry");
    if (!stsd.boxes.empty()) track.entry = stsd.boxes[0].type;
    if (const Box* elst = trak.find("edts/elst")) read_edits(*elst, track);
    read_samples(*trak.find("mdia/minf/stbl"), track);
    check_durations(track);
    movie_.tracks.push_back(std::move(track));
  }

  void read_edits(const Box& elst, MovieTrack& track) {
    const Size word = wide(elst) ? 8 : 4;
    const Size entry = 2 * word + 4;
    const Size count = get(elst, 4, 4);
    if (elst.size != elst.header + 8 + count * entry) {
      fail("elst: size and count do not agree");
      return;
    }
    for (Size at = 8; track.edits.size() < count; at += entry) {
      const std::uint64_t time = get(elst, at + word, word);
      const auto narrow = std::int64_t(std::int32_t(std::uint32_t(time)));
      track.edits.push_back({get(elst, at, word), word == 8 ? std::int64_t(time) : narrow});
    }
  }

  void read_samples(const Box& table, MovieTrack& track) {
    const Box& stsz = *table.find("stsz");
    const std::uint64_t same = get(stsz, 4, 4);
    const Size count = get(stsz, 8, 4);
    if (same == 0 && stsz.size != stsz.header + 12 + 4 * count) {
      fail("stsz: size and count do not agree");
      return;
    }
    for (Size i = 0; i < count; ++i) {
      track.samples.push_back({.size = Size(same != 0 ? same : get(stsz, 12 + 4 * i, 4))});
    }
    read_times(*table.find("stts"), track);
    if (count > 0) read_places(table, track);
    if (const Box* stss = table.find("stss")) read_sync(*stss, track);
  }

  void read_times(const Box& stts, MovieTrack& track) {
    Size sample = 0;
    std::int64_t time = 0;
    for (Size i = 0; i < get(stts, 4, 4); ++i) {
      const std::uint64_t run = get(stts, 8 + 8 * i, 4);
      const auto delta = std::int64_t(get(stts, 12 + 8 * i, 4));
      if (run > track.samples.size() - sample) {
        fail("stts: more samples than stsz has");
        return;
      }
      for (std::uint64_t k = 0; k < run; ++k, ++sample, time += delta) {
        track.samples[sample].time = time;
        track.samples[sample].duration = delta;
      }
    }
    if (sample != track.samples.size()) fail("stts: fewer samples than stsz has");
  }

  void read_places(const Box& table, MovieTrack& track) {
    const Box* places = table.find("stco") != nullptr ? table.find("stco") : table.find("co64");
    if (places == nullptr) {
      fail("a track without stco or co64");
      return;
    }
    const Size word = places->type == "stco" ? 4 : 8;
    const Size chunks = get(*places, 4, 4);
    const Box& stsc = *table.find("stsc");
    const Size runs = get(stsc, 4, 4);
    Size sample = 0;
    for (Size run = 0; run < runs; ++run) {
      const Size end = run + 1 < runs ? get(stsc, 20 + 12 * run, 4) : chunks + 1;
      for (Size chunk = get(stsc, 8 + 12 * run, 4); chunk < end; ++chunk) {
        Size at = get(*places, 8 + word * (chunk - 1), word);
        for (Size k = get(stsc, 12 + 12 * run, 4); k > 0 && sample < track.samples.size(); --k) {
          track.samples[sample].offset = at;
          at += track.samples[sample++].size;
        }
      }
    }
    if (sample != track.samples.size()) fail("stsc: not all samples are in chunks");
  }

  void read_sync(const Box& stss, MovieTrack& track) {
    for (MovieSample& sample : track.samples) sample.sync = false;
    std::uint64_t last = 0;
    for (Size i = 0; i < get(stss, 4, 4); ++i) {
      const std::uint64_t number = get(stss, 8 + 4 * i, 4);
      if (number <= last || number > track.samples.size()) {
        fail("stss: sample " + std::to_string(number));
        return;
      }
      track.samples[number - 1].sync = true;
      last = number;
    }
  }

  void read_fragments(const Box* mvex) {
    std::uint64_t last = 0;
    for (const Box* moof : file_.root().all("moof")) {
      const Box* mfhd = moof->find("mfhd");
      const std::uint64_t number = mfhd != nullptr ? get(*mfhd, 4, 4) : 0;
      if (number <= last) fail("mfhd: numbers do not ascend");
      last = number;
      for (const Box* traf : moof->all("traf")) read_fragment(*moof, *traf, mvex);
    }
  }

  MovieTrack* track_of(std::uint64_t id) {
    for (MovieTrack& track : movie_.tracks) {
      if (track.id == id) return &track;
    }
    return nullptr;
  }

  struct Defaults {
    std::uint64_t duration, size, flags;
  };

  Defaults defaults_of(const Box& tfhd, const Box& trex) const {
    Defaults values{get(trex, 12, 4), get(trex, 16, 4), get(trex, 20, 4)};
    const std::uint64_t flags = get(tfhd, 1, 3);
    Size at = 8 + ((flags & 1) != 0 ? 8 : 0) + ((flags & 2) != 0 ? 4 : 0);
    const auto take = [&](std::uint64_t flag, std::uint64_t& value) {
      if ((flags & flag) == 0) return;
      value = get(tfhd, at, 4);
      at += 4;
    };
    take(0x08, values.duration);
    take(0x10, values.size);
    take(0x20, values.flags);
    return values;
  }

  void read_fragment(const Box& moof, const Box& traf, const Box* mvex) {
    const Box* tfhd = traf.find("tfhd");
    const Box* tfdt = traf.find("tfdt");
    MovieTrack* track = tfhd != nullptr ? track_of(get(*tfhd, 4, 4)) : nullptr;
    const Box* trex = nullptr;
    for (const Box* box : mvex != nullptr ? mvex->all("trex") : std::vector<const Box*>()) {
      if (track != nullptr && get(*box, 4, 4) == track->id) trex = box;
    }
    if (trex == nullptr || tfdt == nullptr) {
      fail("a fragment without tfhd, tfdt, or a track with trex");
      return;
    }
    // Without default-base-is-moof, places would count from the start of the file or from the
    // track before.
    if ((get(*tfhd, 1, 3) & 0x20001) != 0x20000) fail("tfhd: places do not count from moof");
    auto time = std::int64_t(get(*tfdt, 4, wide(*tfdt) ? 8 : 4));
    if (!track->samples.empty()) {
      const MovieSample& before = track->samples.back();
      if (time != before.time + before.duration) fail("tfdt: not where the last fragment ends");
    }
    for (const Box* trun : traf.all("trun")) {
      time = read_run(*trun, moof, defaults_of(*tfhd, *trex), time, *track);
    }
  }

  // Returns the time behind the run.
  std::int64_t read_run(const Box& trun, const Box& moof, const Defaults& defaults,
                        std::int64_t time, MovieTrack& track) {
    const std::uint64_t flags = get(trun, 1, 3);
    Size at = 8;
    const auto take = [&](std::uint64_t flag, std::uint64_t other) {
      if ((flags & flag) == 0) return other;
      at += 4;
      return get(trun, at - 4, 4);
    };
    if ((flags & 1) == 0) fail("trun: no data offset");
    Size offset = moof.start + Size(std::int32_t(std::uint32_t(take(1, 0))));
    const std::uint64_t first_flags = take(4, defaults.flags);
    for (Size i = 0; i < get(trun, 4, 4); ++i) {
      MovieSample sample{.offset = offset, .time = time};
      sample.duration = std::int64_t(take(0x100, defaults.duration));
      sample.size = Size(take(0x200, defaults.size));
      const std::uint64_t own = take(0x400, i == 0 ? first_flags : defaults.flags);
      sample.sync = (own & 0x10000) == 0;
      if (take(0x800, 0) != 0) fail("trun: shown at another time than decoded");
      offset += sample.size;
      time += sample.duration;
      track.samples.push_back(sample);
    }
    if (at != trun.size - trun.header) fail("trun: size and count do not agree");
    return time;
  }

  void check_durations(const MovieTrack& track) {
    const std::string name = "track " + std::to_string(track.id) + ": ";
    std::uint64_t sum = 0;
    for (const MovieSample& sample : track.samples) sum += std::uint64_t(sample.duration);
    if (sum != track.media_duration) fail(name + "mdhd and stts do not agree");
    std::uint64_t shown = 0;
    for (const MovieEdit& edit : track.edits) shown += edit.duration;
    // Each edit is rounded by itself; of fragments nobody knows the end.
    const std::uint64_t apart = std::max(shown, track.duration) - std::min(shown, track.duration);
    if (!fragmented_ && !track.edits.empty() && apart >= track.edits.size()) {
      fail(name + "tkhd and elst do not agree");
    }
    if (track.duration > movie_.duration) fail(name + "longer than the movie");
    if (track.timescale == 0) fail(name + "time scale 0");
  }

  void check_ids(const Box& mvhd) {
    std::set<std::uint32_t> ids;
    for (const MovieTrack& track : movie_.tracks) {
      if (!ids.insert(track.id).second || track.id == 0) fail("tkhd: a track ID twice, or 0");
    }
    const std::uint64_t next = get(mvhd, wide(mvhd) ? 108 : 96, 4);
    if (!ids.empty() && next <= *ids.rbegin()) fail("mvhd: next_track_ID is in use");
  }

  // Samples and the contents of mdat boxes are the same bytes, each once.
  void check_data() {
    std::vector<std::pair<Size, Size>> used;
    for (const MovieTrack& track : movie_.tracks) {
      for (const MovieSample& sample : track.samples) {
        used.emplace_back(sample.offset, sample.offset + sample.size);
      }
    }
    std::sort(used.begin(), used.end());
    Size next = 0;
    for (const Box* mdat : file_.root().all("mdat")) {
      Size at = mdat->content();
      while (next < used.size() && used[next].first == at && used[next].second <= mdat->end()) {
        at = used[next++].second;
      }
      if (at != mdat->end()) fail("mdat: no sample begins at " + std::to_string(at));
    }
    if (next != used.size()) fail("no mdat for the sample at " + std::to_string(used[next].first));
  }

  const BoxFile& file_;
  Movie movie_;
  bool fragmented_ = false;
};

}  // namespace

Movie read_movie(const BoxFile& file) { return Reader(file).read(); }

}  // namespace animeme::test
