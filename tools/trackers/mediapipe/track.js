#!/usr/bin/env node
// Face landmarks of a video as a table: ffmpeg decodes, MediaPipe in a headless Chromium looks.
'use strict';

const {spawn, spawnSync} = require('node:child_process');
const fs = require('node:fs');
const http = require('node:http');
const os = require('node:os');
const path = require('node:path');

const kPoints = 478;
const kUsage = 'usage: track.js --model face_landmarker.task [--shapes] [--confidence 0.5]\n' +
    '                [--chromium PATH] VIDEO TABLE.csv';

function fail(text, code = 1) {
  process.stderr.write('track.js: ' + text + '\n');
  process.exit(code);
}

function parseArguments(list) {
  const options = {shapes: false, confidence: 0.5, files: []};
  for (let i = 0; i < list.length; ++i) {
    const value = () => list[++i] ?? fail(list[i - 1] + ' wants a value\n' + kUsage, 2);
    if (list[i] === '--model') options.model = value();
    else if (list[i] === '--chromium') options.chromium = value();
    else if (list[i] === '--confidence') options.confidence = Number(value());
    else if (list[i] === '--shapes') options.shapes = true;
    else if (list[i] === '--help') { console.log(kUsage); process.exit(0); }
    else if (list[i].startsWith('--')) fail('unknown option ' + list[i] + '\n' + kUsage, 2);
    else options.files.push(list[i]);
  }
  if (options.files.length !== 2 || !options.model) fail(kUsage, 2);
  if (!fs.existsSync(options.model)) {
    fail('there is no model ' + options.model + '; fetch face_landmarker.task (see README.md)');
  }
  if (!(options.confidence >= 0 && options.confidence <= 1)) fail('--confidence is 0 to 1', 2);
  return options;
}

function findPackages() {
  try {
    const vision = path.dirname(require.resolve('@mediapipe/tasks-vision'));
    return {vision, puppeteer: require('puppeteer-core')};
  } catch (error) {
    return fail('npm packages are missing; run npm install in ' + __dirname);
  }
}

function findChromium(given) {
  const names = given ? [given] : [process.env.CHROMIUM, 'chromium', 'chromium-browser', 'google-chrome'];
  for (const name of names.filter(Boolean)) {
    const found = name.includes('/') ? name :
        spawnSync('sh', ['-c', 'command -v "$0"', name]).stdout.toString().trim();
    if (found && fs.existsSync(found)) return found;
  }
  return fail('there is no Chromium; install it, or name it with --chromium');
}

// Frames a second as ffprobe has them, "30000/1001".
function frameRate(video) {
  const probe = spawnSync('ffprobe', ['-v', 'error', '-select_streams', 'v:0', '-show_entries',
    'stream=avg_frame_rate,r_frame_rate', '-of', 'json', video]);
  if (probe.error) fail('ffprobe cannot be started; install ffmpeg');
  if (probe.status !== 0) fail(probe.stderr.toString().trim());
  const stream = JSON.parse(probe.stdout).streams?.[0];
  if (!stream) fail('there is no picture in ' + video);
  for (const text of [stream.avg_frame_rate, stream.r_frame_rate]) {
    const [num, den] = String(text).split('/').map(Number);
    if (num > 0 && den > 0) return {text, value: num / den};
  }
  return fail('ffprobe does not tell the frame rate of ' + video);
}

// The pictures of a video as they are shown: upright, square pixels, at a constant rate from the
// first one on. Each has a header of its own (PAM), so that nobody has to know its size.
async function* frames(video, rate) {
  const ffmpeg = spawn('ffmpeg', ['-v', 'error', '-nostdin', '-i', video, '-map', '0:v:0', '-vf',
    `setpts=PTS-STARTPTS,fps=${rate}:start_time=0,scale=iw*sar:ih,setsar=1`,
    '-f', 'image2pipe', '-c:v', 'pam', '-pix_fmt', 'rgba', '-'],
    {stdio: ['ignore', 'pipe', 'pipe']});
  let said = '';
  ffmpeg.stderr.on('data', (data) => { said = (said + data).slice(-2000); });
  const ended = new Promise((resolve) => ffmpeg.on('close', resolve));
  let waiting = Buffer.alloc(0);
  for await (const data of ffmpeg.stdout) {
    waiting = Buffer.concat([waiting, data]);
    for (;;) {
      const end = waiting.subarray(0, 256).indexOf('ENDHDR\n');
      if (end < 0) break;
      const header = waiting.subarray(0, end).toString();
      const width = Number(/WIDTH (\d+)/.exec(header)[1]);
      const height = Number(/HEIGHT (\d+)/.exec(header)[1]);
      const begin = end + 7;
      const size = width * height * 4;
      if (waiting.length < begin + size) break;
      yield {width, height, pixels: Buffer.from(waiting.subarray(begin, begin + size))};
      waiting = waiting.subarray(begin + size);
    }
  }
  if (await ended !== 0) throw new Error('ffmpeg: ' + said.trim());
}

