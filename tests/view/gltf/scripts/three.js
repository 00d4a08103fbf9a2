// node three.js FILE.glb CAMERA.json OUT.rgb: what three.js draws of a file, by the lights of
// tools/view/render/detail/material_light.cpp. CAMERA: {eye, target, angle (rad), size (pixels),
// background (0xRRGGBB)}; with `time` its first animation at that second, without `eye` what shapes
// move from the front. OUT: R, G, B, rows from the top.
'use strict';

const fs = require('fs');
const path = require('path');
const READERS = path.join(__dirname, '../../../readers/js');
const {launch} = require(path.join(READERS, 'browser'));
const {serve} = require(path.join(READERS, 'server'));
const {readPng} = require('../../viewer/js/png');

const FLAGS = ['--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'];

const PAGE = `<!doctype html><link rel=icon href='data:,'><body style='margin:0'>
<script type=importmap>{"imports": {"three": "/three/build/three.module.js",
  "three/addons/": "/three/examples/jsm/"}}</script>
<script type=module>
import * as THREE from 'three';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
import {MeshoptDecoder} from 'three/addons/libs/meshopt_decoder.module.js';
// Where shapes move vertices by more than a twentieth of what they move any.
const faceOf = (scene) => {
  const box = new THREE.Box3();
  scene.traverse((mesh) => {
    const shapes = mesh.geometry?.morphAttributes.position ?? [];
    const {position} = mesh.geometry?.attributes ?? {};
    const moves = shapes.length === 0 ? [] : Array.from({length: position.count}, (_, v) => Math.max(
        ...shapes.map((s) => Math.abs(s.getX(v)) + Math.abs(s.getY(v)) + Math.abs(s.getZ(v)))));
    const most = moves.reduce((a, b) => Math.max(a, b), 0);
    moves.forEach((move, v) => {
      if (move > most / 20) box.expandByPoint(mesh.getVertexPosition(v, new THREE.Vector3()).applyMatrix4(mesh.matrixWorld));
    });
  });
  return box;
};
const frame = (scene, angle) => {
  const box = faceOf(scene), middle = box.getCenter(new THREE.Vector3());
  const far = 1.3 * (box.max.y - box.min.y) / (2 * Math.tan(angle / 2));
  return {eye: [middle.x, middle.y, box.max.z + far], target: middle.toArray(), scale: far / 10};
};
window.draw = async (file, {eye, target, angle, size, background, time}) => {
  const loader = new GLTFLoader();
  loader.setMeshoptDecoder(MeshoptDecoder);
  const gltf = await loader.loadAsync(file);
  gltf.scene.updateMatrixWorld(true);
  let scale = 1;
  if (!eye) ({eye, target, scale} = frame(gltf.scene, angle));
  if (time !== undefined) {
    const mixer = new THREE.AnimationMixer(gltf.scene);
    mixer.clipAction(gltf.animations.at(-1)).play();
    mixer.setTime(time);
  }
  const renderer = new THREE.WebGLRenderer({antialias: true, preserveDrawingBuffer: true});
  renderer.setSize(size, size);
  renderer.toneMapping = THREE.NeutralToneMapping;
  renderer.setClearColor(background);
  document.body.append(renderer.domElement);
  const scene = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(angle * 180 / Math.PI, 1, 0.5 * scale, 1000 * scale);
  camera.position.set(...eye);
  camera.lookAt(...target);
  camera.updateMatrixWorld();
  // Intensities of lights count once pi, as a white surface sends back light in all directions.
  const lamp = (colour, place) => {
    const light = new THREE.DirectionalLight(0, Math.PI);
    light.color.setRGB(...colour);
    light.position.set(...place).applyQuaternion(camera.quaternion);
    scene.add(light);
  };
  lamp([0.86, 0.82, 0.76], [0.55, 0.62, 0.75]);
  lamp([0.16, 0.20, 0.26], [-0.9, 0.1, 0.5]);
  lamp([0.26, 0.28, 0.31], [-0.7, 0.5, -0.8]);
  const sky = new THREE.HemisphereLight(0, 0, Math.PI);
  sky.color.setRGB(0.40, 0.41, 0.43);
  sky.groundColor.setRGB(0.25, 0.23, 0.22);
  scene.add(sky, gltf.scene);
  renderer.render(scene, camera);
  return true;
};
window.loaded = true;
</script>`;

async function main([file, camera, out]) {
  const wanted = JSON.parse(fs.readFileSync(camera, 'utf8'));
  const folder = path.dirname(path.resolve(out));
  fs.writeFileSync(path.join(folder, 'three.html'), PAGE);
  const server = await serve({'/three/': path.join(READERS, 'node_modules/three'),
    '/file/': path.dirname(path.resolve(file)), '/': folder});
  const browser = await launch({flags: FLAGS});
  try {
    const page = await browser.open(server.url + 'three.html');
    await page.resize(wanted.size, wanted.size);
    await page.wait('window.loaded');
    await page.evaluate((...all) => window.draw(...all), `/file/${path.basename(file)}`, wanted);
    const {width, height, channels,
        data} = readPng(await page.screenshot(path.join(folder, 'three.png')));
    const rgb = Buffer.alloc(width * height * 3);
    for (let i = 0; i < width * height; ++i) {
      for (let k = 0; k < 3; ++k) rgb[i * 3 + k] = data[i * channels + k];
    }
    fs.writeFileSync(out, rgb);
    process.stdout.write(JSON.stringify({width, height, messages: page.messages}) + '\n');
  } finally {
    await browser.close();
    await server.close();
  }
}

main(process.argv.slice(2)).catch((error) => {
  console.error(error);
  process.exitCode = 1;
});
