// MPEG-4 facial animation in browsers and node.

/**
 * Loads the decoder; call once before anything else. Pass `source` if `wasm/decoder.wasm` cannot be
 * fetched.
 */
export function ready(source?: WasmSource | Promise<WasmSource>): Promise<void>;
/** Version of the library at run time: "0.1.0". */
export function version(): string;

export type WasmSource = BufferSource | Response | WebAssembly.Module;

export type ErrorCode =
    'invalid_argument' | 'syntax' | 'out_of_range' | 'truncated' | 'unsupported' | 'not_found'
  | 'io' | 'internal' | 'no_memory';

/** An error: a sentence, and its position. */
export class AnimemeError extends Error {
  constructor(code: ErrorCode, message: string, place?: {bit?: number; line?: number;
      column?: number});
  readonly code: ErrorCode;
  /** Of a stream; -1: no stream position. */
  readonly bit: number;
  /** Of a text, from 1; 0: no text position. */
  readonly line: number;
  readonly column: number;
}

/** FAP 1. */
export interface Viseme { select1: number; select2: number; blend: number; def: boolean; }
/** FAP 2. */
export interface Expression {
  select1: number; intensity1: number; select2: number; intensity2: number; initFace: boolean;
      def: boolean;
}

/** A frame of a face. */
export interface Frame {
  /** Presentation time in seconds. */
  time: number;
  /** At the rate, from 0; gaps are skipped frames. */
  number: number;
  /** [frames, seconds]: frames per number of seconds. */
  rate: [number, number];
  /** Decoders can begin here. */
  intra: boolean;
  /** The plane codes a face. */
  face: boolean;
  /** FAP n at index n - 1, in FAP units (angles: 1e-5 rad); 0 if the mask is 0. */
  values: Int32Array;
  /** 1: the frame has this FAP. */
  mask: Uint8Array;
  viseme: Viseme | null;
  expression: Expression | null;
  /**
   * For each of the ten groups, the rule for absent FAPs: 0 unknown, 1 hold, 2 follow another FAP.
   */
  rules: Uint8Array;
  /** With {bodies: true}: BAP n at index n - 1. */
  body?: {values: Int32Array; mask: Uint8Array} | null;
}

/** A frame as an argument: only `values` is required. */
export type FrameLike = Pick<Frame, 'values'> & Partial<Frame>;

export interface ReceiverOptions {
  /** Convert FAP 1 and 2 to low-level FAPs (true). */
  expand?: boolean;
  /** FAPs that were never sent are present, at 0 (true). */
  complete?: boolean;
}

export interface DecoderOptions {
  /** Return frames as a receiver shows them, not as coded (false). */
  shown?: boolean | ReceiverOptions;
  /** Also return bodies (false). */
  bodies?: boolean;
}

/** Owns WebAssembly memory until free() or garbage collection. */
declare class Handle {
  free(): void;
}

/** Push bytes of an FBA stream, pull frames. */
export class Decoder extends Handle implements Iterable<Frame> {
  constructor(options?: DecoderOptions);
  push(bytes: Uint8Array): void;
  /** No more bytes will come. */
  finish(): void;
  /**
   * The next frame; null: push more, or `ended`. Throws AnimemeError at damage; call again to
   * continue after it.
   */
  next(): Frame | null;
  readonly ended: boolean;
  /** Resets the decoder: the next byte begins another stream. */
  reset(): void;
  /** Number of anomalies that did not prevent decoding. */
  readonly warnings: number;
  /** The frames that are complete so far. */
  [Symbol.iterator](): Iterator<Frame>;
}

/** All frames of a stream; fails at its first error. */
export function decode(bytes: Uint8Array, options?: DecoderOptions): Frame[];

/** Converts coded frames to shown ones: absent FAPs are held, mirrored, or follow the other lip. */
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

/** ARKit's 52 weights for a single frame, which should be complete (shown), by name. */
export function arkit(frame: FrameLike): Record<string, number>;
/** The 15 Oculus visemes for a single frame, by name; their sum is 1. */
export function visemes(frame: FrameLike): Record<string, number>;
/** Converts ARKit weights to a frame. */
export function fromArkit(weights: ArrayLike<number> | Record<string, number>): Frame;

/** For consecutive frames: weights (0..1) and angles (radians) in the order of arkitNames(). */
export class ArkitFitter extends Handle {
  constructor();
  fit(frame: FrameLike, out?: Float32Array): Float32Array;
}
/** For consecutive frames: weights in the order of visemeNames(). */
export class VisemeFitter extends Handle {
  constructor();
  fit(frame: FrameLike, out?: Float32Array): Float32Array;
}

/** Seconds; upper-case ARPAbet without stress, or "SIL". */
export interface Phone { phone: string; start: number; end: number; }

