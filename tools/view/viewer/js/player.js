// The clock of the page. With sound it is what is heard: the time of the audio context less the
// delay of its output. Pictures ask for position() when they are drawn; nothing counts pictures.
import {StretchedSource} from './stretch.js';

const LEAD = 0.02;  // seconds between a decision to play and the first sample
const JUMP = 0.03;  // the steps of the audio clock are smoothed up to this many seconds

/**
 * The sound of a file, and silence behind it up to `duration` seconds. Rejects if the browser
 * cannot
    decode it. */
export async function decodedSound(bytes, duration) {
  const decoder = new OfflineAudioContext(1, 1, 48000);
  const sound = await decoder.decodeAudioData(bytes.buffer);
  const length = Math.ceil(Math.max(duration, sound.duration) * sound.sampleRate);
  const buffer = new AudioBuffer(
      {length, sampleRate: sound.sampleRate, numberOfChannels: sound.numberOfChannels});
  for (let c = 0; c < sound.numberOfChannels; ++c) {
    buffer.copyToChannel(sound.getChannelData(c), c);
  }
  return buffer;
}

/** Plays from 0 to `duration` seconds; silent until loadSound() is done. */
export class Player {
  constructor(duration) {
    this.duration = duration;
    this.playing = false;
    this.rate = 1;
    this.volume = 1;
    this.looping = false;
    /** [from, to] in seconds to play again and again; null: all. */
    this.region = null;
    /** Called after each change that is not the passing of time. */
    this.onChange = () => {};
    this.at = 0;  // position when playing began, or where it rests
    this.buffer = null;
    this.context = null;
  }

  /** Decodes the sound and makes it as long as the clip. Rejects if the browser cannot. */
  async loadSound(bytes) {
    this.buffer = await decodedSound(bytes, this.duration);
    this.duration = Math.max(this.duration, this.buffer.duration);
    this.restart();
    this.onChange();
  }

  /** Another sound (an AudioBuffer, or null) and length: goes on at the moment that is heard. */
  exchange(buffer, duration) {
    this.change(() => {
      this.buffer = buffer;
      this.duration = duration;
      this.at = Math.min(this.at, duration);
    });
  }

  /** Where the loop is: [from, to]; null when it is off or lies behind. */
  loop() {
    const loop = this.looping ? this.region || [0, this.duration] : null;
    return loop && this.at < loop[1] ? loop : null;
  }

  /** Seconds on the clock of the audio context at which that leaves it which is heard now; null
      without sound. */
  clock() {
    return this.context ? this.context.currentTime - (this.context.outputLatency || 0) : null;
  }

  /** The same without the steps in which the context counts. */
  heard() {
    const now = performance.now() / 1000;
    const raw = this.clock();
    const last = this.last;
    let value = raw;
    if (last && this.context.state === 'running') {
      const expected = last.value + now - last.now;
      const error = raw - expected;
      if (Math.abs(error) < JUMP) value = Math.max(last.value, expected + 0.1 * error);
    }
    this.last = {value, now};
    return value;
  }

  /** Seconds since the beginning of the clip that are shown now. */
  position() {
    if (!this.playing) return this.at;
    const passed = this.source ? this.heard() - this.began : performance.now() / 1000 - this.began;
    const time = this.at + Math.max(passed, 0) * this.rate;
    const loop = this.loop();
    if (loop && time >= loop[1]) return loop[0] + (time - loop[0]) % (loop[1] - loop[0]);
    return Math.min(time, this.duration);
  }

  /** To be called before each picture: stops at the end. The position. */
  tick() {
    const time = this.position();
    if (this.playing && !this.loop() && time >= this.duration) this.pause();
    return time;
  }

  play() {
    if (this.playing) return;
    if (this.at >= this.duration - 1e-3) this.at = 0;
    if (this.looping && this.region) this.enterRegion();
    this.playing = true;
    this.restart();
    this.onChange();
  }

  pause() {
    if (!this.playing) return;
    this.at = this.position();
    this.playing = false;
    this.restart();
    this.onChange();
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  seek(time) {
    this.at = Math.min(Math.max(Number.isFinite(time) ? time : 0, 0), this.duration);
    this.restart();
    this.onChange();
  }

  /** 0.25 to 2; the pitch stays. */
  setRate(rate) {
    this.change(() => { this.rate = Math.min(Math.max(rate || 1, 0.25), 2); });
  }

  setVolume(volume) {
    this.volume = Math.min(Math.max(volume, 0), 1);
    if (this.gain) this.gain.gain.value = this.volume;
    this.onChange();
  }

  setLooping(looping, region = this.region) {
    this.change(() => {
      this.region = region && region[1] - region[0] >= 0.02 ? region : null;
      this.looping = looping;
      if (looping && this.region && this.playing) this.enterRegion();
    });
  }

  enterRegion() {
    const [from, to] = this.region;
    if (this.at < from || this.at >= to - 1e-3) this.at = from;
  }

  // What changes the way from time to position begins anew where it is.
  change(set) {
    this.at = this.position();
    set();
    this.restart();
    this.onChange();
  }

  /** The context of the sound; made when it is first played, as browsers want it. */
  open() {
    if (this.context) return;
    // The rate of the buffer, so that pieces of sound join to the sample.
    this.context = new AudioContext(
        {latencyHint: 'interactive', sampleRate: this.buffer.sampleRate});
    this.gain = this.context.createGain();
    this.gain.gain.value = this.volume;
    this.gain.connect(this.context.destination);
  }

  // Begins to play at `at`, or is silent.
  restart() {
    if (this.source) {
      this.source.stop();
      this.source = null;
    }
    if (!this.playing) return;
    this.began = performance.now() / 1000;
    if (!this.buffer) return;
    this.open();
    if (this.context.state !== 'running') this.context.resume();
    this.last = null;
    this.source = this.rate === 1 ? this.wholeSource() :
        new StretchedSource(this.context, this.buffer, this.gain,
            {rate: this.rate, from: this.at, loop: this.loop()});
    this.began = this.source.begin(LEAD);
  }

  // The sound as it is, in the terms of StretchedSource.
  wholeSource() {
    const source = this.context.createBufferSource();
    source.buffer = this.buffer;
    const loop = this.loop();
    if (loop) {
      source.loop = true;
      [source.loopStart, source.loopEnd] = loop;
    }
    source.connect(this.gain);
    return {
      begin: (lead) => {
        const when = this.context.currentTime + lead;
        source.start(when, this.at);
        return when;
      },
      stop: () => {
        source.stop();
        source.disconnect();
      },
    };
  }
}
