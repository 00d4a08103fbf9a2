// node viewer_report.js KIND PAGE.html FOLDER: what Chromium makes of a page, as JSON; KIND is
// looks|other|people|tracks|sound|speeds|texts|says|screens|axe|sheet|picture|closeup|live.
//
// looks: vertices of the frames 0 .. 7 as 32-bit floats in FOLDER/<part>_<frame>.f32; how much the
//   mouth and the forehead change between the frames 0 and 1; `specks` of these frames and of frame
//   2, [x, y],
//   below the nose.
// other: the same vertices of the second head of a page, chosen by the keyboard; `list` of heads.
// people: what two heads side by side do: `names`, how far each one's skin `moved` between the
//   frames 0 and 1 (cm), where chins and noses are, the words that are `said` at two times.
// tracks: plays five seconds and a half; behind two and a half the menu of languages chooses the
// second; `list` of
//   the menu, the state when the first is `back`, and where the address `asked` for German.
// sound: plays ten seconds; each picture against what is heard then, told by the clicks.
// speeds: the same without a head, three seconds of the clip at half and at double speed; `pitches`
// in Hz, of
//   the first 80 ms of each burst.
// texts: what is shown where names are hostile; the ways to compare; what works without a head.
// says: what is said at some times, and how many pixels of the wave are drawn at others.
// screens: at the sizes of screens, what is to be hit or read: {size: {width (of the page),
// targets: [{name,
//   width, height}], outside: [names], overlaps: [pairs of names], chin, said (from the top: where
//   faces end,
//   where what is said begins), legend}}; the lying ones show the distance.
// axe: what axe-core finds wrong at the sizes of a desktop and a phone, light, dark and with the
// help open:
//   {checked: how many elements passed, violations: [texts]}.
// sheet: a page of evaluate --report likewise: also `widths` that are left of the window beside the
//   page, and what is `beyond` its edge.
// picture: the canvas of frame 0, 20 degrees to the left, as R, G, B in FOLDER/picture.rgb; {width,
// height}. closeup: the same at zoom 9. live: `result` of a page with values of its own.
// All have `messages`: what the console said.
'use strict';

const fs = require('fs');
const path = require('path');
const {pathToFileURL} = require('url');
const {launch, sleep} = require('../../../readers/js/browser');
const {axe, sheet} = require('./axe_report');
const {difference, readPng, specks} = require('./png');

const FLAGS = ['--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'];
const FRAMES = 8;
const PARTS = ['skin', 'left_eye', 'right_eye', 'upper_teeth', 'lower_teeth', 'tongue', 'hair',
  'brows', 'lashes', 'body'];

async function open(page, file, query) {
  await page.goto(pathToFileURL(file) + query);
  await page.evaluate('window.animeme.ready.then(() => true)');
}

async function show(page, frame) {
  await page.evaluate((number) => {
    window.animeme.seek(number / 25 + 0.001);
    window.animeme.draw();
  }, frame);
  const state = await page.evaluate('window.animeme.state()');
  if (state.frame !== frame) throw new Error(`frame ${state.frame} is shown, not ${frame}`);
}

// Runs in the page.
function packed(part) {
  const bytes = new Uint8Array(window.animeme.vertices(part).buffer);
  let text = '';
  for (let i = 0; i < bytes.length; i += 4096) {
    text += String.fromCharCode(...bytes.subarray(i, i + 4096));
  }
  return btoa(text);
}

function boxes(points) {
  const at = (id) => points.find((point) => point.id === id);
  const [left, right] = [at('8.4').x, at('8.3').x];
  const brows = Math.min(at('4.3').y, at('4.4').y);
  const hair = at('11.1').y;
  const edge = 0.3 * (brows - hair);
  return {
    mouth: {left, right, top: at('8.1').y, bottom: at('8.2').y},
    around: {left: left - (right - left) / 2, right: right + (right - left) / 2, top: at('9.3').y,
      bottom: at('2.1').y},
    forehead: {left, right, top: hair + edge, bottom: brows - edge},
  };
}

async function looks(page, file, folder) {
  await page.resize(700, 1200);
  await open(page, file, '?frame=0&mode=first');
  const report = {state: await page.evaluate('window.animeme.state()')};
  const {mouth, around, forehead} = boxes(await page.evaluate('window.animeme.points()'));
  const viewport = await page.evaluate(`(() => {
    const box = document.getElementById('picture').getBoundingClientRect();
    return {x: box.left, y: box.top};
  })()`);
  const placed = (box) => ({left: box.left + viewport.x, right: box.right + viewport.x,
    top: box.top + viewport.y, bottom: box.bottom + viewport.y});
  const pictures = [];
  for (const frame of [0, 1, 2]) {
    await show(page, frame);
    pictures.push(readPng(await page.screenshot(path.join(folder, `frame_${frame}.png`))));
  }
  report.specks = pictures.flatMap((picture) => specks(picture, placed(around)));
  report.mouth = difference(...pictures.slice(0, 2), placed(mouth));
  report.forehead = difference(...pictures.slice(0, 2), placed(forehead));
  await vertices(page, folder);
  return report;
}

