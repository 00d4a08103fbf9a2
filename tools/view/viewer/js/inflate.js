// Deflated data (RFC 1950, 1951), by the browser or, where it cannot (before 2023), by hand.

const ORDER = [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15];

// Base value and extra bits of the codes of lengths (from 257 on) and distances.
function bases(count, first, start, per) {
  const out = [];
  for (let code = 0, value = start; code < count; ++code) {
    const bits = Math.max(0, Math.floor(code / per) - 1);
    out.push([value, code < first ? 0 : bits]);
    value += 1 << (code < first ? 0 : bits);
  }
  return out;
}
const LENGTHS = [...bases(28, 4, 3, 4), [258, 0]];
const DISTANCES = bases(30, 2, 1, 2);

// Canonical codes: how many there are of each length, and their symbols in order.
function tree(lengths) {
  const counts = new Uint16Array(16);
  for (const length of lengths) ++counts[length];
  counts[0] = 0;
  const symbols = [];
  for (let length = 1; length < 16; ++length) {
    lengths.forEach((l, symbol) => { if (l === length) symbols.push(symbol); });
  }
  return {counts, symbols};
}

class Inflater {
  constructor(bytes) {
    this.bytes = bytes;
    this.at = 2;  // behind the header of zlib
    this.held = 0;
    this.count = 0;
    this.out = new Uint8Array(bytes.length * 4 + 64);
    this.length = 0;
  }

  bits(count) {
    while (this.count < count) {
      if (this.at >= this.bytes.length) throw new Error('deflated data end early');
      this.held |= this.bytes[this.at++] << this.count;
      this.count += 8;
    }
    const value = this.held & ((1 << count) - 1);
    this.held >>>= count;
    this.count -= count;
    return value;
  }

  symbol({counts, symbols}) {
    let [code, first, index] = [0, 0, 0];
    for (let length = 1; length < 16; ++length) {
      code |= this.bits(1);
      if (code - first < counts[length]) return symbols[index + code - first];
      index += counts[length];
      first = (first + counts[length]) << 1;
      code <<= 1;
    }
    throw new Error('deflated data have an unknown code');
  }

  put(byte) {
    if (this.length === this.out.length) {
      const larger = new Uint8Array(this.out.length * 2);
      larger.set(this.out);
      this.out = larger;
    }
    this.out[this.length++] = byte;
  }

  stored() {
    this.held = this.count = 0;
    const size = this.bytes[this.at] | this.bytes[this.at + 1] << 8;
    this.at += 4;
    for (let i = 0; i < size; ++i) this.put(this.bytes[this.at++]);
  }

  trees() {
    const [literals, distances, codes] = [this.bits(5) + 257, this.bits(5) + 1, this.bits(4) + 4];
    const first = new Array(19).fill(0);
    for (let i = 0; i < codes; ++i) first[ORDER[i]] = this.bits(3);
    const coder = tree(first);
    const lengths = [];
    while (lengths.length < literals + distances) {
      const symbol = this.symbol(coder);
      if (symbol < 16) lengths.push(symbol);
      const [value, times] = symbol === 16 ? [lengths[lengths.length - 1], 3 + this.bits(2)] :
          symbol === 17 ? [0, 3 + this.bits(3)] : symbol === 18 ? [0, 11 + this.bits(7)] : [0, 0];
      for (let i = 0; i < times; ++i) lengths.push(value);
    }
    return [tree(lengths.slice(0, literals)), tree(lengths.slice(literals))];
  }

  block([literals, distances]) {
    for (let symbol; (symbol = this.symbol(literals)) !== 256;) {
      if (symbol < 256) {
        this.put(symbol);
        continue;
      }
      const [length, extra] = LENGTHS[symbol - 257];
      const size = length + this.bits(extra);
      const [distance, more] = DISTANCES[this.symbol(distances)];
      const back = distance + this.bits(more);
      for (let i = 0; i < size; ++i) this.put(this.out[this.length - back]);
    }
  }

  run() {
    const fixed = () => [
      tree(Array.from({length: 288}, (_, i) => (i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8))),
      tree(new Array(30).fill(5))];
    for (let last = 0; !last;) {
      last = this.bits(1);
      const kind = this.bits(2);
      if (kind === 0) this.stored();
      else this.block(kind === 1 ? fixed() : this.trees());
    }
    return this.out.subarray(0, this.length);
  }
}

/** By hand. */
export function inflateByHand(bytes) {
  return new Inflater(bytes).run();
}

/** A promise of the bytes. */
export async function inflate(bytes) {
  if (typeof DecompressionStream === 'undefined') return inflateByHand(bytes);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
