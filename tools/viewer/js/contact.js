// What a face does not do whatever its FAPs say: the same as stop_at_contact() of stops.cpp and
// close_pairs() of pose.cpp in fap/head.
import {smoothStep} from './vector.js';

const LID_RISE = -270;  // upper lids rise by this at most
const JAW_BACK = -250;  // and the jaw goes back by this
const CHIN_UP = 420;  // the chin rises by this at most
const CHEEK_IN = 180;  // cheeks are sucked in by this at most
const CORNER_TURN = 300;  // outer corners rise and fall with the inner ones but for this
const TONGUE_IN = 190;  // the tongue gets as far behind shut lips,
const TONGUE_OUT = 3;  // and this times farther than they are open
const CONTACT = 0.06;  // of MNS: lips and lids so near are shut

// Two FAPs whose points would pass each other let them meet half way.
function meet(v, a, b) {
  const over = (v[a] + v[b]) / 2;
  if (over <= 0) return;
  v[a] -= over;
  v[b] -= over;
}

// Lips that nearly touch are shut: for heads of which no pairs are known, see closePairs().
function closeNearly(v, a, b) {
  const apart = -(v[a] + v[b]);
  if (apart <= 0) return;
  const closer = apart * smoothStep(CONTACT * 1024, CONTACT * 1024 / 3, apart) / 2;
  v[a] += closer;
  v[b] += closer;
}

// As meet(), where the meeting place follows from the shares of both.
function share(v, a, b, room) {
  const sum = v[a] + v[b];
  if (sum <= room) return;
  if (v[a] > 0 && v[b] > 0) {
    v[a] *= room / sum;
    v[b] *= room / sum;
  } else if (v[a] > v[b]) {
    v[a] = room - v[b];
  } else {
    v[b] = room - v[a];
  }
}

// Points that would come too near to each other, so that the skin between them folds over.
// `usual`: on a face that has the reaches of people.
function stopAtRooms(v, rooms, usual) {
  const atLeast = (faps, least) => { for (const f of faps) v[f] = Math.max(v[f], least); };
  const atMost = (faps, room) => {
    for (const [outer, inner] of faps) v[outer] = Math.min(v[outer], v[inner] + room);
  };
  atLeast([19, 20], LID_RISE);
  atLeast([14], JAW_BACK);
  atLeast([18], -rooms.chin);
  v[45] = Math.min(v[45], TONGUE_IN + TONGUE_OUT * Math.max(-v[4] - v[5], 0));
  atLeast([31, 32, 33, 34, 35, 36], -rooms.brow_lid);
  atLeast([37, 38], -0.5 * rooms.brows);
  share(v, 37, 38, rooms.brows);
  // A chin that is up is not pushed aside as well.
  if (usual) atLeast([3], -CHIN_UP + Math.abs(v[15]) + Math.max(v[18], 0));
  // An open jaw takes lips and corners along, down and back.
  const jaw = Math.max(v[3], 0);
  atLeast([16], -620 - 0.5 * jaw);
  atLeast([12, 13, 59, 60], -440 - 0.3 * jaw);
  const chin = v[3] < 0 ? Math.min(v[18], 0) - v[3] : Math.min(v[18] - jaw, 0);
  atLeast([5, 10, 11, 52, 57, 58], chin - rooms.lip_chin);
  atLeast([4, 8, 9, 51, 55, 56], -rooms.nose_lip);
  // The outer corner of the mouth against the inner one, aside and up together.
  for (const side of [0, 1]) {
    const aside = v[53 + side] - v[6 + side];
    const up = v[59 + side] - v[12 + side];
    const far = Math.hypot(aside / (aside < 0 ? rooms.corner : 0.2 * rooms.corner) || 0, up / CORNER_TURN);
    v[53 + side] = v[6 + side] + aside / Math.max(far, 1);
    v[59 + side] = v[12 + side] + up / Math.max(far, 1);
    // Where the corner or the jaw pulls at the cheek it can be sucked in less.
    const pull = Math.max(v[6 + side], v[53 + side], 0.5 * v[12 + side], 0.5 * v[59 + side],
        Math.abs(v[15]));
    if (usual) atLeast([39 + side], -CHEEK_IN + 0.5 * pull);
  }
  atMost([[51, 4], [55, 8], [56, 9]], rooms.upper_lip);
  atMost([[52, 5], [57, 10], [58, 11]], rooms.lower_lip);
}

// As far as faces go: from 85 % of the limit on skin gives way, and it is never passed.
function ease(value, low, high) {
  const limit = value < 0 ? -low : high;
  const soft = 0.15 * limit;
  const over = Math.abs(value) - (limit - soft);
  return over > 0 ? Math.sign(value) * (limit - soft + soft * Math.tanh(over / soft)) : value;
}

/** Changes values by control, low-level FAPs by number, to what the face can do. */
export function stopAtContact(model, v) {
  for (const [fap, low, high] of model.reaches) v[fap] = ease(v[fap], low, high);
  for (const [upper, lower] of [[4, 5], [8, 10], [9, 11]]) {
    meet(v, upper, lower);
    if (model.lips.length === 0) closeNearly(v, upper, lower);
  }
  share(v, 19, 21, 1024);
  share(v, 20, 22, 1024);
  stopAtRooms(v, model.rooms, model.reaches.length > 0);
}

// Pairs that have passed each other or nearly touch meet in the middle.
function closePairs(pairs, soft, skin) {
  for (let k = 0; k < pairs.length; k += 2) {
    const u = pairs[k] * 3;
    const l = pairs[k + 1] * 3;
    const touch = smoothStep(soft, soft / 3, skin[u + 1] - skin[l + 1]) * 0.5;
    for (const axis of [0, 1, 2]) {
      const apart = (skin[l + axis] - skin[u + axis]) * touch;
      skin[u + axis] += apart;
      skin[l + axis] -= apart;
    }
  }
}

/** Closes lips and lids of which the pairs are known. */
export function closeContacts(model, skin) {
  const touch = CONTACT * model.fapu.mns;
  for (const pairs of [model.lips, ...model.lids]) closePairs(pairs, touch, skin);
}
