// Walking the boxes of ISO files. Content lies from `begin` to `end`.

export const typeAt = (view, at) => String.fromCharCode(...new Uint8Array(view.buffer,
    view.byteOffset + at, 4));

/**
 * The box at `at`: {type, begin, end}; null if less than its header is there. It may end beyond the
 * bytes.
 */
export function boxAt(view, at) {
  if (at + 8 > view.byteLength) return null;
  let size = view.getUint32(at), header = 8;
  if (size === 1) {
    if (at + 16 > view.byteLength) return null;
    size = Number(view.getBigUint64(at + 8));
    header = 16;
  } else if (size === 0) {
    size = Infinity;  // up to the end of the file
  }
  return {type: typeAt(view, at + 4), begin: at + header, end: at + Math.max(size, header)};
}

/** The boxes within a range, those that are whole. */
export function* boxesIn(view, begin, end) {
  for (let at = begin; at < end;) {
    const box = boxAt(view, at);
    if (!box || box.end > end) return;
    yield box;
    at = box.end;
  }
}

/** The first box by a path of types from a box, or undefined. */
export function find(view, box, ...path) {
  for (const type of path) {
    box = [...boxesIn(view, box.begin, box.end)].find((each) => each.type === type);
    if (!box) return undefined;
  }
  return box;
}

/** Version and flags of a full box. */
export const fullBox = (view, {begin}) => ({version: view.getUint8(begin),
    flags: view.getUint32(begin) & 0xFFFFFF});
