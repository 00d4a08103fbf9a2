// Reads /faps?binary, one plane a call: {time, duration, intra, missed, bytes, values}.
function planeReader(timescale) {
  let ticks = 0, values = {};
  return (data) => {
    const bytes = new Uint8Array(data);
    let at = 10;
    const number = () => {
      for (let sum = 0, scale = 1;; scale *= 128) {
        const byte = bytes[at++];
        sum += (byte & 127) * scale;
        if (byte < 128) return sum;
      }
    };
    const signed = () => {
      const sum = number();
      return sum % 2 ? -(sum + 1) / 2 : sum / 2;
    };
    const named = (names) => Object.fromEntries(names.map((name) => [name, signed()]));
    const flags = bytes[0];
    if (flags & 4) [ticks, values] = [0, {}];
    ticks += number();
    const plane = {time: ticks / timescale, duration: number() / timescale, intra: (flags & 1) > 0,
      missed: (flags & 2) > 0, bytes: number()};
    values = {...values};
    for (let fap = 1; fap <= 68; ++fap) {
      if (!(bytes[1 + (fap - 1 >> 3)] >> (fap - 1 & 7) & 1)) continue;
      if (fap === 1) values[1] = named(['select1', 'select2', 'blend']);
      else if (fap === 2) values[2] = named(['select1', 'intensity1', 'select2', 'intensity2']);
      else values[fap] = (values[fap] ?? 0) + signed();
    }
    return {...plane, values};
  };
}
