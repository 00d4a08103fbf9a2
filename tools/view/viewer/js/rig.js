// Moves a head: fap/head itself, as WebAssembly (rig/module.cpp).
import {fromBase64} from './bytes.js';
import {inflate} from './inflate.js';

/* global RIG_MODULE -- its bytes, which page.cpp puts in front */

let wasm = null;
let missing = new Error('it is not there yet');

/** To be awaited before the first head. */
export const rigReady = inflate(fromBase64(RIG_MODULE))
    .then((bytes) => WebAssembly.instantiate(bytes))
    .then(({instance}) => {
      wasm = instance.exports;
      wasm._initialize();
    })
    .catch((problem) => { missing = problem; });

const floats = (at, count) => new Float32Array(wasm.memory.buffer, at, count);
const integers = (at, count) => new Int32Array(wasm.memory.buffer, at, count);
const vertices = (at, count) => new Uint32Array(wasm.memory.buffer, at, count);

/** A packed rig: {rig: its number, parts: [{positions, normals, triangles, deforms}]}, at rest. */
export function loadRig(bytes, count) {
  if (!wasm) throw new Error(`no WebAssembly: ${missing.message}`);
  const room = wasm.room(bytes.length);  // may give the memory another buffer
  new Uint8Array(wasm.memory.buffer).set(bytes, room);
  const rig = wasm.load();
  if (rig < 0) throw new Error('a damaged head');
  const parts = Array.from({length: count}, (_, i) => {
    const [positions, normals, size, triangles, faces, deforms] = vertices(wasm.part(rig, i), 6);
    return {positions: floats(positions, size * 3).slice(),
        normals: floats(normals, size * 3).slice(),
      triangles: vertices(triangles, faces * 3).slice(), deforms: deforms !== 0};
  });
  return {rig, parts};
}

// An array whose entries are made when they are asked for: the memory may have moved.
const lazy = (count, entry) => Object.defineProperties([], Object.fromEntries(
    Array.from({length: count}, (_, i) => [i, {enumerable: true, get: () => entry(i)}])));

/** One head in one pose. */
export class Rig {
  constructor(model) {
    this.model = model;
    this.number = wasm.add(model.rig);
    const count = model.parts.length;
    /**
     * Of each part x, y, z of its vertices, before they are placed, and normals; what places it in
     * the scene, [x row, y
        row, z row,
            shift]: p becomes rows * p + shift. Good until the next call of anything here. */
    this.positions = lazy(count, (part) => this.moved(part, 'positions'));
    this.normals = lazy(count, (part) => this.moved(part, 'normals'));
    this.transforms = lazy(count, (part) => floats(wasm.transform(this.number, part), 12));
    this.index = Object.fromEntries(model.parts.map(({name}, i) => [name, i]));
    /** Parts whose vertices move. */
    this.deforming = [...model.parts.keys()].filter((i) => model.parts[i].deforms);
    this.pose({});
  }

  /**
   * By FAP number, FAP units, missing ones are absent; 1 may be {select1, select2, blend}, 2
   * {select1,
      intensity1, select2, intensity2}. */
  pose(values) {
    const at = wasm.frame();
    const [value, given] = [integers(at, 69), integers(at + 4 * 69, 69)];
    const [viseme, expression] = [integers(at + 8 * 69, 3), integers(at + 8 * 69 + 12, 4)];
    for (let fap = 1; fap <= 68; ++fap) {
      const wanted = values[fap];
      if (wanted === undefined || wanted === null || (fap < 3 && typeof wanted !== 'object'))
          continue;
      given[fap] = 1;
      if (fap > 2) value[fap] = Math.round(wanted);
      else if (fap === 1) viseme.set([wanted.select1, wanted.select2, wanted.blend]);
      else expression.set([wanted.select1, wanted.intensity1, wanted.select2, wanted.intensity2]);
    }
    wasm.show(this.number);
  }

  /** By control: FAPs, then the weights of the shapes of the head, as clips have them. */
  move(values) {
    floats(wasm.values(this.number), this.model.controls).set(values.subarray(0,
        this.model.controls));
    wasm.move(this.number);
  }

  moved(part, what) {
    const {[what]: rest, deforms} = this.model.parts[part];
    return deforms ? floats(wasm[what](this.number, part), rest.length) : rest;
  }

  /** Where the vertices of a part are in the scene. */
  placed(part) {
    const m = this.transforms[part];
    const points = this.positions[part];
    return Float32Array.from(points, (_, i) => {
      const [row, first] = [i % 3, i - i % 3];
      return m[row * 3] * points[first] + m[row * 3 + 1] * points[first + 1] +
          m[row * 3 + 2] * points[first + 2] + m[9 + row];
    });
  }
}
