// The structs of animeme.h in the memory of a module. tools/bindings/npm/weights.cpp holds the
// compiler to these places.

export const FAPS = 68;
export const BAPS = 296;
export const FRAME_SIZE = 432;
export const BODY_SIZE = 1496;
export const ERROR_SIZE = 512;
export const SPEAK_OPTIONS_SIZE = 176, TEXT_SIZE = 32;

const INTRA = 1, FACE = 2, BODY = 4;
const VALUE = 32, PRESENT = 304, VISEME = 372, EXPRESSION = 388, RULES = 412;

const viseme = ([select1, select2, blend, def]) => ({select1, select2, blend, def: def !== 0});
const expression = ([select1, intensity1, select2, intensity2, initFace, def]) =>
  ({select1, intensity1, select2, intensity2, initFace: initFace !== 0, def: def !== 0});

/** An animeme_frame as an object of its own. */
export function readFrame(memory, at) {
  const view = new DataView(memory, at, FRAME_SIZE);
  const flags = view.getUint32(4, true);
  const mask = new Uint8Array(memory, at + PRESENT, FAPS).slice();
  return {
    time: view.getFloat64(16, true),
    number: Number(view.getBigInt64(8, true)),
    rate: [view.getUint32(24, true), view.getUint32(28, true)],
    intra: (flags & INTRA) !== 0,
    face: (flags & FACE) !== 0,
    values: new Int32Array(memory, at + VALUE, FAPS).slice(),
    mask,
    viseme: mask[0] ? viseme(new Int32Array(memory, at + VISEME, 4)) : null,
    expression: mask[1] ? expression(new Int32Array(memory, at + EXPRESSION, 6)) : null,
    rules: new Uint8Array(memory, at + RULES, 10).slice(),
  };
}

/** What the plane that readFrame() is of has of a body. */
export function readBody(memory, frame, at) {
  const flags = new DataView(memory, frame, FRAME_SIZE).getUint32(4, true);
  if (!(flags & BODY)) return null;
  return {
    values: new Int32Array(memory, at + 16, BAPS).slice(),
    mask: new Uint8Array(memory, at + 1200, BAPS).slice(),
  };
}

/**
 * The way back. What is missing is as in an empty frame; values count where the mask is set, or all
 * without one.
 */
export function writeFrame(memory, at, frame) {
  const view = new DataView(memory, at, FRAME_SIZE);
  new Uint8Array(memory, at, FRAME_SIZE).fill(0);
  view.setUint32(0, FRAME_SIZE, true);
  view.setUint32(4, (frame.intra ? INTRA : 0) | (frame.face === false ? 0 : FACE), true);
  view.setBigInt64(8, BigInt(frame.number ?? 0), true);
  view.setFloat64(16, frame.time ?? 0, true);
  view.setUint32(24, frame.rate?.[0] ?? 0, true);
  view.setUint32(28, frame.rate?.[1] ?? 0, true);
  new Int32Array(memory, at + VALUE, FAPS).set(frame.values);
  const present = new Uint8Array(memory, at + PRESENT, FAPS);
  if (frame.mask) present.set(frame.mask);
  else present.fill(1, 2);
  if (frame.viseme) new Int32Array(memory, at + VISEME, 4).set(viseme4(frame.viseme));
  if (frame.expression) new Int32Array(memory, at + EXPRESSION,
      6).set(expression6(frame.expression));
  if (frame.rules) new Uint8Array(memory, at + RULES, 10).set(frame.rules);
}

const viseme4 = ({select1 = 0, select2 = 0, blend = 0, def = false}) => [select1, select2, blend,
    def ? 1 : 0];
const expression6 = ({select1 = 0, intensity1 = 0, select2 = 0, intensity2 = 0, initFace = false,
    def = false}) =>
  [select1, intensity1, select2, intensity2, initFace ? 1 : 0, def ? 1 : 0];

/** An animeme_speak_options that `_init` has filled. */
export function writeSpeakOptions(memory, at, options) {
  const {rate, style, sharpness, articulation, tail, idleMotion, seed, lookAhead, mood, look, still,
      tongue, symmetric} = options;
  const view = new DataView(memory, at, SPEAK_OPTIONS_SIZE);
  if (rate !== undefined) {
    const [num, den] = Array.isArray(rate) ? rate : rateOf(rate);
    view.setUint32(4, num, true);
    view.setUint32(8, den, true);
  }
  [style, sharpness, articulation, tail, idleMotion].forEach((value, i) => {
    if (value !== undefined) view.setFloat64(16 + 8 * i, value, true);
  });
  if (seed !== undefined) view.setBigUint64(56, BigInt(seed), true);
  if (lookAhead !== undefined) view.setFloat64(64, lookAhead, true);
  if (tongue !== undefined) view.setUint32(168, tongue ? 1 : 0, true);
  if (symmetric !== undefined) view.setUint32(172, symmetric ? 0 : 1, true);
  [mood, look, still].forEach((text, i) => {
    if (text === undefined) return;
    const bytes = new TextEncoder().encode(text).subarray(0, TEXT_SIZE - 1);
    new Uint8Array(memory, at + 72 + TEXT_SIZE * i, TEXT_SIZE).fill(0).set(bytes);
  });
}

// 29.97 and its like are whole numbers of frames in 1001 seconds.
function rateOf(rate) {
  if (Number.isInteger(rate)) return [rate, 1];
  const ntsc = Math.round(rate * 1.001);
  if (Math.abs(ntsc / 1.001 - rate) < 0.005) return [ntsc * 1000, 1001];
  return [Math.round(rate * 1000), 1000];
}
