// Skin that does not turn over: the same as whole.cpp in fap/head.
const STEPS = 16;
const HALVINGS = 5;

// Twice the areas of triangles, as vectors, to `each`, until one of these says true.
function anyNormal(triangles, points, each) {
  for (let t = 0; t < triangles.length; t += 3) {
    const a = triangles[t] * 3;
    const b = triangles[t + 1] * 3;
    const c = triangles[t + 2] * 3;
    const ux = points[b] - points[a];
    const uy = points[b + 1] - points[a + 1];
    const uz = points[b + 2] - points[a + 2];
    const vx = points[c] - points[a];
    const vy = points[c + 1] - points[a + 1];
    const vz = points[c + 2] - points[a + 2];
    if (each(t, uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx)) return true;
  }
  return false;
}

const restNormals = new WeakMap();  // of the outside of each model

function normalsOf(model) {
  let normals = restNormals.get(model);
  if (normals) return normals;
  normals = new Float32Array(model.outside.length);
  anyNormal(model.outside, model.parts[0].positions, (t, x, y, z) => { normals.set([x, y, z], t); });
  restNormals.set(model, normals);
  return normals;
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
  const {outside, rolling} = model;
  const normals = normalsOf(model);
  const usual = usualShare(model, values);
  const turnedAt = (share) => {
    show(share);
    return anyNormal(outside, skin, (t, x, y, z) => (share > usual || !rolling[t / 3]) &&
        x * normals[t] + y * normals[t + 1] + z * normals[t + 2] < 0);
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
