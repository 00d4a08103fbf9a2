// Makes me.glb, me.vrm and me.obj of woman.glb, woman.obj and woman.points.csv in the current
// folder: our head with fewer triangles, compressed with meshopt, once as an avatar with ARKit's
// shapes and visemes, once as VRM 1.0. Called by make.sh, which installs meshoptimizer (npm).
//   node make_head.mjs FOLDER_OF_MESHOPTIMIZER
import {readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';

const {MeshoptSimplifier, MeshoptEncoder} =
    await import(pathToFileURL(join(process.argv[2], 'index.js')));
await MeshoptSimplifier.ready;
await MeshoptEncoder.ready;

// Share of the triangles that stay.
const KEPT = {
  skin: 0.27, left_eye: 0.5, right_eye: 0.5, upper_teeth: 0.3, lower_teeth: 0.3, hair: 0.4,
      body: 0.2,
};
const KEPT_OF_OBJ = 0.08;
// Shapes whose motion counts as form, so that what closes and folds keeps its vertices.
const FORM = ['jawOpen', 'mouthPucker', 'mouthFunnel', 'mouthRollLower', 'mouthUpperUpLeft',
  'mouthUpperUpRight', 'eyeBlinkLeft', 'eyeBlinkRight'];
const POSITION_BITS = 14, MOVE_BITS = 12;  // of mantissas
const STILL = 4e-5;  // metres: moves below are none

// Visemes of Oculus by shapes of ARKit.
const VISEMES = {
  viseme_sil: {},
  viseme_PP: {mouthClose: 0.12, mouthRollLower: 0.35, mouthRollUpper: 0.3, mouthPressLeft: 0.3,
      mouthPressRight: 0.3},
  viseme_FF: {jawOpen: 0.07, mouthRollLower: 0.75, mouthUpperUpLeft: 0.3, mouthUpperUpRight: 0.3},
  viseme_TH: {jawOpen: 0.16, tongueOut: 0.8, mouthLowerDownLeft: 0.2, mouthLowerDownRight: 0.2},
  viseme_DD: {jawOpen: 0.14, mouthLowerDownLeft: 0.25, mouthLowerDownRight: 0.25,
      mouthUpperUpLeft: 0.12, mouthUpperUpRight: 0.12},
  viseme_kk: {jawOpen: 0.2, mouthLowerDownLeft: 0.2, mouthLowerDownRight: 0.2,
      mouthUpperUpLeft: 0.1, mouthUpperUpRight: 0.1},
  viseme_CH: {jawOpen: 0.1, mouthFunnel: 0.55, mouthPucker: 0.2},
  viseme_SS: {jawOpen: 0.05, mouthStretchLeft: 0.35, mouthStretchRight: 0.35,
      mouthLowerDownLeft: 0.3, mouthLowerDownRight: 0.3},
  viseme_nn: {jawOpen: 0.12, mouthLowerDownLeft: 0.2, mouthLowerDownRight: 0.2},
  viseme_RR: {jawOpen: 0.12, mouthFunnel: 0.35, mouthPucker: 0.25},
  viseme_aa: {jawOpen: 0.75, mouthLowerDownLeft: 0.3, mouthLowerDownRight: 0.3,
      mouthUpperUpLeft: 0.15, mouthUpperUpRight: 0.15},
  viseme_E: {jawOpen: 0.4, mouthStretchLeft: 0.35, mouthStretchRight: 0.35, mouthSmileLeft: 0.15,
      mouthSmileRight: 0.15},
  viseme_I: {jawOpen: 0.15, mouthStretchLeft: 0.4, mouthStretchRight: 0.4, mouthSmileLeft: 0.25,
      mouthSmileRight: 0.25},
  viseme_O: {jawOpen: 0.5, mouthFunnel: 0.55, mouthPucker: 0.25},
  viseme_U: {jawOpen: 0.16, mouthPucker: 0.8, mouthFunnel: 0.2},
};
// Expressions of VRM 1.0, likewise.
const both = (name, share) => ({[`${name}Left`]: share, [`${name}Right`]: share});
const EXPRESSIONS = {
  aa: VISEMES.viseme_aa, ih: VISEMES.viseme_I, ou: VISEMES.viseme_U, ee: VISEMES.viseme_E,
      oh: VISEMES.viseme_O,
  blink: both('eyeBlink', 1), blinkLeft: {eyeBlinkLeft: 1}, blinkRight: {eyeBlinkRight: 1},
  lookUp: both('eyeLookUp', 1), lookDown: both('eyeLookDown', 1),
  lookLeft: {eyeLookOutLeft: 1, eyeLookInRight: 1}, lookRight: {eyeLookInLeft: 1,
      eyeLookOutRight: 1},
  happy: {...both('mouthSmile', 0.75), ...both('cheekSquint', 0.5), ...both('eyeSquint', 0.25)},
  angry: {...both('browDown', 0.9), ...both('mouthPress', 0.5), ...both('noseSneer', 0.4),
      ...both('eyeSquint', 0.35)},
  sad: {browInnerUp: 0.85, ...both('mouthFrown', 0.7), ...both('eyeLookDown', 0.25)},
  relaxed: {...both('mouthSmile', 0.35), ...both('eyeBlink', 0.25)},
  surprised: {browInnerUp: 0.8, ...both('browOuterUp', 0.8), ...both('eyeWide', 0.8), jawOpen: 0.3},
};

const COMPONENTS = {5121: Uint8Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array};
const WIDTHS = {SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16};

/** A .glb as our exporter writes it. */
class Glb {
  constructor(path) {
    const file = readFileSync(path);
    const length = file.readUInt32LE(12);
    this.json = JSON.parse(file.toString('utf8', 20, 20 + length));
    this.bin = file.subarray(28 + length);
  }

  /** `count` elements of `width` numbers. */
  view(index, type, width, count, offset = 0) {
    const {byteOffset = 0, byteStride} = this.json.bufferViews[index],
        size = width * type.BYTES_PER_ELEMENT;
    const start = this.bin.byteOffset + byteOffset + offset, step = byteStride ?? size,
        bytes = new Uint8Array(count * size);
    for (let i = 0; i < count; ++i) bytes.set(new Uint8Array(this.bin.buffer, start + i * step,
        size), i * size);
    return new type(bytes.buffer);
  }

  read(index) {
    const accessor = this.json.accessors[index], type = COMPONENTS[accessor.componentType];
    const width = WIDTHS[accessor.type], {count} = accessor;
    const values = accessor.bufferView === undefined ?
        new type(count * width) : this.view(accessor.bufferView, type, width, count,
            accessor.byteOffset);
    const few = accessor.sparse;
    if (few) {
      const places = this.view(few.indices.bufferView, COMPONENTS[few.indices.componentType], 1,
          few.count);
      const some = this.view(few.values.bufferView, type, width, few.count);
      places.forEach((place, i) => values.set(some.subarray(i * width, (i + 1) * width),
          place * width));
    }
    return values;
  }
}

/** Gathers what a .glb holds, in views that meshopt has compressed. */
class Writer {
  constructor() {
    this.chunks = [];
    this.size = 0;
    this.plain = 0;  // bytes of the buffer that decompressed views would lie in
    this.json = {accessors: [], bufferViews: []};
    this.moved = [];  // vertices that move, shape by shape
    this.by = [];     // how far each, three numbers
    this.sparse = [];  // of the accessors that these are for
  }

  append(bytes) {
    const at = this.size;
    this.chunks.push(bytes, new Uint8Array(-bytes.length & 3));
    this.size += bytes.length + (-bytes.length & 3);
    return at;
  }

  /** `mode`: ATTRIBUTES, TRIANGLES or INDICES. */
  view(bytes, count, stride, mode, filter, isVertices = mode === 'ATTRIBUTES') {
    const packed = MeshoptEncoder.encodeGltfBuffer(bytes, count, stride, mode, 0);
    const compression = {buffer: 0, byteOffset: this.append(packed), byteLength: packed.length,
        byteStride: stride,
      count, mode};
    if (filter) compression.filter = filter;
    const view = {buffer: 1, byteOffset: this.plain, byteLength: count * stride,
      extensions: {EXT_meshopt_compression: compression}};
    if (isVertices) view.byteStride = stride;
    this.plain += (count * stride + 3) & ~3;
    this.json.bufferViews.push(view);
    return this.json.bufferViews.length - 1;
  }

  accessor(fields) {
    this.json.accessors.push(fields);
    return this.json.accessors.length - 1;
  }

  indices(values) {
    return this.accessor({bufferView: this.view(new Uint8Array(Uint16Array.from(values).buffer),
        values.length, 2, 'TRIANGLES'),
      componentType: 5123, count: values.length, type: 'SCALAR'});
  }

  /** Floats with rounded mantissas, three a vertex; all x have one exponent, all y, all z. */
  coded(values, bits) { return MeshoptEncoder.encodeFilterExp(values, values.length / 3, 12, bits,
      'SharedComponent'); }

  /** The bounds are those of what a reader gets. */
  triples(values, bits) {
    const coded = this.coded(values, bits), count = values.length / 3;
    return this.accessor({bufferView: this.view(coded, count, 12, 'ATTRIBUTES', 'EXPONENTIAL'),
        componentType: 5126, count,
      type: 'VEC3', ...bounds(decodedExp(coded))});
  }

  /** The moves of a shape: only of vertices that move. Null: none does. */
  moves(values) {
    const some = [];
    for (let v = 0; v < values.length / 3; ++v) {
      if (Math.max(...values.subarray(3 * v, 3 * v + 3).map(Math.abs)) > STILL) some.push(v);
    }
    if (some.length === 0) return null;
    const by = some.flatMap((v) => [...values.subarray(3 * v, 3 * v + 3)]);
    const {min, max} = bounds(decodedExp(this.coded(Float32Array.from(by), MOVE_BITS)));
    const sparse = {count: some.length, indices: {byteOffset: 2 * this.moved.length,
        componentType: 5123},
      values: {byteOffset: 4 * this.by.length}};
    this.moved.push(...some);
    this.by.push(...by);
    this.sparse.push(sparse);
    // Those that do not move have 0.
    const zero = some.length < values.length / 3;
    return this.accessor({componentType: 5126, count: values.length / 3, type: 'VEC3',
      min: min.map((v) => zero ? Math.min(v, 0) : v), max: max.map((v) => zero ? Math.max(v, 0) :
          v), sparse});
  }

  /** The moves of all shapes, in one view each of vertices and of moves. */
  writeMoves() {
    const vertices = this.view(new Uint8Array(Uint16Array.from(this.moved).buffer),
        this.moved.length, 2, 'INDICES');
    const coded = this.coded(Float32Array.from(this.by), MOVE_BITS);
    const moves = this.view(coded, this.by.length / 3, 12, 'ATTRIBUTES', 'EXPONENTIAL', false);
    for (const sparse of this.sparse) {
      sparse.indices.bufferView = vertices;
      sparse.values.bufferView = moves;
    }
  }

  bytes(values, type, width, more) {
    const bytes = new Uint8Array(values.buffer, values.byteOffset, values.byteLength);
    const count = values.length / width;
    return this.accessor({bufferView: this.view(bytes, count, bytes.length / count, 'ATTRIBUTES'),
        componentType: type, count,
      type: `VEC${width}`, ...more});
  }

  glb(json) {
    const document = {...json, ...this.json,
      buffers: [{byteLength: this.size}, {byteLength: this.plain,
          extensions: {EXT_meshopt_compression: {fallback: true}}}]};
    const text = Buffer.from(JSON.stringify(document));
    const padded = Buffer.concat([text, Buffer.alloc(-text.length & 3, ' ')]);
    const head = Buffer.alloc(20), second = Buffer.alloc(8);
    head.write('glTF');
    [2, 28 + padded.length + this.size, padded.length].forEach((v, i) => head.writeUInt32LE(v,
        4 + 4 * i));
    head.write('JSON', 16);
    second.writeUInt32LE(this.size);
    second.write('BIN', 4);
    return Buffer.concat([head, padded, second, ...this.chunks]);
  }
}

// Mantissas of 24 bits and exponents of 8, as EXT_meshopt_compression has them.
function decodedExp(coded) {
  const words = new Int32Array(coded.buffer, coded.byteOffset, coded.byteLength / 4);
  return Float32Array.from(words, (word) => (word << 8 >> 8) * 2 ** (word >> 24));
}

function bounds(values) {
  const min = [Infinity, Infinity, Infinity], max = [-Infinity, -Infinity, -Infinity];
  values.forEach((v, i) => {
    min[i % 3] = Math.min(min[i % 3], v);
    max[i % 3] = Math.max(max[i % 3], v);
  });
  return {min, max};
}

/**
 * Arrays of a part with the vertices that are left, in the order of `of`: the new number of each
 * old one.
 */
function gathered(values, width, of, count) {
  const out = new values.constructor(count * width);
  of.forEach((to, from) => {
    if (to !== 0xFFFFFFFF) out.set(values.subarray(from * width, (from + 1) * width), to * width);
  });
  return out;
}

/** A mesh of woman.glb with fewer triangles. */
function smaller(source, mesh, kept = KEPT[mesh.name]) {
  const part = mesh.primitives[0], {POSITION, NORMAL, COLOR_0, JOINTS_0,
      WEIGHTS_0} = part.attributes;
  const positions = source.read(POSITION), normals = source.read(NORMAL),
      colours = source.read(COLOR_0);
  const names = mesh.extras?.targetNames ?? [];
  const moves = (part.targets ?? []).map((target) => source.read(target.POSITION));
  const count = positions.length / 3,
      form = FORM.map((name) => names.indexOf(name)).filter((i) => i >= 0);
  let indices = Uint32Array.from(source.read(part.indices));
  if (kept !== undefined) {
    const width = 6 + 3 * form.length, attributes = new Float32Array(count * width);
    for (let v = 0; v < count; ++v) {
      for (let k = 0; k < 3; ++k) {
        attributes[v * width + k] = normals[3 * v + k];
        attributes[v * width + 3 + k] = colours[4 * v + k] / 65535;
        form.forEach((shape, i) => { attributes[v * width + 6 + 3 * i + k] =
            moves[shape][3 * v + k]; });
      }
    }
    // Moves count like lengths; a whole turn of a normal and all of a colour like a centimetre or
    // so.
    const size = MeshoptSimplifier.getScale(positions, 3);
    const weights = [...Array(3).fill(0.02 / size), ...Array(3).fill(0.07 / size),
        ...Array(3 * form.length).fill(1.5 / size)];
    [indices] = MeshoptSimplifier.simplifyWithAttributes(indices, positions, 3, attributes, width,
        weights, null,
                                                         3 * Math.round(kept * indices.length / 3),
                                                             1);
  }
  const [of, left] = MeshoptEncoder.reorderMesh(indices, true, true);
  return {name: mesh.name, names, of, indices, positions: gathered(positions, 3, of, left),
    normals: gathered(normals, 3, of, left), colours: gathered(colours, 4, of, left),
    moves: moves.map((values) => gathered(values, 3, of, left)),
    joints: JOINTS_0 === undefined ? null : gathered(source.read(JOINTS_0), 4, of, left),
    weights: WEIGHTS_0 === undefined ? null : gathered(source.read(WEIGHTS_0), 4, of, left)};
}

/** Shapes made of others, behind those that there are. */
function withVisemes(part) {
  const made = {};
  for (const [name, shares] of Object.entries(VISEMES)) {
    const sum = new Float32Array(part.positions.length);
    for (const [shape, share] of Object.entries(shares)) {
      const moves = part.moves[part.names.indexOf(shape)];
      moves?.forEach((v, i) => { sum[i] += share * v; });
    }
    made[name] = sum;
  }
  return {...part, names: [...part.names, ...Object.keys(made)],
      moves: [...part.moves, ...Object.values(made)]};
}

function meshOf(part, material, out) {
  const count = part.positions.length / 3;
  const shades = Uint8Array.from(part.colours, (v) => Math.round(v / 257));
  const directions = new Float32Array(4 * count);
  for (let v = 0; v < count; ++v) directions.set(part.normals.subarray(3 * v, 3 * v + 3), 4 * v);
  const coded = MeshoptEncoder.encodeFilterOct(directions, count, 4, 8);
  const attributes = {
    POSITION: out.triples(part.positions, POSITION_BITS),
    NORMAL: out.accessor({bufferView: out.view(coded, count, 4, 'ATTRIBUTES', 'OCTAHEDRAL'),
        componentType: 5120,
      normalized: true, count, type: 'VEC3'}),
    COLOR_0: out.bytes(shades, 5121, 4, {normalized: true}),
  };
  if (part.joints) {
    attributes.JOINTS_0 = out.bytes(part.joints, 5121, 4);
    // Bytes whose sum is 255.
    const weights = new Uint8Array(4 * count);
    for (let v = 0; v < count; ++v) {
      const four = Array.from(part.weights.subarray(4 * v, 4 * v + 4), (w) => Math.round(255 * w));
      four[four.indexOf(Math.max(...four))] += 255 - four.reduce((a, b) => a + b);
      weights.set(four, 4 * v);
    }
    attributes.WEIGHTS_0 = out.bytes(weights, 5121, 4, {normalized: true});
  }
  const primitive = {attributes, indices: out.indices(part.indices), material};
  const names = [], targets = [];
  part.names.forEach((name, i) => {
    const index = out.moves(part.moves[i]);
    if (index === null) return;
    names.push(name);
    targets.push({POSITION: index});
  });
  if (targets.length) primitive.targets = targets;
  return {name: part.name, primitives: [primitive],
      ...(names.length ? {extras: {targetNames: names}} : {})};
}

function documentOf(source, parts, out) {
  const {nodes, skins, materials, scenes, scene, meshes} = source.json;
  const packed = parts.map((part, i) => meshOf(part, meshes[i].primitives[0].material, out));
  out.writeMoves();
  const bind = source.read(skins[0].inverseBindMatrices);
  const matrices = out.accessor({bufferView: out.view(new Uint8Array(bind.buffer), bind.length / 16,
      64, 'ATTRIBUTES', undefined, false),
    componentType: 5126, count: bind.length / 16, type: 'MAT4'});
  return {
    asset: {version: '2.0', generator: 'tools/release/samples/make_head.mjs'}, scene, scenes, nodes,
        materials,
    meshes: packed, skins: [{...skins[0], inverseBindMatrices: matrices}],
    extensionsUsed: ['EXT_meshopt_compression', 'KHR_mesh_quantization'],
    extensionsRequired: ['EXT_meshopt_compression', 'KHR_mesh_quantization'],
  };
}

// The bones that VRM wants, where a person of this size has them: [parent, metres].
const BODY = {
  hips: [null, [0, -0.62, -0.02]], spine: ['hips', [0, 0.14, 0]], chest: ['spine', [0, 0.16, 0]],
  neck: ['chest', [0, 0.21, 0]], head: ['neck', [0, 0.05, 0]],
};
for (const [side, sign] of [['left', 1], ['right', -1]]) {
  Object.assign(BODY, {
    [`${side}UpperArm`]: ['chest', [0.17 * sign, 0.14, 0]],
        [`${side}LowerArm`]: [`${side}UpperArm`, [0.26 * sign, 0, 0]],
    [`${side}Hand`]: [`${side}LowerArm`, [0.24 * sign, 0, 0]],
    [`${side}UpperLeg`]: ['hips', [0.09 * sign, -0.06, 0]],
        [`${side}LowerLeg`]: [`${side}UpperLeg`, [0, -0.42, 0]],
    [`${side}Foot`]: [`${side}LowerLeg`, [0, -0.4, 0]],
  });
}

/** The same as VRM 1.0: bones of a body, of which our neck is the head, and expressions. */
function asVrm(document) {
  const nodes = structuredClone(document.nodes), numbers = {};
  for (const [name, [parent, translation]] of Object.entries(BODY)) {
    numbers[name] = nodes.length;
    nodes.push({name, translation});
    if (parent !== null) (nodes[numbers[parent]].children ??= []).push(numbers[name]);
  }
  // Our root stays where it is: below the head, whose place is taken away again.
  const place = [0, 0, 0];
  for (let at = 'head'; at !== null; at = BODY[at][0]) BODY[at][1].forEach((v,
      k) => { place[k] += v; });
  nodes[0].translation = place.map((v) => -v);
  nodes[numbers.head].children = [0];
  const bone = (name) => ({node: nodes.findIndex((node) => node.name === name)});
  const humanBones = Object.fromEntries(Object.keys(BODY).map((name) => [name,
      {node: numbers[name]}]));
  Object.assign(humanBones, {jaw: bone('jaw_bone'), leftEye: bone('left_eye_bone'),
      rightEye: bone('right_eye_bone')});
  const bound = (shares) => ({morphTargetBinds: nodes.flatMap((node, index) => {
    const names = document.meshes[node.mesh]?.extras?.targetNames ?? [];
    return Object.entries(shares).filter(([name]) => names.includes(name))
        .map(([name, weight]) => ({node: index, index: names.indexOf(name), weight}));
  })});
  const scenes =
      [{nodes: [numbers.hips, ...document.scenes[0].nodes.filter((node) => node !== 0)]}];
  const custom =
      new Set(document.meshes.flatMap((mesh) => mesh.extras?.targetNames ?? []).filter((name) =>
      !name.startsWith('viseme_')));
  return {...document, nodes, scenes, extensionsUsed: [...document.extensionsUsed, 'VRMC_vrm'],
      extensions: {VRMC_vrm: {
    specVersion: '1.0', humanoid: {humanBones},
    meta: {name: 'me', version: '1', authors: ['Animeme'],
        licenseUrl: 'https://vrm.dev/licenses/1.0/',
      avatarPermission: 'everyone', commercialUsage: 'corporation',
          modification: 'allowModificationRedistribution',
      allowRedistribution: true, creditNotation: 'unnecessary'},
    expressions: {preset: Object.fromEntries(Object.entries(EXPRESSIONS).map(([name,
        shares]) => [name, bound(shares)])),
      custom: Object.fromEntries([...custom].map((name) => [name, bound({[name]: 1})]))},
    lookAt: {type: 'bone', offsetFromHeadBone: [0, 0.06, 0.09],
      ...Object.fromEntries(['rangeMapHorizontalInner', 'rangeMapHorizontalOuter',
          'rangeMapVerticalDown', 'rangeMapVerticalUp']
          .map((name) => [name, {inputMaxValue: 90, outputScale: 20}]))},
  }}};
}

/** The skin alone, in centimetres, and which of its vertices is which feature point. */
function writeObj(skin, sourcePositions) {
  const lines = [];
  for (let v = 0; v < skin.positions.length; v += 3) {
    lines.push('v ' + [...skin.positions.subarray(v, v + 3)].map((x) =>
        (100 * x).toFixed(2)).join(' '));
  }
  for (let i = 0; i < skin.indices.length; i += 3)
    lines.push('f ' + [...skin.indices.subarray(i, i + 3)].map((v) => v + 1).join(' '));
  writeFileSync('me.obj', lines.join('\n') + '\n');
  const rows = readFileSync('woman.points.csv', 'utf8').trim().split('\n').slice(1).map((line) =>
      line.split(','));
  const marks = ['feature_point,vertex'];
  for (const [point, vertex] of rows) {
    const from = Number(vertex);
    if (from >= sourcePositions.length / 3) continue;  // of another part
    const place = sourcePositions.subarray(3 * from, 3 * from + 3);
    let best = 0, nearest = Infinity;
    for (let v = 0; v < skin.positions.length / 3; ++v) {
      const away = Math.hypot(...place.map((x, k) => x - skin.positions[3 * v + k]));
      if (away < nearest) [best, nearest] = [v, away];
    }
    marks.push(`${point},${skin.of[from] === 0xFFFFFFFF ? best : skin.of[from]}`);
  }
  writeFileSync('landmarks.csv', marks.join('\n') + '\n');
}

const source = new Glb('woman.glb');
const parts = source.json.meshes.map((mesh) => smaller(source, mesh));
const skin = source.json.meshes.find((mesh) => mesh.name === 'skin');
writeObj(smaller(source, skin, KEPT_OF_OBJ), source.read(skin.primitives[0].attributes.POSITION));
const avatar = new Writer();
writeFileSync('me.glb', avatar.glb(documentOf(source, parts.map(withVisemes), avatar)));
const vrm = new Writer();
writeFileSync('me.vrm', vrm.glb(asVrm(documentOf(source, parts, vrm))));
console.log(Object.fromEntries(parts.map((part) => [part.name, part.positions.length / 3])));
