// The same in node, whose fetch() does not read files.
import {readFile} from 'node:fs/promises';

import {setLoader} from './modules.js';

setLoader((place) => new URL(place, 'file:').protocol === 'file:' ?
    readFile(new URL(place, 'file:')) : fetch(place));

export * from './index.js';
