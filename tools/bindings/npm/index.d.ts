// MPEG-4 facial animation in browsers and node.

/** Loads the decoder: once, before anything else is called. `source` where `wasm/decoder.wasm` cannot be fetched. */
export function ready(source?: WasmSource | Promise<WasmSource>): Promise<void>;
/** "0.1.0": of the library that runs. */
export function version(): string;

export type WasmSource = BufferSource | Response | WebAssembly.Module;

export type ErrorCode = 'invalid_argument' | 'syntax' | 'out_of_range' | 'truncated' | 'unsupported' | 'not_found'
  | 'io' | 'internal' | 'no_memory';

/** What failed, as a sentence, and where. */
export class AnimemeError extends Error {
  constructor(code: ErrorCode, message: string, place?: {bit?: number; line?: number; column?: number});
  readonly code: ErrorCode;
  /** Of a stream; -1: no place in a stream. */
  readonly bit: number;
  /** Of a text, from 1; 0: no place in a text. */
  readonly line: number;
  readonly column: number;
}

/** FAP 1. */
export interface Viseme { select1: number; select2: number; blend: number; def: boolean; }
/** FAP 2. */
export interface Expression {
  select1: number; intensity1: number; select2: number; intensity2: number; initFace: boolean; def: boolean;
}

/** One instant of a face. */
export interface Frame {
  /** Seconds at which it is shown. */
  time: number;
  /** At the rate, from 0; gaps are skipped frames. */
  number: number;
  /** Frames, in so many seconds. */
  rate: [number, number];
  /** Decoders can begin here. */
  intra: boolean;
  /** The plane codes a face. */
  face: boolean;
  /** FAP n at index n - 1, in FAP units (angles: 1e-5 rad); 0 where the mask is 0. */
  values: Int32Array;
  /** 1: the frame has this FAP. */
  mask: Uint8Array;
  viseme: Viseme | null;
  expression: Expression | null;
  /** Of the ten groups: what absent FAPs do: 0 unknown, 1 hold, 2 follow others. */
  rules: Uint8Array;
  /** With {bodies: true}: BAP n at index n - 1. */
  body?: {values: Int32Array; mask: Uint8Array} | null;
}

/** What is read of a frame that is given: `values` alone will do. */
export type FrameLike = Pick<Frame, 'values'> & Partial<Frame>;

export interface ReceiverOptions {
  /** FAP 1 and 2 become low-level FAPs (true). */
  expand?: boolean;
  /** FAPs that were never sent are there, at 0 (true). */
  complete?: boolean;
}

export interface DecoderOptions {
  /** Frames as a receiver shows them, not as they are coded (false). */
  shown?: boolean | ReceiverOptions;
  /** Also bodies (false). */
  bodies?: boolean;
}

/** Holds memory outside of JavaScript's, until free() or until it is forgotten. */
declare class Handle {
  free(): void;
}

/** Push bytes of an FBA stream, pull frames. */
export class Decoder extends Handle implements Iterable<Frame> {
  constructor(options?: DecoderOptions);
  push(bytes: Uint8Array): void;
  /** No more bytes will come. */
  finish(): void;
  /** The next frame; null: push more, or `ended`. Throws AnimemeError at damage; called again, it goes on behind it. */
  next(): Frame | null;
  readonly ended: boolean;
  /** Forgets all: the next byte begins another stream. */
  reset(): void;
  /** How often something was not as it should be and could be read all the same. */
  readonly warnings: number;
  /** Frames up to where bytes are missing. */
  [Symbol.iterator](): Iterator<Frame>;
}

/** All frames of a stream; fails at its first error. */
export function decode(bytes: Uint8Array, options?: DecoderOptions): Frame[];

/** From coded frames to what is shown: FAPs that are not sent are held, mirrored, or follow the other lip. */
export class Receiver extends Handle {
  constructor(options?: ReceiverOptions);
  /** null: no frame arrived, the last one is held. */
  show(frame: FrameLike | null): Frame;
}

/** "viseme", "expression", "open_jaw" ...: 68. */
export function fapNames(): readonly string[];
/** 52 shapes ("eyeBlinkLeft" ...), then 9 angles ("headYaw" ...). */
export function arkitNames(): readonly string[];
/** "viseme_sil", "viseme_PP" ...: 15. */
export function visemeNames(): readonly string[];

