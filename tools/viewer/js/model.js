// A head as pack_head() writes it.
import {ByteReader} from './bytes.js';
import {smoothNormals} from './vector.js';

function readPart(reader, info) {
  const {vertices, low, step} = info;
  const positions = new Float32Array(vertices * 3);
  for (let k = 0; k < 3; ++k) {
    const places = reader.u16(vertices);
    for (let i = 0; i < vertices; ++i) positions[i * 3 + k] = low[k] + places[i] * step;
  }
  // Colour and occlusion of a vertex side by side, as the drawing wants them.
  const paint = new Uint8Array(vertices * 4);
  for (let k = 0; k < 4; ++k) {
    const values = reader.u8(vertices);
    for (let i = 0; i < vertices; ++i) paint[i * 4 + k] = values[i];
  }
  const triangles = new Uint32Array(info.triangles * 3);
  let vertex = 0;
  for (let i = 0; i < triangles.length; ++i) triangles[i] = vertex += reader.zigzag();
  const normals = new Float32Array(positions.length);
  smoothNormals(positions, triangles, normals);
  const part = {name: info.name, material: info.material, positions, normals, paint,
    surface: triangles, triangles: triangles.subarray(0, (info.solid ?? info.triangles) * 3)};
  if (info.facets) part.facets = readFacets(reader, info.facets, part);
  return part;
}

const axisOf = (reader, [low, step], count) =>
  Float32Array.from(reader.u16(count), (value) => low + value * step);

// What is drawn with coats: corners, each with its vertex, and facets in runs of one coat.
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
  const runs = info.runs.map(([coat, size]) => {
    const run = {coat, first, count: size * 3, middle: [0, 0, 0]};
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

function readTarget(reader, {control, part, count, steps, low = -Infinity, high = Infinity}) {
  const vertices = new Uint32Array(count);
  let vertex = -1;
  for (let i = 0; i < count; ++i) vertices[i] = (vertex += reader.varint() + 1) * 3;
  const axes = [];
  steps.forEach((step, axis) => {
    if (step > 0) axes.push({axis, step, deltas: reader.i16(count)});
  });
  const rest = Math.min(Math.max(0, low), high);
  return {control, part, vertices, axes, low, high, rest};
}

// Those triangles of a mesh that are in every other run, beginning with the first.
function outsideOf(triangles, runs) {
  const total = runs.reduce((sum, count, i) => sum + (i % 2 === 0 ? count : 0), 0);
  const found = new Uint32Array(total * 3);
  let first = 0;
  let filled = 0;
  runs.forEach((count, i) => {
    const run = triangles.subarray(first * 3, (first + count) * 3);
    first += count;
    if (i % 2 === 1) return;
    found.set(run, filled);
    filled += run.length;
  });
  return found;
}

// 1 in every other run, beginning with the first.
function flagsOf(count, runs) {
  const flags = new Uint8Array(count);
  let first = 0;
  runs.forEach((length, i) => {
    flags.fill(i % 2 === 0 ? 1 : 0, first, first + length);
    first += length;
  });
  return flags;
}

/** {name, parts: [{name, material, positions, normals, paint, triangles, surface (with what bears on
    normals alone), facets}], targets, lips, lids, sliding, beforeEyes, teeth, anchors, neckWeights,
    outside (triangles of the skin), rolling (a flag each), and what the header has}. Vertices of targets are places in the
    array of positions. */
export function readModel(bytes) {
  const reader = new ByteReader(bytes);
  const {header} = reader;
  if (header.version !== 3) throw new Error(`a head of version ${header.version} is not known`);
  const parts = header.parts.map((info) => readPart(reader, info));
  const targets = header.targets.map((info) => readTarget(reader, info));
  const lips = reader.varints(header.lips * 2);
  const lids = header.lids.map((count) => reader.varints(count * 2));
  const sliding = header.sliding.map((count) => reader.varints(count));
  const beforeEyes = header.before_eyes.map((count) => reader.varints(count));
  const teeth = header.teeth.map((arch) => ({...arch, vertices: reader.varints(arch.count)}));
  const anchors = reader.varints(header.anchors);
  const neckWeights = Float32Array.from(reader.u16(parts[0].positions.length / 3),
      (weight) => weight / 65535);
  const outside = outsideOf(parts[0].surface, reader.varints(header.outside));
  const rolling = flagsOf(outside.length / 3, reader.varints(header.rolling));
  const pictures = (header.pictures || []).map(({type, bytes: size}) => ({type, file: reader.u8(size)}));
  return {...header, pictures, parts, targets, lips, lids, sliding, beforeEyes, teeth, anchors,
    neckWeights, outside, rolling};
}
