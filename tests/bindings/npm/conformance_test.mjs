// conformance_test.mjs PACKAGE CASES: the whole suite in node.
import assert from 'node:assert/strict';
import {readdirSync, readFileSync, existsSync} from 'node:fs';

import {checkSuite} from './suite.mjs';

const [folder, cases] = process.argv.slice(2);
const animeme = await import(`${folder}/src/node.js`);
await animeme.ready();
const names = readdirSync(cases).filter((name) => existsSync(`${cases}/${name}/case.json`));
const read = (path) => existsSync(`${cases}/${path}`) ?
    new Uint8Array(readFileSync(`${cases}/${path}`)) : null;
const report = await checkSuite(animeme, names, read);
console.log(`${report.cases} cases, ${report.frames} planes, ${report.values} values`);
assert.deepEqual(report.wrong, []);
assert.ok(report.cases >= 225);
