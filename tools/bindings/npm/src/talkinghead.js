// What speakAudio() and streamAudio() of TalkingHead (met4citizen) take.
import {ArkitFitter, ARKIT_SHAPES, arkitNames, VisemeFitter, visemeNames} from './weights.js';

const kShortest = 0.04;  // seconds; a shorter viseme belongs to the one before it
const milliseconds = (seconds) => Math.round(seconds * 1000);

/** Runs of frames in which one viseme is the strongest: [{viseme, time, duration}], seconds. */
export function visemeEvents(frames) {
  const fitter = new VisemeFitter();
  const events = [];
  frames.forEach((frame, i) => {
    const weights = fitter.fit(frame);
    const viseme = weights.indexOf(Math.max(...weights));
    const end = frames[i + 1]?.time ?? frame.time + frame.rate[1] / frame.rate[0];
    const last = events.at(-1);
    if (last?.viseme === viseme) last.end = end;
    else events.push({viseme, time: frame.time, end});
  });
  fitter.free();
  const merged = [];
  for (const event of events) {
    const last = merged.at(-1);
    if (last &&
        (last.viseme === event.viseme || event.end - event.time < kShortest - 1e-6)) last.end =
        event.end;
    else merged.push(event);
  }
  return merged.map(({viseme, time, end}) => ({viseme: visemeNames()[viseme], time,
      duration: end - time}));
}

// An animation of TalkingHead: times of each step, and for each shape a value to begin with and one
// a step.
function blendshapes(frames) {
  const fitter = new ArkitFitter(), names = arkitNames().slice(0, ARKIT_SHAPES);
  const rows = frames.map((frame) => Array.from(fitter.fit(frame).subarray(0, ARKIT_SHAPES)));
  fitter.free();
  const dt = frames.map((frame, i) =>
    1000 * ((frames[i + 1]?.time ?? frame.time + frame.rate[1] / frame.rate[0]) - frame.time));
  const vs = Object.fromEntries(names.map((name, i) => [name, [0, ...rows.map((row) => row[i])]]));
  return {name: 'blendshapes', dt, vs};
}

/**
 * Frames of a face (shown) beside `audio`, an AudioBuffer or pieces of PCM: {audio, words, wtimes,
 * wdurations, visemes, vtimes, vdurations}, times in milliseconds; with {shapes: true} ARKit's
 * shapes frame by frame: `anim` for speakAudio(), `anims` for streamAudio() (of a stream with
 * {lipsyncType: 'blendshapes'}). Visemes are empty then, or its player would make others from the
 * words. It closes the mouth by itself, so silence is left out.
 */
export function talkingHead(frames, audio, {shapes = false, words = []} = {}) {
  const out = {
    audio,
    words: words.map(({text}) => text),
    wtimes: words.map(({start}) => milliseconds(start)),
    wdurations: words.map(({start, end}) => milliseconds(end) - milliseconds(start)),
  };
  if (shapes) {
    const anim = blendshapes(frames);
    // streamAudio() adds the begin of the sound to the delay of what it is given.
    return {...out, visemes: [], vtimes: [], vdurations: [], anim, anims: [{...anim, delay: 0}]};
  }
  const events = visemeEvents(frames).filter(({viseme}) => viseme !== 'viseme_sil');
  return {
    ...out,
    visemes: events.map(({viseme}) => viseme.replace('viseme_', '')),
    vtimes: events.map(({time}) => milliseconds(time)),
    vdurations: events.map(({time, duration}) => milliseconds(time +
        duration) - milliseconds(time)),
  };
}
