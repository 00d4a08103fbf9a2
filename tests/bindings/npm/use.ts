// What a user in TypeScript writes: compiled and run by package_test.mjs.
import {arkit, type Frame, Decoder, ready, Speaker, talkingHead, visemes} from 'animeme';
import type {AnimemeFace} from 'animeme/face';

declare const process: {argv: string[]};
// @ts-ignore: types of node are none of ours
const {readFileSync} = await import('node:fs');

await ready();
const decoder = new Decoder({shown: {expand: true}});
decoder.push(readFileSync(process.argv[2]));
decoder.finish();
const frames: Frame[] = [];
for (const frame of decoder) frames.push(frame);
const jaw: number = Math.max(...frames.map((frame) => arkit(frame).jawOpen ?? 0));
console.log(`${frames.length} frames, jaw ${jaw.toFixed(2)}`);
visemes({values: frames[0]!.values});

const speaker = await Speaker.load();
const spoken = speaker.speak([{phone: 'AA', start: 0, end: 0.5}], {rate: 25});
console.log(`${spoken.length} frames of speech`);
const heard: string[] | undefined = talkingHead(spoken, new ArrayBuffer(2)).visemes;

// @ts-expect-error: a frame has no such member
frames[0].nothing;
export function play(face: AnimemeFace): Promise<void> { return heard ? face.play() : face.loaded; }
export const element: AnimemeFace | null = typeof document === 'undefined' ? null :
    document.querySelector('animeme-face');
