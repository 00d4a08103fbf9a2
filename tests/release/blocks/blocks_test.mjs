// blocks_test.mjs PACKAGE BLOCKS SOURCE: the JavaScript examples of the pages, with the variables
// that they use.
import assert from 'node:assert/strict';
import {existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {join} from 'node:path';

const [folder, blocks, source] = process.argv.slice(2);
const animeme = await import(join(folder, 'src/index.js'));
const require = createRequire(import.meta.url);
const samples = join(source, 'tools/release/samples');

// A block as the body of a function of `names`, which returns `results`. Imports are parameters.
async function run(file, names, results) {
  const code = readFileSync(join(blocks, file), 'utf8').replace(/^import .*;$/gm, '');
  const scope = {...animeme, ...names};
  const AsyncFunction = (async () => {}).constructor;
  return new AsyncFunction(...Object.keys(scope),
      `${code}\nreturn {${results}};`)(...Object.values(scope));
}

const file = (name) => readFileSync(join(samples, name));
const fetched = async (name) => ({
  arrayBuffer: async () => Uint8Array.from(file(name === 'hello.mp4' ? 'talk.mp4' : name)).buffer,
});

const {jaw} = await run('README_md.js.1.inc', {fetch: fetched}, 'jaw');
assert(jaw >= 0 && jaw <= 1);

const jaws = [], sets = [];
const {track} = await run('tools_bindings_npm_README_md.js.1.inc', {
  bytes: new Uint8Array(file('talk.fba')), fetch: fetched,
      jaw: (time, value) => jaws.push([time, value]),
  set: (names, weights) => sets.push([names.length, weights.length]),
}, 'track');
assert(jaws.length > 10 && jaws.some(([, value]) => value > 0));
assert(sets.length === track.frames.length && sets.every(([a, b]) => a === b));

const {frames} = await run('tools_bindings_npm_README_md.js.2.inc', {}, 'frames');
assert(frames.length >= 10);

const spoken = [];
await run('tools_bindings_npm_README_md.js.3.inc', {
  track, audioBuffer: {duration: 1}, head: {speakAudio: (speech) => spoken.push(speech)},
}, '');
assert(spoken.length === 2 && spoken[0].visemes.length > 0);

const modules = join(source, 'tests/readers/js');
if (existsSync('/usr/bin/chromium')) {
  const dir = mkdtempSync(join(tmpdir(), 'animeme-blocks-'));
  writeFileSync(join(dir, 'index.html'), '<p id="status">ready</p><canvas></canvas>');
  const {launch} = require(join(modules, 'browser.js'));
  const {serve} = require(join(modules, 'server.js'));
  const before = process.cwd();
  process.chdir(dir);
  const {text} = await run('tests_README_md.js.1.inc', {launch, serve, folder: dir}, 'text');
  process.chdir(before);
  assert.equal(text, 'ready');
  assert(existsSync(join(dir, 'page.png')));
  rmSync(dir, {recursive: true});
}
console.log('the JavaScript of all pages runs');
