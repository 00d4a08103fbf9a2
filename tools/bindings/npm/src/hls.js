// HLS as `animeme mux -o talk.m3u8` writes it: the sound by MediaSource, the face from its own
// rendition.
import {addWord, cuesOfVtt, languageIn} from './languages.js';
import {AnimemeError} from './library.js';
import {Mp4Reader} from './mp4.js';
import {SoundBuffer} from './sound.js';
import {UnitDecoder} from './track.js';

const kLongest = 86400;  // seconds of a segment
const kAhead = 30;  // seconds that are loaded in front of the player

const attributes = (text) => Object.fromEntries(
  [...text.matchAll(/(?:^|,)\s*([A-Z0-9-]+)=("[^"]*"|[^,]*)/g)].map(([, name, value]) => [name,
      value.replace(/^"|"$/g, '')]));

function addressOf(text, url) {
  try {
    return new URL(text, url).href;
  } catch {
    throw new AnimemeError('syntax', `${url} names an address that is none`);
  }
}

/**
 * A playlist: {face, sound, renditions: [{type, lang, name, url, chosen}]} of a master, {init,
 * segments: [{url, begin, end}]} of a rendition.
 */
export function readPlaylist(text, url) {
  const lines = text.split(/\r?\n/);
  if (!lines[0].startsWith('#EXTM3U')) throw new AnimemeError('syntax', `${url} is not a playlist`);
  const out = {face: null, sound: null, init: null, segments: [], codecs: null, complete: false,
    renditions: []};
  let duration = 0, time = 0, variant = null;
  for (const line of lines) {
    const [tag, rest] = [line.split(':', 1)[0], line.slice(line.indexOf(':') + 1)];
    if (tag === '#EXT-X-MEDIA') {
      const {TYPE: type, 'GROUP-ID': group, URI: uri, LANGUAGE: lang = '', NAME: name = '',
        DEFAULT: chosen} = attributes(rest);
      const face = type === 'VIDEO' && group === 'face' && uri;
      if (uri) out.renditions.push({type: face ? 'FACE' : type, lang, name,
        url: addressOf(uri, url), chosen: chosen === 'YES'});
      if (face) out.face ??= addressOf(uri, url);
    } else if (tag === '#EXT-X-STREAM-INF') {
      variant = attributes(rest);
    } else if (tag === '#EXT-X-MAP') {
      out.init = addressOf(attributes(rest).URI ?? '', url);
    } else if (tag === '#EXTINF') {
      duration = parseFloat(rest);
      if (!(duration >= 0 && duration < kLongest))
          throw new AnimemeError('syntax', `${url} has a segment without a length`);
    } else if (tag === '#EXT-X-ENDLIST') {
      out.complete = true;
    } else if (line && !line.startsWith('#')) {
      const address = addressOf(line, url);
      if (!variant) {
        out.segments.push({url: address, begin: time, end: time += duration});
        continue;
      }
      // A face without a sound is the variant itself.
      if (/^mp4[sv]\.20/.test(variant.CODECS ?? '')) out.face ??= address;
      else if (!out.sound) [out.sound, out.codecs] = [address, variant.CODECS];
      variant = null;
    }
  }
  return out;
}

async function load(url, signal) {
  const response = await fetch(url, {signal});
  if (!response.ok)
      throw new AnimemeError('io', `${url}: ${response.status} ${response.statusText}`);
  return response;
}

const bytesOf = async (url,
    signal) => new Uint8Array(await (await load(url, signal)).arrayBuffer());

async function playlistOf(url, signal) {
  const list = readPlaylist(await (await load(url, signal)).text(), url);
  if (!list.face && !list.sound && !list.complete) {
    throw new AnimemeError('unsupported',
        `${url} is still being written; use the WebSocket for live faces`);
  }
  return list;
}

