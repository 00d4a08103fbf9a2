// Animeme in browsers and node: MPEG-4 facial animation. See ../README.md.
import {library, need} from './modules.js';

export {AnimemeError} from './library.js';
export {decode, Decoder, Receiver} from './decoder.js';
export {arkit, ArkitFitter, arkitNames, fapNames, fromArkit, VisemeFitter, visemeNames,
    visemes} from './weights.js';
export {Speaker, Speech} from './speaker.js';
export {Mp4Reader} from './mp4.js';
export {decodeMp4, Track, UnitDecoder} from './track.js';
export {FaceReceiver} from './face_receiver.js';
export {talkingHead} from './talkinghead.js';

/**
 * Loads the decoder; `source` is its bytes, a Response or a compiled module where ../wasm cannot be
 * fetched.
 */
export async function ready(source) { await need('decoder', source); }

/** "0.1.0": that of the library that runs. */
export function version() {
  const module = library('decoder');
  return module.text(module.functions.animeme_version_text());
}
