'use strict';
// The connections: sound by MediaSource, decoded values by WebSocket, both on the clock of the
// sound. Knows nothing of how it is shown.
const Live = (() => {
  const kTarget = 0.35;      // seconds that are kept in front of the player
  const kMostTarget = 2;
  const kJump = 1.2;         // further behind than that: jump instead of hurrying
  const kKeep = 10;          // seconds of frames and sound that are kept behind
  const kRetry = [500, 1000, 2000, 4000];

  const socketAddress = (path) => new URL(path, location.href).href.replace(/^http/, 'ws');

  class Session {
    // `events`: state(name, text), hello(faps), frame(frame), error(text)
    constructor(audio, events) {
      Object.assign(this, {audio, events, frames: [], gaps: 0, attempt: 0, target: kTarget});
      audio.addEventListener('waiting', () => {
        if (this.running) this.target = Math.min(this.target * 1.4, kMostTarget);
      });
    }

    async start() {
      this.running = true;
      this.ended = false;
      this.frames = [];
      this.events.state('connecting', 'connecting');
      try {
        this.info = await (await fetch('info.json', {cache: 'no-store'})).json();
      } catch {
        return this.lost();
      }
      if (!this.running) return;
      if (this.info.audio) this.openSound();
      if (this.info.face) this.openFace();
      clearInterval(this.timer);
      this.timer = setInterval(() => this.steer(), 200);
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
      this.retry = setTimeout(() => this.start(), wait);
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
        this.events.error(`This browser cannot play ${mime} from a stream; try talk.mp4 below.`);
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
      this.faceSocket = new WebSocket(socketAddress('faps'));
      this.faceSocket.onmessage = (event) => {
        const message = JSON.parse(event.data);
        if (message.faps) this.events.hello(message.faps);
        else if (!message.event) this.take(message);  // those tell of lines that are spoken
      };
      this.faceSocket.onclose = (event) => this.closed(event);
    }

    take(frame) {
      if (frame.missed) ++this.gaps;  // the server had to drop planes for us
      frame.arrived = performance.now() / 1000;
      this.frames.push(frame);
      if (!this.info.audio && this.begun === undefined) {
        this.begun = frame.time - this.target - frame.arrived;
      }
      const old = this.clock() - kKeep;
      while (this.frames.length > 1 && this.frames[0].time < old) this.frames.shift();
      this.events.frame(frame);
    }

    // Seconds on the clock of the sound; without sound, one that runs as the frames come.
    clock() {
      if (this.info && this.info.audio) return this.audio.currentTime;
      return this.begun === undefined ? 0 : performance.now() / 1000 + this.begun;
    }

    soundEnd() {
      const ranges = this.buffer ? this.buffer.buffered : undefined;
      return ranges && ranges.length ? ranges.end(ranges.length - 1) : undefined;
    }

    // Seconds of sound in front of the player, and how far it is behind the newest that came.
    buffered() { return Math.max(0, (this.soundEnd() ?? this.clock()) - this.clock()); }
    latency() {
      const face = this.frames.length ? this.frames.at(-1).time : 0;
      return Math.max(this.soundEnd() ?? 0, face) - this.clock();
    }

    // Keeps the player a little behind the newest sound.
    steer() {
      const end = this.soundEnd();
      if (!this.info || !this.info.audio) {
        if (this.frames.length && !this.ended) this.live();
        return;
      }
      if (end === undefined) return;
      const audio = this.audio, lag = end - audio.currentTime;
      const ranges = this.buffer.buffered, begin = ranges.start(ranges.length - 1);
      if (audio.paused && !this.ended) {
        if (end - begin < this.target) return;
        audio.currentTime = Math.max(begin, end - this.target);
        audio.play().then(() => this.live(), (problem) => this.refused(problem));
        return;
      }
      if (this.ended) return;
      if (audio.currentTime < begin || lag > this.target + kJump) {
        audio.currentTime = Math.max(begin, end - this.target);
      }
      audio.playbackRate = lag > this.target + 0.15 ? 1.05 : lag < this.target - 0.2 ? 0.96 : 1;
      if (audio.readyState < 3) this.events.state('waiting', 'waiting for sound');
      else this.live();
    }

    live() {
      this.attempt = 0;
      this.events.state('live', 'live');
    }

    refused(problem) {
      if (!this.running || problem.name === 'AbortError') return;
      this.stop();
      this.events.state('idle', 'not started');
      this.events.error(`The browser does not start the sound: ${problem.message}`);
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
  return {Session};
})();
