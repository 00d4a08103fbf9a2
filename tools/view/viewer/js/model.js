// A head as pack_head() writes it.
import {ByteReader} from './bytes.js';
import {loadRig} from './rig.js';

function readPart(reader, info, {positions, normals, triangles, deforms}) {
  const count = positions.length / 3;
  // Colour and occlusion of a vertex side by side, as the drawing wants them.
  const paint = new Uint8Array(count * 4);
  for (let k = 0; k < 4; ++k) {
    const values = reader.u8(count);
    for (let i = 0; i < count; ++i) paint[i * 4 + k] = values[i];
  }
  const part = {name: info.name, surface: info.surface, positions, normals, paint, deforms,
    triangles: triangles.subarray(0, info.solid * 3)};
  if (info.grain) {
    part.grain = new Uint8Array(count * 2);  // relief and gloss side by side
    for (let k = 0; k < 2; ++k) reader.u8(count).forEach((v, i) => { part.grain[i * 2 + k] = v; });
  }
  if (info.facets) part.facets = readFacets(reader, info.facets, part);
  return part;
}

const axisOf = (reader, [low, step], count) =>
  Float32Array.from(reader.u16(count), (value) => low + value * step);

// What is drawn with materials: corners, each with its vertex, and facets in runs of one material.
function readFacets(reader, info, part) {
  const count = info.corners;
  const vertices = new Uint32Array(count);
  let last = 0;
  for (let i = 0; i < count; ++i) vertices[i] = last += reader.zigzag();
  const uvs = new Float32Array(count * 2);
  [info.u, info.v].forEach((scale, k) => {
    axisOf(reader, scale, count).forEach((value, i) => { uvs[i * 2 + k] = value; });
  });
  const own = new Int16Array(count * 4);  // normals of its maker
  for (let k = 0; k < 3; ++k) reader.i16(count).forEach((value, i) => { own[i * 4 + k] = value; });
  const tints = new Uint8Array(count * 4).fill(255);
  for (let k = 0; k < 4 && info.tinted; ++k) {
    reader.u8(count).forEach((value, i) => { tints[i * 4 + k] = value; });
  }
  const facets = info.runs.reduce((sum, run) => sum + run[1], 0);
  const corners = new Uint32Array(facets * 3);
  last = 0;
  for (let i = 0; i < corners.length; ++i) corners[i] = last += reader.zigzag();
  let first = 0;
  const runs = info.runs.map(([material, size]) => {
    const run = {material, first, count: size * 3, middle: [0, 0, 0]};
    first += size * 3;
    for (let i = run.first; i < first; ++i) {
      for (let k = 0; k < 3; ++k) {
        run.middle[k] += part.positions[vertices[corners[i]] * 3 + k] / run.count;
      }
    }
    return run;
  });
  return {vertices, uvs, own, tints, corners, runs};
}

/** {name, rig (its number), parts: [{name, material, positions, normals, paint, deforms, triangles,
    facets}], pictures, and what the header has}. Needs WebAssembly. */
export function readModel(bytes) {
  const reader = new ByteReader(bytes);
  const {header} = reader;
  if (header.version !== 5) throw new Error(`unknown version ${header.version} of the head format`);
  const {rig, parts: shapes} = loadRig(reader.u8(header.rig), header.parts.length);
  const parts = header.parts.map((info, i) => readPart(reader, info, shapes[i]));
  const pictures = (header.pictures || []).map(({type, bytes: size}) =>
      ({type, file: reader.u8(size)}));
  return {...header, rig, parts, pictures};
}
