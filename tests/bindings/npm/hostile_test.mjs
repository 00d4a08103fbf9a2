// hostile_test.mjs SOURCE: the parts of the package that read files without WebAssembly, given cut
// and mutated ones, wrong types, and tables that claim more than is there: an AnimemeError, soon,
// in little memory.
import assert from 'node:assert/strict';
import {cpSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {test} from 'node:test';

const [source] = process.argv.slice(2);
const dir = mkdtempSync(join(tmpdir(), 'animeme-npm-'));
process.on('exit', () => rmSync(dir, {recursive: true}));
cpSync(join(source, 'tools/bindings/npm/src'), join(dir, 'src'), {recursive: true});
writeFileSync(join(dir, 'package.json'), '{"type": "module"}');
const {Mp4Reader} = await import(join(dir, 'src/mp4.js'));
const {readPlaylist} = await import(join(dir, 'src/hls.js'));
const {readHello, readUnit} = await import(join(dir, 'src/live.js'));
const {addWord} = await import(join(dir, 'src/languages.js'));
const {soundCodec} = await import(join(dir, 'src/movie.js'));
const {Track} = await import(join(dir, 'src/track.js'));

// The same numbers in each run.
let state = 47;
const random = (below) => {
  state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
  return Math.floor(state / 2 ** 32 * below);
};

const refused = (use) => {
  try {
    return use();
  } catch (problem) {
    assert.equal(problem.name, 'AnimemeError', problem.stack);
    assert.ok(problem.message && problem.code);
    return null;
  }
};

const folder = join(source, 'tests/fuzz/corpus/container');
const films = readdirSync(folder).filter((name) => name.endsWith('.mp4')).map((name) =>
    new Uint8Array(readFileSync(join(folder, name))));
const isFace = (bytes) => refused(() => { const reader = new Mp4Reader(); reader.push(bytes);
    return reader.track; });
const faces = films.filter(isFace);

// All units of a file that comes in pieces.
function read(bytes, piece) {
  const reader = new Mp4Reader(), units = [];
  for (let at = 0; at < bytes.length;
      at += piece) units.push(...reader.push(bytes.subarray(at, at + piece)));
  reader.finish();
  return units;
}

test('there are faces among the seeds', () => assert.ok(faces.length >= 3,
    `${faces.length} of ${films.length}`));

test('a cut file gives no more than the whole one, or says what is missing', () => {
  for (const bytes of faces) {
    const whole = read(bytes, bytes.length).length;
    for (let end = 0; end < bytes.length; end += 1 + random(97)) {
      const units = refused(() => read(bytes.subarray(0, end), 1 + random(2000)));
      assert.ok(!units || units.length <= whole);
    }
  }
});

test('mutated files', () => {
  for (let i = 0; i < 4000; ++i) {
    const bytes = faces[random(faces.length)].slice();
    for (let left = [1, 1, 3, 20][random(4)]; left > 0; --left) {
      const at = random(bytes.length);
      if (random(3) === 0) bytes.set([0xFF, 0xFF, 0xFF, 0xFF].slice(0, bytes.length - at), at);
      else bytes[at] = random(256);
    }
    refused(() => read(bytes, 1 + random(5000)));
    refused(() => soundCodec(bytes));
  }
});

const box = (type, ...parts) => {
  const content = Buffer.concat(parts.map((part) => Buffer.from(part)));
  const head = Buffer.alloc(8);
  head.writeUInt32BE(8 + content.length);
  head.write(type, 4, 'latin1');
  return Buffer.concat([head, content]);
};
const words = (...values) => Buffer.concat(values.map((value) => {
  const word = Buffer.alloc(4);
  word.writeUInt32BE(value >>> 0);
  return word;
}));

const config = [0, 0, 1, 0xB5, 0x20];  // a face
const descriptor = (tag, ...parts) => {
  const content = Buffer.concat(parts.map((part) => Buffer.from(part)));
  return Buffer.concat([Buffer.from([tag, content.length]), content]);
};
const esds = box('esds', words(0), descriptor(3, [0, 1, 0],
    descriptor(4, [0x20], Buffer.alloc(12), descriptor(5, config, [0]))));
const film = (stsz, stts, rest = []) => Buffer.concat([
  box('ftyp', Buffer.from('isom')),
  box('moov', box('trak', box('tkhd', words(0, 0, 0, 1)),
      box('mdia', box('mdhd', words(0, 0, 0, 1000)),
    box('minf', box('stbl', box('stsd', words(0, 1), box('mp4v', Buffer.alloc(78), esds)), stsz,
        stts,
      box('stsc', words(0, 1, 1, 0xFFFFFFFF, 1)), box('stco', words(0, 1, 0)))))), ...rest)]);
const mvex = box('mvex', box('trex', words(0, 1, 1, 40, 1, 0)));
const nothing = [box('stsz', words(0, 0, 0)), box('stts', words(0, 0))];
const refusedAs = (bytes, what) => assert.throws(() => read(new Uint8Array(bytes), 1 << 20),
    {name: 'AnimemeError', message: what});

test('tables that claim more than is there', () => {
  assert.equal(new Mp4Reader().push(new Uint8Array(film(...nothing))).length, 0);  // it is a face
  const before = process.memoryUsage().heapUsed;
  for (const same of [1, 0, 0xFFFFFFFF]) {
    refusedAs(film(box('stsz', words(0, same, 0xFFFFFFFF)),
        box('stts', words(0, 1, 0xFFFFFFFF, 1))), /too many samples/);
  }
  refusedAs(film(box('stsz', words(0, 1, 9_000_000)), box('stts', words(0, 1, 9_000_000, 1))),
      /too many samples/);
  const run = box('trun', words(0, 1_000_000));
  const fragment = (size, ...runs) => box('moof', box('traf', box('tfhd', words(16, 1, size)),
      ...runs));
  const open = film(...nothing, [mvex]);
  refusedAs(Buffer.concat([open, fragment(0, run)]), /a fragment/);
  refusedAs(Buffer.concat([open, fragment(1, run, run)]), /a fragment/);
  refusedAs(Buffer.concat([open, fragment(9, run), fragment(9, run)]), /wait for their bytes/);
  assert.ok(process.memoryUsage().heapUsed - before < 800e6);
});

test('an hour of frames is added at once', () => {
  const frames = Array.from({length: 200_000}, (_, number) => ({time: number / 50, rate: [50, 1]}));
  const track = new Track();
  track.add(frames.slice(100_000));
  track.add(frames.slice(0, 100_000));
  track.add([]);
  assert.equal(track.frames.length, frames.length);
  assert.ok(track.frames.every((frame, i) => frame === frames[i]));
  assert.equal(track.at(2000.01), frames[100_000]);
});

test('wrong types', () => {
  for (const odd of [undefined, null, 0, NaN, 'abc', [], {}, [1, 2], new ArrayBuffer(8),
      new DataView(new ArrayBuffer(8)), () => 0]) {
    assert.throws(() => new Mp4Reader().push(odd), {name: 'AnimemeError',
        code: 'invalid_argument'});
  }
  assert.deepEqual(new Mp4Reader().push(new Uint8Array(0)), []);
});

test('playlists', () => {
  const url = 'http://a.b/c.m3u8';
  const good =
      '#EXTM3U\n#EXT-X-MAP:URI="init.mp4"\n#EXTINF:2.5,\n0.m4s\n#EXTINF:1,\n1.m4s\n#EXT-X-ENDLIST\n';
  assert.deepEqual(readPlaylist(good, url).segments.map(({end}) => end), [2.5, 3.5]);
  for (const bad of ['', 'x', good.replace('2.5', 'x'), good.replace('2.5', '-1'),
      good.replace('2.5', '1e308'),
                     good.replace('0.m4s', 'http://:x'), good.replace('init.mp4', 'http://[')]) {
    assert.throws(() => readPlaylist(bad, url), {name: 'AnimemeError', code: 'syntax'}, bad);
  }
  for (let i = 0; i < 3000; ++i) {
    const letters = [...good];
    for (let left = 1 + random(6); left > 0; --left) {
      const at = random(letters.length);
      letters[at] = random(2) ? String.fromCharCode(random(128)) :
          letters.slice(at, at + random(30)).join('').repeat(2);
    }
    refused(() => readPlaylist(letters.join(''), url));
  }
  assert.equal(readPlaylist(`#EXTM3U\n${'#EXTINF:1,\na\n'.repeat(100_000)}`, url).segments.length,
      100_000);
  refused(() => readPlaylist(`#EXTM3U\n#EXT-X-MEDIA:${'A='.repeat(200_000)}`, url));
  refused(() => readPlaylist(`#EXTM3U\n#EXT-X-MEDIA:${'A'.repeat(400_000)}`, url));
});

test('messages of servers', () => {
  for (let i = 0; i < 5000; ++i) {
    const bytes = Uint8Array.from({length: random(40)}, () => random(256));
    if (random(2)) bytes.set([0x41, 1].slice(0, bytes.length));
    refused(() => readHello(bytes));
    const unit = refused(() => readUnit(bytes, 1 + random(1000)));
    assert.ok(!unit || Number.isFinite(unit.time));
  }
});

test('words of any script become lines', () => {
  const line = (words) => {
    const lines = [];
    words.forEach((text, i) => addWord(lines, {start: i / 4, end: i / 4 + 0.2, text}));
    return lines.map(({text}) => text);
  };
  assert.deepEqual(line(['Hello,', 'there.', 'Yes']), ['Hello, there.', 'Yes']);
  assert.deepEqual(line(['我', '是，', '人。']), ['我是，人。']);
  assert.deepEqual(line(['ฉัน', 'รัก']), ['ฉันรัก']);
  assert.deepEqual(line(['한국', '사람']), ['한국 사람']);
  assert.deepEqual(line(['Hi,', '你']), ['Hi, 你']);
  assert.deepEqual(line(['我', 'love', '你']), ['我 love 你']);
  assert.deepEqual(line(['', '你']).length, 1);
});
