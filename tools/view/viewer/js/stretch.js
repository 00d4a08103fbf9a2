// Sound at another speed with its own pitch: short windows of the sound are laid over one another,
// each taken from where it continues the one before it best (waveform similarity overlap-add). What
// is heard strays from where it should be by REACH at most and never drifts.

const WINDOW_HOP = 0.012;  // seconds from window to window; each one lasts two
const REACH = 0.008;  // seconds around its place in which a window is looked for
const COARSE = 4;  // samples to a step of the first search

const wrap = (at, begin, end) => begin + ((at - begin) % (end - begin) +
    end - begin) % (end - begin);

/** Reads channels (Float32Array each, of one length) from `from` seconds on, at `rate` times their
    speed, `loop` [from, to] in seconds again and again. Silence lies around the sound. */
export class Stretcher {
  constructor(channels, sampleRate, {rate, from = 0, loop = null}) {
    Object.assign(this, {channels, rate});
    this.from = from * sampleRate;
    this.loop = loop && loop.map((time) => time * sampleRate);
    this.hop = Math.round(WINDOW_HOP * sampleRate / COARSE) * COARSE;
    this.reach = Math.round(REACH * sampleRate / COARSE) * COARSE;
    this.count = 0;  // windows so far
    this.next = 0;  // sample that continues the last window
    this.rest = channels.map(() => new Float32Array(0));
    this.rise = Float32Array.from({length: this.hop},
        (_, i) => 0.5 - 0.5 * Math.cos(Math.PI * (i + 0.5) / this.hop));
  }

  /** The next `length` samples of each channel. */
  read(length) {
    const out = this.channels.map(() => new Float32Array(length));
    for (let done = 0; done < length;) {
      if (!this.rest[0].length) this.rest = this.step();
      const part = Math.min(this.rest[0].length, length - done);
      this.rest.forEach((samples, c) => out[c].set(samples.subarray(0, part), done));
      this.rest = this.rest.map((samples) => samples.subarray(part));
      done += part;
    }
    return out;
  }

  // One hop of sound: the last window fades into a new one.
  step() {
    const place = this.place();
    const first = this.count === 0;
    const at = first ? Math.round(place) : this.search(place);
    const old = first ? at : this.next;
    ++this.count;
    this.next = at + this.hop;
    return this.channels.map((channel) => {
      const fading = this.cut(channel, old, this.hop);
      const rising = this.cut(channel, at, this.hop);
      return fading.map((sample, i) => sample + (rising[i] - sample) * this.rise[i]);
    });
  }

  // Sample at which the next window should begin, so that what is heard in the middle of its fade
  // is what belongs there.
  place() {
    const at = this.from + this.count * this.hop * this.rate - (1 - this.rate) * this.hop;
    const begun = this.count === 0 ? Math.max(at, this.from) : at;
    return this.loop && begun >= this.loop[1] ? wrap(begun, ...this.loop) : begun;
  }

  // The place nearest to where a window should be at which the sound goes on most alike.
  search(place) {
    const {hop, reach} = this;
    const centre = Math.round(place);
    const wanted = this.mixed(this.next, hop);
    const around = this.mixed(centre - reach, hop + 2 * reach + 1);
    const rough = best(wanted, around, reach, 0, reach, COARSE);
    return centre + best(wanted, around, reach, rough, COARSE - 1, 1);
  }

  // All channels as one.
  mixed(from, length) {
    const out = this.cut(this.channels[0], from, length);
    for (const channel of this.channels.slice(1)) {
      this.cut(channel, from, length).forEach((sample, i) => { out[i] += sample; });
    }
    return out;
  }

  // What lies before and behind the sound is silent. At the end of a loop a window goes on behind
  // it while the next one, from its beginning, fades in.
  cut(channel, from, length) {
    const out = new Float32Array(length);
    const begin = Math.max(from, 0);
    if (begin < Math.min(from + length, channel.length)) {
      out.set(channel.subarray(begin, from + length), begin - from);
    }
    return out;
  }
}

// The shift within `centre` - `span` .. `centre` + `span` (steps of `step`) at which `around`,
// whose shift 0 begins at `middle`, is most like `wanted`; nearer ones before farther ones.
function best(wanted, around, middle, centre, span, step) {
  let [shift, most] = [centre, 0];
  for (let k = 0; k <= span; k += step) {
    for (const candidate of k ? [centre + k, centre - k] : [centre]) {
      if (Math.abs(candidate) > middle) continue;
      let [product, power] = [0, 1e-9];
      for (let i = 0; i < wanted.length; i += step) {
        const sample = around[middle + candidate + i];
        product += wanted[i] * sample;
        power += sample * sample;
      }
      const alike = product / Math.sqrt(power);
      if (alike > most * 1.0001) [shift, most] = [candidate, alike];
    }
  }
  return shift;
}

const PIECE = 0.25;  // seconds that are made at once
const AHEAD = 3;  // seconds that are ready before they are heard: hidden pages wake once a second
const FIRST_PIECES = 8;  // made before it begins, so that slow pictures do not interrupt it
const MOST_PIECES = 8;  // made at once after that, so that it does not interrupt pictures for long
const PAUSE = 200;  // milliseconds between looks whether more is needed

/** Plays a buffer at another speed: pieces that begin where the last one ends. */
export class StretchedSource {
  /** `begin(lead)` of the result is to be called once. */
  constructor(context, buffer, output, {rate, from, loop}) {
    Object.assign(this, {context, output, rate: buffer.sampleRate});
    const channels = Array.from({length: buffer.numberOfChannels},
        (_, c) => buffer.getChannelData(c));
    this.stretcher = new Stretcher(channels, buffer.sampleRate, {rate, from, loop});
    this.pieces = new Set();
    this.length = Math.round(PIECE * buffer.sampleRate);
  }

  /** Begins to play `lead` seconds from now; when, on the clock of the context. */
  begin(lead) {
    const first = Array.from({length: FIRST_PIECES}, () => this.make());
    this.start = Math.ceil((this.context.currentTime + lead) * this.rate);
    this.count = 0;
    for (const piece of first) this.schedule(piece);
    this.timer = setTimeout(() => this.fill(), 0);
    return this.start / this.rate;
  }

  stop() {
    clearTimeout(this.timer);
    for (const piece of this.pieces) {
      piece.stop();
      piece.disconnect();
    }
    this.pieces.clear();
  }

  make() {
    const channels = this.stretcher.read(this.length);
    const buffer = new AudioBuffer(
        {length: this.length, sampleRate: this.rate, numberOfChannels: channels.length});
    channels.forEach((samples, c) => buffer.copyToChannel(samples, c));
    return buffer;
  }

  // When the next piece is to be heard.
  next() {
    return (this.start + this.count * this.length) / this.rate;
  }

  fill() {
    const needed = () => this.next() < this.context.currentTime + AHEAD;
    for (let i = 0; i < MOST_PIECES && needed(); ++i) this.schedule(this.make());
    this.timer = setTimeout(() => this.fill(), needed() ? 0 : PAUSE);
  }

  schedule(buffer) {
    const when = this.next();
    ++this.count;
    const late = this.context.currentTime - when;
    if (late >= buffer.duration) return;
    const piece = this.context.createBufferSource();
    piece.buffer = buffer;
    piece.connect(this.output);
    piece.onended = () => {
      piece.disconnect();
      this.pieces.delete(piece);
    };
    piece.start(Math.max(when, 0), Math.max(late, 0));
    this.pieces.add(piece);
  }
}
