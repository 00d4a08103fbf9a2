// Phones to frames, by a model of how somebody talks.
import {roomOf} from './decoder.js';
import {Handle} from './handle.js';
import {bytesOf, need} from './modules.js';
import {readFrame, SPEAK_OPTIONS_SIZE, writeSpeakOptions} from './structs.js';

const NEED_DATA = 1;
const builtin = new URL('../model/grid_s1.dam', import.meta.url);

// The model of the package opens the mouth as far as text with it needs, as the program's built-in
// model does, which is the same file. Models of others have a number of their own.
const BUILTIN_ARTICULATION = 1;

const withOptions = (module, options, use) => module.with(new Uint8Array(SPEAK_OPTIONS_SIZE),
    (at) => {
  module.functions.animeme_speak_options_init(at, SPEAK_OPTIONS_SIZE);
  writeSpeakOptions(module.memory, at, options);
  return use(at);
});

const line = ({start, end, phone}) => `${start}\t${end}\t${phone}\n`;

/** A character: the bytes of a model (.dam) and what it says. */
export class Speaker extends Handle {
  /** `model`: bytes, an address, or nothing for the model that comes with the package. */
  static async load(model = builtin, source = undefined) {
    const module = await need('speaker', source);
    const isBytes = model instanceof ArrayBuffer || ArrayBuffer.isView(model);
    const given = isBytes ? model : await bytesOf(model);
    const bytes = ArrayBuffer.isView(given) ? new Uint8Array(given.buffer, given.byteOffset,
        given.byteLength)
                                            : new Uint8Array(given);
    return new Speaker(module,
        module.with(bytes, (at, size) => module.make('model_read', at, size)),
                       model === builtin ? BUILTIN_ARTICULATION : undefined);
  }

  constructor(module, at, articulation) {
    super(module, 'model', at);
    this.articulation = articulation;
  }

  /** Who has to be named when the model is passed on. */
  get attribution(
      ) { return this.library.text(this.library.functions.animeme_model_attribution(this.handle)); }

  /**
   * Frames for phones [{phone, start, end}] in seconds, or for a script as text (TextGrid, TSV,
   * labels ...).
   */
  speak(phones, options = {}) {
    const module = this.library;
    const script = typeof phones === 'string' ? phones : 'start_s\tend_s\tphone\n' +
        phones.map(line).join('');
    const clip = module.with(script, (text, size) => withOptions(module, this.completed(options),
        (given) =>
      module.make('speak', this.handle, text, size - 1, given)));
    try {
      const rate = rateOf(options);
      const {frame} = roomOf(module);
      return Array.from({length: module.functions.animeme_clip_count(clip)}, (_, i) => {
        module.call('clip_get', clip, i, frame);
        const read = readFrame(module.memory, frame);
        return {...read, face: true, time: read.number * rate[1] / rate[0], rate};
      });
    } finally {
      module.functions.animeme_clip_free(clip);
    }
  }

  /** Speech that is still being made: phones go in, frames come out as soon as they are final. */
  begin(options = {}) {
    const module = this.library;
    return new Speech(module, withOptions(module, this.completed(options),
                                          (given) => module.make('speech_new', this.handle,
                                              given)));
  }

  /** The options with what the model asks for where they say nothing. */
  completed(options) { return {...options, articulation: options.articulation ?? this.articulation};
      }
}

/** What Speaker.begin() gives. */
export class Speech extends Handle {
  constructor(module, at) {
    super(module, 'speech', at);
    this.room = roomOf(module);
    this.ended = false;
  }

  /** The next phone: seconds, upper-case ARPAbet without stress, or "SIL". */
  push({phone, start, end}) {
    this.library.with(phone, (at) => this.library.call('speech_push', this.handle, start, end, at));
  }

  finish() { this.library.call('speech_finish', this.handle); }

  /** The next frame; null: push more, or it is over (`ended`). */
  next() {
    const status = this.library.call('speech_next', this.handle, this.room.frame);
    this.ended = status > NEED_DATA;
    return status === 0 ? readFrame(this.library.memory, this.room.frame) : null;
  }

  *[Symbol.iterator]() {
    for (let frame = this.next(); frame; frame = this.next()) yield frame;
  }
}

const rateOf = ({rate = 25}) => {
  const probe = new ArrayBuffer(SPEAK_OPTIONS_SIZE);
  writeSpeakOptions(probe, 0, {rate});
  const view = new DataView(probe);
  return [view.getUint32(4, true), view.getUint32(8, true)];
};
