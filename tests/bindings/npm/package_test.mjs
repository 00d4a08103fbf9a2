// package_test.mjs PACKAGE SOURCE: what is packed, how large it is, and that the types name what
// there is.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, symlinkSync,
  writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {dirname, join, resolve} from 'node:path';
import {test} from 'node:test';
import {gzipSync} from 'node:zlib';

const [folder, source] = process.argv.slice(2);
const read = (name) => readFileSync(join(folder, name));
const about = JSON.parse(read('package.json'));
const archive = resolve(folder, '..', `animeme-${about.version}.tgz`);

test('the decoder with ARKit is small', () => {
  // All that index.js imports, and what it loads.
  const files = new Set(['wasm/decoder.wasm']);
  const visit = (name) => {
    if (files.has(name)) return;
    files.add(name);
    for (const [, from] of read(name).toString().matchAll(/from '(\.[^']+)'/g)) visit(
        join(dirname(name), from));
  };
  visit('src/index.js');
  const size = gzipSync(Buffer.concat([...files].map(read)), {level: 9}).length;
  console.log(`decoder with ARKit: ${size} bytes in ${files.size} files`);
  assert.ok(size <= 250_000, `${size} bytes`);
});

test('the archive holds what is exported, and nothing else', () => {
  const packed = execFileSync('tar', ['-tzf', archive]).toString().trim().split('\n');
  const names = packed.map((name) => name.replace(/^package\//, ''));
  const targets = Object.values(about.exports).flatMap((each) => typeof each === 'string' ? each :
      Object.values(each));
  for (const target of targets) assert.ok(names.includes(target.replace('./', '')), target);
  const allowed = [/^src\/[a-z0-9]+\.js$/, /^wasm\/(decoder|speaker)\.wasm$/,
      /^model\/(grid_s1\.dam|README\.md)$/,
    /^(index|face)\.d\.ts$/];
  const other = names.filter((name) => !allowed.some((each) => each.test(name)));
  assert.deepEqual(other.sort(), ['LICENSE', 'README.md', 'package.json']);
  for (const name of readdirSync(join(source, 'tools/bindings/npm/src')).filter((each) =>
      each.endsWith('.js'))) {
    assert.ok(names.includes(`src/${name}`), name);
  }
});

test('the types name what the modules export', async () => {
  const types = read('index.d.ts').toString();
  const named = [...types.matchAll(/^export (?:declare )?(?:class|function|const) (\w+)/gm)].map(([,
      name]) => name);
  const module = await import(`${folder}/src/node.js`);
  assert.deepEqual(named.sort(), Object.keys(module).sort());
  await module.ready();
  for (const [, name, body] of types.matchAll(/^export class (\w+)[^{]*\{([^]*?)^\}/gm)) {
    const methods = [...body.matchAll(/^ {2}(?!private|constructor)(?:static )?(\w+)\(/gm)].map(([,
        method]) => method);
    for (const method of methods) {
      assert.equal(typeof (module[name].prototype[method] ?? module[name][method]), 'function',
          `${name}.${method}`);
    }
  }
  const members = /export class AnimemeFace[^{]*\{([^]*?)^\}/m.exec(read('face.d.ts').toString())[
      1];
  const element = read('src/element.js').toString();
  for (const [, member] of members.matchAll(/^ {2}(?:readonly )?(\w+)[(:]/gm)) {
    assert.match(element, new RegExp(`^ {2}(get )?${member}\\(|this\\.${member} = `, 'm'), member);
  }
});

// A project that has installed the archive.
const compiler = `${source}/tests/readers/js/node_modules/typescript/lib/tsc.js`;
const why = existsSync(compiler) ? false : 'typescript is missing (tools/setup.sh full)';
test('a project with types compiles and runs', {skip: why}, (t) => {
  const dir = mkdtempSync(join(tmpdir(), 'animeme-npm-'));
  t.after(() => rmSync(dir, {recursive: true}));
  mkdirSync(join(dir, 'node_modules'));
  execFileSync('tar', ['-xzf', archive, '-C', join(dir, 'node_modules')]);
  symlinkSync('package', join(dir, 'node_modules/animeme'));
  writeFileSync(join(dir, 'package.json'), '{"type": "module"}');
  writeFileSync(join(dir, 'use.ts'), readFileSync(`${source}/tests/bindings/npm/use.ts`));
  const options = ['--strict', '--target', 'es2022', '--module', 'nodenext', '--lib',
      'es2022,dom,dom.iterable'];
  const stdio = ['ignore', 'inherit', 'inherit'];
  execFileSync(process.execPath, [compiler, ...options, join(dir, 'use.ts')], {stdio});
  const said = execFileSync(process.execPath, [join(dir, 'use.js'),
    `${source}/tests/fuzz/corpus/decode/visemes_all.fba`]).toString();
  assert.match(said, /^\d+ frames, jaw [\d.]+\n13 frames of speech\n$/);
});
