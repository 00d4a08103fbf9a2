// Objects that own something in the memory of a module.

const forgotten = new FinalizationRegistry(({library, free, at}) => library.functions[free](at));

export class Handle {
  /** `type` as in animeme.h: animeme_<type>_free() undoes it. */
  constructor(library, type, at) {
    this.library = library;
    this.handle = at;
    this.undo = `animeme_${type}_free`;
    forgotten.register(this, {library, free: this.undo, at}, this);
  }

  /** Frees the memory now; else it is freed some time after the object is forgotten. */
  free() {
    if (!this.handle) return;
    forgotten.unregister(this);
    this.library.functions[this.undo](this.handle);
    this.handle = 0;
  }

  /** For `using`, where there is that. */
  [Symbol.dispose ?? Symbol.for('Symbol.dispose')]() { this.free(); }
}
