// The list of FAPs with a search box: which curves are shown.

const MOST = 24;  // rows that are chosen at once

/** FAPs that move most in a clip, in rows of one kind: left sides stand for both. */
export function mostMoving(clip, count) {
  const moves = Object.keys(clip.columns).map(Number).filter((n) => n <= 68).map((fap) => {
    const column = clip.columns[fap];
    let path = 0;
    for (let i = 1; i < column.length; ++i) path += Math.abs(column[i] - column[i - 1]);
    const [low, high] = clip.range(fap);
    return {fap, path: (high - low) && path / (high - low)};
  });
  const usual = [3, 4, 5, 6, 16, 19, 31, 23, 48, 49].filter((fap) => clip.columns[fap]);
  const others = moves.sort((a, b) => b.path - a.path).map(({fap}) => fap);
  return [...new Set([...usual, ...others])].slice(0, count).sort((a, b) => a - b);
}

export class Chooser {
  /** `onChoose` gets the numbers in ascending order. */
  constructor({search, list, count}, facts, clips, onChoose) {
    Object.assign(this, {search, list, count, onChoose});
    this.boxes = new Map();
    this.groups = facts.groups.map((name, i) => this.group(
        name, facts.faps.filter((fap) => fap.group === i + 1 && fap.number > 2), clips));
    list.append(...this.groups.filter(({faps}) => faps.length).map(({element}) => element));
    search.addEventListener('input', () => this.filter());
    search.addEventListener('keydown', (event) => {
      if (event.key !== 'Escape') return;
      search.value = '';
      this.filter();
    });
  }

  group(name, faps, clips) {
    const element = document.createElement('fieldset');
    const legend = document.createElement('legend');
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = name;
    button.title = 'Show or hide all';
    legend.append(button);
    const rows = faps.map((fap) => this.row(fap, clips));
    element.append(legend, ...rows);
    button.addEventListener('click', () => this.chooseGroup(faps, rows));
    return {element, name, faps, rows};
  }

  row(fap, clips) {
    const row = document.createElement('label');
    const box = document.createElement('input');
    box.type = 'checkbox';
    box.addEventListener('change', () => this.tell());
    this.boxes.set(fap.number, box);
    const number = document.createElement('i');
    number.textContent = fap.number;
    const name = document.createElement('span');
    name.textContent = fap.name;
    row.append(box, number, name);
    row.classList.toggle('still', !clips.some((clip) => clip.columns[fap.number]));
    row.title = [fap.point && `feature point ${fap.point}`, `unit ${fap.unit}`].filter(Boolean)
        .join(', ');
    return row;
  }

  chooseGroup(faps, rows) {
    const shown = faps.filter((_, i) => !rows[i].hidden).map((fap) => this.boxes.get(fap.number));
    const all = shown.every((box) => box.checked);
    for (const box of shown) box.checked = !all;
    this.tell();
  }

  /** Words of the search must all be in the number, name, group or feature point. */
  filter() {
    const words = this.search.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const {element, name, faps, rows} of this.groups) {
      faps.forEach((fap, i) => {
        const text = `${fap.number} ${fap.name} ${name} ${fap.point}`.toLowerCase();
        const numbers = words.every((word) => /^\d+$/.test(word));
        rows[i].hidden = numbers && words.length ? !words.includes(String(fap.number)) :
            !words.every((word) => text.includes(word));
      });
      element.hidden = rows.every((row) => row.hidden);
    }
  }

  choose(faps) {
    for (const [fap, box] of this.boxes) box.checked = faps.includes(fap);
    this.tell();
  }

  chosen() {
    return [...this.boxes].filter(([, box]) => box.checked).map(([fap]) => fap);
  }

  tell() {
    const faps = this.chosen();
    if (faps.length > MOST) {
      for (const fap of faps.splice(MOST)) this.boxes.get(fap).checked = false;
    }
    this.count.textContent = `${faps.length} shown`;
    this.onChoose(faps);
  }
}