// Writes the table beside its place and gives it its name at the end.
class Table {
  constructor(file, options, rate) {
    this.file = file;
    this.part = file + '.part';
    this.options = options;
    this.rate = rate;
    this.rows = [];
    this.names = [];
  }
  add({row, names}) {
    if (names.length > 0) this.names = names;
    this.rows.push(row);
  }
  header() {
    if (this.options.shapes) return ['time_s', ...this.names].join();
    const columns = ['time_s', 'confidence'];
    for (let i = 0; i < kPoints; ++i) columns.push(`x_${i}`, `y_${i}`, `z_${i}`);
    return columns.join();
  }
  finish() {
    if (!this.rows.some((row) => row !== null)) fail('no face was found in any frame');
    const out = fs.openSync(this.part, 'w');
    fs.writeSync(out, this.header() + '\n');
    this.rows.forEach((row, i) => {
      const time = (i / this.rate).toFixed(6);
      if (this.options.shapes) {
        if (row !== null) fs.writeSync(out, `${time},${row}\n`);
      } else {
        fs.writeSync(out, row === null ? `${time},0${','.repeat(3 * kPoints)}\n` : `${time},1,${row}\n`);
      }
    });
    fs.fsyncSync(out);
    fs.closeSync(out);
    fs.renameSync(this.part, this.file);
    const faces = this.rows.filter((row) => row !== null).length;
    process.stderr.write(`track.js: ${faces} faces in ${this.rows.length} frames\n`);
  }
}

function serve(options, vision, source, table, done) {
  const types = {'.mjs': 'text/javascript', '.js': 'text/javascript', '.wasm': 'application/wasm'};
  const send = (response, file) => {
    response.setHeader('content-type', types[path.extname(file)] ?? 'application/octet-stream');
    fs.createReadStream(file).on('error', () => response.writeHead(404).end()).pipe(response);
  };
  const body = async (request) => {
    const parts = [];
    for await (const part of request) parts.push(part);
    return Buffer.concat(parts).toString();
  };
  const server = http.createServer(async (request, response) => {
    const url = request.url;
    if (url === '/') {
      response.setHeader('content-type', 'text/html');
      fs.createReadStream(path.join(__dirname, 'page.html')).pipe(response);
    } else if (url === '/settings') {
      response.end(JSON.stringify({shapes: options.shapes, confidence: options.confidence}));
    } else if (url === '/model') {
      send(response, options.model);
    } else if (url.startsWith('/vision/') && !url.includes('..')) {
      send(response, path.join(vision, url.slice('/vision/'.length)));
    } else if (url === '/frame') {
      try {
        const next = await source.next();
        if (next.done) return response.writeHead(204).end();
        response.setHeader('x-width', next.value.width);
        response.setHeader('x-height', next.value.height);
        response.end(next.value.pixels);
      } catch (error) {
        response.writeHead(500).end(String(error.message));
      }
    } else if (url === '/row') {
      table.add(JSON.parse(await body(request)));
      response.end();
    } else if (url === '/end' || url === '/error') {
      const text = await body(request);
      response.end();
      done(url === '/end' ? null : text);
    } else {
      response.writeHead(404).end();
    }
  });
  return new Promise((resolve) => server.listen(0, '127.0.0.1', () => resolve(server)));
}

async function main() {
  const options = parseArguments(process.argv.slice(2));
  const [video, out] = options.files;
  const {vision, puppeteer} = findPackages();
  const executablePath = findChromium(options.chromium);
  const rate = frameRate(video);
  const table = new Table(out, options, rate.value);
  let finish;
  const finished = new Promise((resolve) => { finish = resolve; });
  const server = await serve(options, vision, frames(video, rate.text), table, finish);
  const profile = fs.mkdtempSync(path.join(os.tmpdir(), 'animeme-mediapipe-'));
  const browser = await puppeteer.launch({
    executablePath,
    userDataDir: profile,
    pipe: true,
    args: ['--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run',
      '--disable-background-networking', '--disable-component-update', '--disable-sync'],
  });
  let problem;
  try {
    const page = await browser.newPage();
    page.on('pageerror', (error) => finish(String(error.message)));
    browser.on('disconnected', () => finish('Chromium has ended'));
    await page.goto(`http://127.0.0.1:${server.address().port}/`);
    problem = await finished;
  } finally {
    await browser.close();
    server.close();
    fs.rmSync(profile, {recursive: true, force: true});
  }
  if (problem) fail(problem);
  table.finish();
  process.exit(0);
}

main().catch((error) => fail(String(error && error.message || error)));
