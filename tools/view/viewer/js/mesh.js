// Buffers of WebGL2.
import {LOOKS} from './shaders.js';

/** Edges of triangles, each once, as pairs of vertices. */
export function edgesOf(triangles, vertices) {
  const edges = new Set();
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 3; ++k) {
      const a = triangles[t + k];
      const b = triangles[t + (k + 1) % 3];
      edges.add(Math.min(a, b) * vertices + Math.max(a, b));
    }
  }
  const out = new Uint32Array(edges.size * 2);
  let i = 0;
  for (const edge of edges) {
    out[i++] = Math.floor(edge / vertices);
    out[i++] = edge % vertices;
  }
  return out;
}

/** The buffers of one part. */
export class Mesh {
  constructor(gl, part, dynamic) {
    this.gl = gl;
    this.part = part;
    this.look = LOOKS[part.surface] || LOOKS.skin;
    this.count = part.triangles.length;
    const usage = dynamic ? gl.DYNAMIC_DRAW : gl.STATIC_DRAW;
    this.array = gl.createVertexArray();
    gl.bindVertexArray(this.array);
    this.places = this.attribute(0, part.positions, 3, gl.FLOAT, false, usage);
    this.normals = this.attribute(1, part.normals, 3, gl.FLOAT, false, usage);
    this.attribute(2, part.paint, 4, gl.UNSIGNED_BYTE, true, gl.STATIC_DRAW);
    if (part.grain) {
      this.attribute(4, part.positions, 3, gl.FLOAT, false, gl.STATIC_DRAW);  // at rest
      this.attribute(5, part.grain, 2, gl.UNSIGNED_BYTE, false, gl.STATIC_DRAW);
    }
    this.triangles = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.triangles);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, part.triangles, gl.STATIC_DRAW);
    if (part.facets) this.addFacets(usage);
    gl.bindVertexArray(null);
  }

  // Corners have buffers of their own: at seams several stand for one vertex.
  addFacets(usage) {
    const {gl} = this;
    const {facets, paint} = this.part;
    this.cornerArray = gl.createVertexArray();
    gl.bindVertexArray(this.cornerArray);
    const [places, normals] = [this.part.positions, this.part.normals].map(
        (values) => this.gathered(values, 3, new Float32Array(facets.vertices.length * 3)));
    this.cornerPlaces = this.attribute(0, places, 3, gl.FLOAT, false, usage);
    this.cornerNormals = this.attribute(1, normals, 3, gl.FLOAT, false, usage);
    const painted = this.gathered(paint, 4, new Uint8Array(facets.vertices.length * 4));
    // Cards of hair lie upon each other: the sky that they see would make spots.
    if (this.part.surface === 'hair') painted.forEach((_, i) => { if (i % 4 === 3) painted[i] = 255;
        });
    this.attribute(2, painted, 4, gl.UNSIGNED_BYTE, true, gl.STATIC_DRAW);
    this.attribute(4, facets.uvs, 2, gl.FLOAT, false, gl.STATIC_DRAW);
    this.attribute(5, facets.own, 4, gl.SHORT, true, gl.STATIC_DRAW);
    this.attribute(6, normals, 3, gl.FLOAT, false, gl.STATIC_DRAW);
    this.attribute(7, facets.tints, 4, gl.UNSIGNED_BYTE, true, gl.STATIC_DRAW);
    this.corners = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.corners);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, facets.corners, gl.STATIC_DRAW);
    this.scratch = new Float32Array(places.length);
  }

  // What vertices have, for each corner.
  gathered(values, size, out) {
    const {vertices} = this.part.facets;
    for (let i = 0, at = 0; i < vertices.length; ++i) {
      const from = vertices[i] * size;
      for (let k = 0; k < size; ++k) out[at++] = values[from + k];
    }
    return out;
  }

  attribute(index, data, size, type, normalised, usage) {
    const {gl} = this;
    const buffer = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, data, usage);
    gl.enableVertexAttribArray(index);
    gl.vertexAttribPointer(index, size, type, normalised, 0, 0);
    return buffer;
  }

  update(places, normals) {
    const {gl} = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.places);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, places);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.normals);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, normals);
    if (!this.part.facets) return;
    for (const [buffer, values] of [[this.cornerPlaces, places], [this.cornerNormals, normals]]) {
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferSubData(gl.ARRAY_BUFFER, 0, this.gathered(values, 3, this.scratch));
    }
  }

  drawRun({first, count}) {
    const {gl} = this;
    gl.bindVertexArray(this.cornerArray);
    gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, first * 4);
  }

  /** A number for each vertex, 0..1, shown as colour; null: the own colours. */
  setHeat(values) {
    const {gl} = this;
    gl.bindVertexArray(this.array);
    if (values === null) {
      this.hot = false;
      gl.disableVertexAttribArray(3);
    } else if (this.heat) {
      this.hot = true;
      gl.bindBuffer(gl.ARRAY_BUFFER, this.heat);
      gl.bufferSubData(gl.ARRAY_BUFFER, 0, values);
      gl.enableVertexAttribArray(3);
    } else {
      this.hot = true;
      this.heat = this.attribute(3, values, 1, gl.FLOAT, false, gl.DYNAMIC_DRAW);
    }
    gl.bindVertexArray(null);
  }

  drawTriangles() {
    const {gl} = this;
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.triangles);
    gl.drawElements(gl.TRIANGLES, this.count, gl.UNSIGNED_INT, 0);
  }

  drawEdges() {
    const {gl} = this;
    gl.bindVertexArray(this.array);
    if (!this.edges) {
      const edges = edgesOf(this.part.triangles, this.part.positions.length / 3);
      this.edges = {buffer: gl.createBuffer(), count: edges.length};
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.edges.buffer);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, edges, gl.STATIC_DRAW);
    }
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.edges.buffer);
    gl.drawElements(gl.LINES, this.edges.count, gl.UNSIGNED_INT, 0);
  }
}
