// <animeme-face src="talk.mp4" head="me.glb" controls></animeme-face>
import {MediaClock, SilentMedia} from './clock.js';
import {openFba, openMp4} from './files.js';
import {openHls} from './hls.js';
import {ready} from './index.js';
import {openLive} from './live.js';
import {Viewport} from './viewport.js';
import {Track} from './track.js';
import {ArkitFitter, VisemeFitter} from './weights.js';

const style = `
  :host { display: inline-block; position: relative; width: 320px; height: 400px; }
  :host([hidden]) { display: none; }
  canvas { display: block; width: 100%; height: 100%; }
  audio { position: absolute; left: 0; right: 0; bottom: 0; width: 100%; opacity: 0; transition: opacity .2s; }
  audio:not([controls]) { display: none; }
  :host(:hover) audio, audio:focus, :host([paused]) audio { opacity: .9; }
`;
const forwarded = ['play', 'pause', 'ended', 'seeked', 'timeupdate', 'volumechange', 'ratechange',
    'durationchange'];

function openerOf(url, live) {
  const {protocol, pathname} = new URL(url, document.baseURI);
  if (live || protocol.startsWith('ws') || pathname.endsWith('/')) return openLive;
  if (/\.m3u8$/i.test(pathname)) return openHls;
  return /\.fba$/i.test(pathname) ? openFba : openMp4;
}

export class AnimemeFace extends HTMLElement {
  static observedAttributes = ['src', 'head', 'controls', 'loop', 'muted', 'label', 'live'];

  constructor() {
    super();
    const root = this.attachShadow({mode: 'open'});
    root.innerHTML = `<style>${style}</style><canvas part="canvas" aria-hidden="true"></canvas>
      <audio part="audio" preload="auto"></audio>`;
    this.canvas = root.querySelector('canvas');
    this.audio = root.querySelector('audio');
    for (const name of forwarded) this.audio.addEventListener(name, () => this.tell(name));
    this.use(this.audio);
    this.track = new Track();
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

  use(media) {
    this.media = media;
    this.clock = new MediaClock(media);
  }

  silent() {
    const media = new SilentMedia();
    for (const name of ['play', 'pause', 'ended', 'seeked']) media.addEventListener(name,
        () => this.tell(name));
    media.loop = this.hasAttribute('loop');
    this.use(media);
    return media;
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
    if (!src) return;
    const url = new URL(src, document.baseURI).href, open = openerOf(src,
        this.hasAttribute('live'));
    const stopped = this.stopped = new AbortController();
    this.track = new Track();
    const source = {media: this.audio, silent: () => this.silent(), track: this.track,
        signal: stopped.signal,
      lost: (problem) => this.lose(problem), told: (text) => this.hear(text)};
    if (open === openFba) source.media = this.silent();
    else this.use(this.audio);
    this.loading = ready().then(() => {
      this.fitters = {arkit: new ArkitFitter(), visemes: new VisemeFitter()};
      this.startsBySelf = this.hasAttribute('autoplay') || open === openLive;
      return open(url, source);
    }).then(() => this.tell('load'), (problem) => { if (!stopped.signal.aborted) this.fail(problem);
        });
    this.loading.catch(() => {});
  }

  stop() {
    this.stopped?.abort();
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
