// Materials: pictures as textures, and a material as uniforms of the program of
// material_shaders.js.

const MAPS = ['base', 'normal', 'metal', 'occlusion', 'emissive', 'shade'];
const SHADINGS = ['lit', 'unlit', 'toon'];
const ALPHAS = ['opaque', 'mask', 'blend'];
const LARGEST = 2048;  // texels a side

async function decode({type, file}) {
  const options = {colorSpaceConversion: 'none', premultiplyAlpha: 'none'};
  const bitmap = await createImageBitmap(new Blob([file], {type}), options);
  const scale = LARGEST / Math.max(bitmap.width, bitmap.height);
  if (scale >= 1) return bitmap;
  return createImageBitmap(bitmap, {...options, resizeQuality: 'high',
    resizeWidth: Math.max(1, Math.round(bitmap.width * scale)),
    resizeHeight: Math.max(1, Math.round(bitmap.height * scale))});
}

/** The materials of a model in a context. */
export class Materials {
  /** `onNeed` is called when a picture has been decoded; until then it is white. */
  constructor(gl, model, onNeed) {
    Object.assign(this, {gl, materials: model.materials || [], textures: new Map()});
    this.white = this.plain();
    const files = new Map();
    const file = (i) => {
      if (!files.has(i)) files.set(i, decode(model.pictures[i]));
      return files.get(i);
    };
    const waits = [];
    for (const material of this.materials) {
      for (const texture of Object.values(material.textures)) {
        const name = String(texture);
        if (!texture || this.textures.has(name)) continue;
        this.textures.set(name, this.white);
        waits.push(file(texture[0]).then((bitmap) => {
          this.textures.set(name, this.texture(bitmap, texture));
          onNeed();
        }));
      }
    }
    /** Nothing to wait for. */
    this.complete = waits.length === 0;
    /** All pictures are there, or cannot be shown: then their materials have plain colours. */
    this.ready = Promise.allSettled(waits);
  }

  plain() {
    const {gl} = this;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 1, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE,
        new Uint8Array([255, 255, 255, 255]));
    return texture;
  }

  texture(bitmap, [, isColour, ...wraps]) {
    const {gl} = this;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, isColour ? gl.SRGB8_ALPHA8 : gl.RGBA8, gl.RGBA,
        gl.UNSIGNED_BYTE, bitmap);
    gl.generateMipmap(gl.TEXTURE_2D);
    const places = {repeat: gl.REPEAT, clamp: gl.CLAMP_TO_EDGE, mirror: gl.MIRRORED_REPEAT};
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, places[wraps[0]]);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, places[wraps[1]]);
    return texture;
  }

  blends(number) {
    return this.materials[number].alpha === 'blend';
  }

  /**
   * Sets the uniforms of a program that is in use. `hiding`: of a material that blends its opaque
   * texels alone.
   */
  bind(number, program, hiding) {
    const {gl} = this;
    const material = this.materials[number];
    const [alpha, cutoff] = hiding && this.blends(number) ? ['mask', 0.995] :
        [material.alpha, material.cutoff];
    MAPS.forEach((name, unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      const texture = material.textures[name];
      gl.bindTexture(gl.TEXTURE_2D, texture ? this.textures.get(String(texture)) : this.white);
      gl.uniform1i(program.place(`${name}Map`), unit);
    });
    const numbers = {cutoff, normalScale: material.normal_scale, metallic: material.metallic,
      roughness: material.roughness, specular: material.specular,
      strength: material.textures.occlusion ? material.strength : 0, shadeShift: material.shift,
      toony: material.toony, rimPower: material.rim_power, rimLift: material.rim_lift};
    for (const [name, value] of Object.entries(numbers)) gl.uniform1f(program.place(name), value);
    gl.uniform1i(program.place('shading'), SHADINGS.indexOf(material.shading));
    gl.uniform1i(program.place('alphaMode'), ALPHAS.indexOf(alpha));
    const bumps = material.textures.normal;
    gl.uniform1i(program.place('bumpy'),
        bumps && this.textures.get(String(bumps)) !== this.white ? 1 : 0);
    gl.uniform1i(program.place('plain'), material.plain ? 1 : 0);
    const [r, g, b, a] = material.factor;
    gl.uniform4fv(program.place('factor'), material.plain ? [1, 1, 1, a] : [r, g, b, a]);
    gl.uniform3fv(program.place('emission'), material.emission);
    gl.uniform3fv(program.place('shade'), material.shade);
    gl.uniform3fv(program.place('rimLight'), material.rim);
    if (material.double) gl.disable(gl.CULL_FACE);
    else gl.enable(gl.CULL_FACE);
  }
}
