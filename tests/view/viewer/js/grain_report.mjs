// node grain_report.mjs: the block of tools/view/viewer/js/grain.js, byte by byte.
import {grainBlock} from '../../../../tools/view/viewer/js/grain.js';

console.log(JSON.stringify({block: Array.from(grainBlock())}));