// Loads the segments of a rendition that are next at the player's time, one after the other.
async function follow(list, media, signal, use) {
  const left = new Set(list.segments), last = list.segments.at(-1);
  while (left.size && !signal.aborted) {
    const time = Math.min(media.currentTime, last.begin);
    const next = list.segments.find((segment) =>
      left.has(segment) && segment.end > time && segment.begin < time + kAhead);
    if (!next) {
      await new Promise((done) => setTimeout(done, 100));
      continue;
    }
    left.delete(next);
    await use(await bytesOf(next.url, signal), left);
  }
}

async function initOf(list, url, signal) {
  if (!list.init) throw new AnimemeError('syntax', `${url} has no #EXT-X-MAP`);
  return bytesOf(list.init, signal);
}

async function openFace(url, media, track, signal) {
  const list = await playlistOf(url, signal), init = await initOf(list, url, signal);
  const end = list.segments.at(-1)?.end ?? 0;
  if (media.duration === 0) media.duration = end;  // nothing else tells it
  await follow(list, media, signal, (bytes) => {
    const reader = new Mp4Reader();
    reader.push(init);
    reader.finish();
    // each segment begins with an intra plane
    const decoder = new UnitDecoder(reader.track.config);
    for (const unit of reader.push(bytes)) track.add(decoder.decode(unit));
    decoder.free();
  });
}

async function openSound(url, codecs, media, signal) {
  const list = await playlistOf(url, signal);
  const init = await initOf(list, url, signal);
  const buffer = new SoundBuffer(media, init, codecs);
  signal.addEventListener('abort', () => buffer.close());
  await buffer.opened;
  buffer.setDuration(list.segments.at(-1)?.end ?? 0);
  await follow(list, media, signal, async (bytes, left) => {
    await buffer.append(bytes);
    if (!left.has(list.segments.at(-1))) buffer.end();
  });
}

// What is said, before it is wanted; a film without it plays on.
async function openWords({url, name}, words, signal) {
  const list = readPlaylist(await (await load(url, signal)).text(), url);
  for (const segment of list.segments) {
    for (const cue of cuesOfVtt(await (await load(segment.url, signal)).text())) {
      if (name.startsWith('captions')) words.push(cue);
      else addWord(words, cue);
    }
  }
}

// {lang, name, face, sound, codecs, words}: by the languages of the faces.
function languagesOf(master) {
  const of = (type) => master.renditions.filter((each) => each.type === type);
  const faces = of('FACE').filter(({lang}) => lang), seen = new Set();
  const out = [];
  for (const {lang, name, url} of faces) {
    if (seen.has(lang)) continue;
    seen.add(lang);
    const same = (list) => list.find((each) => each.lang === lang);
    const texts = of('SUBTITLES').filter((each) => /^(captions|words)\b/.test(each.name));
    out.push({lang, name, face: url, sound: same(of('AUDIO'))?.url ?? master.sound,
      codecs: master.codecs, words: same(texts) ?? null});
  }
  if (out.length) return out;
  return [{lang: '', name: '', face: master.face, sound: master.sound, codecs: master.codecs,
    words: null}];
}

async function openLanguage({face, sound, codecs, words: texts}, {media, silent, track, words,
    signal}) {
  const player = sound ? media : silent();
  // Variants of sound and face name the codecs of both.
  const heard = codecs?.split(',').find((codec) => !/^mp4[sv]\.20/.test(codec.trim()))?.trim();
  if (texts && words) openWords(texts, words, signal).catch(() => {});
  await Promise.all([
    openFace(face, player, track, signal),
    sound ? openSound(sound, heard || undefined, media, signal) : null,
  ]);
}

/** Plays a playlist; resolves when all of it was loaded. */
export async function openHls(url, source) {
  const master = await playlistOf(url, source.signal);
  if (!master.face) throw new AnimemeError('unsupported', `${url} has no face`);
  const languages = languagesOf(master);
  source.offer?.(languages.map((each) =>
      ({lang: each.lang, name: each.name, open: (to) => openLanguage(each, to)})));
  await openLanguage(languages[languageIn(languages, source.lang)], source);
}
