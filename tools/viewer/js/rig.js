// Moves a head: the same as pose.cpp in fap/head, vertex for vertex.
import {closeContacts, stopAtContact} from './contact.js';
import {IDENTITY, compose, inverse, moved, movedPoints, rotationAbout, smoothNormals, smoothStep} from
  './vector.js';
import {bendsSkin, showWhole} from './whole.js';

export const FAP_COUNT = 68;
/** Number of the first shape of a head that has shapes; smaller ones are FAPs. */
export const FIRST_SHAPE = FAP_COUNT + 1;
const RADIANS = 1e-5;  // one unit of an angle
const EYE_SKIN = 1.07;  // of the radius of an eyeball: skin comes no nearer to its centre
const TEETH_SKIN = 1.07;  // of the half axes of a row of teeth, the same
const TEETH_SOFT = 0.05;  // the push begins gently, over this

/** One head in one pose. */
export class Rig {
  constructor(model) {
    this.model = model;
    const names = model.parts.map((part) => part.name);
    this.index = Object.fromEntries(names.map((name, i) => [name, i]));
    /** Positions and normals of each part; those that do not deform are the model's own. */
    this.positions = model.parts.map((part) => part.positions);
    this.normals = model.parts.map((part) => part.normals);
    this.transforms = model.parts.map(() => IDENTITY);
    this.head = IDENTITY;
    /** Parts whose vertices move. */
    this.deforming = names.map((_, i) => i).filter((i) => model.deforms[i]);
    for (const i of this.deforming) {
      this.positions[i] = Float32Array.from(model.parts[i].positions);
      this.normals[i] = Float32Array.from(model.parts[i].normals);
    }
    this.values = new Float64Array(FIRST_SHAPE + model.shapes);
  }

  /** Values by control: low-level FAPs by number, then the weights of shapes. */
  pose(values) {
    const {model, positions, index} = this;
    const skin = positions[index.skin];
    showWhole(model, values, skin, (share) => this.deform(values, share, skin));
    const v = this.values;
    this.turnLashes(skin, positions[index.lashes]);
    this.setTransforms(v);
    this.turnNeck(skin);
    for (const i of this.deforming) {
      smoothNormals(positions[i], model.parts[i].surface, this.normals[i]);
    }
  }

  // All that deforms, before the head turns; of what bends skin this share.
  deform(values, share, skin) {
    const {model, positions} = this;
    const v = this.values;
    for (let f = 3; f < v.length; ++f) v[f] = (values[f] || 0) * (bendsSkin(f) ? share : 1);
    stopAtContact(model, v);
    for (const i of this.deforming) positions[i].set(model.parts[i].positions);
    this.applyTargets(v, true);
    this.slideLids(skin);
    this.applyTargets(v, false);
    this.keepOffEyes(v, skin);
    const [upper, lower] = model.teeth;
    this.keepOffTeeth(upper, IDENTITY, skin);
    this.keepOffTeeth(lower, this.jawTransform(v), skin);
    closeContacts(model, skin);
  }

  /** Where the vertices of a part are in the scene. */
  placed(part) {
    return movedPoints(this.transforms[part], this.positions[part]);
  }

  applyTargets(v, lids) {
    for (const {control, part, vertices, axes, low, high, rest} of this.model.targets) {
      const value = Math.min(Math.max(v[control], low), high) - rest;
      if (value === 0 || (control >= 19 && control <= 22) !== lids) continue;
      const places = this.positions[part];
      for (const {axis, step, deltas} of axes) {
        const scale = value * step;
        for (let i = 0; i < vertices.length; ++i) places[vertices[i] + axis] += deltas[i] * scale;
      }
    }
  }

