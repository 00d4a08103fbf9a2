// Turns of the head and of the eyes between the steps of a quantiser, as fap/turns.h eases them:
// what is eased is never further than half a step from what is coded.
const TURNS = [23, 24, 25, 26, 48, 49, 50];
const FINEST_STEP = 60, COARSEST_STEP = 2000;  // steps in 1e-5 rad
const FOLLOW = 0.15, FOLLOW_SPEED = 0.005, TAKE_SPEED = 0.35, PASSES = 8;
const CERTAIN = 3;  // changes from which on the step is known

const isEased = (step) => step >= FINEST_STEP && step <= COARSEST_STEP;

function commonStep(a, b) {
  [a, b] = [Math.abs(a), Math.abs(b)];
  while (b) [a, b] = [b, a % b];
  return a;
}

const near = (value, coded, step) => Math.min(Math.max(value, coded - step / 2), coded + step / 2);

// One FAP: next() takes a coded value and gives what is shown.
class Turn {
  constructor(step, value) {
    Object.assign(this, {step, value, speed: 0, coded: 0, changes: 0});
  }

  next(coded) {
    const expected = this.value + this.speed, off = coded - expected;
    const wanted = expected + FOLLOW * off, next = near(wanted, coded, this.step);
    this.speed += next === wanted ? FOLLOW_SPEED * off :
        TAKE_SPEED * (next - this.value - this.speed);
    return this.value = next;
  }
}

/** For streams: next() gives the same values, by FAP, with eased turns. */
export class TurnSmoother {
  constructor() {
    this.turns = {};
  }

  next(values) {
    const out = {...values};
    for (const fap of TURNS) {
      const coded = values[fap];
      if (coded === undefined) {
        delete this.turns[fap];
        continue;
      }
      const turn = this.turns[fap] ??= new Turn(0, coded);
      turn.step = commonStep(turn.step, coded);
      if (coded !== turn.coded) ++turn.changes;
      turn.coded = coded;
      if (turn.changes >= CERTAIN && isEased(turn.step)) out[fap] = turn.next(coded);
      else Object.assign(turn, {value: coded, speed: 0});
    }
    return out;
  }
}

/**
 * For clips: the columns of these FAPs, eased forwards and backwards; those that stay are missing.
 */
export function easedTurns(columns) {
  const out = {};
  for (const fap of TURNS) {
    const coded = columns[fap];
    if (!coded?.length) continue;
    const step = coded.reduce(commonStep, 0), last = coded.length - 1;
    if (!isEased(step)) continue;
    const [to, fro] = [new Turn(step, coded[0]), new Turn(step, coded[last])];
    const eased = Float64Array.from(coded, (value) => to.next(value) / 2);
    for (let i = last; i >= 0; --i) eased[i] += fro.next(coded[i]) / 2;
    for (let pass = 0; pass < PASSES; ++pass) {
      let before = eased[0];
      for (let i = 1; i < last; ++i) {
        const mean = (before + 2 * eased[i] + eased[i + 1]) / 4;
        before = eased[i];
        eased[i] = near(mean, coded[i], step);
      }
    }
    out[fap] = eased;
  }
  return out;
}
