// A canvas with a head in it.
import {DirectionalLight, HemisphereLight, PerspectiveCamera, Scene, Vector3,
    WebGLRenderer} from 'three';
import {MeshoptDecoder} from 'three/addons/libs/meshopt_decoder.module.js';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';

import {Head} from './head.js';

export class Viewport {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({canvas, antialias: true, alpha: true});
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(24, 1, 0.01, 1000);
    const light = new DirectionalLight(0xffffff, 2);
    light.position.set(0.5, 1, 1.5);
    this.scene.add(new HemisphereLight(0xffffff, 0x8d8d8d, 2), light);
    this.head = null;
  }

  /** Shows a .glb in place of the one before. */
  async loadHead(url) {
    const {scene} = await new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).loadAsync(url);
    const head = new Head(scene);
    this.removeHead();
    this.head = head;
    this.scene.add(scene);
    this.frame(head.box());
  }

  frame(box) {
    const size = box.getSize(new Vector3()), middle = box.getCenter(new Vector3());
    const distance = 0.58 * Math.max(size.x, size.y) / Math.tan(this.camera.fov * Math.PI / 360) +
        size.z / 2;
    this.camera.position.set(middle.x, middle.y, middle.z + distance);
    this.camera.near = distance / 100;
    this.camera.far = distance * 100;
    this.camera.lookAt(middle);
    this.camera.updateProjectionMatrix();
  }

  removeHead() {
    if (!this.head) return;
    this.scene.remove(this.head.root);
    this.head.root.traverse((node) => {
      node.geometry?.dispose();
      for (const material of [node.material ?? []].flat()) {
        for (const value of Object.values(material)) if (value?.isTexture) value.dispose();
        material.dispose();
      }
    });
    this.head = null;
  }

  draw() {
    const {clientWidth: width, clientHeight: height} = this.canvas;
    if (!width || !height) return;
    const ratio = Math.min(globalThis.devicePixelRatio ?? 1, 2);
    if (this.canvas.width !== Math.floor(width * ratio) ||
        this.canvas.height !== Math.floor(height * ratio)) {
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
    }
    this.renderer.render(this.scene, this.camera);
  }

  close() {
    this.removeHead();
    this.renderer.dispose();
  }
}
