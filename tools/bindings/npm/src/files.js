// Files with a face: an mp4 is played by the browser while its face is read beside it.
import {decode} from './decoder.js';
import {addWord, cueOfSample, languageIn} from './languages.js';
import {AnimemeError} from './library.js';
import {Mp4Reader} from './mp4.js';
import {UnitDecoder} from './track.js';

const checked = (response) => {
  if (response.ok) return response;
  throw new AnimemeError('io', `${response.url}: ${response.status} ${response.statusText}`);
};

const kFree = [...'free'].map((letter) => letter.charCodeAt(0));
const turn = () => new Promise((done) => setTimeout(done));

// The languages of the faces: {lang, name, face, sound, words}, tracks by their ids.
function languagesOf(tracks) {
  const out = [];
  for (const {id, lang, speaker} of tracks.filter(({kind}) => kind === 'face')) {
    if (out.some((each) => each.lang === lang)) continue;
    const own = (kind, names) => tracks.find((each) => each.kind === kind && each.lang === lang &&
        (!names || names.includes(each.name)) && (!each.speaker || each.speaker === speaker));
    const sound = own('sound') ?? tracks.find(({kind}) => kind === 'sound');
    const words = own('text', ['captions']) ?? own('text', ['words']);
    out.push({lang, name: speaker, face: id, sound: sound?.id, words: words?.id,
      lines: words?.name === 'captions'});
  }
  return out;
}

// What is read of an mp4 in a language: its face and its words.
class LanguageReader {
  /** `choose` picks a language of a list when the contents are known. */
  constructor(choose, {track, words}) {
    Object.assign(this, {track, words, decoder: null, texts: null});
    this.faces = new Mp4Reader((tracks) => {
      this.languages = languagesOf(tracks);
      this.language = choose(this.languages);
      return tracks.find(({id}) => id === this.language?.face);
    });
    this.before = [];  // pieces that came before the contents
  }

  push(bytes) {
    const units = this.faces.push(bytes);
    for (const unit of units) {
      this.decoder ??= new UnitDecoder(this.faces.track.config);
      this.track.add(this.decoder.decode(unit));
    }
    if (this.words && this.before) this.before.push(bytes);
    if (!this.faces.track || !this.words) return;
    const {words: id} = this.language;
    if (this.before && id !== undefined) this.texts =
        new Mp4Reader((tracks) => tracks.find((each) => each.id === id));
    for (const piece of this.before ?? [bytes]) {
      for (const unit of this.texts?.push(piece) ?? []) this.say(cueOfSample(unit));
    }
    this.before = null;
  }

  say(cue) {
    if (!cue) return;
    if (this.language.lines) this.words.push(cue);
    else addWord(this.words, cue);
  }

  finish() { this.faces.finish(); }
  free() { this.decoder?.free(); }
}

// An mp4, piece by piece; it is kept where other languages of it may be wanted.
class Film {
  constructor(url) {
    this.url = url;
    this.pieces = [];
  }

  async read(reader, signal) {
    const stream = checked(await fetch(this.url, {signal})).body.getReader();
    try {
      for (;;) {
        const {done, value} = await stream.read();
        if (done) break;
        if (this.pieces) this.pieces.push(value);
        reader.push(value);
        if (reader.languages?.length === 1) this.pieces = null;
      }
      reader.finish();
    } finally {
      reader.free();
      stream.cancel().catch(() => {});
    }
  }

  /** The same file, with one of its sounds: the boxes of the others are said to be free. */
  withSound(tracks, sound) {
    const pieces = [...this.pieces];
    for (const {at} of tracks.filter(({kind, id}) => kind === 'sound' && id !== sound)) {
      let begin = 0;
      pieces.forEach((piece, i) => {
        const first = at - begin;
        const copy = first < piece.length && first + 4 > 0 ? piece.slice() : null;
        for (let k = 0; copy && k < 4; ++k) {
          if (first + k >= 0 && first + k < copy.length) copy[first + k] = kFree[k];
        }
        if (copy) pieces[i] = copy;
        begin += piece.length;
      });
    }
    return URL.createObjectURL(new Blob(pieces, {type: 'audio/mp4'}));
  }

  // Another language, once all of the file is there.
  async open(which, {media, silent, track, words, signal}) {
    const reader = new LanguageReader((languages) => languages[which], {track, words});
    try {
      for (const piece of this.pieces) {
        if (signal.aborted) return;
        reader.push(piece);
        await turn();
      }
      reader.finish();
    } finally {
      reader.free();
    }
    this.play(reader, {media, silent, track, signal});
  }

  play(reader, {media, silent, track, signal}) {
    const {sound} = reader.language;
    if (sound === undefined) {
      silent().duration = track.end;
      return;
    }
    const url = this.withSound(reader.faces.tracks, sound);
    signal.addEventListener('abort', () => URL.revokeObjectURL(url));
    media.src = url;
  }
}

/**
 * Plays an mp4 by `media` while its face goes into `track`; resolves when all of the face is there.
 */
export async function openMp4(url, source) {
  const {media, track, words, signal, lang} = source;
  const film = new Film(url);
  const reader = new LanguageReader((languages) => languages[languageIn(languages, lang)],
      {track, words});
  if (!lang) media.src = url;
  await film.read(reader, signal);
  const {languages, language} = reader;
  source.offer?.(languages.map((each, which) => ({lang: each.lang, name: each.name,
    open: (to) => film.open(which, to)})));
  if (!lang) return;
  if (language === languages[0] || !film.pieces) media.src = url;
  else film.play(reader, source);
}

/** A stream of FBA alone: there is no sound. */
export async function openFba(url, {media, track, signal}) {
  const bytes = new Uint8Array(await checked(await fetch(url, {signal})).arrayBuffer());
  track.add(decode(bytes, {shown: true}));
  media.duration = track.end;
}
