// The sockets of `animeme stream --to http://...`: /face, and /audio if there is a sound. tools/live/web/protocol.md has the
// bytes.
import {AnimemeError} from './library.js';
import {SoundBuffer} from './sound.js';
import {UnitDecoder} from './track.js';

const kTarget = 0.35;  // seconds that are kept in front of the player
const kJump = 0.6;     // further behind than that: jump instead of hurrying
const kSkip = 0.3;     // the same without a sound, where nobody hears it
const kKeep = 10;      // seconds of frames that are kept

/** First message of /face. */
export function readHello(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < 10 || bytes[0] !== 0x41)
      throw new AnimemeError('syntax', 'this is not an animeme server');
  if (bytes[1] !== 1)
      throw new AnimemeError('unsupported', `this server speaks version ${bytes[1]} of /face`);
  const size = view.getUint16(8);
  return {sound: (bytes[3] & 1) !== 0, timescale: view.getUint32(4) || 1,
      config: bytes.slice(10, 10 + size)};
}

/** Any further one: an access unit; `missed`: units in front of it were dropped. */
export function readUnit(bytes, timescale) {
  if (bytes.length < 13) throw new AnimemeError('syntax', 'a message of /face is too short');
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  return {
    time: Number(view.getBigUint64(0)) / timescale, duration: view.getUint32(8) / timescale,
    intra: (bytes[12] & 1) !== 0, missed: (bytes[12] & 2) !== 0, bytes: bytes.slice(13),
  };
}

// A socket as a queue of messages, words apart from bytes; ends quietly with status 1000, else with
// an error.
function listen(url, signal, take, told = () => {}) {
  return new Promise((done, fail) => {
    const socket = new WebSocket(url);
    socket.binaryType = 'arraybuffer';
    signal.addEventListener('abort', () => socket.close(), {once: true});
    socket.onmessage = ({data}) => {
      try {
        if (typeof data === 'string') told(data);
        else take(new Uint8Array(data));
      } catch (problem) {
        socket.close();
        fail(problem);
      }
    };
    socket.onclose = ({code}) => code === 1000 || signal.aborted ? done()
      : fail(new AnimemeError('io', `the connection to ${url} broke (${code})`));
  });
}

// Keeps the player a little behind the newest sound.
function steer(media, buffer) {
  const {range} = buffer;
  if (!range) return;
  const target = range.end - kTarget, off = target - media.currentTime;
  // What lies behind a gap is played when there is enough of it, and at once if it has to be.
  const cut = media.currentTime < range.begin && (media.paused || media.readyState < 3);
  if (target >= range.begin && (cut || off > kJump)) {
    media.currentTime = target;
    media.playbackRate = 1;
    return;
  }
  buffer.hurries = off > (buffer.hurries ? 0.03 : 0.15);
  media.playbackRate = buffer.hurries ? 1 + Math.min(0.2, Math.max(0.05, off / 2)) : off < -0.2 ?
      0.96 : 1;
}

const kRetry = [0.25, 0.5, 0.5, 0.5, ...Array(10).fill(1), 2, 4];  // seconds

// One connection to the server. `heard()`: it has begun to speak.
async function session(url, {media, silent, track, signal, told}, heard) {
  const address = (path) => {
    const whole = new URL(path, url);
    whole.search = new URL(url).search;  // a ticket
    return whole.href.replace(/^http/, 'ws');
  };
  let hello = null, decoder = null, buffer = null, player = media, failSound;
  const noSound = new Promise((_, fail) => { failSound = fail; });
  let sound = null;
  const takeSound = (bytes) => {
    if (!buffer) buffer = new SoundBuffer(media, bytes);
    else buffer.opened.then(() => buffer.append(bytes)).catch(failSound);
  };
  const takeFace = (bytes) => {
    if (!hello) {
      hello = readHello(bytes);
      heard();
      if (hello.config.length) decoder = new UnitDecoder(hello.config);
      if (hello.sound) (sound = listen(address('audio'), signal, takeSound)).catch(failSound);
      else player = silent();
      return;
    }
    const unit = readUnit(bytes, hello.timescale);
    if (unit.missed) decoder?.skip();
    track.add(decoder?.decode(unit) ?? []);
    if (!hello.sound) {
      player.duration = track.end;
      if (player.currentTime < track.end - kTarget - kSkip) player.currentTime =
          track.end - kTarget;
    }
    track.forget(player.currentTime - kKeep);
  };
  const timer = setInterval(() => { if (buffer) steer(media, buffer); }, 200);
  try {
    await Promise.race([listen(address('face'), signal, takeFace, told), noSound]);
    await sound;
    if (buffer) await buffer.opened.then(() => buffer.queue).then(() => buffer.end());
  } catch (problem) {
    buffer?.detach();  // the next one begins like the first
    track.clear();
    throw problem;
  } finally {
    clearInterval(timer);
    decoder?.free();
    buffer?.close();
  }
}

/**
 * Plays what a server sends; resolves when it ends. `url`: of the server (http, ws). A connection
 * that breaks is
    opened again (`lost` is told each time), unless there never was one. */
export async function openLive(url, source) {
  let known = false;
  for (let attempt = 0;; ++attempt) {
    try {
      return await session(url, source, () => {
        known = true;
        attempt = 0;
      });
    } catch (problem) {
      if (problem.code !== 'io' || !known || source.signal.aborted) throw problem;
      source.lost?.(problem);
      // not all at once
      const wait = kRetry[Math.min(attempt, kRetry.length - 1)] * (0.75 + Math.random() / 2);
      await new Promise((done) => setTimeout(done, 1000 * wait));
      if (source.signal.aborted) return undefined;
    }
  }
}
