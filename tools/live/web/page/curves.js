// FAPs that moved in the last seconds as curves, a row each, scaled to its own range.
const Curves = (() => {
  const kSeconds = 5, kMost = 6;
  const kName = 18;  // pixels of a row for its name
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  // What tells most of a talking face first: jaw, lips, corners of the mouth, brows, lids, head.
  const kFirst = ['3', '5', '4', '6', '12', '52', '51', '53', '59', '31', '19', '48', '49', '50'];
  const rank = (number) => (kFirst.indexOf(number) + kFirst.length + 1) % (kFirst.length + 1);

  // The FAPs that move, at most kMost of them, and between which values.
  function choose(frames) {
    const low = new Map(), high = new Map();
    for (const frame of frames) {
      for (const [number, value] of Object.entries(frame.values)) {
        if (typeof value !== 'number') continue;
        low.set(number, Math.min(low.get(number) ?? value, value));
        high.set(number, Math.max(high.get(number) ?? value, value));
      }
    }
    const numbers = [...low.keys()].filter((number) => high.get(number) > low.get(number));
    numbers.sort((a, b) => rank(a) - rank(b) || a - b);
    return {numbers: numbers.slice(0, kMost), low, high};
  }

  function draw(canvas, frames, now, state) {
    const scale = devicePixelRatio, width = canvas.clientWidth, height = canvas.clientHeight;
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round(height * scale);
    const context = canvas.getContext('2d');
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.strokeStyle = colour('--line');
    context.lineWidth = 1;
    for (let second = 0; second <= kSeconds; ++second) {
      const x = Math.round(width * second / kSeconds) + (second === 0 ? 0.5 : -0.5);
      context.beginPath();
      context.moveTo(x, 0);
      context.lineTo(x, height);
      context.stroke();
    }
    const shown = frames.filter((frame) => frame.time > now - kSeconds - 0.2 && frame.time <= now);
    const {numbers, low, high} = choose(shown);
    numbers.forEach((number, index) => {
      const row = height / kMost, top = index * row + kName, curve = row - kName - 4;
      const span = Math.max(high.get(number) - low.get(number), 1);
      context.beginPath();
      for (const frame of shown) {
        const x = width * (1 - (now - frame.time) / kSeconds);
        const value = frame.values[number] ?? 0;
        context.lineTo(x, top + curve * (1 - (value - low.get(number)) / span));
      }
      context.strokeStyle = colour(`--c${index}`);
      context.lineWidth = 2;
      context.lineJoin = 'round';
      context.stroke();
    });
    const changed = numbers.join() !== state.numbers.join();
    state.numbers = numbers;
    return changed;
  }
  return {draw};
})();