export interface SpeakOptions {
  /** Frames a second (25), or [frames, seconds]. */
  rate?: number | [number, number];
  /** Amount of motion: 0..1.5 (1). */
  style?: number;
  /** Quickness: 0..3 (1). */
  sharpness?: number;
  /** Clarity of vowels: 0..2 (1). */
  articulation?: number;
  /** Seconds after the script: 0..60 (0). */
  tail?: number;
  /** Liveliness of gaze, blinks, brows and head: 0..2 (1); 0: none. Not of begin(). */
  idleMotion?: number;
  /** Seed of the idle motion (1). */
  seed?: number | bigint;
  /** "joy", "anger:0.5", "thinking" ... ("neutral"). */
  mood?: string;
  /**
   * Where the eyes look: "camera", "away", "YAW,PITCH" in degrees, "X,Y,Z" in metres ("camera").
   * Not of begin().
   */
  look?: string;
  /** Parts without idle motion: "gaze,head,brows,blinks" (""). Not of begin(). */
  still?: string;
  /** FAP 44 to 47 follow the sounds, for models that do not have the tongue (true). */
  tongue?: boolean;
  /** The resting mouth is the same on both sides (true), or as learned. */
  symmetric?: boolean;
  /** For begin(): seconds; below 0: unlimited (-1). */
  lookAhead?: number;
}

/** Converts phones to frames with a model of a speaker. */
export class Speaker extends Handle {
  private constructor();
  /**
   * A model (.dam) as bytes or URL; default: the model of the package. Loads speaker.wasm (or
   * `source`).
   */
  static load(model?: BufferSource | string | URL,
      source?: WasmSource | Promise<WasmSource>): Promise<Speaker>;
  /** The attribution required when the model is redistributed. */
  readonly attribution: string;
  /** Phones, or a script as text: TextGrid, TSV, label files ... */
  speak(phones: Phone[] | string, options?: SpeakOptions): Frame[];
  /** Starts incremental speech. */
  begin(options?: SpeakOptions): Speech;
}

/** Incremental speech: push phones and get frames as soon as they are final. */
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

/**
 * Reads the face of an mp4 incrementally: files, fragments, segments after their initialisation.
 */
export class Mp4Reader {
  constructor();
  push(bytes: Uint8Array): AccessUnit[];
  /** Throws if the file has no face or ends before it. */
  finish(): void;
  /** Available after the moov box. */
  readonly track: {config: Uint8Array; timescale: number} | null;
}

/** Decodes access units to frames. After a gap (skip) it continues at the next intra plane. */
export class UnitDecoder {
  constructor(config: Uint8Array, options?: DecoderOptions);
  decode(unit: AccessUnit): Frame[];
  skip(): void;
  free(): void;
}

/** Frames ordered by time. */
export class Track {
  constructor();
  readonly frames: Frame[];
  /** Seconds. */
  readonly end: number;
  add(frames: Frame[]): void;
  /** The frame shown at a time. */
  at(time: number): Frame | null;
  indexAt(time: number): number;
  clear(): void;
  /** Drops frames before a time. */
  forget(time: number): void;
}

/** What FaceReceiver is made with. */
export interface FaceReceiverOptions {
  /** A UnitDecoder for a configuration. */
  decoder: (config: Uint8Array) => UnitDecoder;
  track: Track;
  /** Seconds from a message to the sound that was sent with it; default: 0. */
  delay?: () => number;
  /** Seconds; default: those of performance.now(). */
  wall?: () => number;
}

/** The face of a voice agent in a call (tools/bindings/agents), from the messages of its channel. */
export class FaceReceiver {
  constructor(options: FaceReceiverOptions);
  /** A message; those of other topics are left alone. */
  take(topic: string, bytes: Uint8Array): void;
  /** The data of a message that is JSON, as Pipecat's clients hand it to onServerMessage. */
  takeMessage(data: {topic?: string; base64?: string}): void;
  /** The face to be shown now. The mouth is closed while the sound is paused. */
  now(): Frame | null;
  /** Seconds on the clock of the sound. */
  time(): number;
}

/** The face of an mp4 in memory, as a receiver shows it. */
export function decodeMp4(bytes: Uint8Array | ArrayBuffer, options?: DecoderOptions): Track;

/** The argument of TalkingHead's speakAudio() and streamAudio(); times in milliseconds. */
export interface TalkingHeadAudio<Audio> {
  audio: Audio;
  words: string[]; wtimes: number[]; wdurations: number[];
  visemes?: string[]; vtimes?: number[]; vdurations?: number[];
  anim?: {name: string; dt: number[]; vs: Record<string, number[]>};
  anims?: {name: string; dt: number[]; vs: Record<string, number[]>; delay: number}[];
}

/**
 * Frames (shown) for TalkingHead: visemes with times, or with {shapes: true} ARKit's shapes frame
 * by frame.
 */
export function talkingHead<Audio>(frames: Frame[], audio: Audio, options?: {
  shapes?: boolean;
  words?: {text: string; start: number; end: number}[];
}): TalkingHeadAudio<Audio>;
