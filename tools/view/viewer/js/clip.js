// A motion as pack_clip() of page.cpp writes it.
import {ByteReader} from './bytes.js';
import {easedTurns} from './turns.js';

function readColumns(reader, controls, frames) {
  const columns = {};
  for (const control of controls) {
    const column = new Int32Array(frames);
    let value = 0;
    for (let i = 0; i < frames; ++i) column[i] = value += reader.zigzag();
    columns[control] = column;
  }
  return columns;
}

/** Frames at a rate; times are seconds on the clock of the sound. */
export class Clip {
  constructor(bytes) {
    const reader = new ByteReader(bytes);
    const {name, rate, start, first, frames, controls, derived} = reader.header;
    this.name = name;
    this.rate = rate[0] / rate[1];
    this.frames = frames;
    this.start = start + first / this.rate;
    this.end = this.start + frames / this.rate;
    /** Values by FAP number, then weights of shapes; what never moves is missing. */
    this.columns = readColumns(reader, controls, frames);
    /** What the clip does not carry and the head does of itself, such as lids that follow. */
    this.derived = readColumns(reader, derived, frames);
    /** Turns without the steps of the coder, for playing. */
    this.eased = easedTurns(this.columns);
    this.size = Math.max(68, ...controls) + 1;
  }

  /** The frame that is shown at a time: the last one that has begun. */
  frameAt(time) {
    const frame = Math.floor((time - this.start) * this.rate + 1e-6);
    return Math.min(Math.max(frame, 0), this.frames - 1);
  }

  timeOf(frame) {
    return this.start + frame / this.rate;
  }

  value(fap, frame) {
    const column = this.columns[fap];
    return column ? column[frame] : 0;
  }

  /** All values at a time by control; `between`: a mixture of two frames, with eased turns. */
  values(time, between) {
    const out = new Float64Array(this.size);
    const frame = this.frameAt(time);
    const next = Math.min(frame + 1, this.frames - 1);
    const share = between ? Math.min(Math.max((time - this.timeOf(frame)) * this.rate, 0), 1) : 0;
    for (const [control, column] of [...Object.entries(this.columns),
        ...Object.entries(this.derived),
                                     ...Object.entries(between ? this.eased : {})]) {
      out[control] = column[frame] + (column[next] - column[frame]) * share;
    }
    return out;
  }

  /** Least and largest value of a FAP, 0 among them. */
  range(fap) {
    let [low, high] = [0, 0];
    for (const value of this.columns[fap] || []) {
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
    return [low, high];
  }
}

/** Root mean square of the differences of the values of some FAPs in one frame each; 0 for none. */
export function valueDifference(a, b, faps) {
  let square = 0;
  for (const fap of faps) square += (a[fap] - b[fap]) ** 2;
  return Math.sqrt(square / Math.max(faps.length, 1));
}
