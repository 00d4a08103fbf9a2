// What is said: the caption that is spoken now, its word emphasised, and the phone.
export const SILENCE = 'SIL';

const EARLY = 0.3;      // seconds that a line is shown before it is spoken,
const LATE = 0.6;       // and after, unless the next one begins

/** The piece [start, end, ...] that a time lies in. */
export function pieceAt(pieces, time) {
  return pieces.find(([start, end]) => time >= start && time < end);
}

/** Shows the line and the phone of a time in an element. */
export class Said {
  /** Lines are lists of words [start, end, text, whether a blank follows]. */
  constructor(element, phones, lines) {
    this.element = element;
    this.phones = phones;
    this.lines = lines;
  }

  lineAt(time) {
    let shown = null;
    for (const line of this.lines) {
      if (line[0][0] - EARLY > time) break;
      if (line[0][0] <= time || !shown) shown = line;
    }
    return shown && time < shown[shown.length - 1][1] + LATE ? shown : null;
  }

  show(time) {
    const line = this.lineAt(time) || [];
    const word = pieceAt(line, time);
    const piece = pieceAt(this.phones, time);
    const phone = piece && piece[2] !== SILENCE ? piece[2] : '';
    if (this.line === line[0] && this.word === word && this.phone === phone) return;
    Object.assign(this, {line: line[0], word, phone});
    const parts = [];
    for (const each of line) {
      const part = document.createElement(each === word ? 'b' : 'span');
      part.textContent = each[2];
      parts.push(part, each[3] ? ' ' : '');
    }
    if (phone || parts.length) {  // its place stays, so that the line does not shake
      const part = document.createElement('i');
      part.textContent = phone;
      parts.push(part);
    }
    this.element.replaceChildren(...parts);
  }
}
