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
  return {name: info.name, material: info.material, positions, normals, paint, triangles};
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

/** {name, parts: [{name, material, positions, normals, paint, triangles}], targets, lips, lids,
    sliding, beforeEyes, teeth, anchors, neckWeights, and what the header has}. Vertices of targets are places in the
    array of positions. */
export function readModel(bytes) {
  const reader = new ByteReader(bytes);
  const {header} = reader;
  if (header.version !== 2) throw new Error(`a head of version ${header.version} is not known`);
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
  return {...header, parts, targets, lips, lids, sliding, beforeEyes, teeth, anchors,
    neckWeights};
}
