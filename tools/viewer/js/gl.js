// WebGL2: programs, buffers, one draw call for each part.
import {HEAD_FRAGMENT, HEAD_VERTEX, LINE_FRAGMENT, LINE_VERTEX, LOOKS} from './shaders.js';

function compile(gl, type, source) {
  const shader = gl.createShader(type);
  gl.shaderSource(shader, source);
  gl.compileShader(shader);
  return shader;
}

class Program {
  constructor(gl, vertex, fragment) {
    this.gl = gl;
    this.handle = gl.createProgram();
    gl.attachShader(this.handle, compile(gl, gl.VERTEX_SHADER, vertex));
    gl.attachShader(this.handle, compile(gl, gl.FRAGMENT_SHADER, fragment));
    gl.linkProgram(this.handle);
    if (!gl.getProgramParameter(this.handle, gl.LINK_STATUS) && !gl.isContextLost()) {
      throw new Error(`shader: ${gl.getProgramInfoLog(this.handle)}`);
    }
    this.places = {};
  }

  place(name) {
    if (!(name in this.places)) {
      this.places[name] = this.gl.getUniformLocation(this.handle, name);
    }
    return this.places[name];
  }
}

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
class Mesh {
  constructor(gl, part, dynamic) {
    this.gl = gl;
    this.part = part;
    this.look = LOOKS[part.material] || LOOKS.skin;
    this.count = part.triangles.length;
    const usage = dynamic ? gl.DYNAMIC_DRAW : gl.STATIC_DRAW;
    this.array = gl.createVertexArray();
    gl.bindVertexArray(this.array);
    this.places = this.attribute(0, part.positions, 3, gl.FLOAT, false, usage);
    this.normals = this.attribute(1, part.normals, 3, gl.FLOAT, false, usage);
    this.attribute(2, part.paint, 4, gl.UNSIGNED_BYTE, true, gl.STATIC_DRAW);
    this.triangles = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.triangles);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, part.triangles, gl.STATIC_DRAW);
    gl.bindVertexArray(null);
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
  }

  /** A number for each vertex, 0..1, shown as colour; null: the own colours. */
  setHeat(values) {
    const {gl} = this;
    gl.bindVertexArray(this.array);
    if (values === null) {
      gl.disableVertexAttribArray(3);
    } else if (this.heat) {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.heat);
      gl.bufferSubData(gl.ARRAY_BUFFER, 0, values);
      gl.enableVertexAttribArray(3);
    } else {
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

// Rows of a transform as the columns that WebGL wants.
const turnOf = (m) => [m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]];

/** Draws rigs into a canvas. Throws where WebGL2 is missing. */
export class Renderer {
  constructor(canvas) {
    const gl = canvas.getContext('webgl2', {alpha: true, antialias: true});
    if (!gl) throw new Error('no WebGL2');
    this.gl = gl;
    this.heads = new Program(gl, HEAD_VERTEX, HEAD_FRAGMENT);
    this.lines = new Program(gl, LINE_VERTEX, LINE_FRAGMENT);
    gl.enable(gl.CULL_FACE);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.clearColor(0, 0, 0, 0);
  }

  /** The buffers of a rig. */
  load(rig) {
    return rig.model.parts.map(
        (part, i) => new Mesh(this.gl, part, rig.deforming.includes(i)));
  }

  /** Brings a pose to the buffers. */
  update(meshes, rig) {
    for (const i of rig.deforming) meshes[i].update(rig.positions[i], rig.normals[i]);
  }

  clear() {
    this.gl.clear(this.gl.COLOR_BUFFER_BIT | this.gl.DEPTH_BUFFER_BIT);
  }

  /** `view`: what Camera.view() gives, with the place in the canvas. `style`: {tint: [r, g, b,
      share], opacity, wire: [r, g, b, a] or null}; less than full opacity lies over what is there
      already. */
  draw(meshes, rig, view, style) {
    const {gl} = this;
    gl.viewport(...view.viewport);
    if (style.opacity < 1) {
      // First the depths alone, so that only the nearest surface shines through.
      gl.clear(gl.DEPTH_BUFFER_BIT);
      gl.colorMask(false, false, false, false);
      this.drawParts(meshes, rig, view, style);
      gl.colorMask(true, true, true, true);
      gl.enable(gl.BLEND);
    }
    if (style.wire) {
      gl.enable(gl.POLYGON_OFFSET_FILL);
      gl.polygonOffset(1, 1);
    }
    this.drawParts(meshes, rig, view, style);
    gl.disable(gl.POLYGON_OFFSET_FILL);
    if (style.wire) this.drawWires(meshes, rig, view, style.wire);
    gl.disable(gl.BLEND);
    gl.bindVertexArray(null);
  }

  setView(program, view) {
    const {gl} = this;
    gl.useProgram(program.handle);
    gl.uniformMatrix4fv(program.place('view'), false, view.matrix);
    gl.uniform3fv(program.place('eye'), view.eye);
  }

  setPart(program, transform) {
    const {gl} = this;
    gl.uniformMatrix3fv(program.place('turn'), false, turnOf(transform));
    gl.uniform3f(program.place('shift'), transform[9], transform[10], transform[11]);
  }

  drawParts(meshes, rig, view, style) {
    const {gl, heads} = this;
    this.setView(heads, view);
    for (const name of ['back', 'key', 'fill', 'rim']) gl.uniform3fv(heads.place(name), view[name]);
    gl.uniform4fv(heads.place('tint'), style.tint);
    gl.uniform1f(heads.place('opacity'), style.opacity);
    gl.vertexAttrib1f(3, -1);
    meshes.forEach((mesh, i) => {
      if (mesh.count === 0) return;
      this.setPart(heads, rig.transforms[i]);
      const {wrap, shine, sharpness, rim, gloss = 0} = mesh.look;
      gl.uniform3fv(heads.place('wrap'), wrap);
      gl.uniform1f(heads.place('shine'), shine);
      gl.uniform1i(heads.place('sharpness'), sharpness);
      gl.uniform1f(heads.place('rimShare'), rim);
      gl.uniform1f(heads.place('gloss'), gloss);
      gl.uniform1i(heads.place('eyeball'), mesh.part.material === 'eye' ? 1 : 0);
      mesh.drawTriangles();
    });
  }

  drawWires(meshes, rig, view, ink) {
    const {gl, lines} = this;
    this.setView(lines, view);
    gl.uniform4fv(lines.place('ink'), ink);
    gl.enable(gl.BLEND);
    meshes.forEach((mesh, i) => {
      this.setPart(lines, rig.transforms[i]);
      mesh.drawEdges();
    });
  }
}
