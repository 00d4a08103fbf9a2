// node report.js mp4box|isoboxer FILE: what a reader makes of an MP4, as JSON.
'use strict';

const fs = require('fs');

const [reader, file] = process.argv.slice(2);
const content = fs.readFileSync(file);
const bytes = content.buffer.slice(content.byteOffset, content.byteOffset + content.length);
const readers = {
  mp4box: () => require('./mp4box_report').mp4boxReport(
      require('mp4box'), bytes, (part) => Buffer.from(part).toString('hex')),
  isoboxer: () => require('./isoboxer_report').isoboxerReport(bytes),
};
process.stdout.write(JSON.stringify(readers[reader](), null, 1) + '\n');
