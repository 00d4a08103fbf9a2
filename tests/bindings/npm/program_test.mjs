// program_test.mjs PACKAGE PROGRAM SOURCE: values of the package beside those of the program, and
// of the page that it writes.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {test} from 'node:test';
import {inflateSync} from 'node:zlib';

import {faceOf, readText} from './suite.mjs';

const [folder, program, source] = process.argv.slice(2);
const animeme = await import(`${folder}/src/node.js`);
const {Clip} = await import(`${source}/tools/view/viewer/js/clip.js`);
await animeme.ready();

const dir = mkdtempSync(join(tmpdir(), 'animeme-npm-'));
process.on('exit', () => rmSync(dir, {recursive: true}));
const run = (...args) => execFileSync(program, args, {cwd: dir, stdio: ['ignore', 'pipe', 'pipe']});
const bytes = (name) => new Uint8Array(readFileSync(join(dir, name)));
const text = (name) => readFileSync(join(dir, name), 'utf8');
const sample = `${source}/tests/data/grid_s1_sample`;

run('speak', '--script', `${sample}/phonemes/prac8p.tsv`, '-o', 'talk.fba');
run('encode', `${sample}/fap/prac8p.csv`, '-o', 'measured.fba');

run('speak', '--script', `${sample}/phonemes/prac8p.tsv`, '--rate', '100', '-o', 'fast.fba');

for (const name of ['talk', 'measured', 'fast']) {
  const frames = animeme.decode(bytes(`${name}.fba`), {shown: true});

  test(`${name}: ARKit's weights are those of the program`, () => {
    run('export', `${name}.fba`, '-o', `${name}.json`);
    const {names, frames: rows} = JSON.parse(text(`${name}.json`));
    const fitter = new animeme.ArkitFitter();
    assert.deepEqual(names, animeme.arkitNames().slice(0, names.length));
    assert.equal(rows.length, frames.length);
    rows.forEach((row, i) => {
      const weights = fitter.fit(frames[i]);
      row.forEach((weight, k) => assert.ok(Math.abs(weights[k] - weight) < 6e-5,
          `frame ${i}, ${names[k]}`));
    });
  });

  test(`${name}: visemes are those of the program`, () => {
    run('export', `${name}.fba`, '-o', `${name}.visemes.json`);
    const {names, frames: rows} = JSON.parse(text(`${name}.visemes.json`));
    const fitter = new animeme.VisemeFitter();
    assert.deepEqual(names, animeme.visemeNames());
    rows.forEach((row, i) => {
      const weights = fitter.fit(frames[i]);
      row.forEach((weight, k) => assert.ok(Math.abs(weights[k] - weight) < 6e-5,
          `frame ${i}, ${names[k]}`));
    });
  });

  test(`${name}: TalkingHead is told what the program tells it`, () => {
    run('export', `${name}.fba`, '-o', `${name}.talkinghead.json`);
    assert.deepEqual(animeme.talkingHead(frames, null),
        JSON.parse(text(`${name}.talkinghead.json`)));
    const words = [{text: 'hello', start: 0, end: 0.4}];
    const {anim, anims, visemes, vtimes} = animeme.talkingHead(frames, null, {shapes: true, words});
    // Its player makes visemes from words unless there are some, if only none.
    assert.deepEqual([visemes, vtimes], [[], []]);
    assert.deepEqual(anims, [{...anim, delay: 0}]);
    assert.equal(anim.dt.length, frames.length);
    assert.equal(anim.vs.jawOpen.length, frames.length + 1);
    const fitter = new animeme.ArkitFitter(), jaw = animeme.arkitNames().indexOf('jawOpen');
    frames.forEach((frame, i) => assert.equal(anim.vs.jawOpen[i + 1], fitter.fit(frame)[jaw]));
  });

  test(`${name}: the page of animeme view has the same values`, () => {
    run('view', `${name}.fba`, '-o', `${name}.html`);
    const packed = clipOf(text(`${name}.html`));
    const clip = new Clip(packed);
    assert.equal(clip.frames, frames.length);
    for (let i = 0; i < frames.length; ++i) {
      for (let fap = 3; fap <= 68; ++fap) {
        if (clip.derived[fap]) continue;  // what a head does of itself
        assert.equal(frames[i].values[fap - 1], clip.value(fap, i), `frame ${i}, FAP ${fap}`);
      }
    }
  });
}

