// Transforms and normals. A transform is [x row, y row, z row, shift], 12 numbers: p becomes
// rows * p + shift. Right-handed: +X to the person's left, +Y up, +Z forward.

export const IDENTITY = Object.freeze([1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]);

/** The point x, y, z of an array, moved by a transform. */
export function moved(m, x, y, z) {
  return [
    m[0] * x + m[1] * y + m[2] * z + m[9],
    m[3] * x + m[4] * y + m[5] * z + m[10],
    m[6] * x + m[7] * y + m[8] * z + m[11],
  ];
}

/** First `inner`, then `outer`. */
export function compose(outer, inner) {
  const out = [];
  for (let row = 0; row < 3; ++row) {
    for (let column = 0; column < 3; ++column) {
      let sum = 0;
      for (let k = 0; k < 3; ++k) sum += outer[row * 3 + k] * inner[k * 3 + column];
      out.push(sum);
    }
  }
  return out.concat(moved(outer, inner[9], inner[10], inner[11]));
}

/** Of a rotation and shift. */
export function inverse(m) {
  const back = [m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8], 0, 0, 0];
  const [x, y, z] = moved(back, m[9], m[10], m[11]);
  return back.slice(0, 9).concat([-x, -y, -z]);
}

/** Angles in rad about the axes through a point: roll about Z first, then pitch about X, then yaw
    about Y. */
export function rotationAbout([px, py, pz], pitch, yaw, roll) {
  const [cp, sp] = [Math.cos(pitch), Math.sin(pitch)];
  const [cy, sy] = [Math.cos(yaw), Math.sin(yaw)];
  const [cr, sr] = [Math.cos(roll), Math.sin(roll)];
  const aboutZ = [cr, -sr, 0, sr, cr, 0, 0, 0, 1, 0, 0, 0];
  const aboutX = [1, 0, 0, 0, cp, -sp, 0, sp, cp, 0, 0, 0];
  const aboutY = [cy, 0, sy, 0, 1, 0, -sy, 0, cy, 0, 0, 0];
  const turn = compose(aboutY, compose(aboutX, aboutZ));
  const [x, y, z] = moved(turn, px, py, pz);
  turn[9] = px - x;
  turn[10] = py - y;
  turn[11] = pz - z;
  return turn;
}

/** All points of an array, moved. */
export function movedPoints(m, points) {
  const out = new Float32Array(points.length);
  for (let i = 0; i < points.length; i += 3) {
    out.set(moved(m, points[i], points[i + 1], points[i + 2]), i);
  }
  return out;
}

/** Fills `out` with the normal of the triangle whose vertices begin at triangles[t], twice its area
    long. */
export function areaNormal(points, triangles, t, out) {
  const a = triangles[t] * 3;
  const b = triangles[t + 1] * 3;
  const c = triangles[t + 2] * 3;
  const ux = points[b] - points[a];
  const uy = points[b + 1] - points[a + 1];
  const uz = points[b + 2] - points[a + 2];
  const vx = points[c] - points[a];
  const vy = points[c + 1] - points[a + 1];
  const vz = points[c + 2] - points[a + 2];
  out[0] = uy * vz - uz * vy;
  out[1] = uz * vx - ux * vz;
  out[2] = ux * vy - uy * vx;
}

/** Fills `normals` with the directions of the surface at its points, of length 1; triangles count
    by their area. */
export function smoothNormals(points, triangles, normals) {
  normals.fill(0);
  const n = new Float64Array(3);
  for (let t = 0; t < triangles.length; t += 3) {
    areaNormal(points, triangles, t, n);
    for (let k = 0; k < 3; ++k) {
      const i = triangles[t + k] * 3;
      normals[i] += n[0];
      normals[i + 1] += n[1];
      normals[i + 2] += n[2];
    }
  }
  for (let i = 0; i < normals.length; i += 3) {
    const x = normals[i];
    const y = normals[i + 1];
    const z = normals[i + 2];
    const scale = 1 / (Math.sqrt(x * x + y * y + z * z) || 1);
    normals[i] = x * scale;
    normals[i + 1] = y * scale;
    normals[i + 2] = z * scale;
  }
}

/** 0 up to a, 1 from b on, smooth between. */
export function smoothStep(a, b, x) {
  const t = Math.min(Math.max((x - a) / (b - a), 0), 1);
  return t * t * (3 - 2 * t);
}
