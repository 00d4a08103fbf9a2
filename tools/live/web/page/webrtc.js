'use strict';
// The connections by WebRTC where the server and the browser have it, else those of live.js. Sound
// and values come over UDP, without a player's buffer; the RTP time of the sound is its clock.
const Rtc = (() => {
  // Milliseconds, after which it goes by WebSockets: without an answer, then without a way through,
  // then without the channel.
  const kAnswer = 5000, kPatience = 2000, kMostPatience = 6000;
  const kWindow = 25;            // packets of sound that tell how its clock goes
  const kPlanes = 50;            // that tell whether the face is there when it is due
  const kHold = 0.1, kMostHold = 0.6;  // seconds that sound is held back: at first, at most

  const wanted = () => window.RTCPeerConnection &&
      new URLSearchParams(location.search).get('transport') !== 'ws';

  class Session extends Live.Session {
    constructor(audio, events) {
      super(audio, events);
      if (wanted()) this.prepare();  // the first offer takes a browser a while
    }

    async start() {
      if (!wanted() || this.refusedRtc) return super.start();
      this.running = true;
      this.ended = this.soundless = false;
      this.events.state('connecting', 'connecting');
      try {
        this.info = await Live.describe();
      } catch {
        return this.lost();
      }
      if (!this.running) return;
      if (!this.info.webrtc) {
        this.hangUp();
        return super.start();
      }
      this.frames = [];
      try {
        await this.connect();
      } catch (problem) {
        if (!this.running) return;
        console.info(`WebRTC failed (${problem.message}); using WebSockets`);
        this.hangUp();
        this.refusedRtc = true;
        super.start();
      }
    }

    // An offer; whether it is made use of is seen later.
    prepare() {
      const peer = this.peer = new RTCPeerConnection();
      this.receiver = peer.addTransceiver('audio', {direction: 'recvonly'}).receiver;
      this.channel = peer.createDataChannel('animeme.faps', {ordered: false, maxRetransmits: 0});
      this.held = kHold;
      this.samples = [];
      this.spares = [];
      this.ask();
      this.offered = peer.setLocalDescription();
      this.offered.catch(() => {});  // connect() sees it, too
    }

    // WHEP. All candidates of the server are in its answer; ours would be names that mean nothing
    // to it (mDNS), so it is not kept waiting for them: it sees where we come from.
    async connect() {
      if (!this.peer) this.prepare();
      const peer = this.peer;
      if (this.info.audio) this.hear();  // while the click counts
      await this.offered;
      const response = await fetch(Live.address('whep'), {
        method: 'POST', headers: {'Content-Type': 'application/sdp'},
            body: peer.localDescription.sdp,
        signal: AbortSignal.timeout(kAnswer),
      });
      const sdp = await response.text();
      if (response.status !== 201) throw new Error(sdp.trim());
      if (peer !== this.peer) return;
      this.resource = response.headers.get('Location');
      await peer.setRemoteDescription({type: 'answer', sdp});
      if (peer !== this.peer) return;
      // Chromium at times stays silent where the track was not live
      if (this.info.audio) this.hear();
      await this.opened(peer);
      if (peer === this.peer) this.connected = true;
    }

    hear() {
      this.audio.srcObject = new MediaStream([this.receiver.track]);
      this.audio.play().catch((problem) => {
        this.refused(problem);
        if (this.running && this.audio.muted) this.audio.play().catch(() => {});
      });
    }

    opened(peer) {
      return new Promise((done, failed) => {
        const late = () => failed(new Error('connection timed out'));
        const found = () => /^(connected|completed)$/.test(peer.iceConnectionState);
        setTimeout(() => { if (!found()) late(); }, kPatience);
        setTimeout(late, kMostPatience);
        const look = () => {
          const state = peer.connectionState;
          if (state === 'failed' || state === 'closed') {
            failed(new Error('no network path'));
            this.broken();
          } else if (state === 'disconnected') {  // it may come back, but rarely does
            setTimeout(() => { if (peer.connectionState === state) this.broken(); }, kPatience);
          } else if (this.channel.readyState === 'open' ||
              (!this.info.face && state === 'connected')) {
            done();
          }
        };
        peer.onconnectionstatechange = this.channel.onopen = look;
        this.channel.onmessage = (event) => this.read(JSON.parse(event.data));
        this.channel.onclose = () => this.broken();
        look();
      });
    }

    read(message) {
      if (message.event) return this.events.told?.(message);
      if (message.end) {
        this.over = true;
        return;
      }
      // Messages overtake each other; a plane that is late is no news.
      if (this.frames.length && message.time <= this.frames.at(-1).time) return;
      if (this.offset !== undefined) this.hold(message.time - this.clock());
      this.unheard ??= message.time - kHold - performance.now() / 1000;
      this.take(message);
      this.live();
    }

    // Sound is sent a little ahead of the face, and comes on another way: the browser is asked to
    // hold it back until nearly every plane is there before it is due, by `spare` seconds.
    hold(spare) {
      this.spares.push(spare);
      if (this.spares.length < kPlanes) return;
      const least = this.spares.sort((a, b) => a - b)[2];
      this.spares = [];
      if (least < 0.005) this.held += Math.min(0.02 - least, 0.06);
      else if (least > 0.08) this.held -= 0.02;
      this.ask();
    }

    ask() {
      this.held = Math.min(Math.max(this.held, 0), kMostHold);
      if ('jitterBufferTarget' in this.receiver) this.receiver.jitterBufferTarget =
          1000 * this.held;
      else this.receiver.playoutDelayHint = this.held;
    }

    // The server has closed, or the network has.
    broken() {
      if (!this.connected || !this.peer) return;
      if (!this.over) return this.lost();
      // What is still in the buffer is heard.
      const rest = this.frames.length ? this.frames.at(-1).time - this.clock() : 0;
      setTimeout(() => { if (this.running) this.end(); }, Math.max(0, rest * 1000));
    }

    hangUp() {
      if (!this.peer) return;
      this.channel.onclose = this.channel.onmessage = this.peer.onconnectionstatechange = null;
      this.peer.close();
      if (this.resource) fetch(this.resource, {method: 'DELETE', keepalive: true}).catch(() => {});
      this.audio.srcObject = null;
      this.peer = this.channel = this.receiver = this.resource = undefined;
      this.packet = this.offset = this.unheard = undefined;
      this.connected = this.over = false;
    }

    stop() {
      this.hangUp();
      super.stop();
    }

    // Seconds on the clock of the sound: which packet was given to the loudspeaker when.
    clock() {
      if (!this.connected) return super.clock();
      const now = performance.now() / 1000;
      if (this.info.audio) this.listen();
      if (this.offset !== undefined) return now + this.offset;
      return this.unheard === undefined ? 0 : now + this.unheard;  // no sound (yet): as planes come
    }

    listen() {
      const heard = this.receiver.getSynchronizationSources()[0];
      if (!heard || heard.rtpTimestamp === this.packet) return;
      this.packet = heard.rtpTimestamp;
      const at = (heard.timestamp - performance.timeOrigin) / 1000;
      // RTP times are those of the common clock, but begin anew every 24.9 hours.
      const turn = 2 ** 32 / 48000, time = heard.rtpTimestamp / 48000;
      const near = this.frames.length ? this.frames.at(-1).time : time;
      const offset = time + Math.round((near - time) / turn) * turn - at;
      this.samples.push(offset);
      if (this.samples.length > kWindow) this.samples.shift();
      const sorted = [...this.samples].sort((a, b) => a - b);
      this.offset = sorted[sorted.length >> 1];
    }

    buffered() { return this.connected ? this.latency() : super.buffered(); }
    latency() {
      if (!this.connected) return super.latency();
      return this.frames.length ? this.frames.at(-1).time - this.clock() : 0;
    }
  }
  return {Session};
})();
