// Curves of the chosen FAPs over time, the wave of the sound, phones and words above them, and a
// head that moves along.
import {listenToDrags} from './axis.js';
import {SILENCE, Said} from './captions.js';
import {Wave} from './wave.js';

const ROW = 52;
const HEADING = 20;  // of a row, for its name
// Fingers need larger buttons, which stand in the ruler.
const RULER = matchMedia('(pointer: coarse)').matches ? 40 : 22;
const TRACK = 20;
const WAVE = 34;

const RADIAN = 1e-5;  // of an angle unit

/** A value as people read it: angles in degrees, too. */
export function valueText(value, unit) {
  return unit === 'AU' ? `${value} = ${(value * RADIAN * 180 / Math.PI).toFixed(1)}°` :
      String(value);
}

/** `facts`: faps (the table) and phones of the page; `app`: clips, player. */
export class Curves {
  constructor(elements, app, axis, facts) {
    Object.assign(this, {...elements, app, axis});
    this.say(facts);
    this.table = facts.faps;
    this.faps = [];
    this.ranges = {};
    axis.onChange = () => this.draw();
    new ResizeObserver(() => this.draw()).observe(this.area);
    this.listen();
  }

  /** What is said: phones and lines of captions. */
  say({phones, captions}) {
    this.phones = phones;
    this.words = captions.flat();
    this.said = new Said(this.now, phones, captions);
    this.wave = null;
  }

  /** The FAPs to show, one row each. */
  choose(faps) {
    this.faps = faps;
    for (const fap of faps) {
      const ranges = this.app.clips.map((clip) => clip.range(fap));
      this.ranges[fap] = [Math.min(...ranges.map((r) => r[0])),
          Math.max(...ranges.map((r) => r[1]))];
    }
    this.labels.replaceChildren(...faps.map((fap) => this.label(fap)));
    this.canvas.setAttribute('aria-label', 'Curves of ' +
        (faps.map((fap) => this.table[fap - 1].name).join(', ') || 'nothing') + ' over time');
    this.draw();
  }

  label(fap) {
    const label = document.createElement('div');
    label.className = 'label';
    const name = document.createElement('b');
    const {name: text, unit} = this.table[fap - 1];
    name.textContent = `${fap} ${text}`;
    const small = document.createElement('i');
    small.textContent = unit;
    label.append(name, small, ...this.app.clips.map((_, i) => {
      const value = document.createElement('span');
      value.className = `value clip${i} clip${i % 4}`;
      return value;
    }));
    return label;
  }

  // Where phones begin, and where the first row does.
  tracksTop() {
    return RULER + (this.app.hasSound ? WAVE : 0);
  }

  top() {
    return this.tracksTop() + (this.phones.length ? TRACK * (this.words.length ? 2 : 1) : 0);
  }

  listen() {
    const {area, axis, app} = this;
    const timeAt = (share) => axis.time(share);
    listenToDrags(this.canvas, {
      begin: (start) => {
        start.time = timeAt(start.share);
        if (!start.shift) app.scrub(start.time);
      },
      move: (start, share) => {
        const time = timeAt(share);
        if (start.shift) app.mark([Math.min(start.time, time), Math.max(start.time, time)]);
        else app.scrub(time);
      },
      end: (start) => { if (!start.shift) app.endScrub(); },
    });
    area.addEventListener('wheel', (event) => {
      if (event.ctrlKey || event.metaKey) {
        event.preventDefault();
        const box = this.canvas.getBoundingClientRect();
        axis.zoom(Math.exp(-event.deltaY * 0.004), timeAt((event.clientX - box.left) / box.width));
      } else if (Math.abs(event.deltaX) > Math.abs(event.deltaY)) {
        event.preventDefault();
        axis.shift(event.deltaX / area.clientWidth * axis.length);
      }
    }, {passive: false});
    this.canvas.addEventListener('dblclick', () => axis.show(0, axis.total));
  }

  /** Everything but the head; colours come from the style of the page. */
  draw() {
    const width = this.area.clientWidth;
    const height = this.top() + this.faps.length * ROW;
    const scale = Math.min(window.devicePixelRatio || 1, 2);
    this.canvas.width = Math.max(1, Math.round(width * scale));
    this.canvas.height = Math.max(1, Math.round(height * scale));
    this.canvas.style.height = `${height}px`;
    const style = getComputedStyle(this.area);
    const pen = this.canvas.getContext('2d');
    pen.scale(scale, scale);
    pen.font = '11px system-ui, sans-serif';
    pen.textBaseline = 'middle';
    this.paper = {pen, width, height, colour: (name) => style.getPropertyValue(`--${name}`)};
    this.drawRuler();
    this.drawWave();
    const tracks = this.tracksTop();
    this.drawTrack(this.phones, tracks, 'phone', (label) => label === SILENCE);
    this.drawTrack(this.words, tracks + TRACK, 'word', () => false);
    this.faps.forEach((fap, row) => {
      const top = this.top() + row * ROW;
      this.labels.children[row].style.top = `${top}px`;
      this.drawRow(fap, top);
    });
    this.show(this.app.time(), true);
  }

  x(time) {
    return this.axis.share(time) * this.paper.width;
  }

