// The report of the Khronos validator (npm gltf-validator) on a .glb file, as JSON.
'use strict';
const fs = require('fs');
const path = require('path');
const packages = path.join(__dirname, '..', '..', '..', 'readers', 'js', 'node_modules');
const validator = require(path.join(packages, 'gltf-validator'));

validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[2])))
    .then((report) => console.log(JSON.stringify(report)))
    .catch((error) => {
      console.error(error);
      process.exit(1);
    });
