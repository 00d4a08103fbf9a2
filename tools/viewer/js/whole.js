// Skin that does not turn over: the same as whole.cpp in fap/head.
import {areaNormal} from './vector.js';

const STEPS = 16;
const HALVINGS = 5;

const restNormals = new WeakMap();  // of the outside of each model

function normalsOf(model) {
  let normals = restNormals.get(model);
  if (normals) return normals;
  const {outside} = model;
  normals = new Float32Array(outside.length);
  for (let t = 0; t < outside.length; t += 3) {
    areaNormal(model.parts[0].positions, outside, t, normals.subarray(t, t + 3));
  }
  restNormals.set(model, normals);
  return normals;
}

// `all`: or those triangles alone that never roll.
function anyTurned(model, skin, all) {
  const {outside, rolling} = model;
  const rest = normalsOf(model);
  const n = new Float64Array(3);
  for (let t = 0; t < outside.length; t += 3) {
    if (!all && rolling[t / 3]) continue;
    areaNormal(skin, outside, t, n);
    if (n[0] * rest[t] + n[1] * rest[t + 1] + n[2] * rest[t + 2] < 0) return true;
  }
  return false;
}

/** Eyeballs and the head turn as they are. */
export const bendsSkin = (control) =>
  !(control >= 23 && control <= 26) && !(control >= 48 && control <= 50);

// The share of all at which every FAP is within what is usual.
function usualShare({usual}, values) {
  return usual.reduce((share, most, f) => {
    const value = Math.abs(values[f] || 0);
    return f >= 3 && bendsSkin(f) && value > most ? Math.min(share, most / value) : share;
  }, 1);
}

/** Calls show(share), which places the skin, with 1; where that turns triangles of the outside over,
    with as large a share of `values` as does not; for those that roll, no less than is usual. */
export function showWhole(model, values, skin, show) {
  const usual = usualShare(model, values);
  const turnedAt = (share) => {
    show(share);
    return anyTurned(model, skin, share > usual);
  };
  if (!turnedAt(1)) return;
  let step = 1 / STEPS;
  let whole = 0;
  for (let i = 1; i < STEPS && !turnedAt(whole + step); ++i) whole += step;
  for (let i = 0; i < HALVINGS; ++i) {
    step /= 2;
    if (!turnedAt(whole + step)) whole += step;
  }
  show(whole);
}
