// A head in a canvas. All that another page needs to show motion of its own:
//
//     const view = new HeadView(canvas, readModel(bytes));     // throws without WebGL2
//     view.camera.listen(canvas);                               // mouse and touch
//     view.show({3: 200, 5: -300});                             // by FAP number, missing ones are
//     0
//
// show() moves the head and draws it; call it once a displayed frame at most. Values are FAP units,
// an array or an object; 1 may be {select1, select2, blend}, 2 {select1, intensity1, select2,
// intensity2}, whose shapes are shown where the values have no own. Heads with shapes of their
// maker are fitted.
import {Camera} from './camera.js';
import {Renderer} from './gl.js';
import {Rig} from './rig.js';

const PLAIN = [0, 0, 0, 0];
const GHOST = [0.10, 0.35, 0.85, 0.35];  // the second head where both are in one place
const WIRE = [0.05, 0.07, 0.12, 0.30];
const WIDER = 1.3;  // each of several people gets so much more than a share of the width
const HEAT_TOP = 0.2;  // cm that are shown in the strongest colour

export class HeadView {
  /**
   * `count` 2: a second head of the same model, to compare. `people`: heads side by side instead,
   * [{model, turned}], each seen from so many degrees further to its left.
   */
  constructor(canvas, model, count = 1, people = null) {
    this.canvas = canvas;
    this.model = model;
    this.count = count;
    this.people = people;
    this.camera = new Camera(model.camera);
    this.camera.onChange = () => this.onNeed();
    /** 'first', 'second', 'side' (by side), 'ghost' (one over the other), 'heat' (distance). */
    this.mode = 'first';
    this.wire = false;
    /** Called when the picture is out of date; by default it is drawn at once. */
    this.onNeed = () => this.draw();
    this.setUp();
    canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => {
      this.setUp();
      this.onNeed();
    });
    this.resize();
  }

  setUp() {
    this.kept = new Map();  // what was made of each model
    if (this.people) this.seat();
    else this.setModel(this.model);
  }

  // Each of the people has a head of their own.
  seat() {
    const before = this.places || [];
    this.take(this.people.map(({model}, i) => this.made(model, before[i] && [before[i].rig])));
  }

  // What is shown: by head the renderer, rig and meshes.
  take(made) {
    this.places = made.flatMap(({renderer, rigs, meshes}) =>
      rigs.map((rig, i) => ({renderer, rig, meshes: meshes[i]})));
    this.rigs = this.places.map(({rig}) => rig);
    this.meshes = this.places.map(({meshes}) => meshes);
    this.stale = this.rigs.map(() => true);
    this.hot = false;
    // Its pictures are decoded, and it is seen.
    this.ready = this.wait(made.map(({renderer}) => renderer.materials));
  }

  /** Takes another head, which stands as it was left: pose() it. */
  setModel(model) {
    this.model = model;
    this.camera.home = model.camera;
    if (!this.kept.has(model)) {
      const same = this.rigs && this.rigs[0].model === model;
      this.kept.set(model, this.made(model, same && this.rigs));
    }
    this.take([this.kept.get(model)]);
  }

  // A head without its pictures is a white statue: it is not seen until they are there.
  wait(materials) {
    this.canvas.style.opacity = materials.every(({complete}) => complete) ? '' : '0';
    const {places} = this;
    return Promise.all(materials.map(({ready}) => ready)).then(() => {
      for (const each of materials) each.complete = true;
      if (this.places === places) this.canvas.style.opacity = '';
    });
  }

  made(model, known) {
    const renderer = new Renderer(this.canvas, model, () => this.onNeed());
    const rigs = known ||
        Array.from({length: this.people ? 1 : this.count}, () => new Rig(model));
    return {renderer, rigs, meshes: rigs.map((rig) => renderer.load(rig))};
  }

  /** Moves head `which` without drawing it, by FAPs. */
  pose(values, which = 0) {
    this.rigs[which].pose(values);
    this.stale[which] = true;
  }

  /** The same by control, as Clip has them. */
  move(values, which = 0) {
    this.rigs[which].move(values);
    this.stale[which] = true;
  }

  show(values) {
    this.pose(values);
    this.draw();
  }

  /** Takes the size of the canvas on the page; true if it has changed. */
  resize() {
    const {canvas} = this;
    const scale = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.max(1, Math.round(canvas.clientWidth * scale));
    const height = Math.max(1, Math.round(canvas.clientHeight * scale));
    if (canvas.width === width && canvas.height === height) return false;
    canvas.width = width;
    canvas.height = height;
    return true;
  }

  /** Which heads are shown where: [{head, view}]. */
  views() {
    const {width, height} = this.canvas;
    if (this.people) {
      const share = width / this.people.length;
      const own = Math.min(width, Math.round(share * WIDER));
      return this.people.map(({model, turned}, head) => ({head, view: this.camera.view(
          [Math.round((head + 0.5) * share - own / 2), 0, own, height], turned * Math.PI / 180,
          model.camera)}));
    }
    const whole = this.camera.view([0, 0, width, height]);
    if (this.rigs.length < 2 || this.mode === 'first' || this.mode === 'heat') {
      return [{head: 0, view: whole}];
    }
    if (this.mode === 'second') return [{head: 1, view: whole}];
    if (this.mode === 'ghost') return [{head: 0, view: whole}, {head: 1, view: whole}];
    const half = Math.floor(width / 2);
    return [0, 1].map((head) => (
      {head, view: this.camera.view([head * half, 0, half, height])}));
  }

  draw() {
    this.resize();
    this.places[0].renderer.clear();
    if (this.rigs.length > 1 && !this.people) this.updateHeat();
    this.views().forEach(({head, view}, i) => {
      const {renderer, rig, meshes} = this.places[head];
      if (this.stale[head]) renderer.update(meshes, rig);
      this.stale[head] = false;
      if (i > 0 && this.people) renderer.clearDepth();  // whose shoulder reaches over is in front
      const over = i > 0 && this.mode === 'ghost';
      renderer.draw(meshes, rig, view, {
        tint: over ? GHOST : PLAIN, opacity: over ? 0.45 : 1, wire: this.wire ? WIRE : null,
      });
    });
  }

  updateHeat() {
    const hot = this.mode === 'heat';
    const skin = this.rigs[0].index.skin;
    if (hot) {
      const {distances} = this.difference();
      this.meshes[0][skin].setHeat(distances.map((cm) => cm / HEAT_TOP));
    } else if (this.hot) {
      this.meshes[0][skin].setHeat(null);
    }
    this.hot = hot;
  }

  /** How far the skin of the two heads is apart: {distances, largest, mean}, cm; the mean is that
      of the vertices that are apart at all. */
  difference() {
    const [a, b] = this.rigs.map((rig) => rig.positions[rig.index.skin]);
    const distances = new Float32Array(a.length / 3);
    let largest = 0;
    let total = 0;
    let count = 0;
    for (let i = 0; i < distances.length; ++i) {
      const k = i * 3;
      const d = Math.hypot(a[k] - b[k], a[k + 1] - b[k + 1], a[k + 2] - b[k + 2]);
      distances[i] = d;
      largest = Math.max(largest, d);
      total += d;
      if (d > 0) ++count;
    }
    return {distances, largest, mean: count ? total / count : 0};
  }

  /** Feature points on the page: [{id, name, head, x, y, facing}] in CSS pixels of the canvas;
      `facing` is negative where the skin looks away. */
  points() {
    const scale = this.canvas.clientWidth / this.canvas.width || 1;
    return this.views().flatMap(({head, view}) =>
        this.rigs[head].model.points.map(({id, name, part, vertex}) => {
      const rig = this.rigs[head];
      const m = rig.transforms[part];
      const at = (array, shift) => [0, 1, 2].map((row) => m[row * 3] * array[vertex * 3] +
          m[row * 3 + 1] * array[vertex * 3 + 1] + m[row * 3 + 2] * array[vertex * 3 + 2] +
          (shift ? m[9 + row] : 0));
      const place = at(rig.positions[part], true);
      const normal = at(rig.normals[part], false);
      const [x, y] = view.project(place);
      const facing = normal.reduce((sum, n, k) => sum + n * (view.eye[k] - place[k]), 0);
      return {id, name, head, x: (x + view.viewport[0]) * scale, y: y * scale, facing};
    }));
  }
}
