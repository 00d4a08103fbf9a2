// WebGL2: programs, one draw call for each part, or for each material of it.
import {grainTexture} from './grain.js';
import {Materials} from './materials.js';
import {MATERIAL_FRAGMENT, MATERIAL_VERTEX} from './material_shaders.js';
import {Mesh} from './mesh.js';
import {HEAD_FRAGMENT, HEAD_VERTEX, LINE_FRAGMENT, LINE_VERTEX} from './shaders.js';

const GRAIN_UNIT = 15;  // materials have the first ones

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

// Rows of a transform as the columns that WebGL wants.
const turnOf = (m) => [m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]];

/** Draws rigs into a canvas. Throws where WebGL2 is missing. */
export class Renderer {
  /** `onNeed` is called when there is more to see. */
  constructor(canvas, model, onNeed) {
    const gl = canvas.getContext('webgl2', {alpha: true, antialias: true});
    if (!gl) throw new Error('no WebGL2');
    this.gl = gl;
    this.heads = new Program(gl, HEAD_VERTEX, HEAD_FRAGMENT);
    this.lines = new Program(gl, LINE_VERTEX, LINE_FRAGMENT);
    grainTexture(gl, GRAIN_UNIT);
    this.materials = new Materials(gl, model, onNeed);
    if (model.materials) this.lit = new Program(gl, MATERIAL_VERTEX, MATERIAL_FRAGMENT);
    gl.enable(gl.CULL_FACE);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    // Triangles seen edge on are as steep as can be: a sample a sixteenth of a pixel beside them
    // has a depth far before the skin, and the walls of the mouth shine through the cheeks as dark
    // specks. What is steep goes back by what it rises within a pixel.
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.clearColor(0, 0, 0, 0);
  }

  /** The buffers of a rig. */
  load(rig) {
    return rig.model.parts.map((part) => new Mesh(this.gl, part, part.deforms));
  }

  /** Brings a pose to the buffers. */
  update(meshes, rig) {
    for (const i of rig.deforming) meshes[i].update(rig.positions[i], rig.normals[i]);
  }

  clear() {
    this.gl.clear(this.gl.COLOR_BUFFER_BIT | this.gl.DEPTH_BUFFER_BIT);
  }

  /** What is drawn from now on lies over what is there. */
  clearDepth() {
    this.gl.clear(this.gl.DEPTH_BUFFER_BIT);
  }

  /** `view`: what Camera.view() gives, with the place in the canvas. `style`: {tint: [r, g, b,
      share], opacity, wire: [r, g, b, a] or null}; less than full opacity lies over what is there
      already. */
  draw(meshes, rig, view, style) {
    const {gl} = this;
    gl.viewport(...view.viewport);
    gl.polygonOffset(1, style.wire ? 1 : 0);
    if (style.opacity < 1) {
      // First the depths alone, so that only the nearest surface shines through.
      gl.clear(gl.DEPTH_BUFFER_BIT);
      gl.colorMask(false, false, false, false);
      this.drawParts(meshes, rig, view, style);
      this.drawMaterials(meshes, rig, view, style);
      gl.colorMask(true, true, true, true);
      gl.enable(gl.BLEND);
    }
    this.drawParts(meshes, rig, view, style);
    this.drawMaterials(meshes, rig, view, style);
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
    gl.uniform1i(heads.place('grains'), GRAIN_UNIT);
    gl.vertexAttrib1f(3, -1);
    gl.vertexAttrib2f(5, 128, 127);
    meshes.forEach((mesh, i) => {
      if (mesh.count === 0 || this.hasMaterial(mesh)) return;
      this.setPart(heads, rig.transforms[i]);
      const {wrap, shine, sharpness, rim, gloss = 0} = mesh.look;
      gl.uniform3fv(heads.place('wrap'), wrap);
      gl.uniform1f(heads.place('shine'), shine);
      gl.uniform1i(heads.place('sharpness'), sharpness);
      gl.uniform1f(heads.place('rimShare'), rim);
      gl.uniform1f(heads.place('gloss'), gloss);
      gl.uniform1i(heads.place('eyeball'), mesh.part.surface === 'eye' ? 1 : 0);
      mesh.drawTriangles();
    });
  }

  // A mesh that shows distances shows no material.
  hasMaterial(mesh) {
    return Boolean(mesh.part.facets) && !mesh.hot;
  }

  // What blends comes last, and of it first what is far away.
  drawMaterials(meshes, rig, view, style) {
    if (!this.lit) return;
    const {gl, materials, lit} = this;
    this.setView(lit, view);
    for (const name of ['key', 'fill', 'rim']) gl.uniform3fv(lit.place(name), view[name]);
    gl.uniform4fv(lit.place('tint'), style.tint);
    gl.uniform1f(lit.place('opacity'), style.opacity);
    const runs = meshes.flatMap((mesh, i) => (this.hasMaterial(mesh) ?
        mesh.part.facets.runs.map((run) => ({mesh, run, transform: rig.transforms[i]})) : []));
    const away = ({run}) => Math.hypot(...run.middle.map((x, k) => x - view.eye[k]));
    // First the opaque texels, also of materials that blend: many files declare all materials so.
    const draw = ({mesh, run, transform}, hiding) => {
      this.setPart(lit, transform);
      materials.bind(run.material, lit, hiding);
      mesh.drawRun(run);
    };
    const transparent = runs.filter(({run}) => materials.blends(run.material));
    const ghost = style.opacity < 1;  // shines through as a whole
    runs.filter((each) => !ghost || !transparent.includes(each)).forEach((each) => draw(each,
        true));
    const alone = !gl.isEnabled(gl.BLEND);
    gl.enable(gl.BLEND);
    gl.depthMask(false);
    transparent.sort((a, b) => away(b) - away(a)).forEach((each) => draw(each, false));
    gl.depthMask(true);
    if (alone) gl.disable(gl.BLEND);
    gl.enable(gl.CULL_FACE);
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
