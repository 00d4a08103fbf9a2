// Keys, and the list of them.

/** [keys as shown, keys as events name them, what they do, call]. */
export function keyTable(app) {
  const {player} = app;
  const speeds = [0.25, 0.5, 0.75, 1, 1.25, 1.5, 2];
  const faster = (by) => {
    const at = speeds.findIndex((speed) => speed >= player.rate - 1e-6);
    player.setRate(speeds[Math.min(Math.max(at + by, 0), speeds.length - 1)]);
  };
  return [
    ['Space K', [' ', 'k'], 'play or pause', () => player.toggle()],
    ['← →', ['ArrowLeft', 'ArrowRight'], 'one frame; with Shift ten frames',
      (event) => app.step((event.key === 'ArrowLeft' ? -1 : 1) * (event.shiftKey ? 10 : 1))],
    ['J L', ['j', 'l'], 'one second back or forward',
      (event) => app.seek(app.time() + (event.key.toLowerCase() === 'j' ? -1 : 1))],
    ['↑ ↓', ['ArrowUp', 'ArrowDown'], 'faster, slower',
      (event) => faster(event.key === 'ArrowUp' ? 1 : -1)],
    ['Home End', ['Home', 'End'], 'to the beginning or the end',
      (event) => app.seek(event.key === 'Home' ? 0 : player.duration)],
    ['[ ]', ['[', ']'], 'start or end the loop here',
      (event) => (event.key === '[' ? app.markFrom() : app.markTo())],
    ['\\', ['\\'], 'mark nothing', () => app.mark(null)],
    ['O', ['o'], 'loop on or off', () => player.setLooping(!player.looping)],
    ['M', ['m'], 'sound on or off', () => app.mute()],
    ['I', ['i'], 'interpolate between frames', () => app.set('between', !app.options.between)],
    ['W', ['w'], 'wireframe', () => app.set('wire', !app.options.wire)],
    ['P', ['p'], 'feature points', () => app.set('points', !app.options.points)],
    ['G', ['g'], 'next comparison mode for two clips', () => app.nextMode()],
    ['R', ['r'], 'front view', () => app.resetView()],
    ['4 6 8 2', ['4', '6', '8', '2'], 'rotate the head', (event) => app.turnView(
        {4: -15, 6: 15}[event.key] || 0, {8: 10, 2: -10}[event.key] || 0)],
    ['F', ['f'], 'full screen', () => app.fullscreen()],
    ['+ −', ['+', '=', '-'], 'zoom the curves in or out',
      (event) => app.axis.zoom(event.key === '-' ? 0.5 : 2, app.time())],
    ['?', ['?'], 'this list', () => app.help()],
  ];
}

// Keys that a focused element needs for itself.
function isOwn(target, key) {
  if (target.closest('input[type=search], select')) return true;
  if (key === ' ') return Boolean(target.closest('button, input:not([type=range])'));
  return key.startsWith('Arrow') && Boolean(target.closest('input[type=radio]'));
}

/** Listens to the keys of the page. `dialog`: the list, which takes all keys while it is open. */
export function listenToKeys(table, dialog) {
  const calls = new Map();
  for (const [, keys, , call] of table) for (const key of keys) calls.set(key, call);
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || isOwn(event.target, event.key)) return;
    if (dialog.open && event.key !== '?') return;
    const call = calls.get(event.key) || calls.get(event.key.toLowerCase());
    if (!call) return;
    event.preventDefault();
    call(event);
  });
}

export function fillHelp(list, table) {
  for (const [keys, , text] of table) {
    const term = document.createElement('dt');
    term.append(...keys.split(' ').map((key) => {
      const mark = document.createElement('kbd');
      mark.textContent = key;
      return mark;
    }));
    const meaning = document.createElement('dd');
    meaning.textContent = text;
    list.append(term, meaning);
  }
}
