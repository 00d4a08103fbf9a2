// A head in three.js: morph targets by the names of ARKit's shapes or of Oculus' visemes, and the
// bones of head and eyes.
import {Box3, Euler, Quaternion, Vector3} from 'three';

import {arkitNames, visemeNames} from './weights.js';

const kYaw = 52, kLeftEye = 55, kRightEye = 58;  // channels of angles: yaw, pitch, roll
const bones = {
  head: [/^(mixamorig|.*_)?head$/i, /^neck_bone$/i, /^(mixamorig|.*_)?neck$/i],
  left: [/^(mixamorig)?left_?eye(_bone)?$/i, /_L_FaceEye$/i, /^eye_?l$/i],
  right: [/^(mixamorig)?right_?eye(_bone)?$/i, /_R_FaceEye$/i, /^eye_?r$/i],
  jaw: [/^jaw_bone$/],  // of our heads: it carries the lower teeth
};
const kJawTurn = 1.61e-4;  // radians for a unit of FAP 3, of our heads (by animeme export)

const plain = (name) => name.replace(/^.*\./, '').replace(/_L$/, 'Left').replace(/_R$/,
    'Right').toLowerCase();

function boneOf(root, patterns, isTaken) {
  for (const pattern of patterns) {
    let found = null;
    root.traverse((node) => { if (!found && !node.isMesh && pattern.test(node.name) &&
        !isTaken(node)) found = node; });
    if (found) return {node: found, rest: found.quaternion.clone()};
  }
  return null;
}

// Which number of an array of weights moves which morph target.
function bindings(root, names) {
  const number = new Map(names.map((name, i) => [plain(name), i]));
  const found = [];
  root.traverse((node) => {
    for (const [name, index] of Object.entries(node.morphTargetDictionary ?? {})) {
      const channel = number.get(plain(name));
      if (channel !== undefined) found.push({node, index, channel});
    }
  });
  return found;
}

/** Puts weights on what GLTFLoader has read. */
export class Head {
  /** `root`: the scene of a file. Throws if it has none of the shapes. */
  constructor(root) {
    this.root = root;
    this.shapes = bindings(root, arkitNames());
    this.visemes = bindings(root, visemeNames());
    if (!this.shapes.length && !this.visemes.length) {
      throw new Error('this head has neither ARKit shapes nor Oculus visemes');
    }
    // Where both move the mouth, ARKit's say more.
    this.byVisemes = this.visemes.length > 0 && !this.moves('jawOpen');
    const taken = new Set();
    for (const [name, patterns] of Object.entries(bones)) {
      this[name] = boneOf(root, patterns, (node) => taken.has(node));
      if (this[name]) taken.add(this[name].node);
    }
    this.eyesByShapes = this.moves('eyeLookOutLeft');
  }

  moves(name) {
    const channel = arkitNames().indexOf(name);
    return this.shapes.some((binding) => binding.channel === channel);
  }

  /**
   * Weights in the order of arkitNames() (61) and of visemeNames(), and the frame that they are of.
   */
  show(arkit, visemes, frame = null) {
    for (const {node, index, channel} of this.shapes) node.morphTargetInfluences[index] =
        arkit[channel];
    if (this.byVisemes) {
      for (const {node, index, channel} of this.visemes) node.morphTargetInfluences[index] =
          visemes[channel];
    }
    this.turn(this.head, arkit, kYaw);
    // Where shapes move eyes that are part of the face, bones would turn them twice.
    if (!this.eyesByShapes) {
      this.turn(this.left, arkit, kLeftEye);
      this.turn(this.right, arkit, kRightEye);
    }
    if (this.jaw && frame) {
      const open = frame.values[2] * kJawTurn;
      this.jaw.node.quaternion.copy(this.jaw.rest).multiply(quaternion.setFromAxisAngle(xAxis,
          open));
    }
  }

  // Positive angles: yaw to the person's right, pitch down, roll towards the person's left
  // shoulder. The face looks along z, its left is at x.
  turn(bone, arkit, channel) {
    if (!bone) return;
    const [yaw, pitch, roll] = arkit.subarray(channel, channel + 3);
    euler.set(pitch, -yaw, -roll, 'YXZ');
    bone.node.quaternion.copy(bone.rest).multiply(quaternion.setFromEuler(euler));
  }

  /** What of it is to be seen: a box around the meshes that shapes move. */
  box() {
    const box = new Box3();
    this.root.updateWorldMatrix(true, true);
    const meshes = new Set([...this.shapes, ...this.visemes].map(({node}) => node));
    for (const mesh of meshes) box.expandByObject(mesh);
    if (this.head && !this.head.node.name.startsWith('neck')) {
      // A mesh of the whole body: from the bone of the head on.
      const at = this.head.node.getWorldPosition(new Vector3());
      if (at.y - box.min.y > 0.6 * (box.max.y - box.min.y)) box.min.y =
          at.y - 0.5 * (box.max.y - at.y);
      const half = box.max.y - box.min.y;
      box.min.x = Math.max(box.min.x, at.x - half);
      box.max.x = Math.min(box.max.x, at.x + half);
    }
    return box;
  }
}

const euler = new Euler(), quaternion = new Quaternion(), xAxis = new Vector3(1, 0, 0);
