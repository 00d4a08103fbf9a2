'use strict';
// The connections: sound by MediaSource, decoded values by WebSocket, both on the clock of the
// sound. Knows nothing of how it is shown.
const Live = (() => {
  const kTarget = 0.35;    // seconds that are kept in front of the player
  const kMostTarget = 2;   // where the network is so uneven that it runs dry again and again
  const kJump = 0.6;       // further behind than that: jump instead of hurrying
  const kLate = 0.5;       // without sound: frames that come so late turn the clock back
  const kUneven = 6;       // seconds in which it runs dry more than twice: keep more
  const kFirst = 3;        // seconds after the start that count for nothing: the page is being made
  const kKeep = 10;        // seconds of frames and sound that are kept behind
  const kStep = 200;       // milliseconds
  // Milliseconds: a server that is replaced is away for two or three seconds, on a busy machine for
  // ten.
  const kRetry = [250, 500, 500, 500, ...Array(10).fill(1000), 2000, 4000];

  // Of what belongs to this presentation: the ticket of the page is that of all of it.
  const ticket = new URLSearchParams(location.search).get('ticket');
  const address = (path) => {
    const whole = new URL(path, location.href);
    if (ticket) whole.searchParams.set('ticket', ticket);
    return whole.href;
  };
  const socketAddress = (path) => address(path).replace(/^http/, 'ws');
  const describe = async () => {
    const answer = await fetch(address('info.json'), {cache: 'no-store'});
    if (!answer.ok) throw new Error(`info.json: ${answer.status}`);
    return answer.json();
  };
  const wall = () => performance.now() / 1000;

  class Session {
    // `events`: state(name, text), hello(faps), frame(frame), told(message), blocked(), error(text)
    constructor(audio, events) {
      Object.assign(this, {audio, events, frames: [], gaps: 0, attempt: 0, target: kTarget});
      this.dry = [];  // when it was
      audio.addEventListener('waiting', () => this.ranDry());
      document.addEventListener('visibilitychange', () => { if (this.running) this.steer(); });
    }

    async start() {
      this.running = true;
      this.ended = this.soundless = this.hurries = false;
      this.frames = [];
      this.dry = [];
      this.target = kTarget;
      this.events.state('connecting', 'connecting');
      try {
        this.info = await describe();
      } catch {
        return this.lost();
      }
      if (!this.running) return;
      if (this.info.audio) this.openSound();
      if (this.info.face) this.openFace();
      clearInterval(this.timer);
      this.timer = setInterval(() => this.steer(), kStep);
    }

    stop() {
      this.running = false;
      clearInterval(this.timer);
      clearTimeout(this.retry);
      for (const socket of [this.faceSocket, this.soundSocket]) {
        if (!socket) continue;
        socket.onclose = socket.onmessage = null;
        socket.close();
      }
      this.faceSocket = this.soundSocket = this.buffer = undefined;
      this.audio.pause();
      this.audio.removeAttribute('src');
      this.audio.load();
      if (this.url) URL.revokeObjectURL(this.url);
      this.url = undefined;
      this.begun = undefined;
    }

    lost() {
      const wanted = this.running;
      this.stop();
      if (!wanted) return;
      this.running = true;
      this.events.state('lost', 'connection lost, trying again');
      const wait = kRetry[Math.min(this.attempt++, kRetry.length - 1)];
      // not all at once
      this.retry = setTimeout(() => this.start(), wait * (0.75 + Math.random() / 2));
    }

    end() {
      this.ended = true;
      this.events.state('ended', 'ended');
    }

    closed(event) {
      if (event.code === 1000) this.end();
      else this.lost();
    }

    openSound() {
      const Source = window.ManagedMediaSource || window.MediaSource;
      const mime = this.info.audio.mime;
      if (!Source || !Source.isTypeSupported(mime)) {
        this.soundless = true;
        this.events.error(`This browser cannot stream ${mime}; try talk.mp4 below.`);
        return;
      }
      const source = new Source();
      if (window.ManagedMediaSource) this.audio.disableRemotePlayback = true;
      this.queue = [];
      source.addEventListener('sourceopen', () => {
        if (this.buffer || !this.running) return;
        this.buffer = source.addSourceBuffer(mime);
        this.buffer.addEventListener('updateend', () => this.feed());
        this.soundSocket = new WebSocket(socketAddress('audio'));
        this.soundSocket.binaryType = 'arraybuffer';
        this.soundSocket.onmessage = (event) => {
          this.queue.push(event.data);
          this.feed();
        };
        this.soundSocket.onclose = (event) => this.closed(event);
      });
      this.url = URL.createObjectURL(source);
      this.audio.src = this.url;
    }

    feed() {
      if (!this.buffer || this.buffer.updating) return;
      const old = this.audio.currentTime - kKeep;
      if (this.buffer.buffered.length && this.buffer.buffered.start(0) < old - kKeep) {
        this.buffer.remove(0, old);
        return;
      }
      if (this.queue.length) this.buffer.appendBuffer(this.queue.shift());
    }

    openFace() {
      this.faceSocket = new WebSocket(socketAddress('faps?binary'));
      this.faceSocket.binaryType = 'arraybuffer';
      let read;
      this.faceSocket.onmessage = ({data}) => {
        if (typeof data !== 'string') {
          if (read) this.take(read(data));
          return;
        }
        const message = JSON.parse(data);
        if (message.faps) {
          read = planeReader(message.timescale);
          this.events.hello(message.faps);
        } else {
          this.events.told?.(message);
        }
      };
      this.faceSocket.onclose = (event) => this.closed(event);
    }

    take(frame) {
      if (frame.missed) ++this.gaps;  // the server had to drop planes for us
      frame.arrived = wall();
      this.frames.push(frame);
      if (!this.heard) this.begun ??= frame.time - this.target - frame.arrived;
      const old = this.clock() - kKeep;
      while (this.frames.length > 1 && this.frames[0].time < old) this.frames.shift();
      this.events.frame(frame);
    }

    // Does the sound give the time?
    get heard() { return Boolean(this.info?.audio) && !this.soundless; }

    // Seconds on the clock of the sound; without sound, one that runs as the frames come.
    clock() {
      if (this.heard) return this.audio.currentTime;
      return this.begun === undefined ? NaN : wall() + this.begun;
    }

    // The newest sound without a gap.
    newest() {
      const ranges = this.buffer ? this.buffer.buffered : undefined;
      if (!ranges || !ranges.length) return undefined;
      return {begin: ranges.start(ranges.length - 1), end: ranges.end(ranges.length - 1)};
    }
    soundEnd() { return this.newest()?.end; }

    // Seconds of sound in front of the player, and how far it is behind the newest that came.
    buffered() { return Math.max(0, (this.soundEnd() ?? this.clock()) - this.clock()); }
    latency() {
      const face = this.frames.length ? this.frames.at(-1).time : 0;
      return Math.max((this.heard && this.soundEnd()) || 0, face) - this.clock();
    }

    // The player has nothing more to play. Once is a stall, which is over when it goes on; again
    // and again is a network that wants more to be kept.
    ranDry() {
      const now = wall();
      if (!this.running || this.ended || this.audio.seeking) return;
      if (now < this.jumped + 1 || now < this.played + kFirst) return;
      this.dry = this.dry.filter((time) => time > now - kUneven);
      this.dry.push(now);
      if (this.dry.length > 2) this.target = Math.min(this.target * 1.4, kMostTarget);
    }

    // Keeps the player a little behind the newest that came.
    steer() {
      if (this.ended || !this.info) return;
      const calm = !this.dry.length || this.dry.at(-1) < wall() - kUneven;
      if (calm) this.target = Math.max(kTarget, this.target * 0.98);
      if (this.heard) this.steerSound();
      else if (this.frames.length) this.steerFace();
    }

    steerFace() {
      const {time, arrived} = this.frames.at(-1), since = wall() - arrived;
      const off = time - this.clock() - this.target;
      if (since > 1.5) {
        this.events.state('waiting', 'waiting for the face');
        return;
      }
      if (off > kJump || (off < -this.target - kLate &&
          since < 2 * kStep / 1000)) this.begun += off;
      else if (off > 0.15) this.begun += 0.1 * kStep / 1000;
      else if (off < -0.15) this.begun -= 0.04 * kStep / 1000;
      this.live();
    }

    steerSound() {
      const {audio, target} = this, newest = this.newest();
      if (!newest) return;
      const off = newest.end - target - audio.currentTime,
          enough = newest.end - target >= newest.begin;
      if (audio.paused) {
        if (enough) this.play(newest.end - target);
        return;
      }
      // What lies behind a gap is played when there is enough of it, and at once if it has to be.
      const cut = audio.currentTime < newest.begin && audio.readyState < 3;
      if (enough && (cut || off > kJump)) {
        this.jump(newest.end - target);
      } else {
        this.hurries = off > (this.hurries ? 0.03 : 0.15);
        const rate = this.hurries ? 1 + Math.min(0.2, Math.max(0.05, off / 2)) : off < -0.2 ? 0.96 :
            1;
        if (audio.playbackRate !== rate) audio.playbackRate = rate;
      }
      if (audio.readyState < 3) this.events.state('waiting', 'waiting for sound');
      else this.live();
    }

    jump(time) {
      this.jumped = wall();
      this.audio.playbackRate = 1;
      this.audio.currentTime = time;
    }

    // Browsers may let no page sound that nobody has touched: then it begins without sound.
    async play(time) {
      if (this.asking) return;
      this.asking = true;
      this.jump(time);
      try {
        await this.audio.play();
        this.played = wall();
        this.live();
      } catch (problem) {
        this.refused(problem);
      }
      this.asking = false;
    }

    refused(problem) {
      if (!this.running || problem.name === 'AbortError') return;
      if (problem.name !== 'NotAllowedError') {
        this.stop();
        this.events.state('idle', 'not started');
        this.events.error(`The browser does not play the sound: ${problem.message}`);
        return;
      }
      if (this.audio.muted) this.soundless = true;  // not even so; the face has a clock of its own
      this.audio.muted = true;
      this.events.blocked();
    }

    live() {
      this.attempt = 0;
      this.events.state('live', 'live');
    }

    // The newest frame that is due.
    due(time) {
      let found;
      for (const frame of this.frames) {
        if (frame.time > time) break;
        found = frame;
      }
      return found;
    }
  }
  return {Session, address, describe};
})();
