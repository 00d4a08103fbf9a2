// The modules of WebAssembly that are loaded, and from where.
import {AnimemeError, start} from './library.js';

const places = {
  decoder: new URL('../wasm/decoder.wasm', import.meta.url),
  speaker: new URL('../wasm/speaker.wasm', import.meta.url),
};
const loading = {}, loaded = {};
let load = (place) => fetch(place);

/** How files of the package are read where fetch() does not know them (node). */
export function setLoader(loader) { load = loader; }

/** The bytes of a file of the package, or of any address. */
export async function bytesOf(place) {
  const source = await load(place);
  if (!(typeof Response !== 'undefined' && source instanceof Response)) return source;
  if (!source.ok) throw new AnimemeError('io', `${place}: ${source.status} ${source.statusText}`);
  return new Uint8Array(await source.arrayBuffer());
}

/** Loads a module once; after a failure the next call tries again. */
export function need(name, source) {
  loading[name] ??= start(source ?? load(places[name]))
      .then((library) => loaded[name] = library)
      .catch((problem) => { delete loading[name]; throw problem; });
  return loading[name];
}

/** A module that has been loaded. */
export function library(name) {
  if (!loaded[name]) throw new AnimemeError('invalid_argument',
      'await ready() first: nothing is loaded yet');
  return loaded[name];
}
