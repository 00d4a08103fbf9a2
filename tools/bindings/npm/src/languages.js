// Languages of a file, and what is said in one of them.

const kLongestLine = 42;  // letters
const kPause = 0.6;  // seconds, behind which a line begins

// Letters of scripts without blanks between words: Chinese, Japanese, Thai, Lao, Burmese, Khmer.
const kWithoutBlanks =
    '\\p{sc=Han}\\p{sc=Hira}\\p{sc=Kana}\\p{sc=Thai}\\p{sc=Laoo}\\p{sc=Mymr}\\p{sc=Khmr}';
const kJoined = new RegExp(
    `[${kWithoutBlanks}\\u3000-\\u303f\\uff00-\\uffef]\n[${kWithoutBlanks}]`, 'u');

/** Whether a tag is what is wanted, or a narrower one: `pt` is also `pt-BR`. */
export function speaks(wanted, tag) {
  const [a, b] = [wanted.toLowerCase(), tag.toLowerCase()];
  return a === b || b.startsWith(`${a}-`);
}

/** The number of the language in a list of {lang}; the first one where it is not there. */
export function languageIn(list, wanted) {
  return wanted ? Math.max(list.findIndex(({lang}) => speaks(wanted, lang)), 0) : 0;
}

/** Adds a word {start, end, text} to lines, to the last one where it belongs to it. */
export function addWord(lines, {start, end, text}) {
  const line = lines.at(-1);
  const goes = line && start - line.end < kPause && !/[.?!\u3002\uff01\uff1f]$/.test(line.text) &&
      line.text.length + text.length < kLongestLine;
  if (!goes) {
    lines.push({start, end, text});
  } else {
    line.text += (kJoined.test(`${line.text.at(-1)}\n${text}`) ? '' : ' ') + text;
    line.end = end;
  }
}

/** The cue of a time, or null. */
export const cueAt = (cues, time) =>
    cues.find(({start, end}) => start <= time && time < end) ?? null;

/** The cue of a sample of timed text (tx3g): null where it is empty. */
export function cueOfSample({time, duration, bytes}) {
  if (bytes.length < 2) return null;
  const size = bytes[0] << 8 | bytes[1];
  const text = new TextDecoder().decode(bytes.subarray(2, 2 + size)).trim();
  return text ? {start: time, end: time + duration, text} : null;
}

const secondsOf = (text) => text.trim().split(':')
    .reduce((sum, part) => sum * 60 + Number(part), 0);

/** The cues of a WebVTT file, without their markup. */
export function cuesOfVtt(text) {
  const cues = [];
  for (const block of text.replace(/\r\n?/g, '\n').split(/\n{2,}/)) {
    const lines = block.split('\n'), at = lines.findIndex((line) => line.includes('-->'));
    if (at < 0) continue;
    const [start, end] = lines[at].split('-->')
        .map((part) => secondsOf(part.trim().split(/\s/)[0]));
    const said = lines.slice(at + 1).join(' ').replace(/<[^>]*>/g, '')
        .replace(/&lt;/g, '<').replace(/&gt;/g, '>').replace(/&nbsp;/g, ' ').replace(/&amp;/g, '&')
        .trim();
    if (end > start && said) cues.push({start, end, text: said});
  }
  return cues;
}
