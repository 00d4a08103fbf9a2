// node turns_report.mjs VALUE...: what tools/view/viewer/js/turns.js makes of a FAP 49 that is
// coded as these values: {clip: [...], stream: [...]}, rounded as fap/turns.h rounds.
import {easedTurns, TurnSmoother} from '../../../../tools/view/viewer/js/turns.js';

const coded = process.argv.slice(2).map(Number);
const turns = new TurnSmoother();
console.log(JSON.stringify({
  clip: Array.from(easedTurns({49: Int32Array.from(coded)})[49] ?? coded, Math.round),
  stream: coded.map((value) => Math.round(turns.next({49: value})[49])),
}));
