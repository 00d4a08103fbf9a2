// Reads the PNG files that screenshots are: 8 bits, RGB or RGBA, not interlaced.
'use strict';

const zlib = require('zlib');

function chunks(bytes) {
  const out = [];
  for (let at = 8; at < bytes.length;) {
    const size = bytes.readUInt32BE(at);
    out.push({type: bytes.toString('latin1', at + 4, at + 8),
      data: bytes.subarray(at + 8, at + 8 + size)});
    at += size + 12;
  }
  return out;
}

function paeth(a, b, c) {
  const p = a + b - c;
  const [pa, pb, pc] = [Math.abs(p - a), Math.abs(p - b), Math.abs(p - c)];
  if (pa <= pb && pa <= pc) return a;
  return pb <= pc ? b : c;
}

/** {width, height, channels, data}. */
function readPng(bytes) {
  const all = chunks(bytes);
  const header = all.find(({type}) => type === 'IHDR').data;
  const [width, height] = [header.readUInt32BE(0), header.readUInt32BE(4)];
  const channels = {2: 3, 6: 4}[header[9]];
  if (header[8] !== 8 || !channels) throw new Error('no 8-bit RGB picture');
  const raw = zlib.inflateSync(
      Buffer.concat(all.filter(({type}) => type === 'IDAT').map(({data}) => data)));
  const stride = width * channels;
  const data = new Uint8Array(stride * height);
  const at = (x, y) => (x < 0 || y < 0 ? 0 : data[y * stride + x]);
  for (let y = 0; y < height; ++y) {
    const filter = raw[y * (stride + 1)];
    for (let x = 0; x < stride; ++x) {
      const [a, b] = [at(x - channels, y), at(x, y - 1)];
      const c = x < channels ? 0 : at(x - channels, y - 1);
      const guess = [0, a, b, (a + b) >> 1, paeth(a, b, c)][filter];
      data[y * stride + x] = raw[y * (stride + 1) + 1 + x] + guess;
    }
  }
  return {width, height, channels, data};
}

/** Mean absolute difference of two pictures in a box {left, top, right, bottom}, 0..255. */
function difference(a, b, {left, top, right, bottom}) {
  let sum = 0;
  let count = 0;
  for (let y = Math.round(top); y < Math.round(bottom); ++y) {
    for (let x = Math.round(left); x < Math.round(right); ++x) {
      for (let c = 0; c < 3; ++c) {
        sum += Math.abs(a.data[(y * a.width + x) * a.channels + c] -
            b.data[(y * b.width + x) * b.channels + c]);
        ++count;
      }
    }
  }
  if (count === 0) throw new Error('an empty box');
  return sum / count;
}

const CALM = 14;   // of 255: what surrounds a speck differs by less
const APART = 5;   // and a speck is so much darker or lighter than all of it

/**
 * Pixels in a box that differ from all of the calm ring of 16 pixels two steps around them: [x, y].
 */
function specks(picture, {left, top, right, bottom}) {
  const {data, width, channels} = picture;
  const light = (x, y) => {
    const i = (y * width + x) * channels;
    return 0.3 * data[i] + 0.59 * data[i + 1] + 0.11 * data[i + 2];
  };
  const found = [];
  for (let y = Math.round(top); y < bottom; ++y) {
    for (let x = Math.round(left); x < right; ++x) {
      const ring = [];
      for (let k = -2; k < 2; ++k) {
        ring.push(light(x + k, y - 2), light(x + 2, y + k), light(x - k, y + 2),
            light(x - 2, y - k));
      }
      const [low, high] = [Math.min(...ring), Math.max(...ring)];
      const is = light(x, y);
      if (high - low < CALM && (is < low - APART || is > high + APART)) found.push([x, y]);
    }
  }
  return found;
}

module.exports = {readPng, difference, specks};
