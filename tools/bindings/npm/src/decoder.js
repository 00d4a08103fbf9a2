// Bytes to frames.
import {Handle} from './handle.js';
import {library} from './modules.js';
import {BODY_SIZE, FRAME_SIZE, readBody, readFrame, writeFrame} from './structs.js';

const NEED_DATA = 1;
const EXPAND = 4, COMPLETE = 8, KEEP_HIGH_LEVEL = 2;

// Room for one frame and one body, of all handles: nothing of it is kept from call to call.
const rooms = new WeakMap();
export function roomOf(module) {
  if (!rooms.has(module)) {
    const frame = module.allocate(FRAME_SIZE), body = module.allocate(BODY_SIZE);
    module.functions.animeme_frame_init(frame, FRAME_SIZE);
    module.functions.animeme_body_init?.(body, BODY_SIZE);
    rooms.set(module, {frame, body});
  }
  return rooms.get(module);
}

/**
 * Push bytes of an FBA stream, pull what its planes code; with {shown: true} what a receiver shows
 * then.
 */
export class Decoder extends Handle {
  constructor({shown = false, bodies = false} = {}) {
    const module = library('decoder');
    super(module, 'decoder', module.make('decoder_new'));
    this.room = roomOf(module);
    this.bodies = bodies;
    this.shown = shown;
    this.ended = false;
    this.receiver = shown ? new Receiver(shown) : null;
  }

  push(bytes) {
    this.library.with(bytes, (at, size) => this.library.call('decoder_push', this.handle, at,
        size));
  }

  finish() { this.library.call('decoder_finish', this.handle); }

  /**
   * The next frame; null: push more, or it is over (`ended`). Throws at damage, and goes on behind
   * it when called
      again. */
  next() {
    const {frame, body} = this.room;
    const status = this.library.call('decoder_next', this.handle, frame, this.bodies ? body : 0);
    this.ended = status > NEED_DATA;
    if (status !== 0) return null;
    const coded = readFrame(this.library.memory, frame);
    const out = this.receiver ? this.receiver.show(coded) : coded;
    if (this.bodies) out.body = readBody(this.library.memory, frame, body);
    return out;
  }

  /** Forgets all: the next byte begins another stream. */
  reset() {
    this.library.call('decoder_reset', this.handle);
    this.ended = false;
    if (!this.shown) return;
    this.receiver.free();
    this.receiver = new Receiver(this.shown);
  }

  /** How often something in the stream was not as it should be and could be read all the same. */
  get warnings() { return Number(this.library.functions.animeme_decoder_warnings(this.handle, 0)); }

  free() {
    this.receiver?.free();
    super.free();
  }

  /** Frames up to where bytes are missing. */
  *[Symbol.iterator]() {
    for (let frame = this.next(); frame; frame = this.next()) yield frame;
  }
}

/**
 * From coded frames to what is shown: FAPs that are not sent are held, mirrored, or follow the
 * other lip.
 */
export class Receiver extends Handle {
  /**
   * `expand`: FAP 1 and 2 become low-level FAPs; `complete`: what was never sent is there, at 0.
   */
  constructor({expand = true, complete = true} = {}) {
    const module = library('decoder');
    const flags = (expand ? EXPAND : KEEP_HIGH_LEVEL) | (complete ? COMPLETE : 0);
    super(module, 'receiver', module.make('receiver_new', flags));
    this.room = roomOf(module);
  }

  /** A frame arrives; null: none, the last one is held. */
  show(frame) {
    const at = this.room.frame;
    if (frame) writeFrame(this.library.memory, at, frame);
    this.library.call('receiver_next', this.handle, frame ? at : 0, at);
    const shown = readFrame(this.library.memory, at);
    // It numbers and times by the frame that came; without one, by its own count.
    return frame ? {...shown, face: frame.face, intra: frame.intra} : shown;
  }
}

/** All frames of a stream in memory; fails at its first error. */
export function decode(bytes, options) {
  const decoder = new Decoder(options);
  try {
    decoder.push(bytes);
    decoder.finish();
    return [...decoder];
  } finally {
    decoder.free();
  }
}
