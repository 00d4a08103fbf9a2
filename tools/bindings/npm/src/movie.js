// The contents (moov) of an mp4: its tracks, and where the samples of a face or of words lie.
import {boxesIn, find, fullBox, typeAt} from './boxes.js';
import {AnimemeError} from './library.js';

const kMostSamples = 10_000_000;
const kMostAlike = 1_000_000;  // of one size, which no table bounds
const broken = (what) => new AnimemeError('syntax', `this mp4 is broken: ${what}`);

// A descriptor of MPEG-4 Systems: {tag, begin, end}.
function descriptorAt(view, at, end) {
  if (at >= end) return null;
  const tag = view.getUint8(at++);
  let size = 0;
  for (let i = 0, byte = 0x80; i < 4 && byte & 0x80 && at < end; ++i) {
    byte = view.getUint8(at++);
    size = size << 7 | byte & 0x7F;
  }
  return at + size <= end ? {tag, begin: at, end: at + size} : null;
}

// The configuration of an MPEG-4 visual stream.
function configurationOf(view, esds) {
  let es = descriptorAt(view, esds.begin + 4, esds.end);
  if (es?.tag !== 3 || es.begin + 3 > es.end) return null;
  const flags = view.getUint8(es.begin + 2);
  let at = es.begin + 3 + (flags & 0x80 ? 2 : 0) + (flags & 0x20 ? 2 : 0);
  if (flags & 0x40) at += 1 + view.getUint8(at);
  const decoder = descriptorAt(view, at, es.end);
  if (decoder?.tag !== 4 || decoder.end - decoder.begin < 13 ||
      view.getUint8(decoder.begin) !== 0x20) return null;
  const specific = descriptorAt(view, decoder.begin + 13, decoder.end);
  if (specific?.tag !== 5) return null;
  return new Uint8Array(view.buffer, view.byteOffset + specific.begin,
      specific.end - specific.begin).slice();
}

/** A face is told from a film by the type of its visual object: 4. */
export function isFace(config) {
  for (let i = 0; i + 5 < config.length; ++i) {
    if (config[i] || config[i + 1] || config[i + 2] !== 1 || config[i + 3] !== 0xB5) continue;
    // A bit, with it seven of version and priority, then four of the type.
    const identified = config[i + 4] & 0x80;
    return (identified ? config[i + 5] >> 4 : config[i + 4] >> 3 & 15) === 4;
  }
  return false;
}

function faceConfiguration(view, stbl) {
  const stsd = find(view, stbl, 'stsd');
  for (const entry of stsd ? boxesIn(view, stsd.begin + 8, stsd.end) : []) {
    const fixed = {mp4v: 78, mp4s: 8}[entry.type];
    const esds = fixed && find(view, {begin: entry.begin + fixed, end: entry.end}, 'esds');
    const config = esds && configurationOf(view, esds);
    if (config && isFace(config)) return config;
  }
  return null;
}

/** RFC 6381 of a sound track: "mp4a.40.2", "opus"; null if it is none that is known. */
export function soundCodec(moovBytes) {
  const view = new DataView(moovBytes.buffer, moovBytes.byteOffset, moovBytes.byteLength);
  for (const moov of boxesIn(view, 0, view.byteLength)) {
    if (moov.type !== 'moov') continue;
    for (const trak of boxesIn(view, moov.begin, moov.end)) {
      const stsd = trak.type === 'trak' && find(view, trak, 'mdia', 'minf', 'stbl', 'stsd');
      const type = stsd && stsd.end - stsd.begin >= 16 ? typeAt(view, stsd.begin + 12) : '';
      if (type === 'mp4a') return 'mp4a.40.2';
      if (type === 'Opus') return 'opus';
    }
  }
  return null;
}

// Seconds that the times of a track are later than they say.
function shiftOf(view, trak, timescale, movieTimescale) {
  const elst = find(view, trak, 'edts', 'elst');
  if (!elst) return 0;
  const wide = fullBox(view, elst).version === 1, size = wide ? 20 : 12;
  let shift = 0, at = elst.begin + 8;
  for (let left = view.getUint32(elst.begin + 4); left > 0 && at + size <= elst.end;
      --left, at += size) {
    const duration = wide ? Number(view.getBigUint64(at)) : view.getUint32(at);
    const start = wide ? Number(view.getBigInt64(at + 8)) : view.getInt32(at + 4);
    if (start >= 0) return shift - start / timescale;
    shift += duration / movieTimescale;
  }
  return shift;
}

const ofVersion = (view, box, early, late) => box.begin +
    (fullBox(view, box).version === 1 ? late : early);

// Runs of a table: {count, value} pairs of 32 bits.
function* runs(view, box) {
  let at = box.begin + 8;
  for (let left = view.getUint32(box.begin + 4); left > 0 && at + 8 <= box.end; --left, at += 8) {
    yield [view.getUint32(at), view.getUint32(at + 4)];
  }
}

function sizesOf(view, stsz, most) {
  const same = view.getUint32(stsz.begin + 4), count = view.getUint32(stsz.begin + 8);
  if (count > (same ? kMostAlike : kMostSamples) || (same ? same * count > most : stsz.begin + 12 +
      4 * count > stsz.end)) {
    throw broken('too many samples');
  }
  return Array.from({length: count}, (_, i) => same || view.getUint32(stsz.begin + 12 + 4 * i));
}