async function vertices(page, folder) {
  for (let frame = 0; frame < FRAMES; ++frame) {
    await show(page, frame);
    for (const part of PARTS) {
      const bytes = Buffer.from(await page.evaluate(packed, part), 'base64');
      fs.writeFileSync(path.join(folder, `${part}_${frame}.f32`), bytes);
    }
  }
}

async function press(page, key, code, number) {
  for (const type of ['rawKeyDown', 'keyUp']) {
    await page.send('Input.dispatchKeyEvent', {type, key, code, windowsVirtualKeyCode: number});
  }
}

// Where a feature point of each head is, as a share of the width of the picture.
function places(points, id, width) {
  return [0, 1].map((head) =>
    points.find((point) => point.id === id && point.head === head).x / width);
}

async function people(page, file, folder) {
  await page.resize(1000, 800);
  await open(page, file, '?frame=0');
  const report = {title: await page.evaluate('document.getElementById("title").textContent'),
    names: await page.evaluate(
        '[...document.querySelectorAll(".name")].map((each) => each.textContent)'), said: []};
  const skins = () => page.evaluate(() => [0, 1].map((head) =>
    Array.from(window.animeme.vertices('skin', head))));
  await show(page, 0);
  const before = await skins();
  await show(page, 1);
  const after = await skins();
  report.moved = before.map((skin, head) =>
    skin.reduce((most, x, i) => Math.max(most, Math.abs(x - after[head][i])), 0));
  const points = await page.evaluate('window.animeme.points()');
  const width = await page.evaluate('document.getElementById("picture").clientWidth');
  report.chin = places(points, '2.1', width);
  report.nose = places(points, '9.3', width);
  for (const time of [1.2, 2.2]) {
    await page.evaluate((to) => {
      window.animeme.seek(to);
      window.animeme.draw();
    }, time);
    report.said.push(await page.evaluate('document.querySelector("#now b").textContent'));
  }
  await page.screenshot(path.join(folder, 'people.png'));
  return report;
}

async function other(page, file, folder) {
  await page.resize(390, 844);
  await open(page, file, '?frame=0&mode=first');
  const list =
      await page.evaluate(`[...document.getElementById('heads').options].map((o) => o.text)`);
  await page.evaluate(`document.getElementById('heads').focus()`);
  await press(page, 'ArrowDown', 'ArrowDown', 40);
  await page.wait(
      `window.animeme.state().whose === document.getElementById('heads').options[1].text`);
  await vertices(page, folder);
  await page.screenshot(path.join(folder, 'other.png'));
  return {list, state: await page.evaluate('window.animeme.state()')};
}

const TAP = `registerProcessor('tap', class extends AudioWorkletProcessor {
  process([[samples]]) {
    for (let i = 0; samples && i < samples.length; ++i) {
      const time = currentTime + i / sampleRate;
      if (this.burst && time >= this.burst.time + 0.08) {
        this.port.postMessage(this.burst);
        this.burst = null;
      }
      if (this.burst && this.last < 0 && samples[i] >= 0) ++this.burst.periods;
      this.last = samples[i];
      if (Math.abs(samples[i]) < 0.15 || time < (this.quiet || 0)) continue;
      this.quiet = time + 0.45;
      this.burst = {time, periods: 0};
    }
    return true;
  }
})`;

// Runs in the page: when clicks leave the player, and which frame is drawn at which time.
async function listen(tap, seconds, change = Infinity) {
  const {animeme} = window;
  animeme.play();
  const context = animeme.context();
  await context.audioWorklet.addModule('data:text/javascript,' + encodeURIComponent(tap));
  animeme.pause();
  animeme.seek(0);
  const node = new AudioWorkletNode(context, 'tap');
  const bursts = [];
  const pictures = new Map();
  node.port.onmessage = (event) => bursts.push(event.data);
  animeme.output().connect(node);
  animeme.play();
  const end = performance.now() + 60000;
  while (animeme.state().position < seconds && performance.now() < end) {
    await new Promise((next) => setTimeout(next, 5));
    const {playing, frame, clock, lang, position} = animeme.state();
    if (playing) pictures.set(clock, {frame, clock, lang,
        said: document.getElementById('now').textContent});
    if (position < change) continue;
    change = Infinity;
    const menu = document.getElementById('tracks');
    menu.value = '1';
    menu.dispatchEvent(new Event('change'));
  }
  animeme.pause();
  await new Promise((next) => setTimeout(next, 300));
  return {
    clicks: bursts.map((burst) => burst.time), pitches: bursts.map((burst) => burst.periods / 0.08),
    pictures: [...pictures.values()], latency: context.outputLatency, state: animeme.state(),
  };
}

