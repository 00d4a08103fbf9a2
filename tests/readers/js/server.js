// A file server on localhost for pages under test.
//
//     const server = await serve({'/lib/': 'node_modules/mp4box/dist', '/': folder});
//     server.url                                       // 'http://127.0.0.1:PORT/'
//     await server.close();
//
// The longest prefix that fits an address names the folder. Range requests are answered, since
// browsers seek by them. Nothing outside the folders is given out.
'use strict';

const fs = require('fs');
const http = require('http');
const path = require('path');

const TYPES = {
  '.html': 'text/html; charset=utf-8', '.js': 'text/javascript', '.mjs': 'text/javascript',
  '.css': 'text/css',
  '.json': 'application/json', '.svg': 'image/svg+xml', '.png': 'image/png',
  '.glb': 'model/gltf-binary', '.wasm': 'application/wasm',
  '.mp4': 'video/mp4', '.m4a': 'audio/mp4', '.m4s': 'video/iso.segment', '.mkv': 'video/x-matroska',
  '.mka': 'audio/x-matroska', '.webm': 'video/webm', '.opus': 'audio/ogg', '.wav': 'audio/wav',
      '.ts': 'video/mp2t',
  '.m3u8': 'application/vnd.apple.mpegurl', '.mpd': 'application/dash+xml',
};

function fileOf(url, folders) {
  const name = decodeURIComponent(new URL(url, 'http://localhost').pathname);
  const prefix = Object.keys(folders).filter((p) => name.startsWith(p))
      .sort((a, b) => b.length - a.length)[0];
  if (prefix === undefined) return null;
  const root = path.resolve(folders[prefix]);
  const file = path.join(root, name.slice(prefix.length));
  const inside = file === root || file.startsWith(root + path.sep);
  return inside && fs.statSync(file, {throwIfNoEntry: false})?.isFile() ? file : null;
}

function answer(request, response, folders) {
  const file = fileOf(request.url, folders);
  if (file === null) {
    response.writeHead(404).end();
    return;
  }
  const bytes = fs.readFileSync(file);
  const headers = {
    'Content-Type': TYPES[path.extname(file)] || 'application/octet-stream',
    'Accept-Ranges': 'bytes', 'Cache-Control': 'no-store',
  };
  const range = /^bytes=(\d+)-(\d*)$/.exec(request.headers.range || '');
  if (!range) {
    response.writeHead(200, {...headers, 'Content-Length': bytes.length}).end(bytes);
    return;
  }
  const from = Number(range[1]);
  const to = Math.min(range[2] === '' ? Infinity : Number(range[2]), bytes.length - 1);
  if (from > to) {
    response.writeHead(416, {...headers, 'Content-Range': `bytes */${bytes.length}`}).end();
    return;
  }
  response.writeHead(206, {
    ...headers, 'Content-Length': to - from + 1,
    'Content-Range': `bytes ${from}-${to}/${bytes.length}`,
  }).end(bytes.subarray(from, to + 1));
}

/** Serves {prefix: folder}. `special`: function (request, response) asked first; true: it has
    answered. */
async function serve(folders, special = () => false) {
  const server = http.createServer((request, response) => {
    if (!special(request, response)) answer(request, response, folders);
  });
  await new Promise((done, fail) => {
    server.on('error', fail);
    server.listen(0, '127.0.0.1', done);
  });
  return {
    url: `http://127.0.0.1:${server.address().port}/`,
    close: () => new Promise((done) => {
      server.close(done);
      server.closeAllConnections?.();
    }),
  };
}

module.exports = {serve};
