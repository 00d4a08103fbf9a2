// What axe-core (npm, in tests/readers/js) finds wrong with a page.
'use strict';

const fs = require('fs');

// Runs in the page.
async function judged() {
  const {passes, violations} = await window.axe.run({resultTypes: ['violations', 'passes']});
  return {
    checked: passes.reduce((sum, {nodes}) => sum + nodes.length, 0),
    violations: violations.flatMap(({id, nodes}) => nodes.map(
        ({target, failureSummary}) => `${id}: ${target} ${failureSummary}`)),
  };
}

async function axe(page, file, folder, open) {
  const source =
      fs.readFileSync(require.resolve('../../../readers/js/node_modules/axe-core/axe.min.js'),
      'utf8');
  const report = {checked: [], violations: []};
  const judge = async (where) => {
    const {checked, violations} = await page.evaluate(judged);
    report.checked.push(checked);
    report.violations.push(...violations.map((text) => `${where}: ${text}`));
  };
  for (const [width, height] of [[1280, 800], [390, 844]]) {
    await page.resize(width, height);
    await open(page, file, '?t=0.1&loop=0.2-0.4&faps=3,48&mode=heat');
    await page.evaluate(source + '; true');
    for (const theme of ['light', 'dark']) {
      await page.evaluate(`document.documentElement.dataset.theme = '${theme}'`);
      await judge(`${width}x${height} ${theme}`);
    }
    await page.evaluate(`document.getElementById('help').click()`);
    await judge(`${width}x${height} help`);
  }
  return report;
}

module.exports = {axe};
