// node browser_report.js FOLDER FILE...: what Chromium makes of the media files of a folder, as
// JSON.
//
// For each file: `decoded`, what decodeAudioData() gives ({rate, length}, the samples as 32-bit
// floats in FOLDER/FILE.f32) or {error}; `played`, how an <audio> element plays it; for .mp4
// `mp4box`, what mp4box in the page makes of the fetched file. Playlists (.m3u8, .mpd) have only
// `played`, by the
// Shaka player, which fetches the segments and feeds the element. And `messages`, what the page
// said.
'use strict';

const fs = require('fs');
const path = require('path');
const {launch} = require('./browser');
const {serve} = require('./server');

const PAGE = `<!doctype html><meta charset="utf-8"><title>media</title>
<link rel="icon" href="data:,">
<script src="/mp4box/mp4box.all.js"></script><script src="/js/mp4box_report.js"></script>
<script src="/shaka/shaka-player.compiled.js"></script>`;

// The functions below run in the page.

async function decode(name, rate) {
  const bytes = await (await fetch(name)).arrayBuffer();
  try {
    const sound = await new OfflineAudioContext(1, 1, rate).decodeAudioData(bytes);
    const samples = new Uint8Array(sound.getChannelData(0).buffer);
    let text = '';
    for (let i = 0; i < samples.length; i += 4096) {
      text += String.fromCharCode(...samples.subarray(i, i + 4096));
    }
    return {rate: sound.sampleRate, length: sound.length, samples: btoa(text)};
  } catch (error) {
    return {error: String(error)};
  }
}

// Plays until `seconds` are heard, with the times that the element shows.
async function play(name, seconds) {
  const audio = new Audio();
  const times = [];
  const playlist = /\.(m3u8|mpd)$/.test(name);
  const player = playlist ? new shaka.Player() : null;
  try {
    if (player) {
      await player.attach(audio);
      await player.load(name);
    } else {
      audio.src = name;
    }
    await audio.play();
    while (!audio.error && !audio.ended && audio.currentTime < seconds) {
      await new Promise((next) => requestAnimationFrame(next));
      if (audio.currentTime !== times[times.length - 1]) times.push(audio.currentTime);
    }
  } catch (error) {
    return {error: (audio.error && audio.error.message) || error.message || String(error)};
  }
  audio.pause();
  return {
    error: audio.error && audio.error.message, duration: audio.duration, steps: times.length,
    ascending: times.every((time, i) => i === 0 || time > times[i - 1]),
    heard: times[times.length - 1],
    tracks: player && player.getVariantTracks().map((track) => track.codecs),
  };
}

async function parse(name) {
  const bytes = await (await fetch(name)).arrayBuffer();
  const hex = (part) => Array.from(part, (byte) => byte.toString(16).padStart(2, '0')).join('');
  return mp4boxReport(MP4Box, bytes, hex);
}

async function look(page, folder, name) {
  if (/\.(m3u8|mpd)$/.test(name)) return {};
  const decoded = await page.evaluate(decode, name, 48000);
  if (decoded.samples) {
    fs.writeFileSync(path.join(folder, name + '.f32'), Buffer.from(decoded.samples, 'base64'));
    delete decoded.samples;
  }
  const mp4box = name.endsWith('.mp4') ? await page.evaluate(parse, name) : null;
  return {decoded, mp4box};
}

async function main([folder, ...names]) {
  const modules = path.join(__dirname, 'node_modules');
  const folders = {
    '/': folder, '/js/': __dirname, '/mp4box/': path.join(modules, 'mp4box/dist'),
    '/shaka/': path.join(modules, 'shaka-player/dist'),
  };
  const server = await serve(folders, (request, response) => {
    if (request.url !== '/') return false;
    response.writeHead(200, {'Content-Type': 'text/html'}).end(PAGE);
    return true;
  });
  const browser = await launch();
  try {
    const page = await browser.open(server.url);
    const report = {browser: browser.version, files: {}};
    for (const name of names) report.files[name] = await look(page, folder, name);
    // All at once: playing takes its time.
    const played = await Promise.all(names.map((name) => page.evaluate(play, name, 1)));
    names.forEach((name, i) => { report.files[name].played = played[i]; });
    report.messages = page.messages;
    process.stdout.write(JSON.stringify(report, null, 1) + '\n');
  } finally {
    await browser.close();
    await server.close();
  }
}

main(process.argv.slice(2)).catch((error) => {
  console.error(error);
  process.exitCode = 1;
});
