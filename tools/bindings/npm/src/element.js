// <animeme-face src="talk.mp4" head="me.glb" controls></animeme-face>
import {MediaClock, SilentMedia} from './clock.js';
import {openFba, openMp4} from './files.js';
import {openHls} from './hls.js';
import {ready} from './index.js';
import {cueAt, languageIn} from './languages.js';
import {openLive} from './live.js';
import {Viewport} from './viewport.js';
import {Track} from './track.js';
import {ArkitFitter, VisemeFitter} from './weights.js';

const style = `
  :host { display: inline-block; position: relative; width: 320px; height: 400px; }
  :host([hidden]) { display: none; }
  canvas { display: block; width: 100%; height: 100%; }
  audio { position: absolute; left: 0; right: 0; bottom: 0; width: 100%; opacity: 0;
    transition: opacity .2s; }
  audio:not([controls]) { display: none; }
  p { position: absolute; left: 0; right: 0; bottom: 8px; margin: auto; padding: 2px 8px;
    width: fit-content; max-width: 90%; border-radius: 6px; color: #fff; background: #0b1a24d0;
    text-align: center;
    font: 16px system-ui, sans-serif; box-sizing: border-box; }
  p:empty, :host(:not([captions])) p { display: none; }
  audio[controls] ~ p { bottom: 62px; }
  :host(:hover) audio, audio:focus, :host([paused]) audio { opacity: .9; }
`;
const kAhead = 0.25;  // seconds in which another language gets ready to play
const forwarded = ['play', 'pause', 'ended', 'seeked', 'timeupdate', 'volumechange', 'ratechange',
    'durationchange'];

function openerOf(url, live) {
  const {protocol, pathname} = new URL(url, document.baseURI);
  if (live || protocol.startsWith('ws') || pathname.endsWith('/')) return openLive;
  if (/\.m3u8$/i.test(pathname)) return openHls;
  return /\.fba$/i.test(pathname) ? openFba : openMp4;
}

export class AnimemeFace extends HTMLElement {
  static observedAttributes = ['src', 'head', 'controls', 'loop', 'muted', 'label', 'live', 'lang'];

  constructor() {
    super();
    const root = this.attachShadow({mode: 'open'});
    root.innerHTML = `<style>${style}</style><canvas part="canvas" aria-hidden="true"></canvas>
      <audio part="audio" preload="auto"></audio><p part="caption"></p>`;
    this.canvas = root.querySelector('canvas');
    this.caption = root.querySelector('p');
    this.audio = root.querySelector('audio');
    this.forward(this.audio);
    this.use(this.audio);
    this.track = new Track();
    this.words = [];
    this.choices = [];
    this.chosen = 0;
    this.told = [];
    this.weights = {frame: null, arkit: new Float32Array(61), visemes: new Float32Array(15)};
  }

  connectedCallback() {
    // A picture; with controls in it a group, as nobody would find them in a picture.
    if (!this.hasAttribute('role')) this.setAttribute('role',
        this.audio.controls ? 'group' : 'img');
    if (!this.hasAttribute('aria-label')) {
      this.setAttribute('aria-label', this.getAttribute('label') ?? 'a talking face');
    }
    this.connected = true;
    this.restart();
    const draw = () => {
      if (!this.connected) return;
      this.draw();
      requestAnimationFrame(draw);
    };
    requestAnimationFrame(draw);
  }

  disconnectedCallback() {
    this.connected = false;
    this.stop();
    this.viewport?.close();
    this.viewport = null;
    this.loadedHead = null;
  }

  attributeChangedCallback(name, before, now) {
    if (before === now) return;
    if (name === 'controls') this.audio.controls = now !== null;
    else if (name === 'loop') this.media.loop = this.audio.loop = now !== null;
    else if (name === 'muted') this.audio.muted = now !== null;
    else if (name === 'label') this.setAttribute('aria-label', now ?? '');
    else if (name === 'lang') this.changing = this.changeLanguage();
    else if (this.connected) this.restart();
  }

  // Attributes that are set one after the other begin once.
  restart() {
    this.pending ??= Promise.resolve().then(() => {
      this.pending = null;
      if (!this.connected) return;
      this.loadHead();
      this.open();
    });
  }

  /**
   * Resolves when the face of `src` was read to its end (of a live one: when it is over), or
   * rejects.
   */
  get loaded() { return Promise.resolve(this.pending).then(() => this.loading); }
  /** Resolves when the head is there. */
  get headLoaded() { return Promise.resolve(this.pending).then(() => this.headLoading); }

  get src() { return this.getAttribute('src'); }
  set src(url) { this.setAttribute('src', url); }
  get head() { return this.getAttribute('head'); }
  set head(url) { this.setAttribute('head', url); }

