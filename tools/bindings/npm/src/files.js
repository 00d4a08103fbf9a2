// A face in a file: the element of the page plays the sound, its planes are read beside it.
import {decode} from './decoder.js';
import {AnimemeError} from './library.js';
import {Mp4Reader} from './mp4.js';
import {UnitDecoder} from './track.js';

const checked = (response) => {
  if (response.ok) return response;
  throw new AnimemeError('io', `${response.url}: ${response.status} ${response.statusText}`);
};

async function readMp4(response, track) {
  const reader = new Mp4Reader(), stream = response.body.getReader();
  let decoder = null;
  try {
    for (;;) {
      const {done, value} = await stream.read();
      if (done) break;
      for (const unit of reader.push(value)) {
        decoder ??= new UnitDecoder(reader.track.config);
        track.add(decoder.decode(unit));
      }
    }
    reader.finish();
  } finally {
    decoder?.free();
    stream.cancel().catch(() => {});
  }
}

/**
 * Plays an mp4 by `media` while its face goes into `track`; resolves when all of the face is there.
 */
export async function openMp4(url, {media, track, signal}) {
  media.src = url;
  await readMp4(checked(await fetch(url, {signal})), track);
}

/** A stream of FBA alone: there is no sound. */
export async function openFba(url, {media, track, signal}) {
  const bytes = new Uint8Array(await checked(await fetch(url, {signal})).arrayBuffer());
  track.add(decode(bytes, {shown: true}));
  media.duration = track.end;
}