test('a frame alone has the weights of a fit that has seen nothing, and there is a way back',
    () => {
  const frames = animeme.decode(bytes('talk.fba'), {shown: true});
  const weights = animeme.arkit(frames[20]);
  const fitted = new animeme.ArkitFitter().fit(frames[20]);
  assert.deepEqual(Object.keys(weights), animeme.arkitNames().slice(0, 52));
  Object.values(weights).forEach((weight, i) => assert.equal(weight, fitted[i]));
  assert.equal(animeme.fromArkit({jawOpen: 0.5}).values[2], animeme.fromArkit(
    animeme.arkitNames().map((name) => name === 'jawOpen' ? 0.5 : 0)).values[2]);
  assert.ok(animeme.fromArkit({jawOpen: 0.5}).values[2] > 200);
  const sum = Object.values(animeme.visemes(frames[20])).reduce((a, b) => a + b);
  assert.ok(Math.abs(sum - 1) < 1e-5);
});

test('a speaker says what the program says', async () => {
  const script = readFileSync(`${sample}/phonemes/prac8p.tsv`, 'utf8');
  run('speak', '--script', `${sample}/phonemes/prac8p.tsv`, '-o', 'talk.fap');
  const speaker = await animeme.Speaker.load();
  assert.match(speaker.attribution, /GRID/);
  const frames = speaker.speak(script), want = readText(text('talk.fap'));
  assert.deepEqual(frames.map(faceOf), want);

  // The same model as a file of the user's: with the articulation that the file asks for.
  const model = `${source}/dam/model/builtin/grid_s1.dam`;
  run('speak', '--script', `${sample}/phonemes/prac8p.tsv`, '--model', model, '-o', 'file.fap');
  const ofFile = (await animeme.Speaker.load(readFileSync(model))).speak(script).map(faceOf);
  assert.deepEqual(ofFile, readText(text('file.fap')));
  assert.notDeepEqual(ofFile, want);

  // Phones as objects, and as they come.
  const phones = script.trim().split('\n').filter((line) => /^[0-9]/.test(line)).map((line) => {
    const [start, end, phone] = line.split('\t');
    return {start: Number(start), end: Number(end), phone: phone.replace(/[0-9]$/, '')};
  });
  const plain = speaker.speak(phones, {idleMotion: -1, rate: 50});
  const speech = speaker.begin({rate: 50});
  const live = [];
  for (const phone of phones) {
    speech.push(phone);
    for (const frame of speech) live.push(frame);
  }
  speech.finish();
  for (const frame of speech) live.push(frame);
  assert.ok(speech.ended);
  assert.deepEqual(live.map(faceOf), plain.map(faceOf));
  assert.equal(plain[1].time, 0.02);
  assert.throws(() => speaker.speak('nothing of that kind'),
      {code: 'syntax', name: 'AnimemeError'});
  assert.throws(() => speaker.begin().push({start: 0, end: 1, phone: 'XX'}),
      {code: /invalid_argument|not_found/});
});

test('moods, looks, parts that are still and the tongue are those of the program', async () => {
  const file = `${sample}/phonemes/prac8p.tsv`, script = readFileSync(file, 'utf8');
  const speaker = await animeme.Speaker.load();
  const cases = [
    [{mood: 'joy:0.6', seed: 3}, ['--mood', 'joy:0.6', '--seed', '3']],
    [{mood: 'thinking', look: '20,-5', still: 'blinks,brows'},
        ['--mood', 'thinking', '--look', '20,-5', '--still', 'blinks,brows']],
    [{tongue: false, idleMotion: 0.5}, ['--no-tongue', '--liveliness', '0.5']],
    [{mood: 'anger', idleMotion: 0, style: 1.2}, ['--mood', 'anger', '--no-idle-motion', '--style',
        '1.2']],
  ];
  for (const [options, args] of cases) {
    run('speak', '--script', file, ...args, '-o', 'moody.fap');
    assert.deepEqual(speaker.speak(script, options).map(faceOf), readText(text('moody.fap')),
        args.join(' '));
  }
  const moodOf = (mood) => {
    const speech = speaker.begin({mood});
    speech.push({start: 0, end: 0.4, phone: 'AA'});
    speech.finish();
    return [...speech].map(faceOf);
  };
  assert.notDeepEqual(moodOf('sadness'), moodOf('neutral'));
  assert.deepEqual(moodOf('neutral'), moodOf(undefined));
  assert.throws(() => speaker.speak(script, {mood: 'jooy'}), {code: 'not_found'});
  assert.throws(() => speaker.begin({mood: 'joy:9'}), {code: 'invalid_argument'});
  assert.throws(() => speaker.speak(script, {look: 'up'}), {code: 'syntax'});
  assert.throws(() => speaker.speak(script, {still: 'ears'}), {code: 'not_found'});
});

