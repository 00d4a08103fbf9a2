// Access units to frames with times, and the frame of a time.
import {Decoder, Receiver} from './decoder.js';
import {Mp4Reader} from './mp4.js';

const OBJECT_START = Uint8Array.of(0, 0, 1, 0xBA, 0x7F), PLANE_START = Uint8Array.of(0, 0, 1, 0xBB);
const startsWith = (bytes, code) => bytes.length >= 4 &&
    code.subarray(0, 4).every((byte, i) => bytes[i] === byte);

/** Decodes planes as containers carry them. After a gap it begins again at the next intra plane. */
export class UnitDecoder {
  constructor(config, {shown = true, bodies = false} = {}) {
    this.config = config;
    this.decoder = new Decoder({bodies});
    this.receiver = shown ? new Receiver(shown === true ? {} : shown) : null;
    this.begun = false;
  }

  /**
   * The frames of a unit, as a rule one, at the unit's time; none while it waits for an intra
   * plane.
   */
  decode(unit) {
    try {
      if (!this.push(unit)) return [];
      const frames = [];
      for (const frame of this.decoder) frames.push(this.receiver ? this.receiver.show(frame) :
          frame);
      return frames.map((frame,
          i) => ({...frame, time: unit.time + i * frame.rate[1] / frame.rate[0]}));
    } catch (failure) {
      if (failure.name !== 'AnimemeError') throw failure;
      this.begun = false;
      return [];
    }
  }

  // A plane is complete when the next one begins: it is given the start code of that at once, which
  // is then taken off when it comes.
  push({bytes, intra}) {
    const follows = startsWith(bytes, PLANE_START);
    if (this.begun && follows) {
      this.decoder.push(bytes.subarray(PLANE_START.length));
    } else {
      if (!intra) return false;
      this.decoder.reset();
      this.decoder.push(this.config);
      if (follows) this.decoder.push(OBJECT_START);
      this.decoder.push(bytes);
      this.begun = true;
    }
    this.decoder.push(PLANE_START);
    return true;
  }

  /** Units are missing. */
  skip() { this.begun = false; }

  free() {
    this.decoder.free();
    this.receiver?.free();
  }
}

/** Frames in the order of their times. */
export class Track {
  constructor() {
    this.frames = [];
    this.end = 0;
  }

  /** Frames that follow each other; those of a segment that comes late find their place. */
  add(frames) {
    if (!frames.length) return;
    const last = frames.at(-1), behind = this.frames.splice(this.indexAt(frames[0].time) + 1);
    // an hour of them is too long a list of arguments
    for (const frame of frames) this.frames.push(frame);
    for (const frame of behind) this.frames.push(frame);
    this.end = Math.max(this.end, last.time + last.rate[1] / last.rate[0]);
  }

  /** Index of the last frame that has begun; -1 before the first. */
  indexAt(time) {
    let low = 0, high = this.frames.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.frames[middle].time <= time + 1e-6) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }

  at(time) { return this.frames[this.indexAt(time)] ?? null; }

  clear() {
    this.frames.length = 0;
    this.end = 0;
  }

  /** Forgets what is before a time, of streams without an end. */
  forget(time) {
    const count = this.indexAt(time);
    if (count > 0) this.frames.splice(0, count);
  }
}

/** The face of an mp4 in memory, as a receiver shows it (`options`: of Decoder). */
export function decodeMp4(bytes, options) {
  const reader = new Mp4Reader(), track = new Track();
  const units = reader.push(bytes instanceof Uint8Array ? bytes : new Uint8Array(bytes));
  reader.finish();
  const decoder = new UnitDecoder(reader.track.config, options);
  try {
    for (const unit of units) track.add(decoder.decode(unit));
  } finally {
    decoder.free();
  }
  const last = units.at(-1);
  if (last) track.end = Math.max(track.end, last.time + last.duration);
  return track;
}
