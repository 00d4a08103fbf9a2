// The place where heads are shown: the picture, the points over it, what two clips differ by.
import {valueDifference} from './clip.js';
import {HeadView} from './head.js';
import {PointOverlay} from './points.js';

export const MODES = ['first', 'second', 'side', 'ghost', 'heat'];

export class Viewport {
  /**
   * `model` null: without a head, an Error: why there is none; `table`: the FAPs of the page;
   * `people`: null, or who is shown side by side, a clip each, as HeadView takes them.
   */
  constructor(elements, model, clips, table, people = null) {
    Object.assign(this, {...elements, clips, people});
    const moving = table.filter(({number}) => clips.some((clip) => clip.columns[number]));
    const numbers = (isAngle) => moving.filter(({unit}) => (unit === 'AU') === isAngle)
        .map(({number}) => number);
    this.distances = numbers(false);
    this.angles = numbers(true);
    this.view = null;
    this.last = [];
    if (model instanceof Error) this.refuse(model);
    else if (model) this.open(model);
    this.element.classList.toggle('headless', !this.view);
    this.names.forEach((element, i) => { element.textContent = clips[i] ? clips[i].name : ''; });
  }

  open(model) {
    try {
      this.view = new HeadView(this.canvas, model, this.clips.length, this.people);
    } catch (error) {
      this.refuse(error);
      return;
    }
    this.points = new PointOverlay(this.overlay, this.tip, this.view);
    this.view.camera.listen(this.canvas);
  }

  refuse({message}) {
    this.canvas.hidden = true;
    this.message.hidden = false;
    this.message.textContent = message === 'no WebGL2' ?
        'The head needs WebGL2, which this browser does not provide: enable hardware acceleration, ' +
        'or use a current Firefox, Chrome, Edge or Safari. Curves and sound work without it.' :
        `The head cannot be drawn: ${message}. Curves and sound work without it.`;
  }

  /** Called when the picture is out of date. */
  set onNeed(call) {
    if (!this.view) return;
    this.view.onNeed = call;
    new ResizeObserver(call).observe(this.canvas);
  }

  /** Another head, and the clips with its columns. */
  setModel(model, clips) {
    this.clips = clips;
    this.last = [];
    this.view.setModel(model);
  }

  /** The clips in another language. */
  setClips(clips) {
    this.clips = clips;
    this.last = [];
  }

  setMode(mode) {
    if (this.people) {
      this.element.dataset.mode = 'people';
      return 'people';
    }
    const chosen = this.clips.length > 1 && MODES.includes(mode) ? mode : 'first';
    if (this.view) this.view.mode = chosen;
    this.element.dataset.mode = this.clips.length > 1 ? chosen : 'only';
    return chosen;
  }

  /** Shows a time; `between` mixes neighbouring frames. */
  show(time, between) {
    const values = this.clips.map((clip) => clip.values(time, between));
    if (this.view) {
      values.forEach((v, i) => {
        const key = v.join();
        if (key !== this.last[i]) this.view.move(v, i);
        this.last[i] = key;
      });
      this.view.draw();
      this.points.draw();
    }
    if (values.length > 1 && !this.people) this.tellDifference(values);
  }

  // Distances and angles each have their unit; FAPs that never move say nothing.
  tellDifference([a, b]) {
    const parts = [`${valueDifference(a, b, this.distances).toFixed(1)} FAP units RMS`];
    if (this.angles.length) {
      const degrees = valueDifference(a, b, this.angles) * 1e-5 * 180 / Math.PI;
      parts.push(`angles ${degrees.toFixed(2)}°`);
    }
    if (this.view) {
      const {largest, mean} = this.view.difference();
      parts.push(`skin ${(mean * 10).toFixed(2)} mm, at most ${(largest * 10).toFixed(2)} mm`);
    }
    const text = parts.join(' · ');
    if (this.readout.textContent !== text) this.readout.textContent = text;
  }
}
