// A module of WebAssembly behind the C interface (animeme.h): memory, texts, failures.
import {ERROR_SIZE} from './structs.js';

const STATUS = {
  '-1': 'invalid_argument', '-2': 'syntax', '-3': 'out_of_range', '-4': 'truncated',
      '-5': 'unsupported',
  '-6': 'not_found', '-7': 'io', '-8': 'internal', '-9': 'no_memory',
};

/**
 * What failed and where: `code` is a word, `bit` a place in a stream, `line` and `column` one in a
 * text.
 */
export class AnimemeError extends Error {
  constructor(code, message, place = {}) {
    super(message);
    this.name = 'AnimemeError';
    this.code = code;
    this.bit = place.bit ?? -1;
    this.line = place.line ?? 0;
    this.column = place.column ?? 0;
  }
}

/** One instance. Views of its memory are made anew each time, as it may grow. */
export class Library {
  constructor(instance) {
    this.functions = instance.exports;
    this.functions._initialize();
    this.error = this.allocate(ERROR_SIZE);
    this.slot = this.allocate(8);
    this.encoder = new TextEncoder();
    this.decoder = new TextDecoder();
  }

  get memory() { return this.functions.memory.buffer; }

  allocate(size) {
    const at = this.functions.malloc(size) >>> 0;
    if (at === 0) throw new AnimemeError('no_memory', 'out of memory');
    return at;
  }

  free(at) { this.functions.free(at); }

  /** Calls a function whose last argument is the error; what it returns is not a failure. */
  call(name, ...given) {
    const status = this.functions[`animeme_${name}`](...given, this.error);
    if (status < 0) throw this.failure(status);
    return status;
  }

  failure(status) {
    const view = new DataView(this.memory, this.error, ERROR_SIZE);
    const number = (at) => Number(view.getBigInt64(at, true));
    return new AnimemeError(STATUS[status] ?? 'internal', this.text(this.error + 32),
                            {line: number(8), column: number(16), bit: number(24)});
  }

  /** What a function writes as a handle into a place of its own, the one before the error. */
  make(name, ...given) {
    this.call(name, ...given, this.slot);
    return new DataView(this.memory).getUint32(this.slot, true);
  }

  text(at) {
    if (at === 0) return null;
    const bytes = new Uint8Array(this.memory, at);
    return this.decoder.decode(bytes.slice(0, bytes.indexOf(0)));
  }

  /** Runs `use` with a copy of bytes, or of a text with its 0. */
  with(given, use) {
    const bytes = typeof given === 'string' ? this.encoder.encode(given + '\0') : given;
    const at = this.allocate(Math.max(bytes.length, 1));
    try {
      new Uint8Array(this.memory, at, bytes.length).set(bytes);
      return use(at, bytes.length);
    } finally {
      this.free(at);
    }
  }
}

// What the C++ library asks of its system: nothing that happens in a decoder.
const system = {
  proc_exit(code) { throw new Error(`the module ended (${code})`); },
};
const refused = () => 52;  // ENOSYS

/**
 * Compiles and starts a module: bytes, a Response, a WebAssembly.Module, or a promise of one of
 * them.
 */
export async function start(given) {
  const source = await given;
  let module = source;
  if (typeof Response !== 'undefined' && source instanceof Response) {
    if (!source.ok)
        throw new AnimemeError('io', `${source.url}: ${source.status} ${source.statusText}`);
    module = await WebAssembly.compile(await source.arrayBuffer());
  } else if (!(source instanceof WebAssembly.Module)) {
    module = await WebAssembly.compile(source);
  }
  const imports = {};
  for (const {module: from, name} of WebAssembly.Module.imports(module)) {
    imports[from] ??= {};
    imports[from][name] = system[name] ?? (name === 'emscripten_notify_memory_growth' ? () => {} :
        refused);
  }
  return new Library(await WebAssembly.instantiate(module, imports));
}