  // Lids keep their distance from the centre of the eye.
  slideLids(skin) {
    const neutral = this.model.parts[this.index.skin].positions;
    this.model.sliding.forEach((vertices, side) => {
      const {centre: [cx, cy, cz], radius} = this.model.eyes[side];
      for (const vertex of vertices) {
        const i = vertex * 3;
        if (skin[i] === neutral[i] && skin[i + 1] === neutral[i + 1] &&
            skin[i + 2] === neutral[i + 2]) continue;
        const was = (neutral[i] - cx) ** 2 + (neutral[i + 1] - cy) ** 2 +
            (neutral[i + 2] - cz) ** 2;
        const square = was - (skin[i] - cx) ** 2 - (skin[i + 1] - cy) ** 2;
        const slid = Math.sqrt(Math.max(square, 0.04 * was));
        // Not at the sides of the eye nor far from it.
        const size = Math.sqrt(was);
        const share = smoothStep(0.15, 0.4, (neutral[i + 2] - cz) / size) *
            smoothStep(2, 1.4, size / radius);
        skin[i + 2] += (slid - (skin[i + 2] - cz)) * share;
      }
    });
  }

  // Skin that other FAPs have pushed into an eyeball comes out again.
  keepOffEyes(v, skin) {
    const neutral = this.model.parts[this.index.skin].positions;
    this.model.beforeEyes.forEach((vertices, side) => {
      const {centre: [cx, cy, cz], radius} = this.model.eyes[side];
      const front = cz + v[27 + side] * this.model.fapu.es / 1024;
      for (const vertex of vertices) {
        const i = vertex * 3;
        const [x, y, z] = [skin[i] - cx, skin[i + 1] - cy, skin[i + 2] - front];
        const rest = Math.hypot(neutral[i] - cx, neutral[i + 1] - cy, neutral[i + 2] - cz);
        const least = Math.min(EYE_SKIN * radius, rest);
        const distance = Math.sqrt(x * x + y * y + z * z);
        if (distance >= least || distance === 0) continue;
        const push = least / distance - 1;
        skin[i] += x * push;
        skin[i + 1] += y * push;
        skin[i + 2] += z * push;
      }
    });
  }

  // Skin that was pushed into a row of teeth, which is at `place`, comes out again.
  keepOffTeeth(arch, place, skin) {
    const neutral = this.model.parts[this.index.skin].positions;
    const {middle: [mx, my, mz], half_width: width, depth, half_height: height} = arch;
    const ratio = (x, z) =>
        (Math.abs((x - mx) / width) ** 2.5 + Math.abs((z - mz) / depth) ** 2.5) ** 0.4;
    const back = inverse(place);
    for (const vertex of arch.vertices) {
      const i = vertex * 3;
      const [x, y, z] = moved(back, skin[i], skin[i + 1], skin[i + 2]);
      const is = ratio(x, z);
      const least = Math.min(TEETH_SKIN, ratio(neutral[i], neutral[i + 2]));
      if (is >= least || is < 0.5 || z < mz) continue;
      const inside = least - is;
      const push = inside * inside / (inside + TEETH_SOFT) / is *
          smoothStep(2.4, 0.8, Math.abs(y - my) / height);
      const [ox, oz] = [(x - mx) * push, (z - mz) * push];
      skin[i] += place[0] * ox + place[2] * oz;
      skin[i + 1] += place[3] * ox + place[5] * oz;
      skin[i + 2] += place[6] * ox + place[8] * oz;
    }
  }

  // Lashes turn with the rim that carries them, about the centre of the eye.
  turnLashes(skin, lashes) {
    const {anchors, eyes} = this.model;
    if (anchors.length === 0) return;
    const neutral = this.model.parts[this.index.skin].positions;
    const rest = this.model.parts[this.index.lashes].positions;
    for (let k = 0; k < anchors.length; ++k) {
      const a = anchors[k] * 3;
      const i = k * 3;
      const [, cy, cz] = eyes[rest[i] > 0 ? 0 : 1].centre;
      const [wy, wz] = [neutral[a + 1] - cy, neutral[a + 2] - cz];
      const [y, z] = [skin[a + 1] - cy, skin[a + 2] - cz];
      const size = Math.sqrt((wy * wy + wz * wz) * (y * y + z * z));
      if (size <= 0) continue;
      const c = (wy * y + wz * z) / size;
      const s = (wy * z - wz * y) / size;
      const oy = rest[i + 1] - neutral[a + 1];
      const oz = rest[i + 2] - neutral[a + 2];
      lashes[i] = skin[a] + rest[i] - neutral[a];
      lashes[i + 1] = skin[a + 1] + c * oy - s * oz;
      lashes[i + 2] = skin[a + 2] + s * oy + c * oz;
    }
  }

