// The sound as a wave: how far its samples reach over any stretch of time.
const BLOCK = 128;  // samples; longer stretches are looked up by blocks

export class Wave {
  /** `buffer`: an AudioBuffer; its first channel is shown. */
  constructor(buffer) {
    this.samples = buffer.getChannelData(0);
    this.rate = buffer.sampleRate;
    const blocks = Math.ceil(this.samples.length / BLOCK);
    this.low = new Float32Array(blocks);
    this.high = new Float32Array(blocks);
    /** The largest sample, that quiet sounds are seen, too. */
    this.peak = 0;
    for (let block = 0; block < blocks; ++block) {
      const [low, high] = this.reach(block * BLOCK, (block + 1) * BLOCK);
      [this.low[block], this.high[block]] = [low, high];
      this.peak = Math.max(this.peak, -low, high);
    }
  }

  // Of samples, one at least.
  reach(begin, end) {
    let low = Infinity;
    let high = -Infinity;
    for (let i = begin; i < Math.min(Math.max(end, begin + 1), this.samples.length); ++i) {
      const value = this.samples[i];
      if (value < low) low = value;
      if (value > high) high = value;
    }
    return [low, high];
  }

  /** The least and the largest sample from `from` to `to` seconds; null behind the end. */
  extremes(from, to) {
    const begin = Math.max(Math.floor(from * this.rate), 0);
    const end = Math.min(Math.ceil(to * this.rate), this.samples.length);
    if (begin >= end) return null;
    if (end - begin < 4 * BLOCK) return this.reach(begin, end);
    let low = Infinity;
    let high = -Infinity;
    for (let block = Math.floor(begin / BLOCK); block * BLOCK < end; ++block) {
      low = Math.min(low, this.low[block]);
      high = Math.max(high, this.high[block]);
    }
    return [low, high];
  }
}
