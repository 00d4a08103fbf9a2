// What axe-core (npm, in tests/readers/js) finds wrong with a page.
'use strict';

const fs = require('fs');
const path = require('path');
const {pathToFileURL} = require('url');

// Runs in the page.
async function judged() {
  const {passes, violations} = await window.axe.run({resultTypes: ['violations', 'passes']});
  return {
    checked: passes.reduce((sum, {nodes}) => sum + nodes.length, 0),
    violations: violations.flatMap(({id, nodes}) => nodes.map(
        ({target, failureSummary}) => `${id}: ${target} ${failureSummary}`)),
  };
}

function axeSource() {
  return fs.readFileSync(
      require.resolve('../../../readers/js/node_modules/axe-core/axe.min.js'), 'utf8');
}

async function axe(page, file, folder, open) {
  const source = axeSource();
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

// Runs in the page: what reaches beyond the right edge of the window, without what scrolls by
// itself.
function beyond() {
  const edge = document.documentElement.clientWidth + 0.5;
  return [...document.querySelectorAll('main *')].filter((element) =>
    !element.closest('.curves svg') && element.getBoundingClientRect().right > edge)
      .map((element) => `${element.tagName} ${element.textContent.slice(0, 30)}`);
}

async function sheet(page, file, folder) {
  const report = {checked: [], violations: [], widths: [], beyond: []};
  for (const [width, height] of [[1280, 800], [390, 844]]) {
    await page.send('Emulation.setDeviceMetricsOverride',
        {width, height, deviceScaleFactor: 1, mobile: width < 600});
    await page.goto(pathToFileURL(file).href);
    await page.evaluate(axeSource() + '; true');
    for (const theme of ['light', 'dark']) {
      await page.send('Emulation.setEmulatedMedia',
          {features: [{name: 'prefers-color-scheme', value: theme}]});
      const {checked, violations} = await page.evaluate(judged);
      report.checked.push(checked);
      report.violations.push(...violations.map((text) => `${width} ${theme}: ${text}`));
      report.widths.push(width - await page.evaluate('document.documentElement.scrollWidth'));
      report.beyond.push(...await page.evaluate(beyond));
      await page.screenshot(path.join(folder, `sheet_${width}_${theme}.png`));
    }
  }
  return report;
}

module.exports = {axe, sheet};