/** ARKit's 52 weights of a single frame, which should be complete (shown), by name. */
export function arkit(frame: FrameLike): Record<string, number>;
/** The 15 visemes of Oculus of a single frame, by name; 1 together. */
export function visemes(frame: FrameLike): Record<string, number>;
/** The frame that weights of ARKit show. */
export function fromArkit(weights: ArrayLike<number> | Record<string, number>): Frame;

/** Frames that follow each other: weights (0..1) and angles (radians) in the order of arkitNames(). */
export class ArkitFitter extends Handle {
  constructor();
  fit(frame: FrameLike, out?: Float32Array): Float32Array;
}
/** Likewise, in the order of visemeNames(). */
export class VisemeFitter extends Handle {
  constructor();
  fit(frame: FrameLike, out?: Float32Array): Float32Array;
}

/** Seconds; upper-case ARPAbet without stress, or "SIL". */
export interface Phone { phone: string; start: number; end: number; }

export interface SpeakOptions {
  /** Frames a second (25), or [frames, in so many seconds]. */
  rate?: number | [number, number];
  /** How much of the motion is shown: 0..1.5 (1). */
  style?: number;
  /** How quick it is: 0..3 (1). */
  sharpness?: number;
  /** How clearly vowels show: 0..2 (1). */
  articulation?: number;
  /** Seconds behind the script: 0..60 (0). */
  tail?: number;
  /** Brows and head: 0..2 (1); below 0: no blinks either. Not of begin(). */
  idleMotion?: number;
  /** Another one, other blinks (1). */
  seed?: number | bigint;
  /** Of begin(): seconds; below 0: as far as it takes (-1). */
  lookAhead?: number;
}

/** Phones to frames, by a model of how somebody talks. */
export class Speaker extends Handle {
  private constructor();
  /** A model (.dam) as bytes or address; without one that of the package. Loads speaker.wasm (or `source`). */
  static load(model?: BufferSource | string | URL, source?: WasmSource | Promise<WasmSource>): Promise<Speaker>;
  /** Who has to be named when the model is passed on. */
  readonly attribution: string;
  /** Phones, or a script as text: TextGrid, TSV, label files ... */
  speak(phones: Phone[] | string, options?: SpeakOptions): Frame[];
  /** Phones that are still coming. */
  begin(options?: SpeakOptions): Speech;
}

/** Phones go in, frames come out as soon as they are final. */
export class Speech extends Handle implements Iterable<Frame> {
  private constructor();
  push(phone: Phone): void;
  finish(): void;
  /** null: push more, or `ended`. */
  next(): Frame | null;
  readonly ended: boolean;
  [Symbol.iterator](): Iterator<Frame>;
}

/** A plane as containers carry it. */
export interface AccessUnit { time: number; duration: number; intra: boolean; bytes: Uint8Array; }

/** The face of an mp4 while it arrives: files, fragments, segments behind their initialisation. */
export class Mp4Reader {
  constructor();
  push(bytes: Uint8Array): AccessUnit[];
  /** Throws if the file has no face or ends before it. */
  finish(): void;
  /** Once the contents were read. */
  readonly track: {config: Uint8Array; timescale: number} | null;
}

/** Access units to frames. After a gap (skip) it goes on at the next intra plane. */
export class UnitDecoder {
  constructor(config: Uint8Array, options?: DecoderOptions);
  decode(unit: AccessUnit): Frame[];
  skip(): void;
  free(): void;
}

/** Frames in the order of their times. */
export class Track {
  constructor();
  readonly frames: Frame[];
  /** Seconds. */
  readonly end: number;
  add(frames: Frame[]): void;
  /** The frame that is shown at a time. */
  at(time: number): Frame | null;
  indexAt(time: number): number;
  clear(): void;
  /** Drops what is before a time. */
  forget(time: number): void;
}

/** The face of an mp4 in memory, as a receiver shows it. */
export function decodeMp4(bytes: Uint8Array | ArrayBuffer, options?: DecoderOptions): Track;

/** What speakAudio() of TalkingHead takes; times in milliseconds. */
export interface TalkingHeadAudio<Audio> {
  audio: Audio;
  words: string[]; wtimes: number[]; wdurations: number[];
  visemes?: string[]; vtimes?: number[]; vdurations?: number[];
  anim?: {name: string; dt: number[]; vs: Record<string, number[]>};
}

/** Frames (shown) for TalkingHead: visemes with times, or with {shapes: true} ARKit's shapes frame by frame. */
export function talkingHead<Audio>(frames: Frame[], audio: Audio, options?: {
  shapes?: boolean;
  words?: {text: string; start: number; end: number}[];
}): TalkingHeadAudio<Audio>;