  // As of a media element.
  get currentTime() { return this.media.currentTime; }
  set currentTime(time) { this.media.currentTime = time; }
  get duration() { return this.media.duration; }
  get paused() { return this.media.paused; }
  get ended() { return this.media.ended; }
  get volume() { return this.audio.volume; }
  set volume(volume) { this.audio.volume = volume; }
  get playbackRate() { return this.media.playbackRate; }
  set playbackRate(rate) { this.media.playbackRate = rate; }
  play() { return this.media.play(); }
  pause() { this.media.pause(); }

  /** The frame that is shown, as of Decoder; null: none yet. */
  get frame() { return this.weights.frame; }
  /** Its weights: ARKit's by arkitNames(), visemes by visemeNames(). */
  get arkit() { return this.weights.arkit; }
  get visemes() { return this.weights.visemes; }

  /** Languages of the file: [{lang, name}]; `lang` chooses one. */
  get languages() { return this.choices.map(({lang, name}) => ({lang, name})); }
  /** The one that is heard, seen and said. */
  get language() { return this.choices[this.chosen]?.lang ?? ''; }
  /** What is said, as lines {start, end, text}, as far as it was read. */
  get lines() { return this.words; }
  /** As of a media element: a track of captions with the cues that were read. */
  get textTracks() { return this.audio.textTracks; }

  // Only what is played tells of itself.
  forward(audio) {
    for (const name of forwarded) {
      audio.addEventListener(name, () => { if (audio === this.audio) this.tell(name); });
    }
  }

  // What a language is read into, beside what is shown.
  async changeLanguage() {
    const which = languageIn(this.choices, this.lang), choice = this.choices[which];
    this.leaving?.abort();
    this.leaving = null;
    if (!choice || which === this.chosen) return;
    const stopped = this.leaving = new AbortController(), {signal} = stopped, before = this.stopped;
    before.signal.addEventListener('abort', () => {
      if (this.stopped === before) stopped.abort();
    });
    const audio = this.audio.cloneNode();
    audio.removeAttribute('src');
    audio.muted = true;
    const next = {media: audio, track: new Track(), words: [], signal, silent: () => {
      next.media = this.silentMedia();
      return next.media;
    }};
    audio.currentTime = this.media.currentTime;
    let problem = null;
    const loading = choice.open(next);
    loading.catch((failure) => { problem = failure; });
    try {
      if (!await this.beside(next, () => problem || signal.aborted)) {
        if (problem && !signal.aborted) this.tell('error', problem);
        stopped.abort();
        return;
      }
    } finally {
      if (this.leaving === stopped) this.leaving = null;
    }
    this.exchange(which, next, audio, stopped);
  }

  // Brings what is loaded beside what is played; false if `given` up meanwhile.
  async beside(next, given) {
    const until = async (good) => {
      while (!given() && !good()) await new Promise((done) => setTimeout(done, 10));
      return !given();
    };
    const isThere = () => {
      const {currentTime, duration, seeking, readyState = 4} = next.media;
      const needed = currentTime < duration ? HTMLMediaElement.HAVE_FUTURE_DATA :
          HTMLMediaElement.HAVE_CURRENT_DATA;
      return next.track.at(currentTime) && !seeking && readyState >= needed;
    };
    if (!await until(isThere)) return false;
    for (;;) {
      const {media} = next, {paused, playbackRate} = this.media;
      media.currentTime = this.media.currentTime + (paused ? 0 : kAhead * playbackRate);
      media.playbackRate = playbackRate;
      if (!await until(isThere)) return false;
      if (this.media.paused) {
        if (Math.abs(media.currentTime - this.media.currentTime) < 0.001) return true;
        continue;
      }
      const due = media.currentTime;
      if (!await until(() => this.media.paused || this.media.currentTime >= due)) return false;
      if (this.media.paused) continue;
      await media.play();
      return !given();
    }
  }

  // At once: sound, face and words.
  exchange(which, next, audio, stopped) {
    const {audio: old, media, stopped: before} = this;
    const {loop, muted, volume} = old;
    media.pause();
    Object.assign(this, {chosen: which, track: next.track, words: next.words, stopped});
    Object.assign(audio, {loop, volume, muted});
    old.replaceWith(audio);
    this.audio = audio;
    this.forward(audio);
    this.use(next.media);
    this.weights.frame = null;
    before.abort();
    old.removeAttribute('src');
    old.load();
    this.draw();
    this.tell('language', this.languages[which]);
  }

  // Cues come while the file is read.
  say(now) {
    const {audio, words} = this;
    const cue = cueAt(words, now);
    if (words.length && audio.cuesOf !== words) {
      audio.cuesOf = words;
      audio.cued = 0;
      audio.said = audio.addTextTrack('captions', this.choices[this.chosen]?.name ?? '',
          this.language);
      audio.said.mode = 'hidden';
    }
    const known = words.length - (this.complete ? 0 : 1);  // the last line may grow
    for (; audio.cuesOf === words && audio.cued < known; ++audio.cued) {
      const {start, end, text} = words[audio.cued];
      audio.said.addCue(new VTTCue(start, end, text));
    }
    const text = cue?.text ?? '';
    if (this.caption.textContent === text) return;
    this.caption.textContent = text;
    this.caption.lang = this.language;
    this.tell('cue', cue);
  }

