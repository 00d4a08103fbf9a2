
// A head in three dimensions in place of the schematic face. HeadView and readModel stand in front of
// this, in the same script.
const before = [...animeme.viewport.childNodes];
try {
  const load = async (path) => {
    const answer = await fetch(path);
    if (!answer.ok) throw new Error(`${path}: ${answer.status}`);
    return readModel(new Uint8Array(await answer.arrayBuffer()));
  };
  const {asked} = animeme;
  const {heads = []} = await (await fetch('info.json', {cache: 'no-store'})).json();
  const path = (which) => (which > 0 ? `heads/${which}.bin` : 'head.bin');
  const first = Math.max(0, heads.indexOf(asked.get('head')));
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
  let last = {};
  animeme.onFrame = (values) => {
    last = values;
    view.show(values);
  };
  animeme.onFrame({});
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
    animeme.onFrame(last);
    list.value = which;
  };
  list.addEventListener('change', () => animeme.showHead(Number(list.value)));
} catch (problem) {
  animeme.viewport.replaceChildren(...before);
  document.getElementById('face').hidden = false;
  console.info(`no head: ${problem.message}`);
}
