// Puts the page together: data, player, viewport, curves, controls; window.animeme.
import {fromBase64} from './bytes.js';
import {Axis} from './axis.js';
import {Chooser, mostMoving} from './chooser.js';
import {Clip} from './clip.js';
import {Controls} from './controls.js';
import {Curves} from './curves.js';
import {inflate} from './inflate.js';
import {fillHelp, keyTable, listenToKeys} from './keys.js';
import {readModel} from './model.js';
import {decodedSound, Player} from './player.js';
import {rigReady} from './rig.js';
import {MODES, Viewport} from './viewport.js';

const byId = (id) => document.getElementById(id);
const coded = (id) => fromBase64(byId(id).textContent);
const data = (id) => (byId(id) ? inflate(coded(id)) : null);
const asked = new URLSearchParams(location.search);
const SHORTEST_MARK = 0.1;  // seconds
const flag = (name) => asked.has(name) && asked.get(name) !== '0';

/** A track as its speakers call it: "Deutsch", "Ann, Deutsch". */
function trackName({lang, speaker}) {
  let language = lang;
  try {
    if (lang) language = new Intl.DisplayNames([lang], {type: 'language'}).of(lang);
  } catch {
    // The tag will do.
  }
  return [speaker, language].filter(Boolean).join(', ');
}

/** The element with the name of one of the people, above their head. */
function nameOfPerson(_, number, people) {
  const id = `name${number}`;
  const element = byId(id) || Object.assign(document.createElement('p'), {id, className: 'name'});
  byId('viewport').append(element);
  element.style.left = `calc(${100 * number / people.length}% + 10px)`;
  return element;
}

/** What the page does; controls and keys call it. */
class App {
  /**
   * `model`: a head, null for none, an Error where it cannot be; `clips`: the bytes of one or two,
   * or of people; `people`: as Viewport has them.
   */
  constructor(facts, model, clips, people) {
    this.clips = clips.filter(Boolean).map((bytes) => new Clip(bytes));
    this.hasSound = Boolean(facts.sound);
    this.options = {wire: false, points: false, between: true, mode: 'first'};
    const ends = this.clips.map((clip) => clip.end);
    this.player = new Player(Math.max(...ends));
    this.axis = new Axis(this.player.duration);
    this.needed = false;
    this.resume = false;
    this.viewport = new Viewport({
      element: byId('viewport'), canvas: byId('picture'), overlay: byId('overlay'),
          tip: byId('tip'),
      message: byId('message'), readout: byId('readout'),
      names: people ? people.map(nameOfPerson) : [byId('name0'), byId('name1')],
    }, model, this.clips, facts.faps, people);
    this.people = people;
    this.heads = facts.heads || [];
    this.models = [model];
    this.whose = 0;
    /**
     * Languages and people: what is said, and once they are loaded `clips` by head and `buffer`.
     */
    this.tracks = (facts.tracks || [{lang: '', speaker: ''}]).map((track, i) => ({
      ...track, ...(i ? {} : facts), name: trackName(track), clips: i ? [] : [this.clips]}));
    this.track = 0;
    this.curves = new Curves({
      area: byId('area'), canvas: byId('curves'), labels: byId('labels'), head: byId('head'),
      now: byId('now'), buttons: byId('zoom'),
    }, this, this.axis, facts);
    this.controls = new Controls(byId, this);
    this.chooser = new Chooser({search: byId('search'), list: byId('list'), count: byId('count')},
        facts, this.clips, (faps) => this.curves.choose(faps));
    this.viewport.onNeed = () => this.need();
    this.player.onChange = () => this.changed();
  }

  time() {
    return this.player.position();
  }

  /** Asks for a picture, soon. */
  need() {
    if (this.needed) return;
    this.needed = true;
    requestAnimationFrame(() => this.draw());
  }

  draw() {
    this.needed = false;
    const time = this.player.tick();
    this.drawn = {time, frame: this.clips[0].frameAt(time), clock: this.player.clock()};
    this.viewport.show(time, this.options.between && this.player.playing);
    this.curves.show(time);
    this.controls.show(time, this.drawn.frame);
    if (this.player.playing) this.need();
  }

  changed() {
    if (this.axis.total !== this.player.duration) this.axis.setTotal(this.player.duration);
    this.controls.update();
    this.curves.draw();
    this.need();
  }

  set(name, value) {
    this.options[name] = name === 'mode' ? this.viewport.setMode(value) : value;
    if (name === 'wire' && this.viewport.view) this.viewport.view.wire = value;
    if (name === 'points' && this.viewport.view) this.viewport.points.set(value);
    this.controls.update();
    this.need();
  }

  /** Shows head `which`, a number; what is in the page of it is unpacked when it is wanted. */
  async showHead(which) {
    if (!this.viewport.view) return;
    await this.exchange(which, (this.wanted || this).track);
  }

