#!/usr/bin/env node
// 478 points of a face in a video, or 52 shapes, as a table: MediaPipe in a headless Chromium
// looks.
'use strict';

const fs = require('node:fs');
const path = require('node:path');
const {openPage} = require('./page.js');
const {Table} = require('./table.js');
const {openVideo} = require('./video.js');

// pixels of a picture: a face that is a quarter as wide has all that the model sees of it
const kLongest = 960;
const kUsage = 'usage: track.js [--model face_landmarker.task [--shapes]] [--confidence 0.5]\n' +
    '                [--chromium PATH] VIDEO TABLE.csv';

class UsageError extends Error {}

function parseArguments(list) {
  const options = {confidence: 0.5, shapes: false, files: []};
  for (let i = 0; i < list.length; ++i) {
    const value = () => {
      if (i + 1 === list.length) throw new UsageError(list[i] + ' wants a value');
      return list[++i];
    };
    if (list[i] === '--model') options.model = value();
    else if (list[i] === '--chromium') options.chromium = value();
    else if (list[i] === '--confidence') options.confidence = Number(value());
    else if (list[i] === '--shapes') options.shapes = true;
    else if (list[i] === '--help') options.help = true;
    else if (list[i].startsWith('--')) throw new UsageError('unknown option ' + list[i]);
    else options.files.push(list[i]);
  }
  if (options.help) return options;
  if (options.files.length !== 2) throw new UsageError('a video and a table are wanted');
  if (!(options.confidence >= 0 && options.confidence <= 1))
      throw new UsageError('--confidence is 0 to 1');
  if (options.shapes && !options.model) {
    throw new UsageError(
        '--shapes wants --model face_landmarker.task: the one of the npm package finds points alone');
  }
  if (options.model && !fs.existsSync(options.model))
      throw new Error('there is no model ' + options.model);
  return options;
}

// With a model of the user the newer program, else the one that has its own.
function finderOf(options) {
  const name = options.model ? '@mediapipe/tasks-vision' : '@mediapipe/face_mesh';
  const folder = path.join(__dirname, 'node_modules', name);
  if (!fs.existsSync(folder))
      throw new Error(`npm's ${name} is missing; run: npm install --prefix ${__dirname}`);
  return {folder: folder + '/', module: options.model ? '/task.mjs' : '/mesh.mjs'};
}

// {columns, values} of a picture whose points were found as shares of its width and height.
function pointsOf({points}, {width, height, scale}) {
  const x = width * scale;
  const y = height * scale;
  return {
    columns: points.flatMap((_, i) => [`x_${i}`, `y_${i}`, `z_${i}`]),
    values: points.flatMap((point) => [point.x * x, point.y * y, point.z * x]),
  };
}

function shapesOf({shapes}) {
  return {columns: shapes.map((shape) => shape.categoryName),
      values: shapes.map((shape) => shape.score)};
}

async function main() {
  const options = parseArguments(process.argv.slice(2));
  if (options.help) return console.log(kUsage);
  const [file, out] = options.files;
  const {folder, module} = finderOf(options);
  const video = openVideo(file, kLongest);
  const table = new Table(out, {program: 'track.js', count: video.count,
      digits: options.shapes ? 6 : 3});
  const valuesOf = options.shapes ? shapesOf : pointsOf;
  const pictures = video.pictures();
  const waiting = [];  // pictures that the page has
  await openPage({
    chromium: options.chromium,
    // goes with the folder of the table, if somebody has made one for it
    scratch: out + '.chromium-',
    folders: {'/package/': folder, '/': __dirname + '/'},
    files: options.model ? {'/model': options.model} : {},
    settings: {module, shapes: options.shapes, confidence: options.confidence},
    async picture() {
      const {value, done} = await pictures.next();
      if (done) return null;
      const {width, height, scale} = value;
      waiting.push({width, height, scale});
      return value;
    },
    found(found) {
      const picture = waiting.shift();
      table.add(found.points && valuesOf(found, picture));
    },
  });
  table.finish(video.times);
}

main().then(() => process.exit(0), (error) => {
  const wrong = error instanceof UsageError;
  process.stderr.write(`track.js: ${error.message}\n${wrong ? kUsage + '\n' : ''}`);
  process.exit(wrong ? 2 : 1);
});