// Where each sample lies: chunks hold runs of them.
function offsetsOf(view, stbl, sizes) {
  const stco = find(view, stbl, 'stco'), box = stco ?? find(view, stbl, 'co64'),
      stsc = find(view, stbl, 'stsc');
  if (!box || !stsc) throw broken('a track has no chunks');
  const width = stco ? 4 : 8, room = Math.floor((box.end - box.begin - 8) / width);
  const chunks = Math.min(view.getUint32(box.begin + 4), room);
  const rules = [];
  for (let at = stsc.begin + 8; at + 12 <= stsc.end; at += 12) {
    rules.push([view.getUint32(at), view.getUint32(at + 4)]);
  }
  const offsets = [];
  for (let chunk = 1, rule = 0; chunk <= chunks && offsets.length < sizes.length; ++chunk) {
    while (rule + 1 < rules.length && rules[rule + 1][0] <= chunk) ++rule;
    const place = box.begin + 8 + width * (chunk - 1);
    let offset = width === 4 ? view.getUint32(place) : Number(view.getBigUint64(place));
    for (let left = rules[rule]?.[1] ?? 0; left > 0 && offsets.length < sizes.length; --left) {
      offsets.push(offset);
      offset += sizes[offsets.length - 1];
    }
  }
  if (offsets.length < sizes.length) throw broken('samples without a chunk');
  return offsets;
}

function samplesOf(view, stbl, track, most) {
  const stsz = find(view, stbl, 'stsz'), stts = find(view, stbl, 'stts'),
      stss = find(view, stbl, 'stss');
  if (!stsz || !stts) return [];
  const sizes = sizesOf(view, stsz, most), offsets = offsetsOf(view, stbl, sizes);
  const intra = new Set();
  for (let at = stss ? stss.begin + 8 : 0; stss && at + 4 <= stss.end;
      at += 4) intra.add(view.getUint32(at) - 1);
  const samples = [];
  let time = 0;
  for (const [count, duration] of runs(view, stts)) {
    for (let i = 0; i < count && samples.length < sizes.length; ++i, time += duration) {
      const at = samples.length;
      samples.push({offset: offsets[at], size: sizes[at], intra: !stss || intra.has(at),
                    time: time / track.timescale + track.shift,
                        duration: duration / track.timescale});
    }
  }
  return samples;
}

const textAt = (view, begin, end) => new TextDecoder().decode(
    new Uint8Array(view.buffer, view.byteOffset + begin, Math.max(end - begin, 0)))
    .replace(/\0.*$/s, '');

// What tells a track from others: {lang, speaker, name} by elng, else mdhd, and the name "words
// (Ann)" of its handler.
function labelsOf(view, trak, mdhd) {
  const elng = find(view, trak, 'mdia', 'elng'), hdlr = find(view, trak, 'mdia', 'hdlr');
  const packed = view.getUint16(ofVersion(view, mdhd, 20, 32));
  const three = [10, 5, 0].map((shift) =>
      String.fromCharCode((packed >> shift & 31) + 96)).join('');
  const lang = elng ? textAt(view, elng.begin + 4, elng.end) : three === 'und' ? '' : three;
  const title = hdlr ? textAt(view, hdlr.begin + 24, hdlr.end) : '';
  const [, name, speaker = ''] = /^(.*?)(?: \((.*)\))?$/s.exec(title);
  return {lang, name, speaker};
}

// 'face', 'sound', 'text' or null, and the configuration of a face.
function kindOf(view, stbl) {
  const config = faceConfiguration(view, stbl);
  if (config) return {kind: 'face', config};
  const stsd = find(view, stbl, 'stsd');
  const type = stsd && stsd.end - stsd.begin >= 16 ? typeAt(view, stsd.begin + 12) : '';
  const kind = {mp4a: 'sound', Opus: 'sound', tx3g: 'text', mett: 'text'}[type] ?? null;
  return {kind, config: null};
}

/**
 * The tracks of a movie whose kind is known: {kind, id, lang, speaker, name, config, timescale,
 * trak}.
 */
export function tracksOf(view, moov) {
  const tracks = [];
  for (const trak of boxesIn(view, moov.begin, moov.end)) {
    const stbl = trak.type === 'trak' && find(view, trak, 'mdia', 'minf', 'stbl');
    const {kind, config} = stbl ? kindOf(view, stbl) : {};
    if (!kind) continue;
    const tkhd = find(view, trak, 'tkhd'), mdhd = find(view, trak, 'mdia', 'mdhd');
    if (!tkhd || !mdhd) throw broken('a track has no header');
    tracks.push({kind, id: view.getUint32(ofVersion(view, tkhd, 12, 20)), config, trak,
      timescale: view.getUint32(ofVersion(view, mdhd, 12, 20)) || 1,
      ...labelsOf(view, trak, mdhd)});
  }
  return tracks;
}

/**
 * One of tracksOf() with {shift, defaults, samples}.
 */
export function readTrack(view, moov, track, most) {
  const mvhd = find(view, moov, 'mvhd');
  const movieTimescale = mvhd ? view.getUint32(ofVersion(view, mvhd, 12, 20)) || 1 : 1;
  const {trak, timescale} = track;
  const out = {...track, shift: shiftOf(view, trak, timescale, movieTimescale),
      defaults: {duration: 0, size: 0, flags: 0}};
  for (const box of boxesIn(view, moov.begin, moov.end)) {
    if (box.type === 'mvex') out.defaults = defaultsOf(view, box, track.id) ?? out.defaults;
  }
  out.samples = samplesOf(view, find(view, trak, 'mdia', 'minf', 'stbl'), out, most);
  return out;
}

function defaultsOf(view, mvex, id) {
  for (const trex of boxesIn(view, mvex.begin, mvex.end)) {
    if (trex.type !== 'trex' || trex.end - trex.begin < 24 || view.getUint32(trex.begin + 4) !== id)
        continue;
    return {duration: view.getUint32(trex.begin + 12), size: view.getUint32(trex.begin + 16),
            flags: view.getUint32(trex.begin + 20)};
  }
  return null;
}