  /** Language or person `which`, a number: face, sound and words at the same moment. */
  async showTrack(which) {
    await this.exchange((this.wanted || this).whose, which);
  }

  // Unpacks what is wanted, and then changes all of it at once.
  async exchange(whose, track) {
    const wanted = this.wanted = {whose, track};
    if (this.models[whose] === undefined) this.models[whose] =
        readModel(await data(`model_${whose}`));
    const to = this.tracks[track];
    const own = await this.clipsOf(track, whose);
    await this.loadBuffer(track);
    const [first] = to.clips;
    if (this.wanted !== wanted) return;  // somebody was faster
    this.wanted = null;
    const {viewport, player} = this;
    if (whose !== this.whose) viewport.setModel(this.models[whose], own);
    else viewport.setClips(own);
    this.whose = whose;
    if (track !== this.track) {
      this.track = track;
      this.clips = first;
      this.hasSound = Boolean(to.buffer);
      this.curves.say(to);
      byId('now').lang = to.lang;
      byId('viewport').classList.toggle('says', to.phones.length > 0);
      const seconds = Math.max(...first.map((clip) => clip.end),
          to.buffer ? to.buffer.duration : 0);
      player.exchange(to.buffer || null, seconds);
      this.curves.choose(this.curves.faps);
    }
    if (viewport.view) await viewport.view.ready;
    this.changed();
  }

  // The clips of a track with the columns of a head.
  async clipsOf(track, whose) {
    const {clips} = this.tracks[track];
    if (!clips[0]) clips[0] = [new Clip(await data(`track${track}clip`))];
    if (!clips[whose]) {
      const name = (i) => (track ? `track${track}clip_${whose}` : `clip${i}_${whose}`);
      const own = await Promise.all(clips[0].map((_, i) => data(name(i))));
      clips[whose] = own.map((bytes, i) => (bytes ? new Clip(bytes) : clips[0][i]));
    }
    return clips[whose];
  }

  // Silent, where the browser cannot decode it.
  async loadBuffer(track) {
    const to = this.tracks[track];
    if (to.buffer !== undefined || !track || !to.sound) return;
    const end = Math.max(...to.clips[0].map((clip) => clip.end));
    to.buffer = await decodedSound(coded(`track${track}sound`), end).catch(() => {
      byId('silent').hidden = false;
      return null;
    });
  }

  nextMode() {
    this.set('mode', MODES[(MODES.indexOf(this.options.mode) + 1) % MODES.length]);
  }

  seek(time) {
    this.player.seek(time);
  }

  /** To the beginning of a neighbouring frame. */
  step(frames) {
    this.player.pause();
    const [clip] = this.clips;
    // A little behind its beginning, so that rounding never shows the frame before.
    const frame = Math.max(clip.frameAt(this.time()) + frames, 0);
    this.seek(clip.timeOf(Math.min(frame, clip.frames - 1)) + 1e-4);
  }

  /** Seeks while something is dragged; the sound rests meanwhile. */
  scrub(time) {
    this.resume = this.resume || this.player.playing;
    this.player.pause();
    this.seek(time);
  }

  endScrub() {
    if (this.resume) this.player.play();
    this.resume = false;
  }

  mark(region) {
    const {duration} = this.player;
    const inside = region && region.map((time) => Math.min(Math.max(time, 0), duration));
    this.player.setLooping(Boolean(inside), inside);
  }

  /** The marked part begins or ends at the time that is shown. */
  markFrom() {
    const [, to] = this.player.region || [0, this.player.duration];
    const time = Math.min(this.time(), this.player.duration - SHORTEST_MARK);
    this.mark([time, to > time ? to : this.player.duration]);
  }

  markTo() {
    const [from] = this.player.region || [0];
    const time = Math.max(this.time(), SHORTEST_MARK);
    this.mark([from < time ? from : 0, time]);
  }

  mute() {
    this.player.setVolume(this.player.volume > 0 ? 0 : 1);
  }

  resetView() {
    if (this.viewport.view) this.viewport.view.camera.reset();
  }

  /** By degrees to the person's left and up. */
  turnView(left, up) {
    if (this.viewport.view) this.viewport.view.camera.turn(left * Math.PI / 180,
        up * Math.PI / 180);
  }

  fullscreen() {
    if (document.fullscreenElement) document.exitFullscreen();
    else if (byId('main').requestFullscreen) byId('main').requestFullscreen().catch(() => {});
  }

  help() {
    const dialog = byId('keys');
    if (dialog.open) dialog.close();
    else dialog.showModal();
  }
}

