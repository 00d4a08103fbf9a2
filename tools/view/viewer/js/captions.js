// What is said: words and lines of a script, and the line that is spoken now, its word emphasised.
export const SILENCE = 'SIL';

const NEW_LINE = 0.35;     // seconds without a word: what follows is another line
const LONGEST = 34;     // characters of a line
const EARLY = 0.3;      // seconds that a line is shown before it is spoken,
const LATE = 0.6;       // and after, unless the next one begins

/** The piece [start, end, ...] that a time lies in. */
export function pieceAt(pieces, time) {
  return pieces.find(([start, end]) => time >= start && time < end);
}

/** [start, end, text] of phones [start, end, label, word] that follow one another in one word. */
export function wordsOf(phones) {
  const words = [];
  for (const [start, end, , word] of phones) {
    const last = words[words.length - 1];
    if (!word) continue;
    if (last && last[2] === word && Math.abs(last[1] - start) < 1e-3) last[1] = end;
    else words.push([start, end, word]);
  }
  return words;
}

/** Words as lines: lists that are parted by pauses, or where a line would become too long. */
export function linesOf(words) {
  const lines = [];
  let length = 0;
  let before = -Infinity;
  for (const word of words) {
    length += [...word[2]].length + 1;
    if (word[0] - before > NEW_LINE || length > LONGEST) {
      lines.push([]);
      length = [...word[2]].length;
    }
    lines[lines.length - 1].push(word);
    before = word[1];
  }
  return lines;
}

/** Shows the line and the phone of a time in an element. */
export class Said {
  constructor(element, phones) {
    this.element = element;
    this.phones = phones;
    this.lines = linesOf(wordsOf(phones));
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
      parts.push(part, ' ');
    }
    if (phone || parts.length) {  // its place stays, so that the line does not shake
      const part = document.createElement('i');
      part.textContent = phone;
      parts.push(part);
    }
    this.element.replaceChildren(...parts);
  }
}
