// page_test.mjs PACKAGE PROGRAM SOURCE CASES: the package in headless Chromium: the conformance
// suite, and
// <animeme-face> with files, playlists and live faces.
import assert from 'node:assert/strict';
import {execFileSync, spawn} from 'node:child_process';
import {existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {after, test} from 'node:test';

const [folder, program, source, cases] = process.argv.slice(2);
const require = createRequire(import.meta.url);
const {launch} = require(`${source}/tests/readers/js/browser.js`);
const {serve} = require(`${source}/tests/readers/js/server.js`);
// The folder of reference data, as tests/support/shared.h finds it.
const avatars = join(process.env.ANIMEME_SHARED ?? join(dirname(source), 'shared'), 'data/avatars');
const modules = `${source}/tests/readers/js/node_modules`;

function skip(why) {
  console.log(`skipped: ${why}`);
  process.exit(77);
}
if (!existsSync(`${modules}/three`)) skip(
    'npm packages of tests/readers/js are missing (tools/setup.sh full)');

const dir = mkdtempSync(join(tmpdir(), 'animeme-npm-'));
const run = (...args) => execFileSync(program, args, {cwd: dir, stdio: ['ignore', 'pipe', 'pipe']});
const animeme = await import(`${folder}/src/node.js`);
await animeme.ready();

const browser = await launch({flags: ['--use-angle=swiftshader', '--enable-unsafe-swiftshader',
  '--ignore-gpu-blocklist']}).catch(() => skip('chromium is missing (Debian package chromium)'));
const server = await serve({'/animeme/': folder, '/three/': `${modules}/three`,
    '/axe/': `${modules}/axe-core`,
  '/tests/': `${source}/tests/bindings/npm`, '/cases/': cases, '/media/': dir, '/avatars/': avatars,
  '/samples/': `${source}/tools/release/samples`});
after(async () => {
  await browser.close();
  await server.close();
  rmSync(dir, {recursive: true});
});

run('speak', '--text', 'Hello there, my lips move', '-o', 'talk.mp4');
run('demux', 'talk.mp4', '--face', 'talk.fba');
run('mux', 'talk.mp4', 'talk.mp4', '--fragment-seconds', '0.5', '-o', 'talk.m3u8');
run('head', 'child', '-o', 'head.glb');
const frames = animeme.decode(new Uint8Array(readFileSync(join(dir, 'talk.fba'))), {shown: true});

async function open() {
  const page = await browser.open(`${server.url}tests/page.html`);
  await page.wait('window.isReady === true').catch((late) => {
    throw new Error(`${late.message} ${complaints(page)}`);
  });
  return page;
}

// What a page said that it should not have.
const complaints = (page) => page.messages.filter(({type, text}) =>
    /error|exception|warning/.test(type) &&
    !/GPU stall due to ReadPixels|swiftshader|GroupMarkerNotSet/i.test(text)).map(({text}) => text);

// Puts a face into the page and notes every frame that it shows, with the time of its sound.
const put = (page, attributes) => page.evaluate((given) => {
  const face = document.createElement('animeme-face');
  window.seen = [];
  window.events = [];
  face.addEventListener('frame', ({detail}) => window.seen.push(
    {number: detail.number, time: detail.time, heard: face.currentTime,
        values: Array.from(detail.values)}));
  for (const name of ['play', 'pause', 'ended', 'error', 'blocked', 'load', 'head', 'lost']) {
    face.addEventListener(name,
        (event) => window.events.push(name + (event.message ? `: ${event.message}` : '')));
  }
  for (const [name, value] of Object.entries(given)) face.setAttribute(name, value);
  document.querySelector('main').replaceChildren(face);
  window.face = face;
  return true;
}, attributes);

const at = (number) => Array.from(frames[number].values);

function checkSeen(seen, {near = 0.1, least = 10} = {}) {
  assert.ok(seen.length >= least, `${seen.length} frames were shown`);
  for (const {number, time, heard, values} of seen) {
    assert.deepEqual(values, at(number));
    assert.ok(Math.abs(heard - time) < near + 0.04, `frame of ${time} s at ${heard} s`);
  }
}

test('the conformance suite, value for value', async () => {
  const page = await open();
  const names = readdirSync(cases).filter((name) => existsSync(`${cases}/${name}/case.json`));
  const report = await page.evaluate((names) => checkSuite(animeme, names, async (path) => {
    const response = await fetch(`/cases/${path}`);
    return response.ok ? new Uint8Array(await response.arrayBuffer()) : null;
  }), names);
  assert.deepEqual(report.wrong, []);
  assert.ok(report.cases >= 225);
  await page.close();
});

test('the values of the page are those of node', async () => {
  const page = await open();
  const got = await page.evaluate(async () => {
    const bytes = new Uint8Array(await (await fetch('/media/talk.fba')).arrayBuffer());
    const arkit = new animeme.ArkitFitter(), visemes = new animeme.VisemeFitter();
    return animeme.decode(bytes, {shown: true}).map((frame) =>
      [Array.from(frame.values), Array.from(arkit.fit(frame)), Array.from(visemes.fit(frame))]);
  });
  const arkit = new animeme.ArkitFitter(), visemes = new animeme.VisemeFitter();
  const want = frames.map((frame) =>
    [Array.from(frame.values), Array.from(arkit.fit(frame)), Array.from(visemes.fit(frame))]);
  assert.deepEqual(got, JSON.parse(JSON.stringify(want)));  // which has no -0
  await page.close();
});

test('an mp4 plays on a head', async () => {
  const page = await open();
  await put(page, {src: '/media/talk.mp4', head: '/media/head.glb', controls: '', autoplay: '',
      label: 'Ada'});
  await page.evaluate('face.headLoaded.then(() => true)');
  const size = await page.evaluate('[face.canvas.clientWidth, face.canvas.clientHeight]');
  assert.deepEqual(size, [320, 400]);
  await page.wait('events.includes("ended")');
  assert.ok(await page.evaluate('face.loaded.then(() => true)'));
  checkSeen(await page.evaluate('seen'), {near: 0.4, least: 3});  // a processor draws

  // The shapes are those of the frame that is shown, and the picture follows them.
  const look = (number) => page.evaluate(async (number) => {
    face.pause();
    face.currentTime = number / 25 + 0.01;
    for (let i = 0; i < 200 && face.frame?.number !== number;
        ++i) await new Promise(requestAnimationFrame);
    const skin = face.viewport.head.root.getObjectByName('skin');
    const names = animeme.arkitNames();
    const weights = Object.entries(skin.morphTargetDictionary).map(([name, index]) =>
      [skin.morphTargetInfluences[index], face.arkit[names.indexOf(name)]]);
    face.viewport.draw();
    const gl = face.viewport.renderer.getContext(), pixels = new Uint8Array(4 * 320 * 400);
    gl.readPixels(0, 0, 320, 400, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let filled = 0, sum = 0;
    for (let i = 0; i < pixels.length; i += 4) {
      filled += pixels[i + 3] > 0;
      sum = (sum * 31 + pixels[i] + pixels[i + 1]) % 1000003;
    }
    return {number: face.frame.number, weights, filled, sum};
  }, number);
  const jaw = animeme.arkitNames().indexOf('jawOpen'), fitter = new animeme.ArkitFitter();
  const opening = frames.map((frame) => fitter.fit(frame)[jaw]);
  const wide = opening.indexOf(Math.max(...opening));
  const open_ = await look(wide), shut = await look(0);
  assert.equal(open_.number, wide);
  assert.ok(open_.weights.length > 40);
  for (const [moved, meant] of [...open_.weights, ...shut.weights]) assert.equal(moved, meant);
  assert.ok(open_.weights.some(([weight]) => weight > 0.1));
  assert.ok(open_.filled > 20000, `${open_.filled} pixels of a head`);
  assert.notEqual(open_.sum, shut.sum);
  if (process.env.ANIMEME_PICTURES) await page.screenshot(join(process.env.ANIMEME_PICTURES,
      'face.png'));

  await page.evaluate(readFileSync(`${modules}/axe-core/axe.min.js`, 'utf8') + '; 0');
  const violations =
      await page.evaluate(async () => (await axe.run('animeme-face')).violations.map(({id}) => id));
  assert.deepEqual(violations, []);
  assert.equal(
      await page.evaluate('face.getAttribute("role") + " " + face.getAttribute("aria-label")'),
      'group Ada');
  assert.deepEqual(complaints(page), []);
  await page.close();
});

test('a playlist plays by MediaSource, from the middle, too', async () => {
  const page = await open();
  await put(page, {src: '/media/talk.m3u8'});
  await page.wait('face.audio.readyState >= 2');
  await page.evaluate('face.currentTime = 1, face.play()');
  await page.wait('events.includes("ended")');
  const seen = await page.evaluate('seen');
  checkSeen(seen.filter(({time}) => time >= 1));
  assert.ok(seen.at(-1).number >= frames.length - 2);
  await page.evaluate('face.loaded.then(() => true)');
  assert.equal(await page.evaluate('face.track.frames.length'), frames.length);
  assert.deepEqual(complaints(page), []);
  await page.close();
});

// A tone as a WAV file of one channel.
function tone(hertz, seconds) {
  const rate = 16000, count = rate * seconds, file = Buffer.alloc(44 + 2 * count);
  file.write('RIFF', 0);
  file.writeUInt32LE(36 + 2 * count, 4);
  file.write('WAVEfmt ', 8);
  file.writeUInt32LE(16, 16);
  file.writeUInt16LE(1, 20);
  file.writeUInt16LE(1, 22);
  file.writeUInt32LE(rate, 24);
  file.writeUInt32LE(2 * rate, 28);
  file.writeUInt16LE(2, 32);
  file.writeUInt16LE(16, 34);
  file.write('data', 36);
  file.writeUInt32LE(2 * count, 40);
  for (let i = 0; i < count; ++i) {
    file.writeInt16LE(Math.round(9000 * Math.sin(2 * Math.PI * hertz * i / rate)), 44 + 2 * i);
  }
  return file;
}

// Two languages with a tone each: which of them is heard can be measured.
const talks = {en: ['Good morning my friends, I have a map for you.', 440],
  de: ['Guten Morgen liebe Freunde, hier ist eine Karte.', 880]};
const faces = {};
for (const [lang, [text, hertz]] of Object.entries(talks)) {
  writeFileSync(join(dir, `${lang}.wav`), tone(hertz, 30));
  run('speak', '--text', Array(8).fill(text).join(' '), '--lang', lang, '-o', `${lang}.mp4`);
  run('demux', `${lang}.mp4`, '--face', `${lang}.fba`);
  faces[lang] = animeme.decode(new Uint8Array(readFileSync(join(dir, `${lang}.fba`))),
      {shown: true});
}
for (const film of ['film.mp4', 'film.m3u8']) {
  const tracks = Object.keys(talks).flatMap((lang) =>
      ['--track', `lang=${lang},face=${lang}.mp4,audio=${lang}.wav`]);
  run('mux', '-o', film, '--fragment-seconds', '0.5', '--intra-seconds', '0.5', ...tracks);
}

// Hertz of the strongest tone in what is heard now.
const pitchOf = (page) => page.evaluate(async () => {
  window.context ??= new AudioContext();
  await context.resume();
  face.source ??= new Map();
  if (!face.source.has(face.audio)) {
    const analyser = context.createAnalyser();
    analyser.fftSize = 4096;
    context.createMediaElementSource(face.audio).connect(analyser);
    analyser.connect(context.destination);
    face.source.set(face.audio, analyser);
  }
  const analyser = face.source.get(face.audio), bins = new Float32Array(2048);
  await new Promise((done) => setTimeout(done, 400));
  analyser.getFloatFrequencyData(bins);
  return bins.indexOf(Math.max(...bins)) * context.sampleRate / 4096;
});

for (const film of ['film.mp4', 'film.m3u8']) {
  test(`another language while it plays: ${film}`, async () => {
    const page = await open();
    await put(page, {src: `/media/${film}`, captions: ''});
    await page.evaluate(() => {
      window.shown = [];
      face.addEventListener('frame', ({detail}) => shown.push({language: face.language,
        number: detail.number, time: detail.time, heard: face.currentTime,
        caption: face.caption.textContent, values: Array.from(detail.values)}));
      face.addEventListener('language', ({detail}) => events.push(`language ${detail.lang}`));
    });
    await page.wait('face.languages.length === 2 && face.audio.readyState >= 2');
    assert.deepEqual((await page.evaluate('face.languages')).map(({lang}) => lang), ['en', 'de']);
    assert.equal(await page.evaluate('face.language'), 'en');
    await page.evaluate('face.currentTime = 0.3, face.play()');
    assert.ok(Math.abs(await pitchOf(page) - 440) < 20);
    await page.evaluate('face.lang = "de"');
    await page.wait('events.includes("language de")');
    await page.wait(`shown.filter((one) => one.language === 'de' && one.caption).length > 4`);
    assert.ok(Math.abs(await pitchOf(page) - 880) < 20);
    await page.evaluate('face.pause()');
    const shown = await page.evaluate('shown');
    assert.ok(shown.some(({language}) => language === 'en'));
    const german = shown.filter(({language}) => language === 'de');
    // A frame is of the language that is heard, at the time of its sound; it never goes back.
    const key = (frame) => frame.map((value) => Math.round(value)).join();
    let was = 'en';
    for (const {language, time, heard, values} of shown) {
      assert.ok(language === 'de' || was === 'en');
      was = language;
      const own = faces[language][Math.round(time * 25)];
      assert.equal(key(values), key(Array.from(own.values)), `${language} at ${time} s`);
      assert.ok(Math.abs(heard - time) < 0.14, `${language}: frame of ${time} s at ${heard} s`);
    }
    assert.match(await page.evaluate('face.lines.map(({text}) => text).join(" ")'), /Freunde/);
    assert.ok(german.some(({caption}) => /Guten|Freunde|Karte/.test(caption)) &&
        german.every(({caption}) => !/morning|friends/.test(caption)));
    assert.equal(await page.evaluate('face.textTracks[0].language'), 'de');
    assert.ok(await page.evaluate('face.textTracks[0].cues.length > 0'));
    // Paused, too, and by the attribute of a new file.
    await page.evaluate('face.lang = ""');
    await page.wait('face.language === "en"');
    assert.match(await page.evaluate('face.lines.map(({text}) => text).join(" ")'), /friends/);
    await put(page, {src: `/media/${film}`, lang: 'de-AT'});
    await page.wait('face.languages.length === 2');
    assert.equal(await page.evaluate('face.language'), 'en', 'no such language: the default');
    await put(page, {src: `/media/${film}`, lang: 'de'});
    await page.wait('face.language === "de" && face.audio.readyState >= 2');
    await page.evaluate('face.play()');
    assert.ok(Math.abs(await pitchOf(page) - 880) < 20);
    assert.deepEqual(complaints(page), []);
    await page.close();
  });
}

test('a stream without a sound has a clock of its own, and loops', async () => {
  const page = await open();
  await put(page, {src: '/media/talk.fba', autoplay: '', loop: ''});
  await page.wait(
      `seen.length > 20 && seen.some(({number}, i) => i > 0 && number < seen[i - 1].number)`);
  checkSeen(await page.evaluate('seen.slice(1)'));
  await page.evaluate('face.remove()');
  assert.deepEqual(complaints(page), []);
  await page.close();
});

test('what is missing is told', async () => {
  const page = await open();
  await put(page, {src: '/media/none.mp4', head: '/media/none.glb'});
  await page.wait('events.filter((event) => event.startsWith("error")).length === 2');
  assert.match(await page.evaluate('events.join()'), /none\.mp4: 404/);
  await put(page, {src: '/media/head.glb?.mp4'});
  await page.wait('events.some((event) => event.startsWith("error"))');
  assert.match(await page.evaluate('events.join()'), /error: this is not an mp4/);
  await page.close();
});

// Until a server is there.
async function answered(port) {
  for (let i = 0; i < 100; ++i) {
    if (await fetch(`http://127.0.0.1:${port}/info.json`).then(() => true, () => false)) return;
    await new Promise((done) => setTimeout(done, 100));
  }
}

test('a live face, bytes beside values of the server', async () => {
  const port = 20000 + process.pid % 20000;
  const send = () => spawn(program, ['stream', 'talk.mp4', '--to', `http://127.0.0.1:${port}/`,
      '--loop',
    '--allow-origin', server.url.replace(/\/$/, '')], {cwd: dir, stdio: 'ignore'});
  let sender = send();
  try {
    const page = await open();
    await answered(port);
    await put(page, {src: `http://127.0.0.1:${port}/`, live: ''});
    await page.evaluate((port) => {
      window.faps = [];
      new WebSocket(`ws://127.0.0.1:${port}/faps`).onmessage = ({data}) => {
        const {time, values} = JSON.parse(data);
        if (values) window.faps.push([time, values]);
      };
    }, port);
    await page.wait('seen.length > 60 && faps.length > 80');
    const [seen, faps] = await page.evaluate('[seen, faps]');
    const byTime = new Map(faps.map(([time, values]) => [time.toFixed(3), values]));
    let compared = 0;
    for (const {time, heard, values} of seen.slice(10)) {
      const wanted = byTime.get(time.toFixed(3));
      if (!wanted) continue;
      ++compared;
      for (let fap = 3; fap <= 68; ++fap) assert.equal(values[fap - 1], wanted[fap] ?? 0,
          `FAP ${fap} at ${time} s`);
      assert.ok(Math.abs(heard - time) < 0.2, `frame of ${time} s at ${heard} s`);
    }
    assert.ok(compared > 20, `${compared} frames were compared`);

    // It stops, and is as near as before in a few seconds.
    sender.kill('SIGSTOP');
    await new Promise((done) => setTimeout(done, 4000));
    sender.kill('SIGCONT');
    await page.wait(`new Promise((done) => {
      const begin = performance.now();
      let near = begin;
      (function look() {
        const now = performance.now(), behind = face.track.end - face.currentTime;
        if (!(behind > 0 && behind < 0.65)) near = now;
        if (now - near > 1500 || now - begin > 20000) done(now - near > 1500);
        else setTimeout(look, 30);
      })();
    })`);

    // It breaks and comes back.
    sender.kill('SIGKILL');
    await page.wait('events.includes("lost")');
    sender = send();
    await page.evaluate('seen.length = 0');
    await page.wait('seen.length > 20');
    for (const {time, heard} of (await page.evaluate('seen')).slice(5)) assert.ok(
        Math.abs(heard - time) < 0.2);
    await page.close();
  } finally {
    sender.kill();
  }
});

test('what a live head says is told when it is heard', async () => {
  const port = 20000 + (process.pid + 1) % 20000;
  const sender = spawn(program, ['stream', '--say', '-', '--to', `http://127.0.0.1:${port}/`,
    '--allow-origin', server.url.replace(/\/$/, '')], {cwd: dir,
        stdio: ['pipe', 'ignore', 'ignore']});
  try {
    const page = await open();
    await answered(port);
    await put(page, {src: `http://127.0.0.1:${port}/`, live: ''});
    await page.evaluate(() => {
      window.told = [];
      face.addEventListener('speech',
          ({detail}) => told.push({...detail, heard: face.currentTime}));
    });
    await page.wait('seen.length > 20');
    sender.stdin.write('Hello my friend\n');
    await page.wait('told.some(({event}) => event === "done")');
    const told = await page.evaluate('told');
    assert.deepEqual(told.filter(({event}) => event === 'word').map(({word}) => word.toLowerCase()),
        ['hello', 'my', 'friend']);
    assert.deepEqual(told.filter(({line}) => line).map(({event}) => event)
        .filter((event, i, all) => event !== 'phone' && event !== 'word' ||
            all[i - 1] === undefined),
    ['queued', 'started', 'done']);
    for (const {event, time, heard} of told) {
      if (event === 'queued') continue;  // told at once
      // The clock of pictures is that of the sound without its steps.
      assert.ok(heard > time - 0.05 && heard < time + 0.3, `${event} of ${time} s at ${heard} s`);
    }
    await page.close();
  } finally {
    sender.kill();
  }
});

test('a head that meshopt has compressed', async () => {
  const page = await open();
  await put(page, {src: '/media/talk.fba', head: '/samples/me.glb'});
  await page.evaluate('face.headLoaded.then(() => true)');
  await page.evaluate('face.loaded.then(() => true)');
  const {most, vertices} = await page.evaluate(async () => {
    face.currentTime = 0.5;
    for (let i = 0; i < 5; ++i) await new Promise(requestAnimationFrame);
    const {head} = face.viewport;
    return {most: Math.max(...[...head.shapes, ...head.visemes].map(({node, index}) =>
        node.morphTargetInfluences[index])),
      vertices: Math.max(...head.shapes.map(({node}) => node.geometry.attributes.position.count))};
  });
  assert.ok(most > 0.1, `${most}`);
  assert.ok(vertices > 3000, `${vertices}`);
  if (process.env.ANIMEME_PICTURES) await page.screenshot(join(process.env.ANIMEME_PICTURES,
      'me.png'));
  await page.close();
});

for (const name of ['arkit_and_visemes', 'visemes_only', 'brunette-t']) {
  const there = existsSync(`${avatars}/${name}.glb`);
  test(`an avatar of users: ${name}`, {skip: there ? false : 'no avatars beside the tree'},
      async () => {
    const page = await open();
    await put(page, {src: '/media/talk.fba', head: `/avatars/${name}.glb`});
    await page.evaluate('face.headLoaded.then(() => true)');
    await page.evaluate('face.loaded.then(() => true)');
    const moved = await page.evaluate(async () => {
      face.currentTime = 0.5;
      for (let i = 0; i < 5; ++i) await new Promise(requestAnimationFrame);
      const {head} = face.viewport;
      return {byVisemes: head.byVisemes, bone: head.head?.node.name,
        most: Math.max(...[...head.shapes, ...head.visemes].map(({node, index}) =>
            node.morphTargetInfluences[index]))};
    });
    assert.equal(moved.byVisemes, name === 'visemes_only');
    assert.equal(moved.bone, 'Head');
    assert.ok(moved.most > 0.1, JSON.stringify(moved));
    if (process.env.ANIMEME_PICTURES) await page.screenshot(join(process.env.ANIMEME_PICTURES,
        `${name}.png`));
    await page.close();
  });
}
