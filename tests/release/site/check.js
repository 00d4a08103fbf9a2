// node check.js SITE [PART]: opens every page of a folder in Chromium. Links have to lead to a file
// and, behind #, to something with that name; nothing may come from elsewhere; axe-core has to find
// nothing wrong. With PART: only pages whose name has it. Exit code 1: something is wrong, 77:
// skipped.
'use strict';

const fs = require('fs');
const path = require('path');
const {launch} = require('../../readers/js/browser');
const {serve} = require('../../readers/js/server');

// In the page: where it leads and what it has.
function look() {
  const links =
      [...document.querySelectorAll('a[href], link[href], script[src], img[src], iframe[src]')].map(
      (item) => ({
    to: item.href || item.src, loads: item.tagName !== 'A' && item.rel !== 'canonical',
  }));
  const names = [...document.querySelectorAll('[id], a[name]')].flatMap((item) => [item.id,
      item.name || '']);
  return {links, names, title: document.title};
}

function has_content() {
  return Boolean(document.querySelector('.md-content'));
}

async function axe(whole) {
  const where = whole ? document : document.querySelector('.md-content');
  const {violations} = await window.axe.run(where, {resultTypes: ['violations']});
  return violations.map(({id, nodes}) => ({id, count: nodes.length,
      first: nodes[0].html.slice(0, 160),
    why: nodes[0].failureSummary.split('\n').slice(1, 2).join(' ').trim()}));
}

function pages_of(folder, below = '') {
  return fs.readdirSync(path.join(folder, below), {withFileTypes: true}).flatMap((entry) => {
    const name = path.posix.join(below, entry.name);
    return entry.isDirectory() ? pages_of(folder, name) : name.endsWith('.html') ? [name] : [];
  });
}

async function main() {
  const folder = path.resolve(process.argv[2]), part = process.argv[3] || '';
  let source;
  try {
    source = fs.readFileSync(require.resolve('../../readers/js/node_modules/axe-core/axe.min.js'),
        'utf8');
  } catch (error) {
    console.log(
        'site: Skipped\naxe-core is missing (npm ci in tests/readers/js; tools/setup.sh full does it)');
    return 77;
  }
  const server = await serve({'/': folder});
  const browser = await launch();
  const pages = pages_of(folder).sort();
  const seen = new Map(), wrong = [], rules = new Map();
  const queue = pages.filter((name) => name.includes(part));
  async function work() {
    for (let name; (name = queue.shift()) !== undefined;) {
      const page = await browser.open(server.url + name);
      await page.wait('document.readyState === "complete"');
      seen.set(name, await page.evaluate(look));
      await page.evaluate(source + '; true');
      // What surrounds a page is the same in all folders; it has hundreds of links.
      const whole = path.basename(name) === 'index.html' || !name.includes('/') ||
          !(await page.evaluate(has_content));
      for (const violation of await page.evaluate(axe, whole)) {
        wrong.push(
            `${name}: axe ${violation.id} (${violation.count}): ${violation.first} ${violation.why}`);
        rules.set(violation.id, (rules.get(violation.id) || 0) + 1);
      }
      for (const {type, text} of page.messages) {
        if (type === 'error') wrong.push(`${name}: ${text}`);
      }
      await page.close();
    }
  }
  await Promise.all([work(), work()]);
  let links = 0;
  for (const [name, {links: found, title}] of seen) {
    if (!title) wrong.push(`${name}: has no title`);
    for (const {to, loads} of found) {
      if (!to.startsWith(server.url)) {
        if (loads && !to.startsWith('data:')) wrong.push(`${name}: loads ${to} from elsewhere`);
        continue;
      }
      links += 1;
      const [file, place] = to.slice(server.url.length).split('#');
      const target = decodeURIComponent(file.split('?')[0]) || 'index.html';
      const found = [target, path.posix.join(target, 'index.html')].find((one) => {
        const there = path.join(folder, one);
        return fs.existsSync(there) && fs.statSync(there).isFile();
      });
      if (!found) {
        wrong.push(`${name}: leads to ${target}, which is not there`);
      } else if (place && seen.has(found) &&
          !seen.get(found).names.includes(decodeURIComponent(place))) {
        wrong.push(`${name}: leads to ${found}#${place}, where that name is missing`);
      }
    }
  }
  await browser.close();
  await server.close();
  for (const line of [...new Set(wrong)].slice(0, 60)) console.log(line);
  for (const [id, count] of rules) console.log(`axe ${id}: ${count} pages`);
  console.log(`${seen.size} of ${pages.length} pages, ${links} links, ${wrong.length} faults`);
  return wrong.length || seen.size < 1 ? 1 : 0;
}

main().then((code) => process.exit(code), (error) => {
  console.error(error);
  process.exit(1);
});