// What the address asks for, see README.md.
function obey(app) {
  const number = (name) => (asked.has(name) ? Number(asked.get(name)) : NaN);
  if (asked.has('theme')) document.documentElement.dataset.theme = asked.get('theme');
  for (const name of ['wire', 'points']) if (flag(name)) app.set(name, true);
  if (asked.has('between')) app.set('between', flag('between'));
  app.set('mode', asked.get('mode') || 'side');
  if (asked.has('speed')) app.player.setRate(number('speed'));
  if (asked.has('left') || asked.has('up') || asked.has('zoom')) {
    const {view} = app.viewport;
    if (view) view.camera.reset(number('left') || 0, number('up') || 0,
        number('zoom') || undefined);
  }
  // So much time at first that phones can be read.
  app.axis.show(0, byId('area').clientWidth / 200);
  const [from, to] = (asked.get('loop') || '').split('-').map(Number);
  if (to > from) app.mark([from, to]);
  const faps = (asked.get('faps') || '').split(',').map(Number).filter((f) => f >= 3 && f <= 68);
  app.chooser.choose(faps.length ? faps : mostMoving(app.clips[0], 5));
  if (asked.has('frame')) app.seek(app.clips[0].timeOf(number('frame')) + 1e-4);
  if (asked.has('t')) app.seek(number('t'));
}

async function start() {
  const facts = JSON.parse(byId('facts').textContent);
  await rigReady;
  const model = flag('nohead') ? null :
      await data('model').then(readModel).catch((problem) => problem);
  const clips = await Promise.all((facts.people || [0, 1]).map((_, i) => data(`clip${i}`)));
  let people = facts.people || null;
  if (people && model && !(model instanceof Error)) {
    const models = [model];
    for (const {model: which} of people) {
      models[which] = models[which] || await data(`model_${which}`).then(readModel);
    }
    people = people.map((person) => ({...person, model: models[person.model]}));
  }
  const app = new App(facts, model, clips, people);
  byId('title').textContent = people ? document.title :
      app.clips.map((clip) => clip.name).join(' / ');
  byId('viewport').classList.toggle('says', facts.phones.length > 0);
  const table = keyTable(app);
  fillHelp(byId('keylist'), table);
  listenToKeys(table, byId('keys'));
  for (const query of ['(prefers-color-scheme: dark)', '(prefers-contrast: more)']) {
    matchMedia(query).addEventListener('change', () => app.curves.draw());
  }
  const {viewport, player} = app;
  const api = {
    seek: (time) => app.seek(time),
    play: () => player.play(),
    pause: () => player.pause(),
    /** What the last picture showed, and how the player stands. */
    state: () => ({
      ...app.drawn, playing: player.playing, duration: player.duration, rate: player.rate,
      position: player.position(), frames: app.clips[0].frames, clips: app.clips.length,
      sound: Boolean(player.buffer), loop: player.loop(), faps: app.curves.faps,
      people: (app.people || []).map(({name}) => name),
      head: Boolean(viewport.view), whose: app.heads[app.whose],
      track: app.tracks[app.track].name, lang: app.tracks[app.track].lang, ...app.options,
    }),
    /** Vertices of a part ('skin' ...) of head 0 or 1 as they are shown, x y z one after the other
        in cm; null without a head. */
    vertices: (part, head = 0) => {
      if (!viewport.view) return null;
      const rig = viewport.view.rigs[head];
      return rig.placed(rig.index[part]);
    },
    points: () => (viewport.view ? viewport.view.points() : []),
    /** Another head, by its number in the list. */
    showHead: (which) => app.showHead(which),
    /** Another language or person, by its number in the list. */
    showTrack: (which) => app.showTrack(which),
    /** Draws now. */
    draw: () => app.draw(),
    context: () => player.context,
    output: () => player.gain,
  };
  Object.assign(window.animeme, api);
  obey(app);
  if (app.heads.includes(asked.get('head'))) await app.showHead(
      app.heads.indexOf(asked.get('head')));
  byId('now').lang = app.tracks[0].lang;
  if (facts.sound) {
    await player.loadSound(coded('sound')).catch(() => {
      byId('silent').hidden = false;
      app.hasSound = false;  // no wave
      app.changed();
    });
  }
  app.tracks[0].buffer = player.buffer;
  byId('tracks').disabled = false;
  const language = app.tracks.findIndex(({lang}) => lang && lang === asked.get('lang'));
  if (language > 0) await app.showTrack(language);
  if (viewport.view) await viewport.view.ready;
  app.draw();
  if (flag('play')) playUnasked(player);
}

// Browsers may let no page sound that nobody has touched: then it waits for the button.
function playUnasked(player) {
  player.play();
  setTimeout(() => {
    if (player.context && player.context.state === 'suspended') player.pause();
  }, 300);
}

window.animeme = {};
window.animeme.ready = start().then(() => window.animeme);