async function hear(page, file, query, seconds) {
  await page.resize(240, 480);
  await page.send('Page.setBypassCSP', {enabled: true});
  await open(page, file, query);
  return page.evaluate(listen, TAP, seconds);
}

async function tracks(page, file) {
  await page.resize(240, 480);
  await page.send('Page.setBypassCSP', {enabled: true});
  await open(page, file, '?nohead&mode=first');
  const list =
      await page.evaluate(`[...document.getElementById('tracks').options].map((o) => o.text)`);
  const report = {list, ...await page.evaluate(listen, TAP, 5.5, 2.5)};
  await page.evaluate('window.animeme.showTrack(0)');
  report.back = await page.evaluate('window.animeme.state()');
  await open(page, file, '?nohead&lang=de');
  report.asked = await page.evaluate('window.animeme.state()');
  return report;
}

const sound = (page, file) => hear(page, file, '?mode=first', 10.4);

async function speeds(page, file) {
  const report = {};
  for (const speed of ['0.5', '2']) {
    report[speed] = await hear(page, file, `?nohead&speed=${speed}`, 3.4);
  }
  return report;
}

const LOOK_AT_TEXTS = `(() => ({
  hacked: typeof window.hacked, title: document.title,
  heading: document.getElementById('title').textContent,
  name: document.getElementById('name1').textContent,
  now: document.getElementById('now').textContent,
  spoken: document.querySelector('#now b').textContent,
  readout: document.getElementById('readout').textContent,
  images: document.images.length, scripts: document.scripts.length,
}))()`;

async function texts(page, file, folder) {
  await page.resize(700, 500);
  // As in browsers before 2023.
  await page.send('Page.addScriptToEvaluateOnNewDocument',
      {source: 'delete window.DecompressionStream'});
  await open(page, file, '?t=0.1');
  const report = {texts: await page.evaluate(LOOK_AT_TEXTS), modes: {}};
  for (const mode of ['first', 'second', 'side', 'ghost', 'heat']) {
    await page.evaluate(`document.querySelector('[name=mode][value=${mode}]').click()`);
    await page.evaluate('window.animeme.draw()');
    await page.screenshot(path.join(folder, `${mode}.png`));
    report.modes[mode] = (await page.evaluate('window.animeme.state()')).mode;
  }
  for (const key of [' ', 'k', 'ArrowRight', 'w', 'p', 'i', '[', ']', 'o', 'r', '?']) {
    await page.send('Input.dispatchKeyEvent',
        {type: 'keyDown', key, text: key.length === 1 ? key : undefined});
    await page.send('Input.dispatchKeyEvent', {type: 'keyUp', key});
  }
  report.keys = await page.evaluate('window.animeme.state()');
  report.help = await page.evaluate(`document.getElementById('keys').open`);
  await open(page, file, '?nohead&frame=3&faps=3,51&speed=0.5&loop=0.2-0.4');
  report.nohead = await page.evaluate('window.animeme.state()');
  await page.evaluate('window.animeme.play()');
  await sleep(300);
  report.played = await page.evaluate('window.animeme.state()');
  return report;
}

// Runs in the page.
function saidAt(time) {
  window.animeme.seek(time);
  window.animeme.draw();
  const text = (part) => (document.querySelector(`#now ${part}`) || {textContent: ''}).textContent;
  return {line: document.getElementById('now').textContent, spoken: text('b'), phone: text('i')};
}

// Runs in the page, which shows the time from 0 on, 200 pixels a second. Below the ruler.
function waveAt(times) {
  const canvas = document.getElementById('curves');
  const scale = canvas.width / canvas.clientWidth;
  const [top, height] = [22, 34].map((y) => Math.round(y * scale));
  const {data} = canvas.getContext('2d').getImageData(0, top, canvas.width, height);
  return times.map((time) => {
    const x = Math.round(time * 200 * scale);
    const inked = [...Array(height).keys()].filter((y) => data[4 * (y * canvas.width + x) + 3] > 0);
    return inked.length / scale;
  });
}

async function says(page, file, folder) {
  await page.resize(1280, 720);
  await open(page, file, '?mode=first&faps=3');
  const report = {said: {}, wave: await page.evaluate(waveAt, [0.55, 1.1, 1.55, 2.1])};
  for (const time of [0.5, 0.8, 1.15, 1.3, 2.5, 3.1]) report.said[time] =
      await page.evaluate(saidAt, time);
  await page.evaluate(saidAt, 1.15);
  await page.screenshot(path.join(folder, 'says.png'));
  return report;
}

