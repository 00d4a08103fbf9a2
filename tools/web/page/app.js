// The page itself. Other scripts may take part by window.animeme:
//   onFrame(values, time)  is called for each plane when it is due; values by FAP number
//   stage                  the element of the face; setView(element) replaces what it shows
//   session                frames, clock(), latency(), buffered(), gaps
(() => {
  const element = (id) => document.getElementById(id);
  const audio = element('audio'), start = element('start'), badge = element('state');
  let names = {}, shown, values = {}, measured = 0, counted = [];
  const curves = {numbers: []};

  const animeme = window.animeme = {
    onFrame: undefined,
    stage: element('stage'),
    setView(view) { animeme.stage.replaceChildren(view); },
    state: 'idle', shown: 0, time: 0, offset: 0,
  };

  const session = animeme.session = new Rtc.Session(audio, {
    state(name, text) {
      animeme.state = name;
      badge.dataset.state = name;
      if (badge.textContent !== text) badge.textContent = text;
      start.textContent = name === 'idle' || name === 'ended' ? 'Start' : 'Stop';
    },
    hello(faps) { names = faps; },
    frame(frame) { counted.push(frame); },
    error(text) {
      element('message').textContent = text;
      element('message').hidden = false;
    },
  });

  start.addEventListener('click', () => {
    element('message').hidden = true;
    const idle = animeme.state === 'idle' || animeme.state === 'ended';
    session.stop();
    shown = undefined;
    if (idle) {
      session.start();
    } else {
      badge.dataset.state = animeme.state = 'idle';
      badge.textContent = 'not started';
      start.textContent = 'Start';
    }
  });
  element('volume').addEventListener('input', (event) => { audio.volume = event.target.value; });

  const write = (id, value, digits) => {
    element(id).textContent = Number.isFinite(value) ? value.toFixed(digits) : '\u2013';
  };

  function measure(now) {
    const wall = performance.now() / 1000;
    counted = counted.filter((frame) => frame.arrived > wall - 2);
    const running = session.running && session.info;
    write('latency', running ? session.latency() : NaN, 2);
    write('buffered', running && session.info.audio ? session.buffered() : NaN, 2);
    write('offset', shown ? animeme.offset * 1000 : NaN, 0);
    write('rate', running ? counted.length / 2 : NaN, 1);
    write('bits', running ? counted.reduce((sum, frame) => sum + frame.bytes, 0) * 8 / 2000 : NaN, 1);
    element('gaps').textContent = session.gaps;
    const open = Math.round(100 * Math.min(1, Face.opening(values)));
    element('mouth').setAttribute('aria-valuenow', open);
    if (Curves.draw(element('curves'), session.frames, now, curves)) legend();
  }

  function legend() {
    element('legend').replaceChildren(...curves.numbers.map((number, index) => {
      const item = document.createElement('li'), mark = document.createElement('b');
      mark.style.background = `var(--c${index})`;
      const name = names[number] ? names[number].name.replaceAll('_', ' ') : `FAP ${number}`;
      item.append(mark, name);
      return item;
    }));
  }

  function tick() {
    const now = session.clock(), frame = session.due(now);
    if (frame && frame !== shown) {
      shown = frame;
      values = frame.values;
      animeme.time = frame.time;
      // How late the plane is shown, against the sound that is heard.
      animeme.offset = now - frame.time;
      ++animeme.shown;
      element('mouth').firstElementChild.style.width =
          `${100 * Math.min(1, Face.opening(values))}%`;
      if (animeme.onFrame) animeme.onFrame(values, frame.time);
    }
    if (element('face')) Face.draw(element('face'), values);
    if (performance.now() - measured > 100) {
      measured = performance.now();
      measure(now);
    }
    requestAnimationFrame(tick);
  }
  requestAnimationFrame(tick);
})();