  jawTransform(v) {
    const {axis, bite, sine, limit, thrust, shift} = this.model.jaw;
    const turn = Math.asin(Math.min(Math.max(Math.max(v[3], bite) * sine, -limit), limit));
    const jaw = rotationAbout(axis, turn, 0, 0);
    jaw[11] += v[14] * thrust;
    jaw[9] += v[15] * shift;
    return jaw;
  }

  eyeTransform(side, v) {
    const turn = rotationAbout(this.model.eyes[side].centre, v[25 + side] * RADIANS,
        v[23 + side] * RADIANS, 0);
    turn[11] += v[27 + side] * this.model.fapu.es / 1024;
    return turn;
  }

  setTransforms(v) {
    const straight = v[48] === 0 && v[49] === 0 && v[50] === 0;
    this.head = straight ? IDENTITY :
        rotationAbout(this.model.neck, v[48] * RADIANS, v[49] * RADIANS, v[50] * RADIANS);
    const inJaw = compose(this.head, this.jawTransform(v));
    const set = (name, transform) => { this.transforms[this.index[name]] = transform; };
    for (const name of ['upper_teeth', 'hair', 'brows', 'lashes']) set(name, this.head);
    for (const name of ['lower_teeth', 'tongue']) set(name, inJaw);
    set('left_eye', compose(this.head, this.eyeTransform(0, v)));
    set('right_eye', compose(this.head, this.eyeTransform(1, v)));
    // Modelled shapes show all but the turn of the head.
    for (const name of ['lower_teeth', 'tongue', 'left_eye', 'right_eye']) {
      if (this.model.shown_by_shapes[this.index[name]]) set(name, this.head);
    }
  }

  turnNeck(skin) {
    if (this.head === IDENTITY) return;
    const weights = this.model.neckWeights;
    for (let i = 0; i < skin.length; i += 3) {
      const weight = weights[i / 3];
      if (weight === 0) continue;
      const [x, y, z] = moved(this.head, skin[i], skin[i + 1], skin[i + 2]);
      skin[i] += (x - skin[i]) * weight;
      skin[i + 1] += (y - skin[i + 1]) * weight;
      skin[i + 2] += (z - skin[i + 2]) * weight;
    }
  }
}

/** The low-level FAPs of viseme {select1, select2, blend} and expression {select1, intensity1,
    select2, intensity2}, either may be null; those of `own`, by number, win. The same as
    low_level() in head/shapes.h. */
export function lowLevel(model, viseme, expression, own = {}) {
  const values = new Float64Array(FAP_COUNT + 1);
  const given = new Set(Object.keys(own).map(Number));
  const add = (shape, weight) => {
    for (const [fap, value] of shape || []) {
      values[fap] += weight * value;
      given.add(fap);
    }
  };
  if (viseme) {
    add(model.visemes[viseme.select1], viseme.blend / 63);
    add(model.visemes[viseme.select2], 1 - viseme.blend / 63);
  }
  if (expression) {
    add(model.expressions[expression.select1], expression.intensity1 / 63);
    add(model.expressions[expression.select2], expression.intensity2 / 63);
  }
  for (let fap = 3; fap <= FAP_COUNT; ++fap) values[fap] = own[fap] ?? values[fap];
  // Upper lids that nobody moves go along with the eyes.
  for (const side of [0, 1]) {
    if (given.has(19 + side) || model.shapes > 0) continue;
    values[19 + side] = Math.round(model.lid_follow[side] * values[25 + side]);
  }
  return values;
}
