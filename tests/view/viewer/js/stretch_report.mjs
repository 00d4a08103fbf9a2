// node stretch_report.mjs: what tools/view/viewer/js/stretch.js makes of sounds, as JSON.
//
// tones: for each speed a tone of 220 Hz that lasts 2 s of the result: its pitch in Hz, its level
//   against the original, and the largest change from sample to sample against that of the tone.
// bursts: for each speed, when bursts of noise at 0.5, 1.0 and 1.5 s of the clip begin in the
// result,
//   in seconds of the clip.
// loop: the pitch of a loop that does not hold whole periods, and when a burst in it comes, in
// seconds
//   of the result.
import {Stretcher} from '../../../../tools/view/viewer/js/stretch.js';

const RATE = 48000;
const SPEEDS = [0.25, 0.5, 0.75, 1.25, 1.5, 2];
const TONE = 220;

const tone = (seconds) => Float32Array.from({length: seconds * RATE},
    (_, i) => 0.5 * Math.sin(2 * Math.PI * TONE * i / RATE));

// A burst of 60 ms of noise at each time; the noise of a small generator, the same each run.
function bursts(seconds, times) {
  const out = new Float32Array(seconds * RATE);
  let state = 1;
  for (const time of times) {
    const begin = Math.round(time * RATE);
    for (let i = 0; i < 0.06 * RATE; ++i) {
      state = state * 1664525 + 1013904223 >>> 0;
      out[begin + i] = state / 2 ** 31 - 1;
    }
  }
  return out;
}

function pitch(samples) {
  let [first, last, count] = [-1, -1, 0];
  for (let i = 1; i < samples.length; ++i) {
    if (!(samples[i - 1] < 0 && samples[i] >= 0)) continue;
    const at = i - samples[i] / (samples[i] - samples[i - 1]);
    if (first < 0) first = at;
    else ++count;
    last = at;
  }
  return count * RATE / (last - first);
}

const level = (samples) => Math.sqrt(samples.reduce((sum, x) => sum + x * x, 0) / samples.length);

function jump(samples) {
  let largest = 0;
  for (let i = 1; i < samples.length; ++i) {
    largest = Math.max(largest, Math.abs(samples[i] - samples[i - 1]));
  }
  return largest;
}

function onsets(samples) {
  const out = [];
  for (let i = 0; i < samples.length; ++i) {
    if (Math.abs(samples[i]) < 0.2) continue;
    out.push(i / RATE);
    i += 0.1 * RATE;
  }
  return out;
}

function stretched(channels, seconds, settings) {
  const stretcher = new Stretcher(channels, RATE, settings);
  const out = new Float32Array(seconds * RATE);
  // In odd pieces, as nobody asks for whole windows.
  for (let at = 0; at < out.length; at += 1001) {
    const length = Math.min(1001, out.length - at);
    out.set(stretcher.read(length)[0], at);
  }
  return out;
}

const report = {tones: {}, bursts: {}};
const original = tone(5);
for (const rate of SPEEDS) {
  const out = stretched([original, original], 2, {rate, from: 0.3});
  report.tones[rate] = {
    pitch: pitch(out), level: level(out) / level(original), jump: jump(out) / jump(original),
  };
  const noisy = stretched([bursts(2, [0.5, 1, 1.5])], 1.8 / rate, {rate});
  // Between bursts lie 0.5 / rate seconds: those of one burst are less than 0.3 apart.
  report.bursts[rate] = onsets(noisy).filter((time, i, all) => i === 0 || time - all[i - 1] > 0.2)
      .map((time) => time * rate);
}
const looped = stretched([original], 2, {rate: 0.5, from: 1, loop: [1, 1.1234]});
const burst = stretched([bursts(2, [1.5])], 4, {rate: 0.5, from: 1, loop: [1, 2]});
report.loop = {
  pitch: pitch(looped), jump: jump(looped) / jump(original),
  bursts: onsets(burst).filter((time, i, all) => i === 0 || time - all[i - 1] > 0.5),
};
process.stdout.write(JSON.stringify(report) + '\n');
