// The face of an mp4 while it arrives: whole files, fragments, segments behind their
// initialisation.
import {boxAt} from './boxes.js';
import {readFragment} from './fragment.js';
import {AnimemeError} from './library.js';
import {readTrack, tracksOf} from './movie.js';

const kFirst = ['ftyp', 'styp', 'moov', 'moof', 'mdat', 'free', 'skip', 'wide', 'sidx'];

const kMostWaiting = 1_000_000;  // samples of fragments

const firstFace = (tracks) => tracks.find(({kind}) => kind === 'face');

/**
 * Push bytes, get access units: {time, duration (seconds), bytes, intra}. `choose` picks one of the
 * tracks (tracksOf() of movie.js, with the place `at` of each in the file); by default it is the
 * first face.
 */
export class Mp4Reader {
  constructor(choose = firstFace) {
    this.choose = choose;
    /** What there is, once the contents were read. */
    this.tracks = null;
    this.bytes = new Uint8Array(0);
    this.base = 0;     // place of the first of these bytes in the file
    this.at = 0;       // place of the next box
    this.pending = [];
    this.next = 0;
    /** The one that is read, once the contents were read: config, timescale. */
    this.track = null;
    this.fragments = false;
  }

  push(bytes) {
    if (!(bytes instanceof Uint8Array)) throw new AnimemeError('invalid_argument',
        'bytes of an mp4 are a Uint8Array');
    this.bytes = join(this.bytes, bytes);
    while (this.readBox()) { /* all that are there */ }
    const units = [];
    let taken = 0;
    for (; taken < this.pending.length; ++taken) {
      const {offset, size, ...unit} = this.pending[taken];
      if (offset < this.base)
          throw new AnimemeError('syntax', 'this mp4 is broken: samples come before their table');
      if (offset + size > this.base + this.bytes.length) break;
      units.push({...unit, bytes: this.bytes.slice(offset - this.base, offset - this.base + size)});
    }
    this.pending.splice(0, taken);
    this.forget();
    return units;
  }

  /** No more bytes will come. */
  finish() {
    if (!this.track) throw new AnimemeError('unsupported', 'this is not an mp4 with a face');
    if (this.pending.length)
        throw new AnimemeError('truncated', 'this mp4 ends before its samples');
  }

  readBox() {
    const view = new DataView(this.bytes.buffer, this.bytes.byteOffset, this.bytes.byteLength);
    const begin = this.at - this.base;
    const box = begin <= view.byteLength ? boxAt(view, begin) : null;
    if (!box) return false;
    if (this.at === 0 && !kFirst.includes(box.type))
        throw new AnimemeError('syntax', 'this is not an mp4');
    if (box.type === 'moov' || box.type === 'moof') {
      if (box.end > view.byteLength) return false;
      try {
        if (box.type === 'moov') this.readContents(view, box);
        else if (this.track) this.readFragment(view, box);
      } catch (problem) {
        // a box that is shorter than what it says
        if (!(problem instanceof RangeError)) throw problem;
        throw new AnimemeError('syntax', `this mp4 is broken: a box in ${box.type} is too short`);
      }
    }
    this.at = this.base + box.end;
    return true;
  }

  readContents(view, moov) {
    this.tracks = tracksOf(view, moov).map((each) =>
        ({...each, at: this.base + each.trak.begin - 4}));
    const chosen = this.choose(this.tracks);
    if (!chosen) throw new AnimemeError('unsupported', 'there is no face in this mp4');
    const {samples, ...track} = readTrack(view, moov, chosen, Number.MAX_SAFE_INTEGER);
    this.track = track;
    this.pending = samples;
    this.next = 0;
  }

  readFragment(view, moof) {
    const {samples, next} = readFragment(view, moof, this.at, this.track, this.next);
    this.fragments = true;
    if (this.pending.length + samples.length > kMostWaiting) {
      throw new AnimemeError('syntax', 'this mp4 is broken: too many samples wait for their bytes');
    }
    for (const sample of samples) this.pending.push(sample);
    this.next = next;
  }

  // Bytes that nothing asks for any more. Before the contents are known all may be asked for.
  forget() {
    if (!this.track) return;
    const needed = Math.min(this.at, this.pending[0]?.offset ?? Infinity) - this.base;
    const behind = Math.min(Math.max(needed, 0), this.bytes.length);
    this.bytes = this.bytes.subarray(behind);
    this.base += behind;
  }
}

function join(first, second) {
  if (first.length === 0) return second;
  const both = new Uint8Array(first.length + second.length);
  both.set(first);
  both.set(second, first.length);
  return both;
}
