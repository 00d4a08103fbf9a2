// The page itself. Other scripts may take part by window.animeme:
//   addEventListener(type, listener), removeEventListener(): any number of listeners for
//     'frame'    each plane when it is due; event.detail: {values, time}, values by FAP number
//     'tick'     each displayed picture; event.detail: {now}, in audio time
//     'message'  what the server tells in words: event.detail
//   onFrame(values, time), onTick(now), onMessage(message): the same for one function each
//   viewport               the element of the face; setView(element) replaces what it shows
//   session                frames, clock(), latency(), buffered(), gaps
//   asked, flag(name)      parameters of the address; README.md of tools/live/web has them
(() => {
  const element = (id) => document.getElementById(id);
  const audio = element('audio'), start = element('start'), sound = element('sound');
  const badge = element('state');
  let names = {}, shown, values = {}, measured = 0, counted = [], wanted = true, again;
  const curves = {numbers: []}, captions = new Captions(element('captions'));

  const asked = new URLSearchParams(location.search);
  const flag = (name) => asked.has(name) && asked.get(name) !== '0';
  const bare = flag('transparent') || asked.get('controls') === '0';
  const root = document.documentElement;
  root.className = bare ? 'bare' : 'whole';
  root.classList.toggle('transparent', flag('transparent'));
  root.classList.toggle('controlled', flag('controls'));
  root.classList.toggle('captioned', bare ? flag('captions') : asked.get('captions') !== '0');
  // A frame whose scheme differs from that of the page around it would be filled with a colour.
  if (flag('transparent')) document.querySelector('meta[name=color-scheme]').remove();
  audio.muted = flag('muted');
  // Nothing until it is there, which runs behind this script.
  element('face').hidden = Boolean(document.querySelector('script[src="head.js"]'));

  const listeners = new EventTarget();
  const tell = (type, detail) => {
    if (type === 'frame') animeme.onFrame?.(detail.values, detail.time);
    if (type === 'tick') animeme.onTick?.(detail.now);
    if (type === 'message') animeme.onMessage?.(detail);
    listeners.dispatchEvent(new CustomEvent(type, {detail}));
  };
  const animeme = window.animeme = {
    addEventListener: listeners.addEventListener.bind(listeners),
    removeEventListener: listeners.removeEventListener.bind(listeners),
    onFrame: undefined, onTick: undefined, onMessage: undefined,
    viewport: element('viewport'),
    setView(view) { animeme.viewport.replaceChildren(view); },
    asked, flag,
    state: 'idle', shown: 0, time: 0, offset: 0, blocked: false,
  };

  // The button is there in the whole page, and wherever the browser wants a click before sound.
  function showSound() {
    const silent = audio.muted || session.soundless;
    sound.setAttribute('aria-pressed', String(!silent));
    sound.textContent = silent ? 'Sound on' : 'Sound off';
    root.classList.toggle('blocked', animeme.blocked);
  }

  function show(name, text) {
    animeme.state = name;
    badge.dataset.state = name;
    if (badge.textContent !== text) badge.textContent = text;
    start.textContent = name === 'idle' || name === 'ended' ? 'Start' : 'Stop';
    const mute = Boolean(session.info) && !session.info.audio;  // as a whole
    sound.hidden = element('volume').parentElement.hidden = mute;
    // Nobody is there to press Start.
    clearTimeout(again);
    if (name === 'ended' && bare) again = setTimeout(begin, 4000);
  }

  function begin() {
    element('message').hidden = true;
    if (session.info) session.stop();
    shown = undefined;
    session.start();
  }

  const session = animeme.session = new Rtc.Session(audio, {
    state: show,
    hello(faps) { names = faps; },
    frame(frame) { counted.push(frame); },
    told(message) {
      captions.told(message);
      tell('message', message);
    },
    blocked() {
      animeme.blocked = true;
      showSound();
    },
    error(text) {
      element('message').textContent = text;
      element('message').hidden = false;
      console.info(text);
    },
  });

  start.addEventListener('click', () => {
    wanted = animeme.state === 'idle' || animeme.state === 'ended';
    if (wanted) {
      begin();
    } else {
      session.stop();
      show('idle', 'stopped');
    }
  });
  sound.addEventListener('click', () => {
    audio.muted = !(audio.muted || session.soundless);
    animeme.blocked = false;
    if (session.soundless && wanted) begin();
    showSound();
  });
  audio.addEventListener('volumechange', showSound);
  element('volume').addEventListener('input', (event) => { audio.volume = event.target.value; });

  const write = (id, value, digits) => {
    element(id).textContent = Number.isFinite(value) ? value.toFixed(digits) : '\u2013';
  };

  function measure(now) {
    const wall = performance.now() / 1000;
    counted = counted.filter((frame) => frame.arrived > wall - 2);
    if (bare) return;
    const running = session.running && session.info;
    write('latency', running ? session.latency() : NaN, 2);
    write('buffered', running && session.info.audio ? session.buffered() : NaN, 2);
    write('offset', shown ? animeme.offset * 1000 : NaN, 0);
    write('rate', running ? counted.length / 2 : NaN, 1);
    write('bits', running ? counted.reduce((sum, frame) => sum + frame.bytes, 0) * 8 / 2000 : NaN,
        1);
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
      tell('frame', {values, time: frame.time});
    }
    captions.show(now);
    tell('tick', {now});
    if (element('face')) Face.draw(element('face'), values);
    if (performance.now() - measured > 100) {
      measured = performance.now();
      measure(now);
    }
    requestAnimationFrame(tick);
  }
  requestAnimationFrame(tick);
  for (const link of document.querySelectorAll('footer a')) {
    link.href = Live.address(link.getAttribute('href'));
  }
  showSound();
  begin();
})();
