// What a page does with the messages of a voice agent's face: a line of faces on the clock of the
// sound's samples, and which one is to be seen now. See ../../agents/README.md.

const kClosing = 0.2;  // seconds in which a mouth closes whose sound is paused

/**
 * `decoder(config)`: a UnitDecoder of the npm package; `track`: a Track of it; `delay()`: seconds
 * from a message to the
    sound that was sent with it, what the jitter buffer and the player hold; `wall()`: seconds. */
export class FaceReceiver {
  constructor({decoder, track, delay = () => 0, wall = () => performance.now() / 1000}) {
    Object.assign(this, {makeDecoder: decoder, track, delay, wall, decoder: null, timescale: 0,
        anchor: null});
    this.gate = Infinity;  // seconds: where a segment begins whose sound does not play yet
    this.held = Infinity;  // seconds: where the sound is paused
    this.open = 1;         // share of the face that is shown: while the sound is paused it closes
    this.looked = null;    // wall time of the last look
  }

  /** A message of the data channel; those of other topics are left alone. */
  take(topic, bytes) {
    if (topic === 'animeme.clock') this.tell(JSON.parse(new TextDecoder().decode(bytes)));
    if (topic === 'animeme.face') this.read(bytes);
  }

  /** The data of a message that is JSON, as Pipecat's clients hand it to onServerMessage. */
  takeMessage({topic, base64}) {
    if (topic) this.take(topic, Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0)));
  }

  /** The face to be shown now; null: none yet. */
  now() {
    if (!this.track.frames.length) return null;
    const time = this.time(), wall = this.wall();
    this.track.forget(time - 10);
    const frame = this.track.at(time) ?? this.track.frames[0];
    const step = (wall - (this.looked ?? wall)) / kClosing;
    this.looked = wall;
    this.open = Math.min(Math.max(this.open + (time >= this.held ? -step : step), 0), 1);
    if (this.open === 1 || !frame.values) return frame;
    const share = this.open * this.open * (3 - 2 * this.open);
    return {...frame, values: frame.values.map((value) => Math.round(value * share))};
  }

  /** Seconds on the clock of the sound. Between segments it stops where the mouth is closed. */
  time() {
    if (!this.anchor) return Math.min(this.gate, this.held, 0);
    const time = this.anchor.time + this.wall() - this.anchor.wall;
    return Math.min(time, this.gate, this.held, this.track.frames.at(-1)?.time ?? Infinity);
  }

  tell({begins, playing, cut, paused}) {
    if (!this.timescale) return;
    if (paused !== undefined) this.held = paused / this.timescale;
    if (begins !== undefined && cut === undefined) this.gate = (begins - 1) / this.timescale;
    if (playing === undefined) return;
    this.gate = this.held = Infinity;
    this.anchor = {time: playing / this.timescale, wall: this.wall() + this.delay()};
  }

  read(bytes) {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    if (bytes[0] === 0x41) {  // no time is as large as this
      if (this.decoder) return;
      this.timescale = view.getUint32(4);
      this.decoder = this.makeDecoder(bytes.slice(10, 10 + view.getUint16(8)));
      return;
    }
    if (!this.decoder) return;  // not greeted yet
    const time = Number(view.getBigUint64(0)) / this.timescale, flags = bytes[12];
    const {frames} = this.track;
    // it replaces what was sent for later
    while (frames.length && frames.at(-1).time >= time - 1e-6) frames.pop();
    if (flags & 2) this.decoder.skip();
    this.track.add(this.decoder.decode({time, intra: (flags & 1) !== 0, bytes: bytes.slice(13)}));
  }
}
