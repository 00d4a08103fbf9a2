#include "tools/formats/media/detail/mp4/mp4_file.h"

#include <algorithm>
#include <cmath>

namespace animeme::media {
namespace {

constexpr std::uint64_t kLargestFile = 0xFFFFFFFFu;

/// `value` ticks of one scale in another, rounded.
std::int64_t rescale(std::int64_t value, std::uint32_t from, std::uint32_t to) {
  return std::int64_t((double(value) * to) / from + 0.5);
}

/// Where a sample lies in the file, and the second in which it is due.
struct SamplePlace {
  std::size_t track = 0, sample = 0;
  double second = 0;
};

/// Samples that lie side by side.
struct Chunk {
  std::uint64_t offset = 0;
  std::uint32_t samples = 0;
};
using Chunks = std::vector<std::vector<Chunk>>;  // by track

std::vector<SamplePlace> in_order_of_time(const Mp4Movie& movie) {
  std::vector<SamplePlace> places;
  for (std::size_t t = 0; t < movie.tracks.size(); ++t) {
    const Mp4Track& track = movie.tracks[t];
    std::int64_t time = track.start;
    for (std::size_t s = 0; s < track.samples.size(); ++s) {
      // What describes the presentation comes before all of it.
      places.push_back({t, s, track.presented ? std::floor(double(time) / track.timescale) : -1e9});
      time += track.samples[s].duration;
    }
  }
  // Within a second track by track.
  std::stable_sort(places.begin(), places.end(), [](const SamplePlace& a, const SamplePlace& b) {
    return a.second < b.second || (a.second == b.second && a.track < b.track);
  });
  return places;
}

Chunks chunks_of(const Mp4Movie& movie, const std::vector<SamplePlace>& places, std::uint64_t at) {
  Chunks chunks(movie.tracks.size());
  const SamplePlace* before = nullptr;
  for (const SamplePlace& place : places) {
    const bool shared =
        before != nullptr && before->track == place.track && before->second == place.second;
    if (!shared) chunks[place.track].push_back({at, 0});
    ++chunks[place.track].back().samples;
    at += movie.tracks[place.track].samples[place.sample].bytes.size();
    before = &place;
  }
  return chunks;
}

void write_matrix(BoxWriter& out) { out.u32({0x10000, 0, 0, 0, 0x10000, 0, 0, 0, 0x40000000}); }

class MovieWriter {
 public:
  MovieWriter(const Mp4Movie& movie, const Chunks& chunks) : movie_(movie), chunks_(chunks) {}

  std::vector<std::uint8_t> contents() {
    out_.begin("ftyp");
    out_.text(movie_.brands.substr(0, 4));
    out_.u32(0);
    out_.text(movie_.brands);
    out_.end();
    out_.begin("moov");
    write_header();
    if (!movie_.initial_object_descriptor.empty()) {
      out_.begin_full("iods", 0, 0);
      out_.raw(movie_.initial_object_descriptor);
      out_.end();
    }
    for (std::size_t t = 0; t < movie_.tracks.size(); ++t)
      write_track(movie_.tracks[t], chunks_[t]);
    if (movie_.fragments) write_defaults();
    out_.end();
    return out_.bytes();
  }

 private:
  /// What a track takes of the presentation, in the movie's scale.
  std::int64_t shown(const Mp4Track& track) const {
    return rescale(std::max<std::int64_t>(track.start, 0) + track.length, track.timescale,
                   movie_.timescale);
  }

  void write_header() {
    std::int64_t duration = 0;
    unsigned next = 1;
    for (const Mp4Track& track : movie_.tracks) {
      duration = std::max(duration, shown(track));
      next = std::max(next, track.id + 1);
    }
    out_.begin_full("mvhd", 0, 0);
    out_.u32({0, 0, movie_.timescale, std::uint64_t(duration), 0x10000});
    out_.u16(0x100);
    out_.zeros(10);
    write_matrix(out_);
    out_.zeros(24);
    out_.u32(next);
    out_.end();
  }

  void write_defaults() {
    out_.begin("mvex");
    for (const Mp4Track& track : movie_.tracks) {
      out_.begin_full("trex", 0, 0);
      out_.u32({track.id, 1, track.fragment_duration});
      out_.zeros(8);
      out_.end();
    }
    out_.end();
  }

  void write_track(const Mp4Track& track, const std::vector<Chunk>& chunks) {
    out_.begin("trak");
    out_.begin_full("tkhd", 0, track.presented ? 3 : 1);
    out_.u32({0, 0, track.id, 0, std::uint64_t(shown(track))});
    out_.zeros(12);
    out_.u16(track.handler == "soun" ? 0x100 : 0);
    out_.u16(0);
    write_matrix(out_);
    out_.u32({std::uint64_t(track.width) << 16, std::uint64_t(track.height) << 16});
    out_.end();
    write_edits(track);
    if (!track.references.empty()) {
      out_.begin("tref");
      out_.begin("mpod");
      for (const unsigned id : track.references) out_.u32(id);
      out_.end();
      out_.end();
    }
    write_media(track, chunks);
    out_.end();
  }

  void write_edits(const Mp4Track& track) {
    if (track.start == 0) return;
    out_.begin("edts");
    out_.begin_full("elst", 0, 0);
    out_.u32(track.start > 0 ? 2 : 1);
    if (track.start > 0) edit(rescale(track.start, track.timescale, movie_.timescale), -1);
    edit(rescale(track.length, track.timescale, movie_.timescale),
         std::max<std::int64_t>(0, -track.start));
    out_.end();
    out_.end();
  }

  void edit(std::int64_t duration, std::int64_t media_time) {
    out_.u32({std::uint64_t(duration), std::uint32_t(media_time), 0x10000});
  }

