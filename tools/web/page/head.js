
// A head in three dimensions in place of the schematic face. HeadView, readModel and lowLevel stand
// in front of this, in the same script.
const before = [...animeme.stage.childNodes];
try {
  const answer = await fetch('head.bin');
  if (!answer.ok) throw new Error(`head.bin: ${answer.status}`);
  const model = readModel(new Uint8Array(await answer.arrayBuffer()));
  const canvas = document.createElement('canvas');
  canvas.id = 'head';
  canvas.setAttribute('role', 'img');
  canvas.setAttribute('aria-label', 'Head that moves with the stream; drag to turn it');
  const view = new HeadView(canvas, model);  // throws without WebGL2
  view.camera.listen(canvas);
  animeme.setView(canvas);
  animeme.head = view;
  animeme.onFrame = (values) => {
    const {1: viseme, 2: expression, ...own} = values;
    view.show(lowLevel(model, viseme ?? null, expression ?? null, own));
  };
  animeme.onFrame({});
  addEventListener('resize', () => view.draw());
} catch (problem) {
  animeme.stage.replaceChildren(...before);
  console.info(`no head: ${problem.message}`);
}
