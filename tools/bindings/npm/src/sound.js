// Sound in segments, by MediaSource.
import {AnimemeError} from './library.js';
import {soundCodec} from './movie.js';

const kKeep = 20;  // seconds that are kept behind the player

export class SoundBuffer {
  /** `init`: the initialisation segment. */
  constructor(media, init, codecs = soundCodec(init)) {
    const Source = globalThis.ManagedMediaSource ?? globalThis.MediaSource;
    const mime = `audio/mp4; codecs="${codecs}"`;
    if (!Source?.isTypeSupported(mime)) {
      throw new AnimemeError('unsupported', `this browser cannot play ${mime} in segments`);
    }
    if (globalThis.ManagedMediaSource) media.disableRemotePlayback = true;
    this.media = media;
    this.source = new Source();
    this.queue = Promise.resolve();
    this.url = URL.createObjectURL(this.source);
    this.opened = new Promise((done, fail) => {
      this.source.addEventListener('sourceopen', () => {
        try {
          this.buffer = this.source.addSourceBuffer(mime);
          done(this.append(init));
        } catch (problem) {
          fail(problem);
        }
      }, {once: true});
    });
    media.src = this.url;
  }

  /** One after the other; resolves when the segment can be played. */
  append(bytes) {
    this.queue = this.queue.then(async () => {
      const old = this.media.currentTime - kKeep;
      if (this.buffer.buffered.length && this.buffer.buffered.start(0) < old - kKeep) {
        await this.settled(() => this.buffer.remove(0, old));
      }
      await this.settled(() => this.buffer.appendBuffer(bytes));
    });
    return this.queue;
  }

  settled(begin) {
    return new Promise((done, fail) => {
      const end = () => {
        this.buffer.removeEventListener('error', failed);
        done();
      };
      const failed = () => fail(new AnimemeError('syntax',
          'the browser cannot read a segment of the sound'));
      this.buffer.addEventListener('updateend', end, {once: true});
      this.buffer.addEventListener('error', failed, {once: true});
      begin();
    });
  }

  setDuration(seconds) {
    if (this.source.readyState === 'open' && !this.buffer.updating) this.source.duration = seconds;
  }

  end() { if (this.source.readyState === 'open') this.source.endOfStream(); }

  /**
   * Seconds at which the newest sound ends, and where its range begins; undefined: there is none.
   */
  get range() {
    const ranges = this.buffer?.buffered;
    return ranges?.length ? {begin: ranges.start(ranges.length - 1),
        end: ranges.end(ranges.length - 1)} : undefined;
  }

  close() { URL.revokeObjectURL(this.url); }

  /** Takes the sound away from its player. */
  detach() {
    if (this.media.src !== this.url) return;
    this.media.removeAttribute('src');
    this.media.load();
  }
}
