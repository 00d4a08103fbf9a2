// <animeme-face>: importing this module defines it. It imports 'three', and of 'three/addons/' the
// loader of glTF and the decoder of meshopt.
import type {Frame, Track} from './index.js';

/**
 * Attributes: `src` (.mp4, .m3u8, .fba, or the address of `animeme stream`), `head` (.glb),
 * `autoplay`, `controls`, `loop`, `muted`, `label`, `live` (src is a server), `lang` (of a file
 * with several languages; changing it switches sound, face and words at once), `captions` (shows
 * what is said). Events: `frame` (detail: Frame), `head`, `load`, `error` (ErrorEvent), `lost` (a
 * live connection was lost and is reopened), `blocked` (the browser requires a gesture first),
 * `speech` (detail: an event of a line, word or phone of `animeme stream`, when it is heard),
 * `languages` (`languages` is known), `language` (detail: the one that is heard and seen now),
 * `cue` (detail: the line that is said now, or null), and play, pause, ended, seeked, timeupdate,
 * volumechange, ratechange, durationchange. Parts for styles: `canvas`, `audio` and `caption`.
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
  /** Resolves when the face has been read completely, rejects if that fails. */
  readonly loaded: Promise<void>;
  /** Resolves when the head is loaded, rejects if that fails. */
  readonly headLoaded: Promise<void>;
  /** The current frame, and its weights in the order of arkitNames() and visemeNames(). */
  readonly frame: Frame | null;
  readonly arkit: Float32Array;
  readonly visemes: Float32Array;
  readonly track: Track;
  /** Those of the file, the default first; `lang` chooses one. */
  readonly languages: {lang: string, name: string}[];
  /** The one that is heard and seen; empty: the file does not tell. */
  readonly language: string;
  /** What is said in it, as far as it has been read. */
  readonly lines: {start: number, end: number, text: string}[];
  /** A track of captions, as of a media element. */
  readonly textTracks: TextTrackList;
}

declare global {
  interface HTMLElementTagNameMap { 'animeme-face': AnimemeFace; }
}
