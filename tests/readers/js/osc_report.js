// node osc_report.js < HEX: messages of OSC packets, one packet a line in hexadecimal, as JSON, one
// a line.
'use strict';

const fs = require('fs');

// A bundle's messages in their order; a message as it is.
function flat(packet) {
  return packet.oscType === 'bundle' ? packet.elements.flatMap(flat) : [packet];
}

import('osc-min').then(({fromBuffer}) => {
  for (const line of fs.readFileSync(0, 'latin1').split('\n')) {
    if (line === '') continue;
    for (const message of flat(fromBuffer(Buffer.from(line, 'hex')))) {
      const args = message.args.map((argument) => argument.value);
      process.stdout.write(JSON.stringify({address: message.address, args}) + '\n');
    }
  }
});
