// node page_axe.js PAGE.html WIDTH... [--pictures FOLDER]: what axe-core finds wrong with a page, at
// some widths, light and dark, as JSON: {checked: how many elements passed each time, violations:
// [texts], wide: [{width, needs}] (pages that scroll sideways)}.
'use strict';

const fs = require('fs');
const path = require('path');
const {pathToFileURL} = require('url');
const {launch} = require('./browser');

const HEIGHT = 900;

// Runs in the page.
async function judged() {
  const {passes, violations} = await window.axe.run({resultTypes: ['violations', 'passes']});
  return {
    checked: passes.reduce((sum, {nodes}) => sum + nodes.length, 0),
    violations: violations.flatMap(({id, nodes}) =>
      nodes.map(({target, failureSummary}) => `${id}: ${target} ${failureSummary}`)),
  };
}

async function main(file, words) {
  const at = words.indexOf('--pictures');
  const folder = at >= 0 ? words[at + 1] : null;
  const widths = (at >= 0 ? words.slice(0, at) : words).map(Number);
  const source = fs.readFileSync(require.resolve('./node_modules/axe-core/axe.min.js'), 'utf8');
  const browser = await launch();
  const report = {checked: [], violations: [], wide: []};
  try {
    for (const width of widths) {
      for (const theme of ['light', 'dark']) {
        const page = await browser.open('about:blank');
        await page.send('Page.setBypassCSP', {enabled: true});
        await page.resize(width, HEIGHT);
        await page.send('Emulation.setEmulatedMedia',
            {features: [{name: 'prefers-color-scheme', value: theme}]});
        await page.goto(pathToFileURL(file).href);
        await page.evaluate(`${source}; true`);
        const {checked, violations} = await page.evaluate(judged);
        report.checked.push(checked);
        report.violations.push(...violations.map((text) => `${width} ${theme}: ${text}`));
        const needs = await page.evaluate('document.documentElement.scrollWidth');
        if (needs > width) report.wide.push({width, needs});
        if (folder) await page.screenshot(path.join(folder, `${width}_${theme}.png`));
        await page.close();
      }
    }
  } finally {
    await browser.close();
  }
  return report;
}

main(process.argv[2], process.argv.slice(3)).then(
    (report) => console.log(JSON.stringify(report)),
    (error) => {
      console.error(error.message);
      process.exit(1);
    });
