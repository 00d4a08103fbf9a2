// page_test.mjs FILE PACKAGE: what a page makes of the messages in FILE, one JSON a line: [topic,
// base64]; by the npm package, if it is built, else by a decoder that remembers bytes.
import assert from 'node:assert';
import {existsSync, readFileSync} from 'node:fs';
import {FaceReceiver} from '../../../tools/bindings/npm/src/face_receiver.js';

const [file, folder] = process.argv.slice(2);
let kit = await import('../../../tools/bindings/npm/src/track.js');
let decoder = () => ({decode: ({time, intra, bytes}) => [{time, intra, bytes, rate: [25, 1]}],
    skip() {}});
const built = existsSync(`${folder}/wasm/decoder.wasm`);
if (built) {
  kit = await import(`${folder}/src/node.js`);
  await kit.ready();
  decoder = (config) => new kit.UnitDecoder(config);
}

let wall = 100;
const face = new FaceReceiver({decoder, track: new kit.Track(), delay: () => 0.05,
    wall: () => wall});
assert.equal(face.now(), null);
const messages = readFileSync(file, 'utf8').trim().split('\n').map((line) => {
  const [topic, base64] = JSON.parse(line);
  const bytes = new Uint8Array(Buffer.from(base64, 'base64'));
  return {topic, bytes, told: topic === 'animeme.clock' ? JSON.parse(Buffer.from(bytes)) : {}};
});
// The sound of the last segment begins late: all of its face is there before.
const last = messages.findLastIndex(({told}) => told.playing !== undefined);
const late = messages.splice(last, 1)[0];
let begun = 0, cuts = 0, units = 0, replaced = 0;
for (const {topic, bytes, told} of messages) {
  const before = face.track.frames.length;
  face.take(topic, bytes);
  if (topic === 'animeme.face' && bytes[0] !== 0x41) {
    ++units;
    replaced += before + 1 - face.track.frames.length;
    const times = face.track.frames.map(({time}) => time);
    assert.ok(times.every((time, i) => i === 0 || time > times[i - 1]), 'in order');
    if (built) assert.equal(face.track.frames.at(-1).values.length, 68);
  }
  if (told.playing !== undefined) {
    ++begun;
    wall += 0.05;  // that is when the sound is heard
    assert.ok(Math.abs(face.anchor.time - told.playing / 22050) < 1e-9);
    wall += 0.4;
  }
  if (told.cut !== undefined) ++cuts;
}
assert.ok(begun >= 2 && cuts >= 1 && units > 50 && replaced > 0);
wall += 1000;
assert.ok(face.now().time < late.told.playing / 22050 && face.now() !== face.track.frames.at(-1),
    'it waits for its sound');
face.take(late.topic, late.bytes);
wall += 0.05;
// Where a segment is 0.4 s old, its eleventh face is shown; long after the last one, that one.
wall = face.anchor.wall + 0.4 + 1e-4;
assert.ok(Math.abs(face.now().time - (face.anchor.time + 0.4)) < 1e-3);
wall += 1000;
assert.equal(face.now(), face.track.frames.at(-1));
if (built) assert.ok(face.now().values.every((value) => value === 0), 'closed');
console.log(
    `${units} units, ${replaced} replaced, by ${built ? 'the npm package' : 'a decoder that decodes nothing'}`);
