// A camera that goes around a head, by mouse, touch or keys.

const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const normalised = (a) => a.map((x) => x / Math.hypot(...a));
const sum = (...terms) => [0, 1, 2].map(
    (k) => terms.reduce((total, [vector, factor]) => total + vector[k] * factor, 0));

const NARROW = 0.74;  // pictures narrower than this share of their height see more
const STEEPEST = 80 * Math.PI / 180;

/** `home`: the camera of the model, {target, near, distance, angle}. */
export class Camera {
  constructor(home) {
    this.home = home;
    /** Called when the view changes. */
    this.onChange = () => {};
    this.reset();
  }

  /** Degrees to the person's left and up; zoom 1 shows head and shoulders, as pictures do. */
  reset(left = 0, up = 0, zoom = 1) {
    this.left = left * Math.PI / 180;
    this.up = up * Math.PI / 180;
    this.zoom = zoom;
    this.offset = [0, 0, 0];
    this.onChange();
  }

  /** What it looks at: nearer pictures have the face in their middle. */
  targetOf(home) {
    const t = Math.min(Math.max((this.zoom - 1) / 0.8, 0), 1);
    const near = t * t * (3 - 2 * t);
    return sum([home.target, 1 - near], [home.near, near], [this.offset, 1]);
  }

  turn(left, up) {
    this.left = (this.left + left) % (2 * Math.PI);
    this.up = Math.min(Math.max(this.up + up, -STEEPEST), STEEPEST);
    this.onChange();
  }

  zoomBy(factor) {
    this.zoom = Math.min(Math.max(this.zoom * factor, 0.4), 12);
    this.onChange();
  }

  /** By shares of the picture's height. */
  shift(right, up) {
    const size = 2 * this.home.distance * Math.tan(this.home.angle / 2) / this.zoom;
    const axes = this.axes();
    const most = this.home.distance / 3;
    this.offset = sum([this.offset, 1], [axes.right, -right * size], [axes.up, -up * size])
        .map((x) => Math.min(Math.max(x, -most), most));
    this.onChange();
  }

  axes(turned = 0) {
    const left = this.left + turned;
    const back = [Math.sin(left) * Math.cos(this.up), Math.sin(this.up),
      Math.cos(left) * Math.cos(this.up)];
    const right = normalised(cross([0, 1, 0], back));
    return {back, right, up: cross(back, right)};
  }

  /** For a viewport [x, y, width, height] in pixels of the canvas, y up: the matrix, the lights,
      and project(point) that gives [x, y] there, y down. `turned`: radians further to the left;
      `home`: of another model. */
  view(viewport, turned = 0, home = this.home) {
    const {right, up, back} = this.axes(turned);
    const {distance, angle} = home;
    const eye = sum([this.targetOf(home), 1], [back, distance]);
    const [, , width, height] = viewport;
    const aspect = width / height;
    const focus = this.zoom / (Math.tan(angle / 2) * Math.max(1, NARROW / aspect));
    const near = distance * 0.25;
    const far = distance * 2.5;
    const depth = (far + near) / (near - far);
    const matrix = new Float32Array(16);
    for (let k = 0; k < 3; ++k) {
      matrix[k * 4] = right[k] * focus / aspect;
      matrix[k * 4 + 1] = up[k] * focus;
      matrix[k * 4 + 2] = back[k] * depth;
      matrix[k * 4 + 3] = -back[k];
    }
    matrix[12] = -dot(right, eye) * focus / aspect;
    matrix[13] = -dot(up, eye) * focus;
    matrix[14] = -dot(back, eye) * depth + 2 * far * near / (near - far);
    matrix[15] = dot(back, eye);
    const light = (r, u, b) => normalised(sum([right, r], [up, u], [back, b]));
    return {
      viewport, matrix, eye, back, key: light(0.55, 0.62, 0.75), fill: light(-0.9, 0.1, 0.5),
      rim: light(-0.7, 0.5, -0.8),
      project(point) {
        const p = sum([point, 1], [eye, -1]);
        const scale = focus / -dot(p, back) * height / 2;
        return [width / 2 + dot(p, right) * scale, height / 2 - dot(p, up) * scale];
      },
    };
  }

  /** Makes an element turn, shift and zoom the camera: drag, right button or shift drag, wheel, two
      fingers, double click. */
  listen(element) {
    const touches = new Map();
    const spread = () => {
      const [a, b] = [...touches.values()];
      return {x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, size: Math.hypot(a.x - b.x, a.y - b.y) || 1};
    };
    element.addEventListener('pointerdown', (event) => {
      element.setPointerCapture(event.pointerId);
      touches.set(event.pointerId, {x: event.clientX, y: event.clientY});
    });
    for (const end of ['pointerup', 'pointercancel']) {
      element.addEventListener(end, (event) => touches.delete(event.pointerId));
    }
    element.addEventListener('pointermove', (event) => {
      const last = touches.get(event.pointerId);
      if (!last) return;
      const before = touches.size === 2 ? spread() : null;
      const [dx, dy] = [event.clientX - last.x, event.clientY - last.y];
      touches.set(event.pointerId, {x: event.clientX, y: event.clientY});
      const height = element.clientHeight || 1;
      if (before) {
        const after = spread();
        this.zoomBy(after.size / before.size);
        this.shift((after.x - before.x) / height, (before.y - after.y) / height);
      } else if (event.shiftKey || event.buttons & 6) {
        this.shift(dx / height, -dy / height);
      } else {
        this.turn(-dx * 3.2 / height, dy * 3.2 / height);
      }
    });
    element.addEventListener('wheel', (event) => {
      event.preventDefault();
      const lines = event.deltaMode === 1 ? 16 : 1;
      this.zoomBy(Math.exp(-Math.max(-200, Math.min(200, event.deltaY * lines)) * 0.0015));
    }, {passive: false});
    element.addEventListener('contextmenu', (event) => event.preventDefault());
    element.addEventListener('dblclick', () => this.reset());
  }
}
