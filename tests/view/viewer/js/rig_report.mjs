// node rig_report.mjs task.json: how far rig.js with a given rig.wasm moves vertices from where the
// program does, as JSON.
//
// The task has "module", a path; "parts", the parts of a rig; "frames", values by FAP; "rigs",
// paths to which ".rig" (the packed rig) and ".places" (32-bit floats: x, y, z of each vertex of
// each part, frame by frame) are added. distances: of each rig, the largest distance of a
// coordinate, cm; moved: how far the frames are apart; coordinates: all.
import {readFileSync} from 'node:fs';
import {deflateSync} from 'node:zlib';

const task = JSON.parse(readFileSync(process.argv[2], 'utf8'));
globalThis.RIG_MODULE = deflateSync(readFileSync(task.module)).toString('base64');
const {Rig, loadRig, rigReady} = await import('../../../../tools/view/viewer/js/rig.js');
await rigReady;

const report = {distances: [], moved: [], coordinates: 0};
for (const name of task.rigs) {
  const {rig, parts} = loadRig(new Uint8Array(readFileSync(name + '.rig')), task.parts);
  const head = new Rig({rig, parts: parts.map((part, i) => ({...part, name: `part ${i}`}))});
  const bytes = readFileSync(name + '.places');
  const places = new Float32Array(bytes.buffer.slice(bytes.byteOffset,
      bytes.byteOffset + bytes.length));
  let [at, most, moved, first] = [0, 0, 0, null];
  for (const frame of task.frames) {
    head.pose(frame);
    const all = parts.flatMap((_, part) => Array.from(head.placed(part)));
    first ??= all;
    for (const [i, x] of all.entries()) {
      const distance = Math.abs(x - places[at++]);
      most = distance <= most ? most : distance;  // not a number: that
      moved = Math.max(moved, Math.abs(x - first[i]));
    }
  }
  if (at !== places.length)
      throw new Error(`${name}: ${at} coordinates in place of ${places.length}`);
  report.distances.push(most);
  report.moved.push(moved);
  report.coordinates += at;
}
console.log(JSON.stringify(report));
