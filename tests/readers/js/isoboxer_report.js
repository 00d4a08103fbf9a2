// What npm codem-isoboxer makes of an MP4. It reads the boxes that players of segments need, so
// the sample tables of a plain movie are not among them: there it gives times, in fragments also
// the samples themselves.
'use strict';

const ISOBoxer = require('codem-isoboxer');

// Paths of all boxes, in the order of the file.
function paths(boxes, above, out) {
  for (const box of boxes || []) {
    out.push(above + box.type);
    paths(box.boxes, above + box.type + '/', out);
    paths(box.entries && box.entries.filter((entry) => entry.type), above + box.type + '/', out);
  }
  return out;
}

const child = (box, ...names) =>
  names.reduce((at, name) => at && (at.boxes || []).find((b) => b.type === name), box);

function track(trak) {
  const table = child(trak, 'mdia', 'minf', 'stbl');
  const entry = child(table, 'stsd').entries[0];
  const times = child(table, 'stts');
  const edits = child(trak, 'edts', 'elst');
  return {
    id: child(trak, 'tkhd').track_ID,
    handler: child(trak, 'mdia', 'hdlr').handler_type,
    timescale: child(trak, 'mdia', 'mdhd').timescale,
    entry: entry.type,
    durations: times.entries.map((run) => [run.sample_count, run.sample_delta]),
    edits: edits ? edits.entries.map(
        (edit) => ({duration: edit.segment_duration, media_time: edit.media_time})) : [],
  };
}

// The samples of a track fragment, cut where its own numbers say.
function fragment(buffer, moof, traf) {
  const header = child(traf, 'tfhd');
  const samples = [];
  let time = child(traf, 'tfdt').baseMediaDecodeTime;
  for (const run of traf.boxes.filter((box) => box.type === 'trun')) {
    let at = moof._offset + (run.data_offset || 0);
    run.samples.forEach((sample, i) => {
      const size = sample.sample_size ?? header.default_sample_size;
      const duration = sample.sample_duration ?? header.default_sample_duration;
      const flags = sample.sample_flags ??
          (i === 0 ? run.first_sample_flags : undefined) ?? header.default_sample_flags;
      samples.push({
        hex: Buffer.from(buffer, at, size).toString('hex'), time, duration,
        sync: (flags & 0x10000) === 0,
      });
      at += size;
      time += duration;
    });
  }
  return {id: header.track_ID, samples};
}

function isoboxerReport(bytes) {
  const file = ISOBoxer.parseBuffer(bytes);
  const movie = file.fetch('moov');
  const iods = movie.boxes.find((box) => box.type === 'iods');
  return {
    brand: file.fetch('ftyp').major_brand,
    paths: paths(file.boxes, '', []),
    complete: !file._incomplete,
    iods: iods ? Buffer.from(bytes, iods._offset, iods.size).toString('hex') : null,
    tracks: movie.boxes.filter((box) => box.type === 'trak').map(track),
    fragments: file.boxes.filter((box) => box.type === 'moof').flatMap((moof) =>
      moof.boxes.filter((box) => box.type === 'traf')
          .map((traf) => fragment(bytes, moof, traf))),
  };
}

module.exports = {isoboxerReport};
