// Pictures of a video for trackers: ffmpeg decodes.
//
//     const video = openVideo('clip.mp4', 1280);       // an Error says what is wrong
//     video.count                                      // about how many pictures, 0: not known
//     for await (const {width, height, pixels, scale} of video.pictures()) ...
//     video.times                                      // of all pictures that came, in seconds
'use strict';

const {spawn, spawnSync} = require('node:child_process');
const readline = require('node:readline');

function probe(file) {
  const entries = 'stream=avg_frame_rate,width,height,sample_aspect_ratio,duration:format=duration';
  const ffprobe = spawnSync('ffprobe', ['-v', 'error', '-select_streams', 'v:0', '-show_entries',
      entries,
    '-of', 'json', file]);
  if (ffprobe.error) throw new Error('ffprobe cannot be started; install ffmpeg');
  if (ffprobe.status !== 0) throw new Error(ffprobe.stderr.toString().trim());
  const {streams, format} = JSON.parse(ffprobe.stdout);
  if (!streams || streams.length === 0) throw new Error('there is no picture in ' + file);
  return {...streams[0], seconds: Number(streams[0].duration) || Number(format?.duration) || 0};
}

// How many pictures there are, about; 0: nobody knows.
function countOf(stream, seconds) {
  const [num, den] = String(stream.avg_frame_rate).split('/').map(Number);
  return num > 0 && den > 0 ? Math.round(seconds * num / den) : 0;
}

// Takes the bytes of a stream apart, without copying what was already waiting.
class Bytes {
  constructor(stream) {
    this.stream = stream[Symbol.asyncIterator]();
    this.rest = Buffer.alloc(0);
  }
  // The next `count` bytes; fewer at the end.
  async take(count) {
    const parts = [this.rest];
    let have = this.rest.length;
    while (have < count) {
      const {value, done} = await this.stream.next();
      if (done) break;
      parts.push(value);
      have += value.length;
    }
    const all = parts.length === 1 ? parts[0] : Buffer.concat(parts);
    this.rest = all.subarray(Math.min(count, have));
    return all.subarray(0, Math.min(count, have));
  }
  // Up to `end`, which is taken, too; empty at the end.
  async takeTo(end, most) {
    for (let want = end.length; want <= most; want += end.length) {
      const head = await this.take(Math.max(want, Math.min(this.rest.length, most)));
      const at = head.indexOf(end);
      const used = at < 0 ? 0 : at + end.length;
      this.rest = Buffer.concat([head.subarray(used), this.rest]);
      if (at >= 0) return head.subarray(0, used);
      if (head.length < want) break;
    }
    return Buffer.alloc(0);
  }
}

/**
 * A video whose pictures come as they are shown: upright and with square pixels. Those wider or
 * higher than
    `longest` are made smaller;
        pixels of a picture times its `scale` are pixels of the video. `times`: of the pictures
    that came, in seconds; complete at the end. */
function openVideo(file, longest) {
  const stream = probe(file);
  const [wide, high] = String(stream.sample_aspect_ratio).split(':').map(Number);
  const aspect = wide > 0 && high > 0 ? wide / high : 1;
  const scale = Math.max(1, Math.max(stream.width * aspect, stream.height) / longest);
  // The times are told by showinfo; behind it all pictures are evenly apart, so that none is
  // doubled or dropped.
  const filter = `showinfo,settb=1/25,setpts=N,scale=iw*sar/${scale}:ih/${scale},setsar=1`;
  const times = [];
  async function* pictures() {
    const ffmpeg = spawn('ffmpeg', ['-hide_banner', '-nostats', '-nostdin', '-i', file, '-map',
        '0:v:0', '-vf', filter,
      '-r', '25', '-f', 'image2pipe', '-c:v', 'pam', '-pix_fmt', 'rgba', '-'],
          {stdio: ['ignore', 'pipe', 'pipe']});
    const said = [];
    const heard = (async () => {
      for await (const line of readline.createInterface({input: ffmpeg.stderr})) {
        const time = /showinfo.* pts_time: *([-\d.e+]+)/.exec(line);
        if (time) times.push(Number(time[1]));
        else if (!line.includes('showinfo')) said.push(line);
      }
    })();
    const ended = new Promise((resolve) => ffmpeg.on('close', resolve));
    const bytes = new Bytes(ffmpeg.stdout);
    for (;;) {
      const header = (await bytes.takeTo('ENDHDR\n', 1024)).toString();
      if (header === '') break;
      const [width, height] = ['WIDTH', 'HEIGHT'].map((name) =>
          Number(new RegExp(name + ' (\\d+)').exec(header)[1]));
      const pixels = await bytes.take(width * height * 4);
      if (pixels.length < width * height * 4) break;
      yield {width, height, pixels, scale};
    }
    await heard;
    if (await ended !== 0) throw new Error('ffmpeg: ' + said.slice(-3).join('; '));
  }
  return {count: countOf(stream, stream.seconds), times, pictures};
}

module.exports = {openVideo};
