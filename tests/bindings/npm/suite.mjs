// The conformance suite by the package, in node and in pages: every value, mask, number and rate.

/**
 * The frames of FAP text of version 2.1, or of BAP text: {number, values by index}, nothing where
 * the mask is 0.
 */
export function readText(text) {
  const lines = text.split('\n').filter((line) => line.trim() !== '' && !line.startsWith('#'));
  const isFap = lines[0].startsWith('2.1');
  const frames = [];
  for (let i = 1; i + 1 < lines.length; i += 2) {
    const mask = lines[i].trim().split(/\s+/).map(Number);
    const numbers = lines[i + 1].trim().split(/\s+/).map(Number);
    let at = 1;
    const coded = mask.map((present, index) => {
      if (!present) return null;
      const count = isFap && index === 0 ? 4 : isFap && index === 1 ? 6 : 1;
      at += count;
      return numbers.slice(at - count, at).join(' ');
    });
    frames.push({number: numbers[0], coded});
  }
  return frames;
}

const bits = (flags) => flags.map(Number).join(' ');

/** A frame of the package in the same form. */
export function faceOf({number, values, mask, viseme, expression}) {
  const coded = Array.from(mask, (present, i) => present ? String(values[i]) : null);
  if (viseme) coded[0] = bits([viseme.select1, viseme.select2, viseme.blend, viseme.def]);
  if (expression) {
    coded[1] = bits([expression.select1, expression.intensity1, expression.select2,
        expression.intensity2,
                     expression.initFace, expression.def]);
  }
  return {number, coded};
}

const bodyOf = ({number, body}) =>
  ({number, coded: Array.from(body.mask, (present, i) => present ? String(body.values[i]) : null)});

// BAP text of old programs ends at 186.
function firstDifference(what, got, want) {
  if (got.length !== want.length) return `${got.length} frames of a ${what}, not ${want.length}`;
  for (let i = 0; i < want.length; ++i) {
    if (got[i].number !== want[i].number)
        return `${what} ${i} has number ${got[i].number}, not ${want[i].number}`;
    for (let k = 0; k < Math.max(want[i].coded.length, got[i].coded.length); ++k) {
      const value = got[i].coded[k] ?? null, right = want[i].coded[k] ?? null;
      if (value !== right) return `${what} ${i}, parameter ${k + 1}: ${value}, not ${right}`;
    }
  }
  return null;
}

// In pieces, as streams arrive; at damage it goes on, as the suite's decoders may.
function decodeAll(animeme, bytes) {
  const decoder = new animeme.Decoder({bodies: true});
  const frames = [], failures = [];
  const pull = () => {
    for (let tries = 0; tries < 1000; ++tries) {
      try {
        for (const frame of decoder) frames.push(frame);
        return;
      } catch (failure) {
        failures.push(failure.code);
      }
    }
  };
  for (let at = 0; at < bytes.length; at += 97) {
    decoder.push(bytes.subarray(at, at + 97));
    pull();
  }
  decoder.finish();
  pull();
  decoder.free();
  return {frames, failures};
}

/**
 * `read(path)`: bytes of a file of the suite, null if there is none. What is wrong, and how much
 * was compared.
 */
export async function checkSuite(animeme, names, read) {
  const report = {cases: 0, frames: 0, values: 0, wrong: []};
  const text = async (path) => {
    const bytes = await read(path);
    return bytes && new TextDecoder().decode(bytes);
  };
  for (const name of names) {
    const about = JSON.parse(await text(`${name}/case.json`));
    const {frames, failures} = decodeAll(animeme, await read(`${name}/${name}.fba`));
    const damaged = about.expected === 'error';
    const part = damaged ? 'intact' : 'dec';
    const faces = await text(`${name}/${name}.${part}.fap`),
        bodies = await text(`${name}/${name}.${part}.bap`);
    const got = frames.filter((frame) => frame.face).map(faceOf);
    const gotBodies = frames.filter((frame) => frame.body).map(bodyOf);
    const problem = firstDifference('face', got, faces ? readText(faces) : []) ??
        (bodies || !damaged ? firstDifference('body', gotBodies, bodies ? readText(bodies) : []) :
            null) ??
        (frames[0] && !rateIs(frames[0].rate, about.rate) ?
            `rate ${frames[0].rate}, not ${about.rate}` : null) ??
        (damaged !== failures.length > 0 ? `failures: ${failures}` : null) ??
        (damaged && !about.errors.includes(failures[0]) ? `${failures[0]}, not ${about.errors}` :
            null);
    if (problem) report.wrong.push(`${name}: ${problem}`);
    ++report.cases;
    report.frames += frames.length;
    for (const {coded} of [...got, ...gotBodies]) report.values += coded.filter((value) =>
        value !== null).length;
  }
  return report;
}

// "29.97" of texts is 30000/1001.
const rateIs = ([num, den],
    text) => Number((num / den).toFixed((text.split('.')[1] ?? '').length)) === Number(text);
