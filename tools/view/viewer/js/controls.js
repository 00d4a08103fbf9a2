// Buttons, switches and the slider below the picture.

export function timeText(seconds) {
  const whole = Math.floor(seconds + 1e-6);
  const rest = Math.floor((seconds + 1e-6 - whole) * 1000);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, '0')}.` +
      String(rest).padStart(3, '0');
}

export class Controls {
  /** `byId(id)` finds an element; `app` does what is asked. */
  constructor(byId, app) {
    Object.assign(this, {byId, app});
    const {player} = app;
    const click = (id, call) => byId(id).addEventListener('click', call);
    click('play', () => player.toggle());
    click('back', () => app.step(-1));
    click('forward', () => app.step(1));
    click('loop', () => player.setLooping(!player.looping));
    click('unmark', () => app.mark(null));
    click('markFrom', () => app.markFrom());
    click('markTo', () => app.markTo());
    click('mute', () => app.mute());
    click('reset', () => app.resetView());
    click('help', () => app.help());
    click('full', () => app.fullscreen());
    click('closer', () => app.axis.zoom(2, app.time()));
    click('wider', () => app.axis.zoom(0.5, app.time()));
    byId('speed').addEventListener('change', (event) => player.setRate(Number(event.target.value)));
    const slider = byId('slider');
    slider.addEventListener('input', () => app.scrub(Number(slider.value)));
    slider.addEventListener('change', () => app.endScrub());
    for (const name of ['wire', 'points', 'between']) {
      byId(name).addEventListener('change', (event) => app.set(name, event.target.checked));
    }
    for (const radio of document.getElementsByName('mode')) {
      radio.addEventListener('change', () => app.set('mode', radio.value));
    }
    byId('modes').hidden = app.clips.length < 2 || Boolean(app.people);
    byId('whose').hidden = app.heads.length < 2 || !app.viewport.view;
    byId('heads').replaceChildren(...app.heads.map((name, i) => new Option(name, i)));
    byId('heads').addEventListener('change', (event) => app.showHead(Number(event.target.value)));
    byId('spoken').hidden = app.tracks.length < 2;
    byId('tracks').replaceChildren(...app.tracks.map((track, i) => {
      const option = new Option(track.name, i);
      option.lang = track.lang;
      return option;
    }));
    byId('tracks').addEventListener('change', (event) => app.showTrack(Number(event.target.value)));
    byId('full').hidden = !document.fullscreenEnabled;
  }

  press(id, on) {
    this.byId(id).setAttribute('aria-pressed', String(on));
  }

  /** What does not change from picture to picture. */
  update() {
    const {byId, app} = this;
    const {player, options} = app;
    byId('play').classList.toggle('playing', player.playing);
    byId('play').setAttribute('aria-label', player.playing ? 'Pause' : 'Play');
    this.press('loop', player.looping);
    this.press('mute', player.volume === 0);
    byId('mute').hidden = !app.hasSound;
    byId('unmark').hidden = !player.region;
    byId('slider').max = player.duration;
    byId('duration').textContent = timeText(player.duration);
    const speed = byId('speed');
    if (![...speed.options].some((option) => Number(option.value) === player.rate)) {
      speed.add(new Option(`${player.rate}×`, player.rate));
    }
    speed.value = String(player.rate);
    if (app.heads.length) byId('heads').value = String(app.whose);
    if (app.tracks.length) byId('tracks').value = String(app.track);
    for (const name of ['wire', 'points', 'between']) byId(name).checked = options[name];
    for (const radio of document.getElementsByName('mode')) {
      radio.checked = radio.value === options.mode;
    }
  }

  /** The moving parts. */
  show(time, frame) {
    const slider = this.byId('slider');
    slider.value = time;
    slider.setAttribute('aria-valuetext', `${time.toFixed(2)} seconds, frame ${frame}`);
    slider.style.setProperty('--done', `${100 * time / (this.app.player.duration || 1)}%`);
    this.byId('time').textContent = timeText(time);
    this.byId('frame').textContent = `frame ${frame}`;
  }
}
