// Which part of the time is seen.

const SHORTEST = 0.2;  // seconds

/** Seconds from `begin` to `end`, a part of 0 to `total`. */
export class Axis {
  constructor(total) {
    this.total = Math.max(total, SHORTEST);
    this.begin = 0;
    this.end = this.total;
    /** Called when another part is to be seen. */
    this.onChange = () => {};
  }

  get length() {
    return this.end - this.begin;
  }

  /** Another whole length; all of it is seen if that was so before. */
  setTotal(total) {
    const all = this.length >= this.total;
    this.total = Math.max(total, SHORTEST);
    this.show(all ? 0 : this.begin, all ? this.total : this.length);
  }

  /** Place of a time as a share of the width. */
  share(time) {
    return (time - this.begin) / this.length;
  }

  time(share) {
    return this.begin + Math.min(Math.max(share, 0), 1) * this.length;
  }

  show(begin, length) {
    const size = Math.min(Math.max(length, SHORTEST), this.total);
    const from = Math.min(Math.max(begin, 0), this.total - size);
    if (from === this.begin && from + size === this.end) return;
    this.begin = from;
    this.end = from + size;
    this.onChange();
  }

  /** factor > 1: more detail around a time. */
  zoom(factor, time) {
    this.show(time - this.share(time) * this.length / factor, this.length / factor);
  }

  shift(seconds) {
    this.show(this.begin + seconds, this.length);
  }

  /** Turns the page when a time has left it. */
  follow(time) {
    if (time < this.begin || time > this.end) this.show(time - 0.05 * this.length, this.length);
  }

  /** Seconds between marks, so that at most `count` of them are seen. */
  step(count) {
    const least = this.length / Math.max(count, 1);
    const power = 10 ** Math.floor(Math.log10(least));
    return [1, 2, 5, 10].map((n) => n * power).find((step) => step >= least * 0.999);
  }
}

/** Calls back with the shares of the width where a drag across an element begins and is, and says
    which keys were held; `end` when it is over. */
export function listenToDrags(element, {begin, move, end}) {
  let start = null;
  const share = (event) => {
    const box = element.getBoundingClientRect();
    return (event.clientX - box.left) / (box.width || 1);
  };
  element.addEventListener('pointerdown', (event) => {
    if (event.button !== 0) return;
    start = {share: share(event), shift: event.shiftKey};
    element.setPointerCapture(event.pointerId);
    begin(start);
  });
  element.addEventListener('pointermove', (event) => {
    if (start) move(start, share(event));
  });
  for (const name of ['pointerup', 'pointercancel']) {
    element.addEventListener(name, () => {
      if (start) end(start);
      start = null;
    });
  }
}
