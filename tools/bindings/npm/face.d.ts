// <animeme-face>: importing this module defines it. It imports 'three' and 'three/addons/loaders/GLTFLoader.js'.
import type {Frame, Track} from './index.js';

/**
 * Attributes: `src` (.mp4, .m3u8, .fba, or the address of `animeme stream`), `head` (.glb), `autoplay`, `controls`,
 * `loop`, `muted`, `label`, `live` (src is a server). Events: `frame` (detail: Frame), `head`, `load`, `error`
 * (ErrorEvent), `lost` (a live connection, which is opened again), `blocked` (the browser wants a gesture first),
 * `speech` (detail: what `animeme stream` tells of lines, words and phones, when it is heard), and play, pause, ended,
 * seeked, timeupdate, volumechange, ratechange, durationchange. Parts for styles: `canvas` and `audio`.
 */
export class AnimemeFace extends HTMLElement {
  src: string | null;
  head: string | null;
  currentTime: number;
  readonly duration: number;
  readonly paused: boolean;
  readonly ended: boolean;
  volume: number;
  playbackRate: number;
  play(): Promise<void>;
  pause(): void;
  /** Resolves when the face was read to its end, rejects if it cannot be. */
  readonly loaded: Promise<void>;
  /** Resolves when the head is there, rejects if it cannot be. */
  readonly headLoaded: Promise<void>;
  /** What is shown: the frame, and its weights in the order of arkitNames() and visemeNames(). */
  readonly frame: Frame | null;
  readonly arkit: Float32Array;
  readonly visemes: Float32Array;
  readonly track: Track;
}

declare global {
  interface HTMLElementTagNameMap { 'animeme-face': AnimemeFace; }
}