  drawRuler() {
    const {pen, width, height, colour} = this.paper;
    const loop = this.app.player.region;
    if (loop) {
      pen.fillStyle = colour('region');
      pen.fillRect(this.x(loop[0]), 0, this.x(loop[1]) - this.x(loop[0]), height);
    }
    const step = this.axis.step(width / 70);
    const free = this.buttons.offsetLeft - 48;  // no mark of time stands below the buttons
    const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    pen.fillStyle = colour('soft');
    pen.strokeStyle = colour('line');
    pen.lineWidth = 1;
    for (let k = Math.ceil(this.axis.begin / step); k * step <= this.axis.end; ++k) {
      const x = Math.round(this.x(k * step)) + 0.5;
      pen.beginPath();
      pen.moveTo(x, 4);
      pen.lineTo(x, height);
      pen.stroke();
      if (x > free) continue;
      pen.fillText(`${(k * step).toFixed(digits)} s`, x + 4, RULER / 2);
    }
  }

  // A line from the least to the largest sample of each pixel.
  drawWave() {
    const {buffer} = this.app.player;
    if (!this.app.hasSound || !buffer) return;  // it is being decoded
    if (!this.wave) this.wave = new Wave(buffer);
    const {pen, width, colour} = this.paper;
    const middle = RULER + WAVE / 2;
    const height = (WAVE / 2 - 2) / (this.wave.peak || 1);
    pen.strokeStyle = colour('soft');
    pen.lineWidth = 1;
    pen.beginPath();
    for (let x = 0; x < width; ++x) {
      const reach = this.wave.extremes(this.axis.time(x / width), this.axis.time((x + 1) / width));
      if (!reach) continue;
      pen.moveTo(x + 0.5, middle - reach[1] * height - 0.5);
      pen.lineTo(x + 0.5, middle - reach[0] * height + 0.5);
    }
    pen.stroke();
  }

  drawTrack(pieces, top, kind, quiet) {
    const {pen, width, colour} = this.paper;
    pen.textAlign = 'center';
    pieces.forEach(([start, end, text], i) => {
      const [from, to] = [this.x(start), this.x(end)];
      if (to < 0 || from > width || quiet(text)) return;
      pen.fillStyle = colour(i % 2 ? kind : `${kind}-other`);
      pen.fillRect(from, top + 1, Math.max(to - from - 1, 0.5), TRACK - 2);
      pen.fillStyle = colour('ink');
      if (to - from > pen.measureText(text).width + 3) {
        pen.fillText(text, (from + to) / 2, top + TRACK / 2);
      }
    });
    pen.textAlign = 'left';
  }

  drawRow(fap, top) {
    const {pen, width, colour} = this.paper;
    const [low, high] = this.ranges[fap];
    const y = (value) => top + HEADING + (ROW - HEADING - 6) * (high - value) / (high - low || 1);
    pen.strokeStyle = colour('line');
    pen.lineWidth = 1;
    for (const level of [top + 0.5, Math.round(y(0)) + 0.5]) {
      pen.beginPath();
      pen.moveTo(0, level);
      pen.lineTo(width, level);
      pen.stroke();
    }
    // The second clip lies below and is wider, so that both are seen where they agree.
    for (let i = this.app.clips.length - 1; i >= 0; --i) {
      pen.strokeStyle = colour(`clip${i % 4}`);
      pen.globalAlpha = i ? 0.55 : 1;
      pen.lineWidth = i ? 4 : 1.5;
      pen.beginPath();
      this.trace(this.app.clips[i], fap, y);
      pen.stroke();
    }
    pen.globalAlpha = 1;
    this.drawRange(low, high, y);
  }

  // The least and the largest value at the right edge.
  drawRange(low, high, y) {
    const {pen, width, colour} = this.paper;
    if (low === high) return;
    pen.textAlign = 'right';
    pen.strokeStyle = colour('panel');
    pen.lineWidth = 3;
    pen.fillStyle = colour('soft');
    for (const value of [low, high]) {
      const place = [String(value), width - 4, value === high ? y(high) - 3 : y(low) - 2];
      pen.strokeText(...place);
      pen.fillText(...place);
    }
    pen.textAlign = 'left';
  }

  // One point a frame, or where frames are denser than pixels the extremes of each pixel.
  trace(clip, fap, y) {
    const {pen} = this.paper;
    const first = Math.max(clip.frameAt(this.axis.begin) - 1, 0);
    const last = Math.min(clip.frameAt(this.axis.end) + 1, clip.frames - 1);
    const dense = (last - first) / this.paper.width > 2;
    let column = -Infinity;
    let [low, high] = [0, 0];
    for (let frame = first; frame <= last; ++frame) {
      const value = clip.value(fap, frame);
      const x = this.x(clip.timeOf(frame));
      if (!dense) {
        pen.lineTo(x, y(value));
      } else if (Math.floor(x) === column) {
        [low, high] = [Math.min(low, value), Math.max(high, value)];
      } else {
        if (column > -Infinity) pen.lineTo(column, y(low)), pen.lineTo(column, y(high));
        [column, low, high] = [Math.floor(x), value, value];
      }
    }
    if (dense) pen.lineTo(column, y(low)), pen.lineTo(column, y(high));
  }

  /** The moving parts: head, values, what is said. */
  show(time, still = false) {
    if (!still) this.axis.follow(time);
    const share = this.axis.share(time);
    this.head.hidden = share < 0 || share > 1;
    this.head.style.transform = `translateX(${share * this.area.clientWidth}px)`;
    this.head.style.height = `${this.paper ? this.paper.height : 0}px`;
    const rows = this.labels.children;
    this.faps.forEach((fap, row) => {
      this.app.clips.forEach((clip, i) => {
        const text = valueText(clip.value(fap, clip.frameAt(time)), this.table[fap - 1].unit);
        const cell = rows[row].querySelector(`.clip${i}`);
        if (cell.textContent !== text) cell.textContent = text;
      });
    });
    this.said.show(time);
  }
}
