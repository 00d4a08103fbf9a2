// The relief of skin and the fine lines of lips: a small block of numbers that repeats in space,
// the same as in tools/view/render/detail/grain.cpp, which says why.

export const GRAIN_SIZE = 32;  // texels a side
const UNITS = 14;
const CELL = 64;
const CELLS = GRAIN_SIZE * UNITS / CELL;
const LONG = 6;

function scrambled(h) {
  h = Math.imul(h ^ (h >>> 15), 2246822519);
  h = Math.imul(h ^ (h >>> 13), 3266489917);
  return (h ^ (h >>> 16)) >>> 0;
}

const wrappedCell = (i) => (i + CELLS) % CELLS;

// Middles of the grains of cells, x, y, z, from the corner of their cell.
function middles(lines) {
  const deep = lines ? CELLS * CELL : CELL;
  const places = new Int32Array(3 * CELLS ** 3);
  for (let cell = 0; cell < CELLS ** 3; ++cell) {
    const h = scrambled(2 * (lines ? cell % CELLS : cell) + (lines ? 2 : 1));
    places.set([h % CELL, (h >>> 8) % deep, (h >>> 20) % deep], 3 * cell);
  }
  return {deep, places};
}

function heightAt(texel, lines, {deep, places}) {
  const [x, y, z] = texel.map((i) => i * UNITS + UNITS / 2);
  const stretch = lines ? LONG * LONG : 1;
  const [left, low, back] = [x / CELL, y / deep, z / deep].map((i) => Math.floor(i) - 1);
  let first = 1 << 30;
  let second = 1 << 30;
  for (let c = back; c < back + 3; ++c) {
    for (let b = low; b < low + 3; ++b) {
      const row = (wrappedCell(c) * CELLS + wrappedCell(b)) * CELLS;
      for (let a = left; a < left + 3; ++a) {
        const i = 3 * (row + wrappedCell(a));
        const dx = a * CELL + places[i] - x;
        const dy = b * deep + places[i + 1] - y;
        const dz = c * deep + places[i + 2] - z;
        const square = stretch * dx * dx + dy * dy + dz * dz;
        second = Math.min(second, Math.max(first, square));
        first = Math.min(first, square);
      }
    }
  }
  return Math.min((Math.sqrt(second) - Math.sqrt(first)) / (lines ? LONG : 1) / 36, 1);
}

let kept = null;

/** Two bytes a texel, x fastest: relief, then lines; 128 is none. */
export function grainBlock() {
  if (kept) return kept;
  const count = GRAIN_SIZE ** 3;
  const block = new Uint8Array(2 * count);
  const at = (x, y, z) => {
    const [i, j, k] = [x, y, z].map((v) => v & (GRAIN_SIZE - 1));
    return (k * GRAIN_SIZE + j) * GRAIN_SIZE + i;
  };
  for (const lines of [0, 1]) {
    const places = Array.from({length: count}, (_, i) => [i % GRAIN_SIZE,
      Math.floor(i / GRAIN_SIZE) % GRAIN_SIZE, Math.floor(i / GRAIN_SIZE ** 2)]);
    const grains = middles(lines);
    const heights = Float64Array.from(places, (place) => heightAt(place, lines, grains));
    places.forEach(([x, y, z], i) => {
      const slope = heights[i] - heights[at(x + 1, y + 1 - lines, z + 1 - lines)];
      const light = 0.9 * slope + 0.7 * (heights[i] - 0.45);
      block[2 * i + lines] = Math.max(1, Math.min(255, Math.floor(128.5 + 127 * light)));
    });
  }
  kept = block;
  return block;
}

/** The block as a texture in the unit, with its coarser levels. */
export function grainTexture(gl, unit) {
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_3D, gl.createTexture());
  gl.texImage3D(gl.TEXTURE_3D, 0, gl.RG8, GRAIN_SIZE, GRAIN_SIZE, GRAIN_SIZE, 0, gl.RG,
      gl.UNSIGNED_BYTE, grainBlock());
  gl.generateMipmap(gl.TEXTURE_3D);
  gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
  gl.activeTexture(gl.TEXTURE0);
}