const SCREENS = [
  {width: 1280, height: 800}, {width: 700, height: 620},
  {width: 390, height: 844, touch: true}, {width: 320, height: 568, touch: true},
  {width: 844, height: 390, touch: true}, {width: 667, height: 375, touch: true},
];

// Runs in the page.
function measure() {
  const shown = (element) => element.getClientRects().length > 0;
  const named = [...document.querySelectorAll(
      'main button, main select, main #slider, main #search, main label, .clock, .name, #readout, #now, #legend')]
      .filter((element) => shown(element) && !element.matches('label.speed'));
  const found = named.map((element) => ({
    name: element.id || element.textContent.trim(), box: element.getBoundingClientRect(),
    target: element.matches('button, select, input, label'),
    listed: Boolean(element.closest('#list')),
  }));
  const names = ({name}) => name;
  const meet = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 0.5 &&
      Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 0.5;
  const placed = found.filter(({listed}) => !listed);
  const overlaps = placed.flatMap((a, i) => placed.slice(i + 1)
      .filter((b) => meet(a.box, b.box)).map((b) => [a.name, b.name]));
  return {
    legend: getComputedStyle(document.getElementById('legend')).display,
    width: document.documentElement.scrollWidth, overlaps,
    outside: found.filter(({box}) => box.left < -0.5 || box.right > innerWidth + 0.5).map(names),
    targets: found.filter(({target}) => target).map(
        ({name, box}) => ({name, width: box.width, height: box.height})),
  };
}

// Runs in the page, which shows one head then, as large as it can be.
function lowest() {
  document.querySelector('[name=mode][value=first]').click();
  window.animeme.draw();
  const {top} = document.getElementById('viewport').getBoundingClientRect();
  return {
    chin: window.animeme.points().find(({id}) => id === '2.1').y + top,
    said: document.getElementById('now').getBoundingClientRect().top,
  };
}

async function screens(page, file, folder) {
  const report = {};
  for (const {width, height, touch = false} of SCREENS) {
    const mode = width > height ? '&mode=heat' : '';
    await page.send('Emulation.setTouchEmulationEnabled', {enabled: touch, maxTouchPoints: 5});
    await page.send('Emulation.setDeviceMetricsOverride',
        {width, height, deviceScaleFactor: 1, mobile: touch});
    await open(page, file, `?t=0.1&loop=0.2-0.4&faps=3,48${mode}`);
    await page.evaluate('window.animeme.draw()');
    await page.screenshot(path.join(folder, `${width}x${height}.png`));
    report[`${width}x${height}`] = {touch, ...await page.evaluate(measure),
        ...await page.evaluate(lowest)};
  }
  return report;
}

async function picture(page, file, folder, zoom = 1) {
  await page.resize(500, 700);
  await open(page, file, `?frame=0&mode=first&left=20&zoom=${zoom}`);
  await page.evaluate('window.animeme.draw()');
  const box = await page.evaluate(`(() => {
    const {left, top, width, height} = document.getElementById('picture').getBoundingClientRect();
    return {left, top, width, height};
  })()`);
  const whole = readPng(await page.screenshot(path.join(folder, 'picture.png')));
  const [left, top, width, height] = [box.left, box.top, box.width, box.height].map(Math.round);
  const rgb = Buffer.alloc(width * height * 3);
  for (let y = 0, at = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x, at += 3) {
      const from = ((y + top) * whole.width + x + left) * whole.channels;
      for (let k = 0; k < 3; ++k) rgb[at + k] = whole.data[from + k];
    }
  }
  fs.writeFileSync(path.join(folder, 'picture.rgb'), rgb);
  return {width, height};
}

const closeup = (page, file, folder) => picture(page, file, folder, 9);

async function live(page, file) {
  await page.resize(300, 300);
  await page.goto(pathToFileURL(file).href);
  return {result: await page.wait('window.result', {seconds: 120})};
}

async function main([kind, file, folder]) {
  const browser = await launch({flags: FLAGS});
  try {
    const page = await browser.open();
    const report = await {looks, other, people, tracks, sound, speeds, texts, says, screens, axe,
        sheet, picture, closeup, live}[kind](page, path.resolve(file), folder, open);
    report.messages = page.messages;
    process.stdout.write(JSON.stringify(report) + '\n');
  } finally {
    await browser.close();
  }
}

main(process.argv.slice(2)).catch((error) => {
  console.error(error);
  process.exitCode = 1;
});
