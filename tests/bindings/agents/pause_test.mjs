// pause_test.mjs MESSAGES FOLDER: a page whose sound is paused, goes on, and is interrupted.
import assert from 'node:assert';
import {readFileSync} from 'node:fs';

const [file, folder] = process.argv.slice(2);
const {FaceReceiver} = await import(`${folder}/face_receiver.js`);
const {Track} = await import(`${folder}/track.js`);

// It decodes nothing: each face is open as far as its number.
let number = 0;
const decoder = () => ({
  decode: ({time, intra}) => [{time, intra, rate: [25, 1], values: [100 + number++, 0, -50]}],
  skip() {},
});
let wall = 100;
const face = new FaceReceiver({decoder, track: new Track(), wall: () => wall});
const tell = (told) =>
    face.take('animeme.clock', new TextEncoder().encode(JSON.stringify({segment: 0, ...told})));
for (const line of readFileSync(file, 'utf8').trim().split('\n')) {
  const [topic, base64] = JSON.parse(line);
  face.takeMessage({topic, base64});
}
face.takeMessage({});  // of somebody else
assert.ok(face.track.frames.length > 30);

function draw(seconds) {
  const seen = [];
  for (let i = 0; i < seconds * 60; ++i) {
    wall += 1 / 60;
    seen.push(face.now().values[0]);
  }
  return seen;
}
tell({playing: 0});
const spoken = draw(0.5);
assert.ok(spoken.every((value, i) => value >= 100 && (i === 0 || value >= spoken[i - 1])));
const at = face.time();
tell({paused: Math.round(at * 22050)});
const closing = draw(0.3);
assert.ok(closing[0] > 90 && closing.at(-1) === 0, 'it closes');
assert.ok(closing.every((value, i) => i === 0 || value <= closing[i - 1]), 'and only that');
draw(5);
assert.ok(Math.abs(face.time() - at) < 1e-3, 'the clock is held');
tell({playing: Math.round(at * 22050)});
const again = draw(0.3);
assert.ok(again[0] < 50 && again.at(-1) > 100, 'it goes on where it was');
assert.ok(Math.abs(face.time() - at - 0.3) < 0.02);
// A pause that becomes an interruption: the mouth stays closed until the next sound.
tell({paused: Math.round(face.time() * 22050)});
draw(0.3);
tell({begins: 0, cut: Math.round(face.time() * 22050)});
assert.ok(draw(1).every((value) => value === 0));
tell({segment: 1, begins: 44100});
assert.ok(draw(1).every((value) => value === 0));