  void write_media(const Mp4Track& track, const std::vector<Chunk>& chunks) {
    std::int64_t duration = 0;
    for (const Mp4Sample& sample : track.samples) duration += sample.duration;
    out_.begin("mdia");
    out_.begin_full("mdhd", 0, 0);
    out_.u32({0, 0, track.timescale, std::uint64_t(duration)});
    out_.u16(0x55C4);  // no language
    out_.u16(0);
    out_.end();
    out_.begin_full("hdlr", 0, 0);
    out_.u32(0);
    out_.text(track.handler);
    out_.zeros(12);
    out_.text(track.name);
    out_.u8(0);
    out_.end();
    out_.begin("minf");
    write_media_header(track.handler);
    out_.begin("dinf");
    out_.begin_full("dref", 0, 0);
    out_.u32(1);
    out_.begin_full("url ", 0, 1);  // in this file
    out_.end();
    out_.end();
    out_.end();
    write_sample_table(track, chunks);
    out_.end();
    out_.end();
  }

  void write_media_header(const std::string& handler) {
    const bool video = handler == "vide", sound = handler == "soun";
    out_.begin_full(video ? "vmhd" : sound ? "smhd" : "nmhd", 0, video ? 1 : 0);
    out_.zeros(video ? 8 : sound ? 4 : 0);
    out_.end();
  }

  void write_sample_table(const Mp4Track& track, const std::vector<Chunk>& chunks) {
    out_.begin("stbl");
    out_.begin_full("stsd", 0, 0);
    out_.u32(1);
    out_.raw(track.entry);
    out_.end();
    write_times(track);
    write_sync(track);
    write_chunks(chunks);
    out_.begin_full("stsz", 0, 0);
    out_.u32({0, track.samples.size()});
    for (const Mp4Sample& sample : track.samples) out_.u32(sample.bytes.size());
    out_.end();
    out_.begin_full("stco", 0, 0);
    out_.u32(chunks.size());
    for (const Chunk& chunk : chunks) out_.u32(chunk.offset);
    out_.end();
    out_.end();
  }

  void write_chunks(const std::vector<Chunk>& chunks) {
    std::vector<std::size_t> changes;  // chunks with another number of samples than the one before
    for (std::size_t c = 0; c < chunks.size(); ++c) {
      if (c == 0 || chunks[c].samples != chunks[c - 1].samples) changes.push_back(c);
    }
    out_.begin_full("stsc", 0, 0);
    out_.u32(changes.size());
    for (const std::size_t c : changes) out_.u32({c + 1, chunks[c].samples, 1});
    out_.end();
  }

  void write_times(const Mp4Track& track) {
    std::vector<std::pair<std::uint32_t, std::int64_t>> runs;  // count, duration
    for (const Mp4Sample& sample : track.samples) {
      if (runs.empty() || runs.back().second != sample.duration)
        runs.emplace_back(0, sample.duration);
      ++runs.back().first;
    }
    out_.begin_full("stts", 0, 0);
    out_.u32(runs.size());
    for (const auto& [count, duration] : runs) out_.u32({count, std::uint64_t(duration)});
    out_.end();
  }

  void write_sync(const Mp4Track& track) {
    std::vector<std::uint32_t> sync;
    for (std::size_t s = 0; s < track.samples.size(); ++s)
      if (track.samples[s].sync) sync.push_back(std::uint32_t(s + 1));
    if (sync.size() == track.samples.size()) return;  // all are
    out_.begin_full("stss", 0, 0);
    out_.u32(sync.size());
    for (const std::uint32_t number : sync) out_.u32(number);
    out_.end();
  }

  const Mp4Movie& movie_;
  const Chunks& chunks_;
  BoxWriter out_;
};

}  // namespace

void begin_entry(BoxWriter& out, std::string_view type) {
  out.begin(type);
  out.zeros(6);
  out.u16(1);  // data reference
}

void begin_sound_entry(BoxWriter& out, std::string_view type, unsigned channels, int sample_rate) {
  begin_entry(out, type);
  out.zeros(8);
  out.u16(channels);
  out.u16(16);
  out.u32(0);
  out.u32(sample_rate < 65536 ? std::uint64_t(sample_rate) << 16 : 0);
}

std::vector<std::uint8_t> write_contents(const Mp4Movie& movie) {
  return MovieWriter(movie, Chunks(movie.tracks.size())).contents();
}

Result<std::vector<std::uint8_t>> write_movie(const Mp4Movie& movie) {
  const std::vector<SamplePlace> places = in_order_of_time(movie);
  Chunks chunks = chunks_of(movie, places, 0);
  // The contents have the same size whatever the offsets are.
  const std::uint64_t data_begin = MovieWriter(movie, chunks).contents().size();
  chunks = chunks_of(movie, places, data_begin + 8);
  std::uint64_t at = data_begin + 8;
  for (const SamplePlace& place : places) {
    at += movie.tracks[place.track].samples[place.sample].bytes.size();
  }
  if (at > kLargestFile)
    return make_error(Code::out_of_range, "the file would be larger than 4 GB; cut the clip");
  std::vector<std::uint8_t> file = MovieWriter(movie, chunks).contents();
  BoxWriter data;
  data.u32(at - data_begin);
  data.text("mdat");
  file.reserve(at);
  for (const std::uint8_t byte : data.bytes()) file.push_back(byte);
  for (const SamplePlace& place : places) {
    const auto& bytes = movie.tracks[place.track].samples[place.sample].bytes;
    file.insert(file.end(), bytes.begin(), bytes.end());
  }
  return file;
}

}  // namespace animeme::media
