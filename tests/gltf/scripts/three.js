// node three.js FILE.glb CAMERA.json OUT.rgb: what three.js draws of a file, by the lights of
// tools/render/detail/coat_light.cpp. CAMERA: {eye, target, angle (rad), size (pixels), background (0xRRGGBB)}. OUT: R, G, B,
// rows from the top.
'use strict';

const fs = require('fs');
const path = require('path');
const READERS = path.join(__dirname, '../../readers/js');
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
window.draw = async (file, {eye, target, angle, size, background}) => {
  const renderer = new THREE.WebGLRenderer({antialias: true, preserveDrawingBuffer: true});
  renderer.setSize(size, size);
  renderer.toneMapping = THREE.NeutralToneMapping;
  renderer.setClearColor(background);
  document.body.append(renderer.domElement);
  const scene = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(angle * 180 / Math.PI, 1, 0.5, 1000);
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
  scene.add(sky, (await new GLTFLoader().loadAsync(file)).scene);
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
    const {width, height, channels, data} = readPng(await page.screenshot(path.join(folder, 'three.png')));
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
