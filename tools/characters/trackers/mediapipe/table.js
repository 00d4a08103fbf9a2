// What trackers write: a row a picture, beside its place until it is whole, and on standard error
// how far it is.
'use strict';

const fs = require('node:fs');

class Table {
  /** `count`: of rows, if it is known (else 0). `digits` behind the point. */
  constructor(file, {program, count, digits}) {
    Object.assign(this, {file, program, count, digits, rows: [], columns: [], begin: Date.now(),
        told: 0});
  }
  /**
   * {columns, values} of a picture, or null where there is no face. The columns are those of the
   * first face.
   */
  add(found) {
    if (found && this.columns.length === 0) this.columns = found.columns;
    this.rows.push(found && found.values.map((value) => value.toFixed(this.digits)).join());
    const now = Date.now();
    if (this.count === 0 || now - this.told < 500) return;
    this.told = now;
    const share = Math.min(99, Math.floor(100 * this.rows.length / this.count));
    process.stderr.write(`${this.program}: ${share} %\n`);
  }
  /**
   * Gives the file its name. `times`: of the rows, in seconds. An Error if there is no face in any
   * row.
   */
  finish(times) {
    const faces = this.rows.filter((row) => row !== null).length;
    if (faces === 0) throw new Error(`no face was found in any of ${this.rows.length} pictures`);
    if (times.length < this.rows.length)
        throw new Error('ffmpeg does not report the times of all frames');
    const empty = ','.repeat(this.columns.length);
    const part = this.file + '.part';
    const out = fs.openSync(part, 'w');
    fs.writeSync(out, 'time_s,confidence,' + this.columns.join() + '\n');
    this.rows.forEach((row, i) => {
      fs.writeSync(out, (times[i] - times[0]).toFixed(6) +
          (row === null ? ',0' + empty : ',1,' + row) + '\n');
    });
    fs.fsyncSync(out);
    fs.closeSync(out);
    fs.renameSync(part, this.file);
    const speed = 1000 * this.rows.length / (Date.now() - this.begin);
    process.stderr.write(`${this.program}: a face in ${faces} of ${this.rows.length} pictures, ` +
        `${speed.toFixed(1)} a second\n`);
  }
}

module.exports = {Table};