test('the face of an mp4 is that of its stream, whole, in fragments and in pieces', () => {
  run('speak', '--text', 'Hello there', '-o', 'hello.mp4');
  run('demux', 'hello.mp4', '--face', 'hello.fba');
  const want = animeme.decode(bytes('hello.fba'), {shown: true});
  run('mux', 'hello.mp4', 'hello.mp4', '--fragmented', '-o', 'fragments.mp4');
  run('mux', 'hello.mp4', 'hello.mp4', '--systems', '-o', 'systems.mp4');
  run('mux', 'hello.mp4', 'hello.mp4', '--audio-codec', 'opus', '-o', 'opus.mp4');
  for (const name of ['hello', 'fragments', 'systems', 'opus']) {
    const track = animeme.decodeMp4(bytes(`${name}.mp4`));
    assert.deepEqual(track.frames.map(faceOf), want.map(faceOf), name);
    track.frames.forEach((frame, i) => assert.ok(Math.abs(frame.time - want[i].time) < 1e-3,
        `${name}: ${frame.time}`));
    assert.ok(Math.abs(track.end - want.length / 25) < 1e-3);
    assert.equal(track.at(0.5).number, 12);
  }
  const whole = bytes('fragments.mp4');
  const reader = new animeme.Mp4Reader();
  const pieces = [];
  for (let at = 0; at < whole.length;
      at += 333) pieces.push(...reader.push(whole.subarray(at, at + 333)));
  reader.finish();
  assert.deepEqual(pieces, new animeme.Mp4Reader().push(whole));
  assert.ok(reader.bytes.length < 400);
  assert.throws(() => animeme.decodeMp4(whole.subarray(0, 900)), {name: 'AnimemeError'});
  assert.throws(() => animeme.decodeMp4(new TextEncoder().encode('no mp4 at all')),
      {code: 'syntax'});
});

test('the edits of a track move its times', () => {
  const moved = bytes('hello.mp4'), view = new DataView(moved.buffer);
  const {timescale} = readerOf(moved).track;
  let edits = 0;
  for (let i = 0; i + 20 < moved.length; ++i) {
    if (String.fromCharCode(...moved.subarray(i, i + 4)) !== 'elst' || view.getUint32(i + 8) !== 1)
        continue;
    view.setInt32(i + 16, timescale / 4);  // begins a quarter of a second into the track
    ++edits;
  }
  assert.ok(edits > 0);
  assert.ok(Math.abs(animeme.decodeMp4(moved).frames[10].time - (0.4 - 0.25)) < 1e-9);
});

function readerOf(whole) {
  const reader = new animeme.Mp4Reader();
  reader.push(whole);
  return reader;
}

test('a broken mp4 is an error or a face, whatever is broken', () => {
  let state = 1;
  const random = (below) => (state = (Math.imul(state, 1103515245) + 12345) & 0x7fffffff) % below;
  const codes = new Set();
  for (const name of ['hello', 'fragments']) {
    const good = bytes(`${name}.mp4`);
    for (let k = 0; k < 600; ++k) {
      const broken = good.slice(0, k % 3 === 0 ? random(good.length) : good.length);
      for (let i = random(4); i >= 0; --i) {
        broken[random(Math.min(broken.length, 4000))] = [0, 255, random(256)][random(3)];
      }
      try {
        animeme.decodeMp4(broken);
      } catch (problem) {
        assert.equal(problem.name, 'AnimemeError', problem.stack);
        codes.add(problem.code);
      }
    }
  }
  assert.deepEqual([...codes].sort(), ['syntax', 'truncated', 'unsupported']);
  // A fragment that ends in the middle of a header.
  const box = (type, ...content) => [0, 0, 0, 8 + content.length, ...Buffer.from(type), ...content];
  const cut = Uint8Array.from(box('moof', ...box('traf', ...box('tfhd', 0, 0, 0, 0))));
  assert.throws(() => readerOf(bytes('fragments.mp4')).push(cut),
      {name: 'AnimemeError', code: 'syntax'});
});

// As page.cpp puts it in: base64 of a deflated clip.
function clipOf(html) {
  const found = /id="clip0"[^>]*>([A-Za-z0-9+/=\s]+)</.exec(html);
  assert.ok(found, 'the page has no clip');
  return inflateSync(Buffer.from(found[1], 'base64'));
}
