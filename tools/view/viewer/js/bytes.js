// Packed numbers: what detail/bytes.h writes.

/** The bytes of a base64 text. */
export function fromBase64(text) {
  const binary = atob(text.trim());
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/** Reads a header in JSON and the numbers behind it. */
export class ByteReader {
  constructor(bytes) {
    this.bytes = bytes;
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const length = this.view.getUint32(0, true);
    this.header = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length)));
    this.at = 4 + length;
  }

  u8(count) {
    this.at += count;
    return this.bytes.slice(this.at - count, this.at);
  }

  u16(count) {
    const out = new Uint16Array(count);
    for (let i = 0; i < count; ++i, this.at += 2) out[i] = this.view.getUint16(this.at, true);
    return out;
  }

  i16(count) {
    return new Int16Array(this.u16(count).buffer);
  }

  varint() {
    let value = 0;
    for (let scale = 1;; scale *= 128) {
      const byte = this.bytes[this.at++];
      value += (byte & 127) * scale;
      if (byte < 128) return value;
    }
  }

  zigzag() {
    const value = this.varint();
    return value % 2 ? -(value + 1) / 2 : value / 2;
  }
}
