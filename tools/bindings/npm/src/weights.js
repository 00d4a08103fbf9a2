// Frames to weights: ARKit's shapes, and the visemes of Oculus.
import {roomOf} from './decoder.js';
import {Handle} from './handle.js';
import {library} from './modules.js';
import {readFrame, writeFrame} from './structs.js';

export const ARKIT_SHAPES = 52;
const CHANNELS = 61, VISEMES = 15;

const names = {};
function namesOf(kind, count) {
  names[kind] ??= Object.freeze(Array.from({length: count}, (_, i) => {
    const module = library('decoder');
    return module.text(module.functions[`animeme_${kind}_name`](i));
  }));
  return names[kind];
}

/** "eyeBlinkLeft" ...: 52 shapes, then 9 angles of head and eyes ("headYaw" ...). */
export const arkitNames = () => namesOf('arkit', CHANNELS);
/** "viseme_sil", "viseme_PP" ...: 15. */
export const visemeNames = () => namesOf('viseme', VISEMES);
/** "viseme", "expression", "open_jaw" ...: 68, that of FAP 1 first. */
export const fapNames = () => {
  names.fap ??= Object.freeze(Array.from({length: 68}, (_, i) => {
    const module = library('decoder');
    return module.text(module.functions.animeme_fap_name(i + 1));
  }));
  return names.fap;
};

// Frame by frame: what came before has a say, so that weights that look alike do not take turns.
class Fitter extends Handle {
  constructor(type, count) {
    const module = library('decoder');
    super(module, type, module.make(`${type}_new`));
    this.type = type;
    this.count = count;
    this.weights = module.allocate(4 * count);
    this.room = roomOf(module);
  }

  fit(frame, out = new Float32Array(this.count)) {
    writeFrame(this.library.memory, this.room.frame, frame);
    const size = this.type === 'arkit' ? [this.count] : [];
    this.library.call(`${this.type}_fit`, this.handle, this.room.frame, this.weights, ...size);
    out.set(new Float32Array(this.library.memory, this.weights, this.count));
    return out;
  }

  free() {
    if (this.handle) this.library.free(this.weights);
    super.free();
  }
}

/**
 * Weights of ARKit's shapes (0..1) and angles (radians) of the frames of one face, which should be
 * complete.
 */
export class ArkitFitter extends Fitter {
  constructor() { super('arkit', CHANNELS); }
}

/** Weights of the 15 visemes (1 together) of the frames of one face. */
export class VisemeFitter extends Fitter {
  constructor() { super('visemes', VISEMES); }
}

function once(Kind, frame, names) {
  const fitter = new Kind();
  try {
    const weights = fitter.fit(frame);
    return Object.fromEntries(names.map((name, i) => [name, weights[i]]));
  } finally {
    fitter.free();
  }
}

/** ARKit's 52 weights of a single frame by name. For frames that follow each other: ArkitFitter. */
export const arkit = (frame) => once(ArkitFitter, frame, arkitNames().slice(0, ARKIT_SHAPES));
/** The 15 visemes of a single frame by name. */
export const visemes = (frame) => once(VisemeFitter, frame, visemeNames());

/** The way back: the frame that weights of ARKit (in order, or by name) show. */
export function fromArkit(weights) {
  const module = library('decoder');
  const given = new Float32Array(CHANNELS);
  if (Array.isArray(weights) || ArrayBuffer.isView(weights)) given.set(weights);
  else arkitNames().forEach((name, i) => given[i] = weights[name] ?? 0);
  const {frame} = roomOf(module);
  return module.with(new Uint8Array(given.buffer), (at) => {
    module.call('arkit_to_frame', at, CHANNELS, frame);
    return readFrame(module.memory, frame);
  });
}
