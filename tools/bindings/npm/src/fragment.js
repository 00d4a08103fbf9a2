// The samples of a track in a fragment (moof). Source: ISO/IEC 14496-12, section 8.8.
import {boxesIn, fullBox} from './boxes.js';
import {AnimemeError} from './library.js';

const NOT_SYNC = 0x10000;
const kMostSamples = 1_000_000;  // of a fragment

function headerOf(view, traf, track) {
  const header = {base: null, time: null, ...track.defaults};
  for (const box of boxesIn(view, traf.begin, traf.end)) {
    const {version, flags} = fullBox(view, box);
    if (box.type === 'tfhd') {
      if (view.getUint32(box.begin + 4) !== track.id) return null;
      let at = box.begin + 8;
      if (flags & 1) header.base = Number(view.getBigUint64((at += 8) - 8));
      if (flags & 2) at += 4;
      if (flags & 8) header.duration = view.getUint32((at += 4) - 4);
      if (flags & 16) header.size = view.getUint32((at += 4) - 4);
      if (flags & 32) header.flags = view.getUint32(at);
    } else if (box.type === 'tfdt') {
      header.time = version === 1 ? Number(view.getBigUint64(box.begin + 4)) :
          view.getUint32(box.begin + 4);
    }
  }
  return header;
}

function* samplesOfRun(view, trun, header, track, state) {
  const {version, flags} = fullBox(view, trun);
  const count = view.getUint32(trun.begin + 4);
  let at = trun.begin + 8;
  if (flags & 1) state.offset = state.base + view.getInt32((at += 4) - 4);
  const first = flags & 4 ? view.getUint32((at += 4) - 4) : header.flags;
  const row = [0x100, 0x200, 0x400, 0x800].filter((flag) => flags & flag).length * 4;
  // A sample without bytes is none; without a row each, nothing else bounds their number.
  const empty = row === 0 && count > 0 && header.size === 0;
  if (at + row * count > trun.end || state.left < count || empty) {
    throw new AnimemeError('syntax', 'this mp4 is broken: a fragment');
  }
  state.left -= count;
  for (let i = 0; i < count; ++i) {
    let {duration, size, flags: kind} = header;
    let shift = 0;
    if (i === 0) kind = first;
    if (flags & 0x100) duration = view.getUint32((at += 4) - 4);
    if (flags & 0x200) size = view.getUint32((at += 4) - 4);
    if (flags & 0x400) kind = view.getUint32((at += 4) - 4);
    if (flags & 0x800) shift = version === 0 ? view.getUint32((at += 4) - 4) :
        view.getInt32((at += 4) - 4);
    yield {offset: state.offset, size, intra: !(kind & NOT_SYNC),
           time: (state.time + shift) / track.timescale + track.shift,
               duration: duration / track.timescale};
    state.offset += size;
    state.time += duration;
  }
}

/**
 * `at`: where the fragment lies in the file; `next`: the time (ticks) where the one before ended.
 */
export function readFragment(view, moof, at, track, next) {
  const samples = [];
  let time = next, left = kMostSamples;
  for (const traf of boxesIn(view, moof.begin, moof.end)) {
    const header = traf.type === 'traf' ? headerOf(view, traf, track) : null;
    if (!header) continue;
    const base = header.base ?? at;
    const state = {base, offset: base, time: header.time ?? time, left};
    for (const trun of boxesIn(view, traf.begin, traf.end)) {
      if (trun.type !== 'trun') continue;
      for (const sample of samplesOfRun(view, trun, header, track, state)) samples.push(sample);
    }
    ({time, left} = state);
  }
  return {samples, next: time};
}
