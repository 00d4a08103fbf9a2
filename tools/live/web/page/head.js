
// A head in three dimensions in place of the schematic face. HeadView and readModel stand in front
// of this, in the same script.
// Planes as a motion without steps: turns are eased, and between two planes lies their mixture.
class LiveMotion {
  #turns = new TurnSmoother();
  #newest = -Infinity;

  // Frames come in order, and each is eased once.
  #ease(frames) {
    let first = frames.length;
    while (first > 0 && !frames[first - 1].eased) --first;
    for (const frame of frames.slice(first)) {
      if (!(frame.time > this.#newest && frame.time < this.#newest + 1)) this.#turns =
          new TurnSmoother();
      this.#newest = frame.time;
      frame.eased = this.#turns.next(frame.values);
    }
  }

  /** Values at a time; undefined before the first plane is due. */
  at(frames, now) {
    this.#ease(frames);
    const next = frames.findIndex((frame) => frame.time > now);
    const shown = frames.at(next < 0 ? -1 : next - 1);
    if (!shown || shown.time > now) return undefined;
    if (next < 0) return shown.eased;
    const after = frames[next], step = after.time - shown.time;
    if (step > 2.5 * shown.duration) return shown.eased;  // planes were lost
    const values = {...shown.eased}, share = (now - shown.time) / step;
    for (const [fap, value] of Object.entries(values)) {
      const to = after.eased[fap];
      if (fap > 2 && to !== undefined) values[fap] = value + (to - value) * share;
    }
    return values;
  }
}

const differ = (a, b) => Object.keys({...a, ...b}).some((fap) => a[fap] !== b[fap]);

const before = [...animeme.viewport.childNodes];
try {
  const load = async (path) => {
    const answer = await fetch(path);
    if (!answer.ok) throw new Error(`${path}: ${answer.status}`);
    return readModel(new Uint8Array(await answer.arrayBuffer()));
  };
  const {asked} = animeme;
  const info = await fetch(Live.address('info.json'), {cache: 'no-store'});
  const {heads = [], head} = info.ok ? await info.json() : {};
  const path = (which) => (which > 0 ? `heads/${which}.bin` : 'head.bin');
  const first = Math.max(0, heads.indexOf(asked.get('head') ?? head));
  let model = await load(path(first));
  const canvas = document.createElement('canvas');
  canvas.id = 'head';
  canvas.setAttribute('role', 'img');
  canvas.setAttribute('aria-label', 'Head that moves with the stream; drag to rotate it');
  const view = new HeadView(canvas, model);  // throws without WebGL2
  const number = (name) => Number(asked.get(name)) || 0;
  if (['left', 'up', 'zoom'].some((name) => asked.has(name))) {
    view.camera.reset(number('left'), number('up'), number('zoom') || undefined);
  }
  view.camera.listen(canvas);
  animeme.setView(canvas);
  animeme.head = view;
  const motion = new LiveMotion();
  let last = {};
  const show = (values) => {
    last = values;
    view.show(values);
  };
  animeme.addEventListener('tick', ({detail: {now}}) => {
    const values = motion.at(animeme.session.frames, now);
    if (values && differ(values, last)) show(values);
  });
  show({});
  new ResizeObserver(() => view.draw()).observe(canvas);

  const list = document.getElementById('heads');
  const models = new Map([[first, model]]);
  list.append(...heads.map((name, which) => new Option(name, which, false, which === first)));
  list.parentElement.hidden = heads.length < 2;
  /** Another head, by its number in the list. */
  animeme.showHead = async (which) => {
    if (!models.has(which)) models.set(which, await load(path(which)));
    model = models.get(which);
    view.setModel(model);
    show(last);
    list.value = which;
  };
  list.addEventListener('change', () => animeme.showHead(Number(list.value)));
} catch (problem) {
  animeme.viewport.replaceChildren(...before);
  document.getElementById('face').hidden = false;
  console.info(`no head: ${problem.message}`);
}