  use(media) {
    this.media = media;
    this.clock = new MediaClock(media);
  }

  silentMedia() {
    const media = new SilentMedia();
    for (const name of ['play', 'pause', 'ended', 'seeked']) media.addEventListener(name,
        () => { if (media === this.media) this.tell(name); });
    media.loop = this.hasAttribute('loop');
    return media;
  }

  silent() {
    this.use(this.silentMedia());
    return this.media;
  }

  loadHead() {
    const {head} = this;
    if (!head || head === this.loadedHead) return;
    this.loadedHead = head;
    this.headLoading = ready().then(async () => {
      this.viewport ??= new Viewport(this.canvas);
      await this.viewport.loadHead(head);
      this.weights.frame = null;  // shown again on this head
      this.tell('head');
    }).catch((problem) => this.fail(problem));
    this.headLoading.catch(() => {});
  }

  open() {
    const {src} = this;
    if (src === this.opened) return;
    this.stop();
    this.opened = src;
    this.openedIn = this.lang;
    if (!src) return;
    const url = new URL(src, document.baseURI).href, open = openerOf(src,
        this.hasAttribute('live'));
    const stopped = this.stopped = new AbortController();
    this.track = new Track();
    this.words = [];
    const source = {media: this.audio, silent: () => this.silent(), track: this.track,
        words: this.words, signal: stopped.signal, lang: this.lang,
        offer: (choices) => this.offer(choices),
      lost: (problem) => this.lose(problem), told: (text) => this.hear(text)};
    if (open === openFba) source.media = this.silent();
    else this.use(this.audio);
    this.loading = ready().then(() => {
      this.fitters = {arkit: new ArkitFitter(), visemes: new VisemeFitter()};
      this.startsBySelf = this.hasAttribute('autoplay') || open === openLive;
      return open(url, source);
    }).then(() => {
      this.complete = true;
      this.tell('load');
    }, (problem) => { if (!stopped.signal.aborted) this.fail(problem);
        });
    this.loading.catch(() => {});
  }

  // The file has languages. What `lang` was when it was opened is chosen already.
  offer(choices) {
    this.choices = choices;
    this.chosen = languageIn(choices, this.openedIn);
    this.tell('languages', this.languages);
    if (this.lang !== this.openedIn) this.changing = this.changeLanguage();
  }

  stop() {
    this.leaving?.abort();
    this.stopped?.abort();
    Object.assign(this, {choices: [], chosen: 0, words: [], complete: false});
    this.caption.textContent = '';
    this.opened = null;
    this.media.pause();
    if (this.audio.src) {
      this.audio.removeAttribute('src');
      this.audio.load();
    }
    for (const fitter of Object.values(this.fitters ?? {})) fitter.free();
    this.fitters = null;
    this.told = [];
    this.weights.frame = null;
  }

  // What a server tells of its lines, each word when it is heard. Other words are none of our
  // business.
  hear(text) {
    let told = null;
    try {
      told = JSON.parse(text);
    } catch {
      return;
    }
    if (told?.event) this.told.push(told);
  }

  // The next connection begins like the first.
  lose(problem) {
    this.told = [];
    this.weights.frame = null;
    this.startsBySelf = true;
    this.tell('lost', problem);
  }

  fail(problem) {
    this.tell('error', problem);
    throw problem;
  }

  tell(name, detail = null) {
    this.toggleAttribute('paused', this.media.paused);
    this.dispatchEvent(name === 'error' ? Object.assign(new ErrorEvent(name,
        {error: detail, message: detail?.message}))
                                        : new CustomEvent(name, {detail}));
  }

  // Plays by itself as soon as there is something to show; browsers may want a gesture first.
  begin() {
    if (!this.startsBySelf || !this.track.frames.length) return;
    if (this.media === this.audio &&
        this.audio.readyState < HTMLMediaElement.HAVE_CURRENT_DATA) return;
    this.startsBySelf = false;
    this.play().catch((problem) => { if (problem.name !== 'AbortError') this.tell('blocked',
        problem); });
  }

  draw() {
    this.begin();
    const now = this.clock.now();
    while (this.told.length && !(this.told[0].time > now)) this.tell('speech', this.told.shift());
    this.say(now);
    const frame = this.track.at(now) ?? this.track.frames[0];
    if (frame && frame !== this.weights.frame && this.fitters) {
      this.weights.frame = frame;
      this.fitters.arkit.fit(frame, this.weights.arkit);
      this.fitters.visemes.fit(frame, this.weights.visemes);
      this.viewport?.head?.show(this.weights.arkit, this.weights.visemes, frame);
      this.tell('frame', frame);
    }
    if (this.viewport?.head) this.viewport.draw();
  }
}

if (!customElements.get('animeme-face')) customElements.define('animeme-face', AnimemeFace);
