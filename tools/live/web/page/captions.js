// Captions of what heads say line by line: the words of the moment, and the one that is spoken.
class Captions {
  // Seconds that a line is shown before its first word, and after its last one; a pause that ends
  // a line; letters of a line.
  static early = 0.3;
  static late = 0.8;
  static pause = 1.2;
  static longest = 64;
  // Chinese, Japanese, Thai, Lao, Burmese and Khmer are written without blanks.
  static joined =
      /^[\p{sc=Han}\p{sc=Hira}\p{sc=Kana}\p{sc=Thai}\p{sc=Laoo}\p{sc=Mymr}\p{sc=Khmr}]/u;

  constructor(element) {
    this.element = element;
    this.lines = [];
  }

  /** A message of the server: {event: 'word', time, duration, line, word}, or another one. */
  told({event, time, duration, line, word}) {
    if (event !== 'word') return;
    const last = this.lines.at(-1), end = time + duration;
    const fits = last && last.line === line && time < last.end + Captions.pause &&
        last.letters + word.length < Captions.longest;
    if (!fits) this.lines.push({line, letters: 0, words: []});
    const into = this.lines.at(-1);
    into.words.push({time, end, word});
    into.letters += word.length + 1;
    into.end = end;
    if (this.lines.length > 50) this.lines.shift();
  }

  /** Shows the captions of a time, in seconds of the clock of the messages. */
  show(now) {
    const line = this.lines.findLast(({words}) => words[0].time - Captions.early <= now);
    const shown = line && now < line.end + Captions.late ? line : undefined;
    const spoken = shown?.words.findLast(({time, end}) => time <= now && now < end + 0.1);
    if (shown === this.shown && spoken === this.spoken && shown?.letters === this.letters) return;
    Object.assign(this, {shown, spoken, letters: shown?.letters});
    const parts = [];
    for (const each of shown?.words ?? []) {
      const part = document.createElement(each === spoken ? 'b' : 'span');
      part.textContent = each.word;
      parts.push(parts.length && !Captions.joined.test(each.word) ? ' ' : '', part);
    }
    this.element.replaceChildren(...parts);
  }
}
