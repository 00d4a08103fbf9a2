// The time of what is heard.

const kJump = 0.12;  // seconds; further apart it was a seek

/** Time of a media element, whose currentTime moves in steps, smoothed between them. */
export class MediaClock {
  constructor(media) {
    this.media = media;
    this.last = null;
  }

  now() {
    const heard = this.media.currentTime, wall = performance.now() / 1000;
    if (this.media.paused || this.media.seeking || !this.last) {
      this.last = {time: heard, wall};
      return heard;
    }
    let time = this.last.time + (wall - this.last.wall) * this.media.playbackRate;
    const off = heard - time;
    time = Math.abs(off) > kJump ? heard : time + 0.1 * off;
    this.last = {time, wall};
    return time;
  }
}

/** A clock for faces without a sound, with what the element asks of a media element. */
export class SilentMedia extends EventTarget {
  constructor() {
    super();
    Object.assign(this, {paused: true, ended: false, seeking: false, loop: false});
    Object.assign(this, {duration: 0, playbackRate: 1, time: 0});
  }

  get currentTime() {
    if (this.paused) return this.time;
    const time = this.time + (performance.now() / 1000 - this.since) * this.playbackRate;
    if (time < this.duration) return time;
    if (this.loop && this.duration > 0) {
      this.currentTime = time % this.duration;
      return this.currentTime;
    }
    this.time = this.duration;
    this.paused = this.ended = true;
    for (const name of ['pause', 'ended']) this.dispatchEvent(new Event(name));
    return this.time;
  }

  set currentTime(time) {
    this.time = Math.min(Math.max(time, 0), this.duration);
    this.since = performance.now() / 1000;
    this.ended = false;
    this.dispatchEvent(new Event('seeked'));
  }

  async play() {
    if (!this.paused) return;
    if (this.ended || this.time >= this.duration) this.time = 0;
    this.since = performance.now() / 1000;
    this.paused = this.ended = false;
    this.dispatchEvent(new Event('play'));
  }

  pause() {
    if (this.paused) return;
    this.time = this.currentTime;
    this.paused = true;
    this.dispatchEvent(new Event('pause'));
  }
}
