// A page in a headless Chromium that asks for pictures and says what it finds: served on 127.0.0.1
// alone.
'use strict';

const {spawn, spawnSync} = require('node:child_process');
const fs = require('node:fs');
const http = require('node:http');
const path = require('node:path');

// ms without a word of the page: the first one waits for all to be compiled
const kPatience = 180000;
const kTypes = {
  '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript',
      '.wasm': 'application/wasm',
};
// WebGL by the processor: the same on all machines.
const kFlags = ['--headless=new', '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader', '--disable-quic', '--no-first-run',
      '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--disable-dev-shm-usage', '--disable-extensions',
  '--disable-background-timer-throttling', '--disable-renderer-backgrounding',
      '--remote-debugging-pipe'];

function findChromium(given) {
  const names = given ? [given] : [process.env.CHROMIUM, 'chromium', 'chromium-browser',
      'google-chrome'];
  for (const name of names.filter(Boolean)) {
    const found = name.includes('/') ? name :
        spawnSync('sh', ['-c', 'command -v "$0"', name]).stdout.toString().trim();
    if (found && fs.existsSync(found)) return found;
  }
  throw new Error(given ? 'there is no ' + given :
      'there is no Chromium; install it, or name it with --chromium');
}

async function bodyOf(request) {
  const parts = [];
  for await (const part of request) parts.push(part);
  return Buffer.concat(parts).toString();
}

// Files of folders and single ones, by the first part of the address.
function fileOf(url, {folders, files}) {
  if (files[url]) return files[url];
  const prefix = Object.keys(folders).find((key) => url.startsWith(key));
  return url.includes('..') || !prefix ? null : folders[prefix] +
      (url.slice(prefix.length) || 'page.html');
}

async function answer(request, response, page, end) {
  const url = request.url;
  if (url === '/settings') {
    response.end(JSON.stringify(page.settings));
  } else if (url === '/picture') {
    const picture = await page.picture();
    if (!picture) return response.writeHead(204).end();
    response.writeHead(200,
        {'x-width': picture.width, 'x-height': picture.height}).end(picture.pixels);
  } else if (url === '/found') {
    page.found(JSON.parse(await bodyOf(request)));
    response.end();
  } else if (url === '/end' || url === '/error') {
    const text = await bodyOf(request);
    response.end();
    end(url === '/end' ? null : new Error(text));
  } else {
    const file = fileOf(url, page);
    if (!file || !fs.existsSync(file)) return response.writeHead(404).end();
    response.writeHead(200,
        {'content-type': kTypes[path.extname(file)] ?? 'application/octet-stream'});
    fs.createReadStream(file).pipe(response);
  }
}

/**
 * Opens page.html and waits until it has ended. `page.picture()` gives the next picture or null,
 * `page.found()`
    takes what is found,
        `page.scratch` is what the name of a folder for Chromium begins with. Rejects with what the
    page said, or if Chromium ends. */
async function openPage(page) {
  const program = findChromium(page.chromium);
  let end, timer;
  const ended =
      new Promise((resolve, reject) => { end = (error) => (error ? reject(error) : resolve()); });
  const server = http.createServer((request, response) => {
    clearTimeout(timer);
    timer = setTimeout(() => end(new Error(`the page said nothing for ${kPatience / 1000} s`)),
        kPatience);
    answer(request, response, page, end).catch((error) => {
      end(error);
      response.writeHead(500).end(error.message);
    });
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const profile = fs.mkdtempSync(page.scratch);
  for (const signal of ['SIGINT', 'SIGTERM', 'SIGHUP']) process.on(signal,
      () => end(new Error('stopped')));
  // It ends by itself if nobody holds the other end of its pipes (3 and 4) any more.
  const chromium = spawn(program, [...kFlags, `--user-data-dir=${profile}`,
    `http://127.0.0.1:${server.address().port}/`],
        {stdio: ['ignore', 'ignore', 'pipe', 'pipe', 'pipe']});
  chromium.stdio[3].on('error', () => {});  // it has gone before it was told to
  let said = '';
  chromium.stderr.on('data', (data) => { said = (said + data).slice(-600); });
  const gone = new Promise((resolve) => {
    chromium.on('error', resolve);
    chromium.on('exit', resolve);
  });
  gone.then((code) => end(new Error(`Chromium has ended (${code}): ${said.trim()}`)));
  try {
    await ended;
  } finally {
    clearTimeout(timer);
    chromium.stdio[3].end('{"id": 1, "method": "Browser.close"}\0');
    const slow = setTimeout(() => chromium.kill('SIGKILL'), 5000);
    await gone;
    clearTimeout(slow);
    server.close();
    server.closeAllConnections?.();
    try {
      fs.rmSync(profile, {recursive: true, force: true, maxRetries: 10, retryDelay: 100});
    } catch {
      // A last process of Chromium may still write there; the table is not its business.
    }
  }
}

module.exports = {openPage};
