// What npm mp4box makes of an MP4: for node and, as a plain script behind mp4box.all.js, for pages.
//
//     mp4boxReport(MP4Box, bytes, hex)
//
// bytes: ArrayBuffer; hex: function of a Uint8Array. Returns what JSON can hold: brands, tracks
// with their samples, the initial object descriptor.
'use strict';

// Hex of a box as it stands in the file, header included; null: there is none.
function hexOf(bytes, box, hex) {
  return box ? hex(new Uint8Array(bytes, box.start, box.size)) : null;
}

function mp4boxTrack(file, bytes, hex, trak, samples) {
  const {mdia} = trak;
  const {minf} = mdia;
  const entry = minf.stbl.stsd.entries[0];
  return {
    id: trak.tkhd.track_id,
    handler: mdia.hdlr.handler,
    media_header: ['vmhd', 'smhd', 'nmhd'].find((type) => minf[type]) || null,
    entry: entry.type,
    codec: entry.getCodec(),
    timescale: mdia.mdhd.timescale,
    references: (trak.tref ? trak.tref.boxes : []).map(
        ({type, track_ids}) => ({type, ids: Array.from(Object.values(track_ids))})),
    // Of mp4v and mp4s it knows the place, not the content.
    entry_hex: hexOf(bytes, entry, hex),
    edits: trak.edts && trak.edts.elst ? trak.edts.elst.entries.map(
        (edit) => ({duration: edit.segment_duration, media_time: edit.media_time})) : [],
    samples: samples.map((sample) => ({
      hex: hex(sample.data), time: sample.cts, decode_time: sample.dts,
      duration: sample.duration, sync: sample.is_sync,
    })),
  };
}

function mp4boxReport(MP4Box, bytes, hex) {
  const file = MP4Box.createFile();
  const samples = {};
  let failed = null;
  file.onError = (error) => { failed = String(error); };
  file.onReady = (info) => {
    for (const track of info.tracks) {
      samples[track.id] = [];
      file.setExtractionOptions(track.id, null, {nbSamples: 1});
    }
    file.start();
  };
  file.onSamples = (id, user, some) => samples[id].push(...some);
  bytes.fileStart = 0;
  file.appendBuffer(bytes);
  file.flush();
  if (failed || !file.moov) return {error: failed || 'no moov'};
  const movie = file.moov;
  return {
    brand: file.ftyp.major_brand,
    compatible: file.ftyp.compatible_brands,
    timescale: movie.mvhd.timescale,
    duration: movie.mvhd.duration,
    fragmented: Boolean(movie.mvex),
    iods: hexOf(bytes, movie.boxes.find((box) => box.type === 'iods'), hex),
    tracks: movie.traks.map((trak) =>
      mp4boxTrack(file, bytes, hex, trak, samples[trak.tkhd.track_id] || [])),
  };
}

if (typeof module !== 'undefined') module.exports = {mp4boxReport};
